// Surfaces of type subdivision are the limit surfaces themselves: where they are evaluated, and where they are certified.
#include "subdivision.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <random>

#include "bound.h"
#include "cages.h"
#include "error.h"
#include "limit.h"
#include "meshes/triangle_tree.h"
#include "subdivision/subdivision_face.h"
#include "tessellation_options.h"

namespace isoparm {
namespace {

using test::all_cages, test::NamedCage;

std::map<std::string, Patch> by_name(const Composite& surface) {
    std::map<std::string, Patch> map;
    for (const auto& m : surface) map.emplace(m.name, m.patch);
    return map;
}
const Patch& patch_of(const std::map<std::string, Patch>& patches, const LimitSample& s) {
    return patches.at("#" + std::to_string(s.face) + (s.corner < 0 ? "" : "." + std::to_string(s.corner)));
}

using Evaluate = std::function<void(const Patch&, const LimitSample&)>;
/// Calls f for every sample and the patch that holds it.
void compare(const Cage& cage, Scheme scheme, int levels, const Evaluate& f) {
    const auto surface = make_subdivision(cage, scheme);
    const auto patches = by_name(surface.patches);
    for (const LimitSample& s : limit_samples(cage, scheme, levels)) f(patch_of(patches, s), s);
}

TEST(Subdivision, EqualsTheLimitOfOpenSubdivsMasksAtAllRefinedVertices) {
    for (const NamedCage& c : all_cages()) {
        double worst = 0, enclosed = 0, turned = 0;
        std::size_t count = 0, corners = 0;
        compare(c.cage, c.scheme, 4, [&](const Patch& patch, const LimitSample& s) {
            if (!s.exact) return;
            worst = std::max(worst, distance(patch.point(s.u, s.v), s.p)), ++count;
            enclosed = std::max(enclosed, slack_of(patch, {s.u, s.v}, s.p));
            const auto x = evaluate(patch, s.u, s.v);
            if (x.du || !x.normal || !finite(s.normal)) return;
            turned = std::max(turned, length(*x.normal - s.normal)), ++corners;
        });
        EXPECT_GT(count, 100u) << c.name;
        EXPECT_LT(worst, 2e-14) << c.name;
        EXPECT_LT(enclosed, 4e-12) << c.name;
        EXPECT_LT(turned, 1e-13) << c.name << ": normals at " << corners << " extraordinary corners";
        if (c.name == "cube") {
            EXPECT_EQ(corners, 24u);
        }
    }
}

// At the end of a crease and at valence 2 OpenSubdiv's masks are not those of the limit: its answer moves with the level, by a
// factor lambda each (< 0.62 here), towards where this one is from the beginning.
TEST(Subdivision, IsWhereTheMasksTendToWhereTheyAreNotExact) {
    for (const NamedCage& c : all_cages()) {
        if (c.name != "corners" && c.name != "fan of 2" && c.name != "L, creased") continue;
        double off[2] = {0, 0};
        for (const int levels : {4, 6})
            compare(c.cage, c.scheme, levels, [&](const Patch& patch, const LimitSample& s) {
                if (s.u != 0 && s.u != 1) return;
                if (s.v == 0 || s.v == 1) off[levels == 6] = std::max(off[levels == 6], distance(patch.point(s.u, s.v), s.p));
            });
        EXPECT_LT(off[1], off[0] * 0.4 + 2e-14) << c.name;
        EXPECT_GT(off[0], 1e-5) << c.name;
    }
}

// A boundary vertex with three faces: derivatives do not exist there, the normal is that of points ever nearer (by 0.82 a level).
TEST(Subdivision, NormalsAtExtraordinaryVerticesAreLimits) {
    const auto surface = make_subdivision(test::l_cage(), Scheme::catmull_clark);
    const Patch& patch = surface.patches[5].patch;
    const auto corner = evaluate(patch, 1, 1);
    EXPECT_FALSE(corner.du || corner.dv || corner.duu || corner.gaussian);
    ASSERT_TRUE(corner.normal);
    double before = HUGE_VAL;
    for (int level = 8; level <= 32; level += 8) {
        const double near = 1 - std::ldexp(1.0, -level), off = length(*evaluate(patch, near, near).normal - *corner.normal);
        EXPECT_LT(off, 0.4 * before);
        before = off;
    }
    EXPECT_LT(before, 1e-3);
}

// Sub-faces there turn for many hundreds of levels.
TEST(Subdivision, NormalsOfHighValenceAreThoseOfOpenSubdivsMasks) {
    for (const bool triangles : {false, true}) {
        double turned = 0;
        int corners = 0;
        compare(test::fan_cage(60, triangles), triangles ? Scheme::loop : Scheme::catmull_clark, 1, [&](const Patch& patch, const LimitSample& s) {
            const auto x = evaluate(patch, s.u, s.v);
            if (!s.exact || x.du || std::fabs(s.p.x) + std::fabs(s.p.y) > 0.2) return;
            ASSERT_TRUE(x.normal);
            turned = std::max(turned, length(*x.normal - s.normal)), ++corners;
        });
        EXPECT_GE(corners, 60);
        EXPECT_LT(turned, 1e-12) << triangles;
    }
}

Tessellation mesh_of(const Composite& surface, double relative, Measure measure = Measure::parametric) {
    TessellationOptions options = tests::options_of(surface, relative, measure);
    options.study = false;
    return tessellate(surface, options);
}

/// Random points of the mesh, and where the surface has the same parameters.
double largest_gap(const Composite& surface, const Mesh& mesh) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> uniform(0, 1);
    double worst = 0;
    for (const MeshPart& part : mesh.parts)
        for (const auto& t : part.triangles) {
            double w[3] = {uniform(random), uniform(random), uniform(random)};
            const double sum = w[0] + w[1] + w[2];
            Vec2 uv{0, 0};
            Point p{0, 0, 0};
            for (int k = 0; k < 3; ++k) {
                uv = {uv.x + w[k] / sum * part.uv[t[k]].x, uv.y + w[k] / sum * part.uv[t[k]].y};
                p += w[k] / sum * mesh.positions[part.vertex[t[k]]];
            }
            worst = std::max(worst, distance(p, surface[part.member].patch.point(uv.x, uv.y)));
        }
    return worst;
}

// The certificate holds against positions that the masks of OpenSubdiv give, not this program.
TEST(Subdivision, CertifiedMeshesHoldAgainstTheLimitAndAreWatertight) {
    for (const NamedCage& c : all_cages()) {
        const auto surface = make_subdivision(c.cage, c.scheme);
        for (const Measure measure : {Measure::parametric, Measure::geometric}) {
            if (measure == Measure::geometric && c.name.size() % 2) continue;  // half of them will do
            const Tessellation t = mesh_of(surface.patches, 6e-3, measure);
            EXPECT_LE(t.certified_error, t.tolerance) << c.name;
            EXPECT_EQ(t.topology.t_junctions + t.topology.non_manifold_edges + t.topology.degenerate_triangles, 0u) << c.name;
            const bool open = c.name.find("fan") == 0 || c.name[0] == 'L' || c.name.find("triangles") == 0;
            EXPECT_EQ(t.topology.boundary_loops, open ? 1u : 0u) << c.name;
            EXPECT_LE(largest_gap(surface.patches, t.mesh), measure == Measure::parametric ? t.certified_error : 4 * t.certified_error) << c.name;
            const TriangleMesh flat = triangles_of(t.mesh);
            const TriangleTree tree(flat);
            double worst = 0;
            for (const LimitSample& s : limit_samples(c.cage, c.scheme, 4))
                if (s.exact) worst = std::max(worst, tree.nearest(s.p).distance);
            EXPECT_LE(worst, t.certified_error) << c.name;
            EXPECT_GT(worst, 0.02 * t.certified_error) << c.name << ": or this looks in the wrong place";
        }
    }
}

// The bound does not rest on where the core is cut off: inside it nothing is known but a box, and triangles as small are refused.
TEST(Subdivision, EnclosuresHoldTheSurfaceAndItsDerivatives) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> uniform(0, 1);
    for (const NamedCage& c : all_cages()) {
        const auto surface = make_subdivision(c.cage, c.scheme);
        for (int trial = 0; trial < 200; ++trial) {
            const Patch& patch = surface.patches[random() % surface.patches.size()].patch;
            const double size = std::pow(0.5, 12 * uniform(random));
            Box box;
            for (Interval* side : {&box.u, &box.v}) {
                const double low = (1 - size) * (trial % 3 ? uniform(random) : std::floor(2 * uniform(random)));
                *side = {low, low + size};
            }
            if (patch.domain() == Domain::triangle && box.u.lo + box.v.lo >= 1) continue;
            const Enclosure e = patch.enclose(box);
            const auto positions = patch.enclose_points(box);
            for (int k = 0; k < 10; ++k) {
                const double u = box.u.lo + uniform(random) * (box.u.hi - box.u.lo), v = box.v.lo + uniform(random) * (box.v.hi - box.v.lo);
                if (patch.domain() == Domain::triangle && u + v > 1) continue;
                const PointJet x = patch.jet(u, v);
                for (int axis = 0; axis < 3; ++axis) {
                    const double allowed = 1e-13;  // of the jet
                    EXPECT_TRUE(positions[axis].lo - allowed <= x[axis].c[0] && x[axis].c[0] <= positions[axis].hi + allowed) << c.name;
                    for (int d = 0; d < x.x.size; ++d) {
                        if (std::isnan(x[axis].c[d])) continue;
                        const double eps = allowed * (1 + std::fabs(x[axis].c[d]));
                        EXPECT_TRUE(e.over[axis].c[d].lo - eps <= x[axis].c[d] && x[axis].c[d] <= e.over[axis].c[d].hi + eps) << c.name << " derivative " << d;
                    }
                }
            }
        }
    }
}

