// Around extraordinary vertices networks of the limit's curves are off by what the eigenvalues of subdivision say, level by level; and what is one polynomial is
// reproduced wherever it is.
#include "subdivision/limit_levels.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <numbers>

#include "cages.h"
#include "commands/command.h"
#include "error.h"
#include "io/cage_obj.h"
#include "scene/json.h"
#include "subdivision.h"
#include "subdivision/limit_cell.h"
#include "subdivision/limit_compare.h"
#include "subdivision/limit_vertices.h"

namespace isoparm {
namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();
constexpr double pi = std::numbers::pi;

/// n sectors of 3 x 3 quads (or of 9 triangles) about a vertex, heights those of a saddle and of a bowl: of frequency 2 and 0 around the vertex.
Cage star(int n, bool triangles, double saddle, double bowl) {
    constexpr int m = 3;
    Cage c;
    std::map<std::array<int, 3>, int> number;
    const auto vertex = [&](int k, int i, int j) {
        if (i == 0 && j > 0) k = (k + 1) % n, i = j, j = 0;
        if (i == 0) k = 0;
        const auto [at, fresh] = number.try_emplace({k, i, j}, static_cast<int>(c.positions.size()));
        if (fresh) {
            const double a = 2 * pi * k / n, b = 2 * pi * (k + 1) / n, x = i * std::cos(a) + j * std::cos(b), y = i * std::sin(a) + j * std::sin(b);
            c.positions.emplace_back(x, y, saddle * (x * x - y * y) + bowl * (x * x + y * y));
        }
        return at->second;
    };
    for (int k = 0; k < n; ++k)
        for (int i = 0; i < m; ++i)
            for (int j = 0; j < m; ++j) {
                const int a = vertex(k, i, j), b = vertex(k, i + 1, j), d = vertex(k, i + 1, j + 1), e = vertex(k, i, j + 1);
                if (!triangles) c.faces.push_back({a, b, d, e});
                else if (i + j < m) {
                    c.faces.push_back({a, b, e});
                    if (i + j < m - 1) c.faces.push_back({b, d, e});
                }
            }
    return c;
}

LimitLevels levels_of(const Cage& c, Scheme scheme = Scheme::catmull_clark, int levels = 6) { return measure_levels(LimitSurface(c, scheme), {levels, 9}); }
const LimitLevel& last(const LimitLevels& r, int valence, const std::string& method) {
    const LimitLevel* found = nullptr;
    for (const LimitLevel& row : r.by_level)
        if (row.valence == valence && row.method == method) found = &row;
    if (!found) throw std::runtime_error("no level of valence " + std::to_string(valence) + " by " + method);
    return *found;
}

TEST(LimitLevels, EigenvaluesAreThoseOfTheLiterature) {
    const std::map<int, Eigenvalues> table{{3, {.41010, .16667}}, {4, {.5, .25}}, {5, {.54999, .34011}}, {6, {.57968, .41010}}, {8, {.61112, .5}}};
    for (const auto& [n, e] : table) {
        EXPECT_NEAR(eigenvalues(Scheme::catmull_clark, n).lambda, e.lambda, 1e-5) << n;
        EXPECT_NEAR(eigenvalues(Scheme::catmull_clark, n).mu, e.mu, 1e-5) << n;
    }
    EXPECT_DOUBLE_EQ(eigenvalues(Scheme::loop, 6).lambda, 0.5);
    EXPECT_NEAR(eigenvalues(Scheme::loop, 6).mu, 0.25, 1e-15);
    EXPECT_DOUBLE_EQ(eigenvalues(Scheme::loop, 3).lambda, 0.25);
    EXPECT_DOUBLE_EQ(eigenvalues(Scheme::loop, 3).mu, 0.125);
}

struct Around {
    int valence;
    Scheme scheme;
};
class Ratios : public testing::TestWithParam<Around> {};

// At valence 3 no frequency 2 exists, and of Loop's scheme at 5 that of the bowl is the greater. At valence 8 the saddle of Catmull and Clark is linear in (u,v) on each
// face (mu = 1/2), and bilinear Coons patches reproduce it: there is nothing along the normal to fall.
TEST_P(Ratios, TendToTheEigenvalues) {
    const auto [n, scheme] = GetParam();
    const bool loop = scheme == Scheme::loop, cup = n == 3 || (loop && n < 6);
    const LimitLevels r = levels_of(star(n, loop, cup ? 0 : 0.2, cup ? 0.2 : 0), scheme, 8);
    EXPECT_EQ(r.refused, "");
    ASSERT_EQ(r.valences.size(), 1u);
    EXPECT_EQ(r.valences[0].vertices, 1);
    const double lambda = r.valences[0].lambda, mu = r.valences[0].mu;
    for (const LimitMethod& method : loop ? triangle_methods() : quad_methods()) {
        const LimitLevel& row = last(r, n, method.name);
        EXPECT_EQ(row.level, 8);
        ASSERT_TRUE(row.ratio_deviation) << method.name;
        EXPECT_NEAR(*row.ratio_deviation, lambda, 0.01 * lambda) << method.name;
        if (n == 8 && method.name == "coons") {
            EXPECT_LT(*row.measured.normal_deviation, 1e-14);
            continue;
        }
        ASSERT_TRUE(row.ratio_normal && row.ratio_g1) << method.name;
        EXPECT_NEAR(*row.ratio_normal, mu, 0.03 * mu) << method.name;
        EXPECT_NEAR(*row.ratio_g1, mu / lambda, 0.03 * mu / lambda) << method.name;
    }
    EXPECT_LT(*r.masks_gap, 1e-13);
}
INSTANTIATE_TEST_SUITE_P(Around, Ratios,
                         testing::Values(Around{3, Scheme::catmull_clark}, Around{5, Scheme::catmull_clark}, Around{6, Scheme::catmull_clark}, Around{8, Scheme::catmull_clark},
                                         Around{5, Scheme::loop}, Around{7, Scheme::loop}, Around{8, Scheme::loop}),
                         [](const auto& info) { return (info.param.scheme == Scheme::loop ? "loop" : "catmull_clark") + std::to_string(info.param.valence); });

/// The tangents of the masks at the corner of face 0 of a star that is its vertex.
CornerTangents tangents_of(const Cage& c, Scheme scheme) {
    for (const LimitSample& s : limit_samples(c, scheme, 1))
        if (s.face == 0 && s.u == 0 && s.v == 0) return {s.next, s.previous};
    throw std::runtime_error("no sample");
}
Patch face_of(const Cage& c, Scheme scheme = Scheme::catmull_clark, const std::string& name = "#0") {
    for (const Member& m : make_subdivision(c, scheme).patches)
        if (m.name == name) return m.patch;
    throw std::runtime_error("no patch " + name);
}

// Nearer and nearer to the vertex the limit's own derivatives turn into the masks' directions, by mu / lambda a level.
TEST(LimitLevels, TangentsAreTheDirectionsOfTheLimitAtTheVertex) {
    for (const bool loop : {false, true})
        for (const int n : {3, 5, 7}) {
            const Scheme scheme = loop ? Scheme::loop : Scheme::catmull_clark;
            const Cage c = star(n, loop, 0.2, 0.1);
            const CornerTangents t = tangents_of(c, scheme);
            const Patch face = face_of(c, scheme);
            const double near = std::ldexp(1.0, -12), off = std::pow(eigenvalues(scheme, n).mu / eigenvalues(scheme, n).lambda, 12);
            const LimitFrame x = limit_function(face)(near, 0), y = limit_function(face)(0, near);
            EXPECT_LT(length(normalized(x.du) - normalized(t.next)), 10 * off + 1e-9) << n << loop;
            EXPECT_LT(length(normalized(y.dv) - normalized(t.previous)), 10 * off + 1e-9) << n << loop;
        }
}

double normal_deviation(const Patch& face, const CornerTangents& tangents, const Point& normal, int level) {
    FaceTangents known;
    known[0] = tangents;
    const LimitCell cell(Domain::quad, limit_function(face), 0, std::ldexp(1.0, -level), known);
    const Patch surface = quad_methods().back().make(cell);
    double worst = 0;
    for (int i = 0; i <= 8; ++i)
        for (int j = 0; j <= 8; ++j) worst = std::max(worst, std::fabs(dot(surface.point(i / 8.0, j / 8.0) - cell(i / 8.0, j / 8.0).p, normal)));
    return worst;
}

// The negative control: tangents one degree off the tangent plane are felt by lambda a level, not by mu.
TEST(LimitLevels, TangentsOffTheTangentPlaneAreFound) {
    const Cage c = star(5, false, 0.2, 0);
    const Patch face = face_of(c);
    const CornerTangents right = tangents_of(c, Scheme::catmull_clark);
    const Point normal = normalized(cross(right.next, right.previous));
    const CornerTangents tilted{right.next + 0.0175 * length(right.next) * normal, right.previous};
    const Eigenvalues e = eigenvalues(Scheme::catmull_clark, 5);
    EXPECT_NEAR(normal_deviation(face, right, normal, 8) / normal_deviation(face, right, normal, 7), e.mu, 0.03 * e.mu);
    EXPECT_NEAR(normal_deviation(face, tilted, normal, 8) / normal_deviation(face, tilted, normal, 7), e.lambda, 0.1 * e.lambda);
}

double identity_gap(const Patch& face, double u, double v, double h) {
    const LimitCell cell = LimitCell(Domain::quad, limit_function(face), 0, 1).part({u, v}, {u + h, v}, {u, v + h});
    const Patch surface = quad_methods().back().make(cell);
    double worst = 0;
    for (int i = 0; i <= 8; ++i)
        for (int j = 0; j <= 8; ++j) worst = std::max(worst, distance(surface.point(i / 8.0, j / 8.0), cell(i / 8.0, j / 8.0).p));
    return worst;
}

// A crease of sharpness s is smooth after ceil(s) steps: then, and not before, the cells beside it are one bicubic patch each.
TEST(LimitLevels, SemiSharpCreasesAreBicubicOnTheirSubCellsOnly) {
    Cage c = star(4, false, 0.2, 0.1);
    c.positions[0].z = 0.5;
    for (const double sharpness : {1.0, 1.5, 3.0}) {
        c.creases.clear();
        for (const int end : {1, 2, 3}) c.creases.push_back({c.faces[3 * (end - 1)][0], c.faces[3 * (end - 1)][1], sharpness});  // along a side of sector 0
        const Patch face = face_of(c);
        const double h = std::ldexp(1.0, -static_cast<int>(std::ceil(sharpness)));
        EXPECT_LT(identity_gap(face, 0.5, 0, h), 100 * eps) << sharpness;
        EXPECT_GT(identity_gap(face, 0, 0, 2 * h), 1e-5) << sharpness;
        EXPECT_TRUE(levels_of(c).identities_hold(200 * eps * 5));
    }
}

// All kinds of vertices and creases, valence 2 among them.
TEST(LimitLevels, SubCellsOfIrregularFacesAreReproduced) {
    for (const test::NamedCage& c : test::all_cages()) {
        const LimitSurface limit(c.cage, c.scheme);
        const LimitLevels r = measure_levels(limit, {1, 5});
        EXPECT_EQ(r.refused, "") << c.name;
        EXPECT_TRUE(r.identities_hold(200 * eps * 5)) << c.name;
        for (int f = 0; f < limit.faces() && c.scheme == Scheme::catmull_clark; ++f) EXPECT_EQ(r.subcells.compared[f] == 1, limit.kind(f) == LimitFace::irregular) << c.name << " face " << f;
    }
}

TEST(LimitLevels, OrdersOfTriangularMethodsShowOnLoopsRegularFaces) {
    const LimitLevels r = levels_of(test::triangle_grid_cage(), Scheme::loop, 5);
    std::map<std::string, int> seen;
    for (const LoopLevel& row : r.loop) {
        if (row.level != 5) continue;
        ++seen[row.method];
        ASSERT_TRUE(row.ratio) << row.method;
        EXPECT_NEAR(*row.ratio, 1 << row.order, 0.03 * (1 << row.order)) << row.method;
    }
    EXPECT_EQ(seen.size(), 7u);
    EXPECT_LT(*r.loop_edges, 1e-14);
    EXPECT_GT(r.loop[0].deviation, 1e-5);  // no Coons triangle here reproduces a quartic
}

TEST(LimitLevels, DoesNotDependOnTheNumberOfThreads) {
    const Cage c = test::fan_cage(5);
    const auto numbers = [&](int threads) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        std::vector<double> all;
        const LimitLevels r = levels_of(c, Scheme::catmull_clark, 3);
        for (const LimitLevel& row : r.by_level) all.insert(all.end(), {*row.measured.deviation, *row.measured.normal_deviation, *row.measured.g1_degrees, *row.measured.c1});
        all.push_back(*r.masks_gap), all.push_back(*r.subcells.deviation);
        return all;
    };
    EXPECT_EQ(numbers(1), numbers(4));
}

