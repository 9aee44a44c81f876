// The distance of mesh and surface as sets, both ways: no random point of either is farther from the other than certified.
// ISOPARM_SOUNDNESS=N sets the random patches of each type.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "bounds/bound_cell.h"
#include "curves/bezier.h"
#include "error.h"
#include "patches/tensor_bezier.h"
#include "patches/transformed.h"
#include "samples.h"
#include "tessellation/refine.h"
#include "tessellation_options.h"

namespace isoparm::tests {
namespace {

Tessellation mesh_of(const Composite& surface, double relative, Measure measure) {
    return tessellate(surface, options_of(surface, relative, measure));
}

/// From a point to the nearest triangle of a mesh; triangles are passed over by the spheres around them.
class NearestTriangle {
public:
    explicit NearestTriangle(const Mesh& mesh) {
        for (const auto& part : mesh.parts)
            for (const auto& t : part.triangles) {
                std::array<Point, 3> x;
                for (int k = 0; k < 3; ++k) x[k] = mesh.positions[part.vertex[t[k]]];
                const Point c = (x[0] + x[1] + x[2]) / 3.0;
                all_.push_back({x, c, std::max({distance(c, x[0]), distance(c, x[1]), distance(c, x[2])})});
            }
    }
    double operator()(const Point& p) const {
        double least = HUGE_VAL;
        for (const auto& t : all_)
            if (distance(p, t.centre) - t.radius < least) least = std::min(least, distance_to_triangle(p, t.corner[0], t.corner[1], t.corner[2]));
        return least;
    }

private:
    struct Ball {
        std::array<Point, 3> corner;
        Point centre;
        double radius;
    };
    std::vector<Ball> all_;
};

/// At least the distance of x from the surface: the nearest point that Gauss and Newton find from p, within the domain.
double distance_to_surface(const Patch& patch, Vec2 p, const Point& x) {
    const Rect r = patch.rect();
    const auto inside = [&](Vec2 q) {
        if (patch.domain() == Domain::quad) return Vec2{std::clamp(q.x, r.u0, r.u1), std::clamp(q.y, r.v0, r.v1)};
        q = {std::max(q.x, 0.0), std::max(q.y, 0.0)};
        const double over = q.x + q.y - 1;
        return over > 0 ? Vec2{std::clamp(q.x - over / 2, 0.0, 1.0), 1 - std::clamp(q.x - over / 2, 0.0, 1.0)} : q;
    };
    double least = distance(patch.point(p.x, p.y), x);
    for (int i = 0; i < 30; ++i) {
        const PointJet j = patch.jet(p.x, p.y);
        const Point s{j.x.coefficient(0, 0), j.y.coefficient(0, 0), j.z.coefficient(0, 0)}, su{j.x.coefficient(1, 0), j.y.coefficient(1, 0), j.z.coefficient(1, 0)},
            sv{j.x.coefficient(0, 1), j.y.coefficient(0, 1), j.z.coefficient(0, 1)};
        const double a = dot(su, su), b = dot(su, sv), c = dot(sv, sv), f = dot(su, x - s), g = dot(sv, x - s), det = a * c - b * b;
        if (!(det > 1e-14 * a * c)) break;
        Vec2 step{(c * f - b * g) / det, (a * g - b * f) / det};
        bool better = false;
        for (int half = 0; half < 8 && !better; ++half, step = {step.x / 2, step.y / 2}) {
            // Along the border too: one parameter alone.
            for (const Vec2 way : {step, Vec2{a > 0 ? f / a : 0, 0}, Vec2{0, c > 0 ? g / c : 0}}) {
                const Vec2 q = inside({p.x + way.x, p.y + way.y});
                const double d = distance(patch.point(q.x, q.y), x);
                if (d < least * (1 - 1e-13)) p = q, least = d, better = true;
            }
        }
        if (!better) break;
    }
    return least;
}

class TwoSided : public testing::TestWithParam<PatchType> {};

TEST_P(TwoSided, NoPointOfEitherSetIsFartherThanCertified) {
    const char* wanted = std::getenv("ISOPARM_SOUNDNESS");
    const int patches = wanted ? std::atoi(wanted) : 4;
    for (int i = 0; i < patches; ++i) {
        Random random(4000 + std::uint64_t(i));
        const Patch patch = GetParam().make(random).patch;
        const Composite surface{{"S", patch}};
        const Tessellation t = mesh_of(surface, i % 2 == 0 ? 0.02 : 0.004, Measure::geometric);
        ASSERT_LE(t.certified_error, t.tolerance) << "seed " << 4000 + i;
        ASSERT_LE(t.sampled_error, t.certified_error * (1 + 1e-12) + 1e-13 * size_of_sample(patch)) << "seed " << 4000 + i;
        ASSERT_EQ(t.topology.t_junctions, 0u);
        const double allowed = t.certified_error * (1 + 1e-12) + 1e-12 * size_of_sample(patch);
        const NearestTriangle nearest(t.mesh);
        for (int s = 0; s < 300; ++s) {
            const Vec2 p = random_parameter(random, patch);
            ASSERT_LE(nearest(patch.point(p.x, p.y)), allowed) << "seed " << 4000 + i;
        }
        const MeshPart& part = t.mesh.parts[0];
        for (int s = 0; s < 300; ++s) {
            const auto& c = part.triangles[std::size_t(random.integer(0, int(part.triangles.size()) - 1))];
            double w[3] = {random.number(), random.number(), s % 3 == 0 ? 0 : random.number()};  // a third of them on edges
            const double sum = w[0] + w[1] + w[2];
            Vec2 p;
            Point x;
            for (int k = 0; k < 3; ++k) p = {p.x + w[k] / sum * part.uv[c[k]].x, p.y + w[k] / sum * part.uv[c[k]].y}, x += w[k] / sum * t.mesh.positions[part.vertex[c[k]]];
            ASSERT_LE(distance_to_surface(patch, p, x), allowed) << "seed " << 4000 + i;
        }
    }
}

// What the cells prove about single triangles, along the normal and along the edges too.
TEST_P(TwoSided, BoundsOfACellHoldOnRandomTriangles) {
    int quiet = 0;
    for (int i = 0; i < 60; ++i) {
        Random random(9000 + std::uint64_t(i));
        const Patch patch = GetParam().make(random).patch;
        const auto us = patch.lines_u(), vs = patch.lines_v();
        const double u0 = us[0], u1 = us[1], v0 = vs[0], v1 = vs[1], size = std::pow(2.0, -random.number(2, 9));
        CornerData data;
        const double a = random.number(0.1, 0.5), b = random.number(0.1, 0.9 - a);
        for (auto& p : data.uv) p = {u0 + (u1 - u0) * (a + size * random.number(-0.1, 0.1)), v0 + (v1 - v0) * (b + size * random.number(-0.1, 0.1))};
        for (int k = 0; k < 3; ++k) data.points[k] = patch.point(data.uv[k].x, data.uv[k].y);
        data.slack = 1e-13 * size_of_sample(patch);
        BoundCell root(patch, {{u0, u1}, {v0, v1}});
        const BoundCell* cell = &root;
        const double tolerance = random.number(0, 1) * bound_triangle(patch, data.uv, data.points).parametric;
        const TriangleBound proof = BoundCell::bound(patch, cell, data, tolerance, Measure::geometric);
        quiet += proof.quiet;
        const auto& x = data.points;
        for (int s = 0; s < 90; ++s) {
            double w[3] = {random.number(), random.number(), s % 2 ? 0 : random.number()};
            const int turn = s % 3;
            const double sum = w[0] + w[1] + w[2];
            Vec2 q;
            Point flat;
            for (int k = 0; k < 3; ++k) {
                const double l = w[(k + 3 - turn) % 3] / sum;
                q = {q.x + l * data.uv[k].x, q.y + l * data.uv[k].y}, flat += l * x[k];
            }
            const Point d = patch.point(q.x, q.y) - flat;
            const double rounding = 4 * data.slack;
            ASSERT_LE(length(d), proof.parametric * (1 + 1e-12) + rounding) << "seed " << 9000 + i;
            if (!proof.quiet) continue;
            ASSERT_LE(std::abs(dot(d, proof.unit)), proof.normal * (1 + 1e-12) + rounding) << "seed " << 9000 + i;
            double l[3];
            for (int k = 0; k < 3; ++k) l[k] = w[(k + 3 - turn) % 3] / sum;
            const double twice_area = length(cross(x[1] - x[0], x[2] - x[0]));
            for (int k = 0; k < 3; ++k) {  // as near to edge k as the surface may lie beyond it
                const double depth = l[(k + 2) % 3] * twice_area / distance(x[k], x[(k + 1) % 3]);
                if (depth <= proof.parametric) ASSERT_LE(std::abs(dot(d, proof.unit)), proof.beside[k] * (1 + 1e-12) + rounding) << "seed " << 9000 + i;
            }
            if (s % 2 == 0) continue;
            const Point e = normalized(x[(turn + 1) % 3] - x[turn]);
            ASSERT_LE(std::abs(dot(d, cross(proof.unit, e))), proof.across[turn] * (1 + 1e-12) + rounding) << "seed " << 9000 + i;
        }
    }
    EXPECT_GT(quiet, 0);
}
INSTANTIATE_TEST_SUITE_P(EveryType, TwoSided, testing::ValuesIn(patch_types()), name_of);

Patch cylinder(double height) { return make_bezier_patch({{{0, 0, 0}, {0, 1, 0}}, {{0.5, 0, height}, {0.5, 1, height}}, {{1, 0, 0}, {1, 1, 0}}}); }

TEST(Geometric, AOnePercentSmallerBoundIsCaught) {
    // A parabolic cylinder z = 2 h x (1 - x) over two triangles in the plane z = 0: the ridge is h/2 above them.
    const double h = 0.01;
    const Patch patch = cylinder(h);
    const Tessellation t = mesh_of({{"S", patch}}, 0.5 * h / std::sqrt(2) * 1.2, Measure::geometric);
    ASSERT_EQ(t.mesh.triangle_count(), 2u);
    const double truth = NearestTriangle(t.mesh)(patch.point(0.5, 0.5));
    EXPECT_NEAR(truth, h / 2, 1e-15);
    EXPECT_GE(t.certified_error, truth);
    EXPECT_LT(0.99 * t.certified_error, truth);
}

TEST(Geometric, IsNotMoreThanParametric) {
    for (const auto& type : patch_types()) {
        Random random(17);
        const Composite surface{{"S", type.make(random).patch}};
        const double tolerance = 0.02 * bounding_box(surface).diagonal();
        const Topology topology = find_topology(surface, 1e-6 * tolerance);
        Refinement refinement(surface, topology, tolerance, Measure::geometric);
        for (int round = 0; round < 100 && !(refinement.bound_and_mark() && !refinement.mark_with_neighbours()); ++round) refinement.split_marked();
        const PatchMesh& mesh = refinement.patches()[0];
        for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i)
            ASSERT_LE(refinement.bound_of(mesh, i), (mesh.triangles[i].proof.parametric + refinement.worst_slack()) * (1 + 1e-14)) << type.name;
    }
}

TEST(Geometric, StretchedParametersCostNothing) {
    // A plane whose parameters run unevenly: at equal parameters far apart, as sets the same.
    const Patch plane = make_bezier_patch({{{0, 0, 0}, {0, 1, 0}}, {{0.2, 0, 0}, {0.2, 1, 0}}, {{1, 0, 0}, {1, 1, 0}}});
    const std::size_t parametric = mesh_of({{"S", plane}}, 1e-6, Measure::parametric).mesh.triangle_count();
    const Tessellation t = mesh_of({{"S", plane}}, 1e-6, Measure::geometric);
    EXPECT_LE(t.certified_error, t.tolerance);
    EXPECT_LT(t.mesh.triangle_count(), parametric / 4);
}

TEST(Geometric, TriangleWithoutQuietNeighbourIsChargedForItsEdges) {
    TriangleBound t;
    t.parametric = 5, t.normal = 1, t.beside = {1, 1, 1}, t.across = {0.5, 0.75, 0.25}, t.unit = {0, 0, 1}, t.tilt = 0, t.quiet = true;
    TriangleBound flat = t, wild = t, steep = t;
    flat.normal = 0.5, flat.beside = {0.5, 0.5, 0.5}, wild.quiet = false, steep.unit = {1, 0, 0};
    const double alone = std::hypot(1, 0.75);
    EXPECT_NEAR(geometric_bound(t, {}), alone, 1e-12);
    const auto around = [](const TriangleBound& other) { return std::array<Neighbour, 3>{{{&other, 0}, {&other, 1}, {&other, 2}}}; };
    EXPECT_NEAR(geometric_bound(t, around(wild)), alone, 1e-12);
    EXPECT_NEAR(geometric_bound(t, around(steep)), alone, 1e-12);
    EXPECT_NEAR(geometric_bound(t, around(flat)), 1, 1e-12);
    EXPECT_NEAR(geometric_bound(flat, around(t)), 1, 1e-12);  // the neighbour's part of the surface may lie under this triangle
    EXPECT_EQ(geometric_bound(wild, around(flat)), 5);
    t.beside = {0.25, 0.25, 0.25};  // along its edges it is nearer than in its middle
    EXPECT_NEAR(geometric_bound(flat, around(t)), 0.5, 1e-12);
}

TEST(Geometric, WhatIsKeptOfABoundIsNotBelowIt) {
    Random random(11);
    const auto size = [&] { return std::pow(10.0, 600 * random.number() - 300); };  // all over the range of doubles
    for (int n = 0; n < 20000; ++n) {
        const double x = size(), y = RoundedUp(x);
        ASSERT_GE(y, x);
        ASSERT_LE(y, x * (1 + 0x1p-20) + 1e-310);
        ASSERT_EQ(double(RoundedUp(y)), y);
    }
    EXPECT_EQ(double(RoundedUp(0.0)), 0);
    for (const double all : {TriangleBound::none, std::numeric_limits<double>::quiet_NaN(), -std::numeric_limits<double>::quiet_NaN()}) EXPECT_EQ(double(RoundedUp(all)), TriangleBound::none);
    for (int n = 0; n < 2000; ++n) {
        const double scale = std::pow(10.0, 100 * random.number() - 50);
        const auto bound = [&] {
            TriangleBound b;
            b.parametric = scale * (1 + random.number()), b.normal = scale * random.number(), b.tilt = 1e-9 * random.number(), b.turn = random.number(), b.quiet = true;
            for (int k = 0; k < 3; ++k) b.beside[std::size_t(k)] = b.normal * random.number(), b.across[std::size_t(k)] = scale * random.number();
            b.unit = normalized(Point{0.1 * random.number(), 0.1 * random.number(), 1});
            b.worst_edge = n % 3, b.worst_turn = (n + 1) % 3, b.worst_across = (n + 2) % 3;
            return b;
        };
        const TriangleBound t = bound(), beside[3] = {bound(), bound(), bound()};
        const Proof kept = t, kept_beside[3] = {beside[0], beside[1], beside[2]};
        const TriangleBound back = kept;
        ASSERT_LE(length(back.unit - t.unit) + t.tilt, back.tilt);
        ASSERT_TRUE(back.quiet && back.worst_edge == t.worst_edge && back.worst_turn == t.worst_turn && back.worst_across == t.worst_across);
        ASSERT_TRUE(back.parametric >= t.parametric && back.normal >= t.normal && back.turn >= t.turn && kept.own(Measure::geometric) >= t.own(Measure::geometric));
        const double exact = geometric_bound(t, std::array<Neighbour, 3>{{{&beside[0], 0}, {&beside[1], 2}, {}}});
        const double rounded = geometric_bound(kept, std::array<ProvedNeighbour, 3>{{{&kept_beside[0], 0}, {&kept_beside[1], 2}, {}}});
        ASSERT_GE(rounded, exact);
        ASSERT_LE(rounded, exact * (1 + 4e-6));
    }
}

}  // namespace
}  // namespace isoparm::tests
