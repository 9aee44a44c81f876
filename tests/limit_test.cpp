// The composite Hermite Coons surface over regular faces is the subdivision limit, and nothing less is.
#include "limit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <limits>

#include "commands/command.h"
#include "commands/limit_report.h"
#include "error.h"
#include "io/cage_obj.h"
#include "patches/tensor_bezier.h"
#include "scene/json.h"
#include "subdivision/limit_compare.h"

namespace isoparm {
namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();

std::string cage_path(const std::string& name) { return std::string(ISOPARM_SOURCE_DIR) + "/tests/data/cages/" + name + ".obj"; }
Cage cage(const std::string& name) { return read_cage_obj(read_text_file(cage_path(name)), name); }
LimitReport report(const Cage& c, Scheme scheme = Scheme::catmull_clark) { return compare_limit(LimitSurface(c, scheme)); }

/// m x n quads with heights; vertex (i,j) has index j (m+1) + i, face (i,j) index j m + i.
Cage grid(int m, int n) {
    Cage c;
    for (int j = 0; j <= n; ++j)
        for (int i = 0; i <= m; ++i) c.positions.emplace_back(i, j, 0.3 * ((i * 7 + j * 5 + i * j) % 4));
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < m; ++i) {
            const int k = j * (m + 1) + i;
            c.faces.push_back({k, k + 1, k + m + 2, k + m + 1});
        }
    return c;
}

// ---- the evaluator

TEST(LimitSurface, RegularFacesAreUniformBicubicBSplines) {
    const Cage c = grid(5, 5);
    const LimitSurface limit(c, Scheme::catmull_clark);
    Grid<Point> points(4);
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j) points[i].push_back(c.positions[(j + 1) * 6 + i + 1]);
    const Patch spline = make_bspline_patch(3, 3, {0, 1, 2, 3, 4, 5, 6, 7}, {0, 1, 2, 3, 4, 5, 6, 7}, points);
    for (const double u : {0.0, 0.3, 1.0})
        for (const double v : {0.0, 0.6, 1.0}) {
            const LimitPoint x = limit(2 * 5 + 2, u, v);
            const auto s = evaluate(spline, 3 + u, 3 + v);
            EXPECT_LT(distance(x.p, s.position), 20 * eps * 5);
            EXPECT_LT(distance(x.du, *s.du), 50 * eps * 5);
            EXPECT_LT(distance(x.dv, *s.dv), 50 * eps * 5);
            EXPECT_LT(distance(x.duv, *s.duv), 50 * eps * 5);
        }
}

// A regular vertex goes to (16 P + 4 sum of edge neighbours + sum of diagonal neighbours) / 36, the value of the bicubic
// B-spline at its knot: (1 4 1)/6 each way.
TEST(LimitSurface, CornersFollowTheLimitMask) {
    const Cage c = grid(4, 4);
    const LimitSurface limit(c, Scheme::catmull_clark);
    const auto p = [&](int i, int j) { return c.positions[j * 5 + i]; };
    const Point mask = (16.0 * p(2, 2) + 4.0 * (p(1, 2) + p(3, 2) + p(2, 1) + p(2, 3)) + p(1, 1) + p(3, 1) + p(1, 3) + p(3, 3)) / 36.0;
    EXPECT_LT(distance(limit(2 * 4 + 2, 0, 0).p, mask), 20 * eps * 4);
    EXPECT_LT(distance(limit(2 * 4 + 1, 1, 0).p, mask), 20 * eps * 4);
    EXPECT_LT(distance(limit(1 * 4 + 1, 1, 1).p, mask), 20 * eps * 4);
    EXPECT_LT(distance(limit(1 * 4 + 2, 0, 1).p, mask), 20 * eps * 4);
}

// An infinitely sharp crease from boundary to boundary cuts the surface as a pair of scissors would.
TEST(LimitSurface, CreasesSplitTheSurfaceIntoItsHalves) {
    const Cage whole = cage("creased");  // 6 x 4 faces, crease along i = 3
    Cage left;
    for (int j = 0; j <= 4; ++j)
        for (int i = 0; i <= 3; ++i) left.positions.push_back(whole.positions[j * 7 + i]);
    left.faces = grid(3, 4).faces;
    const LimitSurface a(whole, Scheme::catmull_clark), b(left, Scheme::catmull_clark);
    for (int j = 0; j < 4; ++j)
        for (int i = 0; i < 3; ++i) {
            ASSERT_EQ(a.kind(j * 6 + i), LimitFace::regular);
            for (const double u : {0.0, 0.4, 1.0})
                for (const double v : {0.0, 0.7, 1.0}) {
                    const LimitPoint x = a(j * 6 + i, u, v), y = b(j * 3 + i, u, v);
                    EXPECT_LT(distance(x.p, y.p), 50 * eps * 7);
                    EXPECT_LT(distance(x.du, y.du), 100 * eps * 7);
                    EXPECT_LT(distance(x.duv, y.duv), 200 * eps * 7);
                }
        }
}