// What is measured is as small as the cells; rounding is as large as the coordinates.
TEST(LimitLevels, HoldFarFromTheOriginAndForOneLine) {
    for (const Scheme scheme : {Scheme::catmull_clark, Scheme::loop}) {
        const bool loop = scheme == Scheme::loop;
        Cage c = star(5, loop, 0.2, 0.1);
        const LimitLevels near = levels_of(c, scheme, 2);
        for (Point& p : c.positions) p = p + Point(1e7, -2e7, 1e7);
        const LimitLevels far = levels_of(c, scheme, 2);
        ASSERT_EQ(far.by_level.size(), near.by_level.size());
        for (std::size_t k = 0; k < far.by_level.size(); ++k) EXPECT_NEAR(*far.by_level[k].measured.deviation, *near.by_level[k].measured.deviation, 1e-6);
        EXPECT_EQ(far.loop.size(), near.loop.size());
        EXPECT_TRUE(far.identities_hold(200 * eps * 3e7));
        for (Point& p : c.positions) p = {p.x, p.x, p.x};
        EXPECT_TRUE(levels_of(c, scheme, 2).identities_hold(200 * eps * 6e7));
    }
}

TEST(LimitLevels, WhereDerivativesVanishTheirDirectionsDoNotCount) {
    // At vertices of three triangles the limit's derivatives vanish. The limit is an affine image of that of the regular tetrahedron, which is smooth.
    Cage corner;
    corner.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    corner.faces = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
    const LimitLevels r = levels_of(corner, Scheme::loop);
    EXPECT_LT(*r.worst.g1_degrees, 5);
    for (const LimitLevel& row : r.by_level)
        if (row.level == 6) { EXPECT_LT(*row.measured.g1_degrees, row.method == "nielson_c1" ? 1e-3 : 2) << row.method; }
}