TEST(Subdivision, IsTheSameForEveryNumberOfThreads) {
    const auto with = [](std::size_t threads) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        return mesh_of(make_subdivision(test::prism_cage(), Scheme::catmull_clark).patches, 2e-3).mesh;
    };
    const Mesh one = with(1);
    for (const std::size_t threads : {2, 7}) {
        const Mesh other = with(threads);
        ASSERT_EQ(one.positions.size(), other.positions.size());
        for (std::size_t k = 0; k < one.positions.size(); ++k) EXPECT_TRUE(one.positions[k] == other.positions[k]);
        ASSERT_EQ(one.triangle_count(), other.triangle_count());
    }
}

TEST(Subdivision, IsNotChangedByVerticesThatNoFaceHas) {
    Cage cage = test::prism_cage();
    const auto alone = make_subdivision(cage, Scheme::catmull_clark);
    cage.positions.push_back({1e6, 1e6, 1e6});
    const auto surface = make_subdivision(cage, Scheme::catmull_clark);
    ASSERT_EQ(surface.patches.size(), alone.patches.size());
    const Box box{{0, 1e-5}, {0, 1e-5}};
    for (std::size_t k = 0; k < alone.patches.size(); ++k)
        EXPECT_EQ(surface.patches[k].patch.enclose_points(box).x.hi, alone.patches[k].patch.enclose_points(box).x.hi);
}