TEST(LimitSurface, BoundaryRulesDecideWhichFacesAreThere) {
    Cage c = grid(4, 3);
    EXPECT_EQ(report(c).regular, 12);
    c.boundary = Cage::Boundary::edge_only;  // the four corners are rounded
    EXPECT_EQ(report(c).regular, 8);
    EXPECT_EQ(LimitSurface(c, Scheme::catmull_clark).reason(0), "boundary corner that is rounded");
    c.boundary = Cage::Boundary::none;
    EXPECT_EQ(report(c).regular, 2);
    EXPECT_EQ(report(c).without_limit, 10);
    EXPECT_EQ(LimitSurface(c, Scheme::catmull_clark).reason(0), "boundary without interpolation");
    c.holes = {5};
    EXPECT_EQ(report(c).regular, 1);
    EXPECT_EQ(LimitSurface(c, Scheme::catmull_clark).reason(5), "hole");
}

TEST(LimitSurface, SharedEdgesMeetWhateverVertexAFaceStartsWith) {
    Cage c = cage("torus");
    for (std::size_t k = 0; k < c.faces.size(); ++k) std::rotate(c.faces[k].begin(), c.faces[k].begin() + k % 4, c.faces[k].end());
    const LimitSurface limit(c, Scheme::catmull_clark);
    const auto edges = limit.shared_edges();
    EXPECT_EQ(edges.size(), 120u);
    const LimitReport r = compare_limit(limit);
    EXPECT_EQ(r.edges.compared, 120);
    EXPECT_LT(*r.edges.c0, 50 * eps * r.size);
    EXPECT_LT(*r.edges.c1, 200 * eps * r.size);
    EXPECT_LT(*r.edges.g1_degrees, 1e-10);
    EXPECT_TRUE(r.identity_holds());
}

TEST(LimitSurface, RefusesWhatOpenSubdivCannotRead) {
    const auto refused = [](Cage c, Scheme s, const std::string& words) {
        try {
            LimitSurface limit(c, s);
            ADD_FAILURE() << "accepted; expected: " << words;
        } catch (const Error& e) {
            EXPECT_EQ(e.kind(), ErrorKind::input);
            EXPECT_NE(std::string(e.what()).find(words), std::string::npos) << e.what();
        }
    };
    const Cage good = grid(1, 1);
    Cage c = good;
    c.faces = {};
    refused(c, Scheme::catmull_clark, "without faces");
    c = good, c.faces[0][2] = 4;
    refused(c, Scheme::catmull_clark, "index 4, expected 0 to 3");
    c = good, c.faces[0][2] = -1;
    refused(c, Scheme::catmull_clark, "index -1");
    c = good, c.faces[0][2] = 0;
    refused(c, Scheme::catmull_clark, "degenerate");
    c = good, c.faces[0].resize(2);
    refused(c, Scheme::catmull_clark, "2 vertices");
    c = good, c.positions[0].x = std::numeric_limits<double>::quiet_NaN();
    refused(c, Scheme::catmull_clark, "not finite");
    c = good, c.creases = {{0, 3, 1}};
    refused(c, Scheme::catmull_clark, "OpenSubdiv refuses");
    c = good, c.creases = {{0, 1, -1}};
    refused(c, Scheme::catmull_clark, "0 or more");
    c = good, c.corners = {{7, 1}};
    refused(c, Scheme::catmull_clark, "a corner");
    c = good, c.holes = {1};
    refused(c, Scheme::catmull_clark, "a hole");
    refused(good, Scheme::loop, "expected 3");
}

// ---- the comparison

struct Expected {
    const char* cage;
    int regular, irregular, compared, creases;
    double bilinear;  // what the negative control must exceed
};
class Identity : public testing::TestWithParam<Expected> {};