TEST(LimitLevels, AnswersWhereThereIsNothingToMeasure) {
    const LimitLevels torus = levels_of(read_cage_obj(read_text_file(std::string(ISOPARM_SOURCE_DIR) + "/tests/data/cages/torus.obj"), "torus"));
    EXPECT_TRUE(torus.by_level.empty() && torus.refused.empty());
    Cage bowtie;  // two faces at one vertex
    bowtie.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {-1, 0, 1}, {-1, -1, 0}, {0, -1, 0}};
    bowtie.faces = {{0, 1, 2, 3}, {0, 4, 5, 6}}, bowtie.boundary = Cage::Boundary::edge_only;
    const LimitLevels r = levels_of(bowtie);
    EXPECT_NE(r.refused.find("vertex 0 is not manifold"), std::string::npos) << r.refused;
    EXPECT_TRUE(r.by_level.empty());
    Cage wing;  // three faces on one edge, each regular
    wing.positions = {{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0}, {-1, 0, 0}, {-1, 1, 0}, {0, 0, 1}, {0, 1, 1}};
    wing.faces = {{0, 2, 3, 1}, {0, 1, 5, 4}, {0, 1, 7, 6}};
    EXPECT_NE(levels_of(wing).refused.find("not manifold"), std::string::npos);
    Cage hole = star(5, false, 0.2, 0.1);
    hole.holes = {0};
    EXPECT_TRUE(levels_of(hole).by_level.empty());
    EXPECT_THROW(levels_of(bowtie, Scheme::catmull_clark, 13), Error);
}