// So that joints there are proved at the tolerance that `check` has by default, 1e-9 of the diagonal.
TEST(Subdivision, BoxesAroundExtraordinaryVerticesAreFarSmallerThanDefaultTolerances) {
    const auto surface = make_subdivision(test::prism_cage(), Scheme::catmull_clark);
    const double corner = 0x1p-52;
    for (const auto& m : surface.patches) {
        const auto box = m.patch.enclose_points({{0, corner}, {0, corner}});
        for (int axis = 0; axis < 3; ++axis) EXPECT_LT(box[axis].hi - box[axis].lo, 1e-10) << m.name;
    }
}

void expect_refused(const Cage& cage, Scheme scheme, ErrorKind kind, const std::string& part) {
    try {
        make_subdivision(cage, scheme, 5000);
        FAIL() << "not refused: " << part;
    } catch (const Error& e) {
        EXPECT_EQ(e.kind(), kind);
        EXPECT_NE(std::string(e.what()).find(part), std::string::npos) << e.what();
    }
}

TEST(Subdivision, RefusesWhatHasNoSurface) {
    Cage bow = test::fan_cage(4);
    bow.faces = {bow.faces[0], bow.faces[2]};
    expect_refused(bow, Scheme::catmull_clark, ErrorKind::input, "vertex 0 is not manifold");
    Cage book = test::cube_cage();
    book.faces.push_back({0, 1, 7});
    expect_refused(book, Scheme::catmull_clark, ErrorKind::input, "found a third face");
    Cage turned = test::cube_cage();
    std::reverse(turned.faces[3].begin(), turned.faces[3].end());
    expect_refused(turned, Scheme::catmull_clark, ErrorKind::input, "turn the same way");
    expect_refused(test::cube_cage(), Scheme::loop, ErrorKind::input, "triangles only");
    expect_refused(test::creased(test::cube_cage(), {{0, 7, 1}}), Scheme::catmull_clark, ErrorKind::input, "ends of an edge");
    expect_refused(test::fan_cage(600), Scheme::catmull_clark, ErrorKind::input, "600 faces around it");
    Cage plate;
    plate.faces.emplace_back();
    for (int k = 0; k < 501; ++k) plate.positions.emplace_back(std::cos(0.0125 * k), std::sin(0.0125 * k), 0), plate.faces[0].push_back(k);
    expect_refused(plate, Scheme::catmull_clark, ErrorKind::input, "face 0: found 501 vertices, expected at most 500");
    Cage bare = test::l_cage();
    bare.boundary = Cage::Boundary::none;
    expect_refused(bare, Scheme::catmull_clark, ErrorKind::input, "no limit surface");
    Cage sharp = test::l_cage();
    for (const auto& f : sharp.faces)
        for (int k = 0; k < 4; ++k) sharp.creases.push_back({f[k], f[(k + 1) % 4], 9.9});
    expect_refused(sharp, Scheme::catmull_clark, ErrorKind::budget, "pieces");
}