// Hermite Coons patches reproduce what is cubic in u or in v, and every regular face is bicubic: equal up to rounding.
TEST_P(Identity, HermiteCompositeEqualsTheLimitAndBilinearCoonsDoesNot) {
    const Expected& e = GetParam();
    const LimitReport r = report(cage(e.cage));
    EXPECT_EQ(r.regular, e.regular);
    EXPECT_EQ(r.irregular, e.irregular);
    EXPECT_EQ(r.faces, e.regular + e.irregular);
    EXPECT_EQ(r.not_compared.size(), std::size_t(e.irregular));
    EXPECT_EQ(r.edges.compared, e.compared);
    EXPECT_EQ(r.edges.creases, e.creases);
    ASSERT_TRUE(r.deviation);
    EXPECT_LE(*r.deviation, 50 * eps * r.size);
    EXPECT_LE(*r.network_gap, 100 * eps * r.size);
    EXPECT_LE(*r.normal_degrees, 1e-10);
    EXPECT_TRUE(r.identity_holds());
    EXPECT_GE(*r.bilinear_coons, e.bilinear);
    if (e.compared > 0) {
        EXPECT_LE(*r.edges.c1, 200 * eps * r.size);
        EXPECT_LE(*r.edges.g1_degrees, 1e-10);
    }
}
// plane: 3*3 + 4*2 inner edges; creased: 5*4 + 6*3 less 4 creases; valence5: of 80 inner edges (45 quads, 20 boundary: hence
// (180-30)/2 = 75) 15 touch a face at the extraordinary vertex; cube_sharp: faces flat, so bilinear Coons is exact too.
INSTANTIATE_TEST_SUITE_P(Cages, Identity,
                         testing::Values(Expected{"torus", 60, 0, 120, 0, 1e-3}, Expected{"plane", 12, 0, 17, 0, 1e-3},
                                         Expected{"creased", 24, 0, 34, 4, 1e-3}, Expected{"semisharp", 16, 8, 20, 0, 1e-3},
                                         Expected{"valence5", 40, 5, 60, 0, 1e-8}, Expected{"cube_sharp", 6, 0, 0, 12, 0}),
                         [](const auto& info) { return std::string(info.param.cage); });

TEST(LimitReport, HoldsFarFromTheOrigin) {
    Cage c = cage("torus");
    for (Point& p : c.positions) p = p + Point(1e7, -2e7, 3e7);
    const LimitReport r = report(c);
    EXPECT_LE(*r.deviation, 50 * eps * r.size);
    EXPECT_TRUE(r.identity_holds());
    EXPECT_GE(*r.bilinear_coons, 1e-3);
}

TEST(LimitReport, IrregularFacesAreCountedAndNamed) {
    const LimitReport cube = report(cage("cube"));
    EXPECT_EQ(cube.regular, 0);
    EXPECT_EQ(cube.irregular, 6);
    EXPECT_FALSE(cube.deviation);
    EXPECT_TRUE(cube.identity_holds());
    EXPECT_EQ(cube.not_compared[5].reason, "extraordinary vertex of valence 3");
    const LimitReport star = report(cage("valence5"));
    for (const auto& [face, reason] : star.not_compared) {
        EXPECT_EQ(face % 9, 0);
        EXPECT_EQ(reason, "extraordinary vertex of valence 5");
    }
    EXPECT_EQ(report(cage("semisharp")).not_compared[0].reason, "semi-sharp crease");
}

TEST(LimitReport, LoopFacesAreCountedOnly) {
    const LimitReport r = report(cage("icosahedron"), Scheme::loop);
    EXPECT_EQ(r.faces, 20);
    EXPECT_EQ(r.irregular, 20);
    EXPECT_FALSE(r.deviation);
}

TEST(LimitReport, BilinearSchemeIsReproducedByBothKinds) {
    const LimitReport r = report(cage("torus"), Scheme::bilinear);
    EXPECT_EQ(r.regular, 60);
    EXPECT_LE(*r.deviation, 50 * eps * r.size);
    EXPECT_LE(*r.bilinear_coons, 50 * eps * r.size);
}