// ---- the command

std::pair<int, std::string> limit(const std::vector<std::string>& arguments) {
    testing::internal::CaptureStdout();
    testing::internal::CaptureStderr();
    const int code = limit_command.run(arguments);
    testing::internal::GetCapturedStderr();
    return {code, testing::internal::GetCapturedStdout()};
}
std::string cage_path(const std::string& name) { return std::string(ISOPARM_SOURCE_DIR) + "/tests/data/cages/" + name + ".obj"; }

TEST(LimitLevelsCommand, FillsTheContract) {
    const auto [code, out] = limit({cage_path("valence5"), "--json", "--levels", "3"});
    EXPECT_EQ(code, kSuccess);
    const Json j = Json::parse(out, "out");
    EXPECT_GT(j.at("max_deviation", "").at("irregular", "").number(), 1e-6);
    EXPECT_GT(j.at("max_normal_degrees", "").at("irregular", "").number(), 1e-6);
    EXPECT_GT(j.at("edges", "").at("max_g1_degrees", "").number(), 1e-6);
    EXPECT_GT(j.at("edges", "").at("max_c1", "").number(), 1e-6);
    const Json levels = j.at("by_level", "");
    ASSERT_EQ(levels.size(), 8u);  // two methods, levels 0 to 3
    EXPECT_EQ(levels[7].at("level", "").number(), 3);
    EXPECT_EQ(levels[7].at("valence", "").number(), 5);
    EXPECT_NEAR(levels[7].at("ratios", "").at("deviation", "").number(), 0.55, 0.03);
    EXPECT_NEAR(levels[7].at("expected", "").at("normal_deviation", "").number(), 0.34011, 1e-5);
    EXPECT_TRUE(levels[0].at("ratios", "").at("deviation", "").is(Json::Kind::null));
}