// Two triangles back to back: refined for Loop's scheme, edges have the same ends, and no sub-face would ever be regular.
TEST(Subdivision, RefusesLoopsPillowAndCountsPiecesThatAreRefined) {
    Cage pillow;
    pillow.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, pillow.faces = {{0, 1, 2}, {0, 2, 1}};
    expect_refused(pillow, Scheme::loop, ErrorKind::input, "vertex 0: found two edges, between face 0 and face 1");
    const Composite quads = make_subdivision(pillow, Scheme::catmull_clark).patches;  // of valence 2 as well, which does no harm there
    EXPECT_EQ(quads.size(), 6u);
    for (const Member& m : quads) EXPECT_EQ(m.patch.point(0.3, 0.4).z, 0);
    Ring<Interval> ring;
    for (const Point& p : pillow.positions) ring.points.push_back({Interval(p.x), Interval(p.y), Interval(p.z)});
    ring.sharpness.assign(3, 0), ring.faces = pillow.faces;
    FaceLimits limits;
    limits.core = 1e-11, limits.most_pieces = 50;
    try {
        make_subdivision_face(ring, Scheme::loop, limits);
        ADD_FAILURE() << "accepted";
    } catch (const Error& e) {
        EXPECT_EQ(e.kind(), ErrorKind::budget);
        EXPECT_NE(std::string(e.what()).find("more than 50 pieces, refined ones included"), std::string::npos) << e.what();
    }
}

}  // namespace
}  // namespace isoparm