TEST(LimitReport, AnswersForAwkwardCages) {
    const auto answer = [](const std::string& faces) {
        std::string text;
        for (int i = 0; i < 12; ++i) text += "v " + std::to_string(i % 4) + " " + std::to_string(i / 4) + " " + std::to_string(i * i % 5) + "\n";
        return report(read_cage_obj(text + faces, "c.obj"));
    };
    EXPECT_EQ(answer("f 1 2 6 5\nf 2 3 7 6\nf 2 6 11 10\n").edges.compared, 0);  // three faces at an edge
    EXPECT_EQ(answer("f 1 2 6 5\nf 6 7 11 10\n").faces, 2);                   // two faces at a vertex
    EXPECT_EQ(answer("f 1 2 3 4 8 7 6 5\n").irregular, 1);                    // an octagon
    EXPECT_EQ(answer("f 1 2 6\nf 2 3 6\n").irregular, 2);                     // triangles
    EXPECT_EQ(answer("f 1 2 6 5\nf 1 2 6 5\n").faces, 2);                     // the same face twice
    EXPECT_EQ(answer("f 1 2 6 5\nf 1 5 6 2\n").irregular, 2);                 // a pillow: every vertex has valence 2
    EXPECT_EQ(answer("f 1 2 6 5\n").regular, 1);                              // one face alone
    EXPECT_EQ(answer("f 1 2 6 5\nf 2 6 7 3\n").faces, 2);                     // neighbours that turn opposite ways
}

TEST(LimitReport, DegenerateShapesStillAnswer) {
    Cage c = cage("torus");
    for (Point& p : c.positions) p = {p.x, 2, 3};
    const LimitReport r = report(c);
    EXPECT_TRUE(r.identity_holds());
    EXPECT_FALSE(r.normal_degrees);
}

// Where squares of lengths leave the range of doubles every deviation is 0, or none is finite.
TEST(LimitReport, RefusesSizesThatCannotBeMeasured) {
    for (const double scale : {0.0, 1e-200, 1e-72, 1e72, 1e160}) {
        Cage c = cage("torus");
        for (Point& p : c.positions) p = scale * p;
        try {
            LimitSurface(c, Scheme::catmull_clark);
            ADD_FAILURE() << "accepted " << scale;
        } catch (const Error& e) {
            EXPECT_EQ(e.kind(), ErrorKind::input);
            EXPECT_NE(std::string(e.what()).find("expected one between 1e-70 and 1e70 to compare"), std::string::npos) << e.what();
        }
    }
    for (const double scale : {1e-69, 1e68}) {
        Cage c = cage("torus");
        for (Point& p : c.positions) p = scale * p;
        const LimitReport r = report(c);
        EXPECT_TRUE(r.identity_holds());
        EXPECT_GT(*r.bilinear_coons, 1e-3 * scale);
    }
}

TEST(LimitReport, VerticesThatNoFaceHasDoNotWidenTheTolerance) {
    Cage c = cage("torus");
    const LimitReport near = report(c);
    c.positions.emplace_back(1e20, 0, 0);
    EXPECT_EQ(report(c).tolerance, near.tolerance);
}

TEST(LimitReport, AFailureIsNeverOverlooked) {
    LimitReport r;
    r.tolerance = 1;
    r.deviation = 2;
    EXPECT_FALSE(r.identity_holds());
    r.deviation = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(r.identity_holds());
    r.deviation = 1, r.network_gap = 2;
    EXPECT_FALSE(r.identity_holds());
    r.network_gap = 1;
    EXPECT_TRUE(r.identity_holds());
}

TEST(LimitReport, DoesNotDependOnTheRun) {
    const LimitReport a = report(cage("valence5")), b = report(cage("valence5"));
    EXPECT_EQ(*a.deviation, *b.deviation);
    EXPECT_EQ(*a.network_gap, *b.network_gap);
    EXPECT_EQ(a.worst_face, b.worst_face);
    EXPECT_EQ(*a.edges.c1, *b.edges.c1);
}

// ---- the command

struct Answer {
    int code;
    std::string out;
};
Answer limit(const std::vector<std::string>& arguments) {
    testing::internal::CaptureStdout();
    testing::internal::CaptureStderr();
    const int code = limit_command.run(arguments);
    testing::internal::GetCapturedStderr();
    return {code, testing::internal::GetCapturedStdout()};
}