TEST(LimitLevelsCommand, FillsTheContractForLoopsScheme) {
    const std::string path = testing::TempDir() + "isoparm_limit_star.obj";
    const Cage c = star(5, true, 0.2, 0.1);
    std::ofstream out(path);
    for (const Point& p : c.positions) out << "v " << to_text(p.x) << " " << to_text(p.y) << " " << to_text(p.z) << "\n";
    for (const auto& f : c.faces) out << "f " << f[0] + 1 << " " << f[1] + 1 << " " << f[2] + 1 << "\n";
    out.close();
    const auto [code, text] = limit({path, "--scheme", "loop", "--json", "--levels", "1"});
    std::filesystem::remove(path);
    EXPECT_EQ(code, kSuccess);
    const Json j = Json::parse(text, "out"), row = j.at("loop", "")[0];
    EXPECT_EQ(row.at("method", "").string(), "nielson_c1");
    EXPECT_EQ(j.at("max_deviation", "").at("regular", "").number(), row.at("deviation", "").number());
    EXPECT_GT(row.at("deviation", "").number(), 0);
}

TEST(LimitLevelsCommand, ComparesLoopsSchemeToo) {
    const auto [code, out] = limit({cage_path("icosahedron"), "--scheme", "loop", "--levels", "2"});
    EXPECT_EQ(code, kSuccess);
    EXPECT_NE(out.find("valence 5 (12 vertices), nielson_c1; expected ratios (to the level before): 0.4523 lambda"), std::string::npos) << out;
}

/// The folder of cages named by ISOPARM_CAGES, when there is one: *.obj, those of Loop's scheme with that word in their name.
TEST(LimitLevelsCommand, AnswersForTheCagesOfTheEnvironment) {
    const char* folder = std::getenv("ISOPARM_CAGES");
    if (!folder) GTEST_SKIP() << "ISOPARM_CAGES is not set";
    for (const auto& file : std::filesystem::directory_iterator(folder)) {
        if (file.path().extension() != ".obj") continue;
        const bool loop = file.path().filename().string().find("loop") != std::string::npos;
        const auto [code, out] = limit({file.path().string(), "--scheme", loop ? "loop" : "catmull-clark"});
        EXPECT_TRUE(code == kSuccess || (code == kNotComparable && out.find("not manifold") != std::string::npos)) << file.path() << "\n" << out;
    }
}

}  // namespace
}  // namespace isoparm