TEST(LimitCommand, AnswersInJson) {
    const std::string folder = testing::TempDir() + "isoparm_limit_test/a/b";
    const Answer a = limit({cage_path("valence5"), "--json", "-o", folder});
    EXPECT_EQ(a.code, kSuccess);
    EXPECT_EQ(read_text_file(folder + "/limit.json"), a.out);
    EXPECT_TRUE(std::filesystem::exists(folder + "/limit.png"));
    std::filesystem::remove_all(testing::TempDir() + "isoparm_limit_test");
    const Json j = Json::parse(a.out, "out");
    EXPECT_EQ(j.at("faces", "").number(), 45);
    EXPECT_EQ(j.at("regular", "").number(), 40);
    EXPECT_EQ(j.at("irregular", "").number(), 5);
    EXPECT_LT(j.at("max_deviation", "").at("regular", "").number(), j.at("tolerance", "").number());
    EXPECT_LT(j.at("max_normal_degrees", "").at("regular", "").number(), 1e-10);
    EXPECT_LT(j.at("edges", "").at("regular", "").at("max_g1_degrees", "").number(), 1e-10);
    EXPECT_LT(j.at("edges", "").at("regular", "").at("max_c1", "").number(), 1e-12);
    EXPECT_EQ(j.at("not_compared", "").size(), 0u);
}

TEST(LimitCommand, NamesWhatItCannotCompare) {
    const std::string path = testing::TempDir() + "isoparm_limit_bowtie.obj";
    std::ofstream(path) << "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv -1 0 1\nv -1 -1 0\nv 0 -1 0\nv 2 0 0\nv 2 1 0\nf 1 2 3 4\nf 1 5 6 7\nf 2 8 9 3\nt interpolateboundary 1/0/0 2\n";
    const Answer a = limit({path});
    EXPECT_EQ(a.code, kNotComparable);
    EXPECT_NE(a.out.find("vertex 0 is not manifold"), std::string::npos) << a.out;
    EXPECT_NE(a.out.find("boundary corner that is rounded: face 0 (line 10)"), std::string::npos) << a.out;
    std::filesystem::remove(path);
}

/// The torus moved along x, as a file.
std::string moved_torus(double by) {
    const Cage c = cage("torus");
    const std::string path = testing::TempDir() + "isoparm_limit_moved.obj";
    std::ofstream out(path);
    for (const Point& p : c.positions) out << "v " << to_text(p.x + by) << " " << to_text(p.y) << " " << to_text(p.z) << "\n";
    for (const auto& f : c.faces) out << "f " << f[0] + 1 << " " << f[1] + 1 << " " << f[2] + 1 << " " << f[3] + 1 << "\n";
    return path;
}

TEST(LimitCommand, ClaimsNoIdentityWhereRoundingHidesIt) {
    const std::string near = moved_torus(1e6);
    const Answer a = limit({near, "--json"});
    EXPECT_EQ(a.code, kSuccess);
    EXPECT_NE(a.out.find("\"identity\": true"), std::string::npos);
    const std::string far = moved_torus(1e15);
    const Answer b = limit({far, "--json"});
    EXPECT_EQ(b.code, kNotComparable);
    EXPECT_NE(b.out.find("\"identity\": null"), std::string::npos);
    EXPECT_NE(limit({far}).out.find("says nothing"), std::string::npos);
    std::filesystem::remove(far);
}

// Every identity that decides about the exit code decides about the report's word.
TEST(LimitCommand, IdentityCountsAllThatMustBeEqual) {
    LimitResult r;
    r.regular.tolerance = 1e-7, r.regular.diagonal = 1;
    EXPECT_FALSE(r.identity() || r.something_compared());
    r.irregular.masks_gap = 1e-8;
    EXPECT_TRUE(r.identity().value() && r.something_compared());
    r.irregular.masks_gap = 1e-3;
    EXPECT_FALSE(r.identity().value());
    EXPECT_NE(limit_json(r).find("\"identity\": false"), std::string::npos);
    r.irregular.masks_gap.reset(), r.irregular.loop_edges = 1e-3;
    EXPECT_FALSE(r.identity().value());
    r.regular.diagonal = 0.01;
    EXPECT_FALSE(r.identity().has_value());
}

TEST(LimitCommand, RefusesBadArguments) {
    const std::string torus = cage_path("torus");
    const std::vector<std::vector<std::string>> bad = {
        {}, {"--json"}, {torus, torus}, {torus, "--scheme"}, {torus, "--scheme", "doo-sabin"}, {torus, "--nonsense"}, {torus, "-o"},
        {torus, "--samples", "1"}, {torus, "--samples", "many"}, {torus, "--samples", "9999999999"}, {torus, "--levels", "13"}};
    for (const auto& arguments : bad) {
        try {
            limit_command.run(arguments);
            ADD_FAILURE() << "accepted";
        } catch (const Error& e) {
            EXPECT_EQ(e.kind(), ErrorKind::usage) << e.what();
        }
    }
}

}  // namespace
}  // namespace isoparm
