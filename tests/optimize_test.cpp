// What --quality optimal promises: the same certificate, the same watertight joints, never more triangles than fast, far fewer where
// that is possible, and one mesh for every number of threads.
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>

#include "bounds/bound_cell.h"
#include "bounds/quiet.h"
#include "patches/tensor_bezier.h"
#include "patches/transformed.h"
#include "samples.h"
#include "shapes.h"
#include "tessellation/optimize_estimate.h"
#include "tessellation_options.h"

namespace isoparm::tests {
namespace {

Tessellation meshed(const Composite& surface, double relative, Quality quality, Measure measure = Measure::geometric) {
    TessellationOptions options = options_of(surface, relative, measure);
    options.quality = quality;
    return tessellate(surface, options);
}

double twice_area(const MeshPart& part, const std::array<std::uint32_t, 3>& t) {
    const Vec2 &a = part.uv[t[0]], &b = part.uv[t[1]], &c = part.uv[t[2]];
    return ((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x)) * (part.flipped ? -1 : 1);
}

double covered(const Tessellation& t) {
    double sum = 0;
    for (const MeshPart& part : t.mesh.parts)
        for (const auto& c : part.triangles) sum += 0.5 * twice_area(part, c);
    return sum;
}

/// No triangle is turned over in the domain, or lies on both sides of a break.
void expect_triangles_between_breaks(const Composite& surface, const Tessellation& t) {
    for (const MeshPart& part : t.mesh.parts) {
        const auto us = surface[part.member].patch.breaks_u(), vs = surface[part.member].patch.breaks_v();
        for (const auto& c : part.triangles) {
            ASSERT_GT(twice_area(part, c), 0);
            const auto [u0, u1] = std::minmax({part.uv[c[0]].x, part.uv[c[1]].x, part.uv[c[2]].x});
            const auto [v0, v1] = std::minmax({part.uv[c[0]].y, part.uv[c[1]].y, part.uv[c[2]].y});
            for (const double b : us) ASSERT_FALSE(u0 < b && b < u1);
            for (const double b : vs) ASSERT_FALSE(v0 < b && b < v1);
        }
    }
}

/// One bicubic patch whose boundary curves wave.
Composite waves() {
    std::vector<std::vector<Point>> net(4, std::vector<Point>(4));
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j) net[std::size_t(i)][std::size_t(j)] = {double(i), double(j), (i == 1 || i == 3 ? 1.0 : 0.2) * (j == 2 ? -1.0 : 0.6)};
    return {{"waves", make_bezier_patch(net)}};
}

/// Two that meet in an edge.
Composite pair_of_waves() {
    const Patch one = waves()[0].patch;
    return {{"right", one}, {"left", transformed(one, Transform::scale({-1, 1, 1}))}};
}

double ratio(const Tessellation& t) {
    double optimum = 0;
    for (const SurfaceReport& r : t.surfaces) optimum += r.optimal_triangles;
    return double(t.mesh.triangle_count()) / optimum;
}

class Optimal : public testing::TestWithParam<PatchType> {};

TEST_P(Optimal, KeepsTheCertificateAndTheDomain) {
    Random random(4000);
    const Composite surface{{"S", GetParam().make(random).patch}};
    for (const Measure measure : {Measure::geometric, Measure::parametric}) {
        const double relative = measure == Measure::geometric ? 0.02 : 0.05;
        const Tessellation fast = meshed(surface, relative, Quality::fast, measure), t = meshed(surface, relative, Quality::optimal, measure);
        EXPECT_LE(t.certified_error, t.tolerance);
        EXPECT_LE(t.sampled_error, t.certified_error);
        EXPECT_LE(t.mesh.triangle_count(), fast.mesh.triangle_count());
        EXPECT_EQ(t.topology.t_junctions, 0u);
        EXPECT_EQ(t.topology.non_manifold_edges, 0u);
        EXPECT_EQ(t.topology.degenerate_triangles, 0u);
        EXPECT_EQ(t.topology.boundary_loops, fast.topology.boundary_loops);
        EXPECT_NEAR(covered(t), covered(fast), 1e-12 * covered(fast));
        expect_triangles_between_breaks(surface, t);
    }
}

/// One of each kind: polynomial, rational, with breaks, triangular, with cone points, collapsed, developable.
std::vector<PatchType> some_types() {
    std::vector<PatchType> list;
    for (const PatchType& t : patch_types())
        for (const char* name : {"coons_of_rationals", "coons_hermite", "translational_of_splines", "cone_of_nurbs", "gordon_of_splines", "ruled_of_rationals", "network",
                                 "bezier_triangle_rational", "three_curves", "side_vertex_seed_t2", "bbg_symmetric_waves"})
            if (std::string(name) == t.name) list.push_back(t);
    return list;
}
INSTANTIATE_TEST_SUITE_P(SomeTypes, Optimal, testing::ValuesIn(some_types()), name_of);

TEST(OptimalMesh, IsNearerTheOptimum) {
    const Composite one{{"octant", octant()}};
    const double optimal = ratio(meshed(one, 2e-3, Quality::optimal));
    EXPECT_LT(optimal, 0.9 * ratio(meshed(one, 2e-3, Quality::fast)));
    EXPECT_LT(optimal, 2.2);
    EXPECT_LT(ratio(meshed(waves(), 6e-3, Quality::optimal)), 0.92 * ratio(meshed(waves(), 6e-3, Quality::fast)));
}

TEST(OptimalMesh, OfASphereIsClosed) {
    const Tessellation fast = meshed(sphere(), 1e-2, Quality::fast), t = meshed(sphere(), 1e-2, Quality::optimal);
    EXPECT_LE(t.certified_error, t.tolerance);
    EXPECT_LE(t.mesh.triangle_count(), fast.mesh.triangle_count());
    EXPECT_EQ(t.topology.boundary_edges, 0u);
    EXPECT_EQ(t.topology.non_manifold_edges, 0u);
    EXPECT_EQ(2 * t.mesh.positions.size() - t.mesh.triangle_count(), 4u);  // V - E + F = 2, 2 E = 3 F
    for (const Point& p : t.mesh.positions) EXPECT_NEAR(length(p), 1, 1e-14);
    expect_triangles_between_breaks(sphere(), t);
}

TEST(OptimalMesh, KeepsSharedEdgesShared) {
    const Tessellation fast = meshed(pair_of_waves(), 5e-3, Quality::fast), t = meshed(pair_of_waves(), 5e-3, Quality::optimal);
    EXPECT_LE(t.certified_error, t.tolerance);
    EXPECT_LT(t.mesh.triangle_count(), fast.mesh.triangle_count());
    EXPECT_EQ(t.topology.t_junctions, 0u);
    EXPECT_EQ(t.topology.non_manifold_edges, 0u);
    EXPECT_EQ(t.topology.boundary_loops, 1u);
    EXPECT_EQ(2 * t.mesh.positions.size(), t.mesh.triangle_count() + t.topology.boundary_edges + 2);  // V - E + F = 1, 2 E = 3 F + boundary
    EXPECT_NEAR(covered(t), covered(fast), 1e-12);
    expect_triangles_between_breaks(pair_of_waves(), t);
}

TEST(OptimalMesh, DoesNotDependOnTheNumberOfThreads) {
    const auto with = [](int threads) {
        tbb::global_control limit(tbb::global_control::max_allowed_parallelism, std::size_t(threads));
        return meshed(pair_of_waves(), 1e-2, Quality::optimal);
    };
    const Mesh one = with(1).mesh;
    for (const int threads : {2, 7}) {
        const Mesh other = with(threads).mesh;
        EXPECT_TRUE(one.positions == other.positions);
        for (std::size_t m = 0; m < one.parts.size(); ++m) EXPECT_TRUE(one.parts[m].triangles == other.parts[m].triangles && one.parts[m].vertex == other.parts[m].vertex);
    }
}

// Where the model is exact an estimate is what is proved, but for rounding and the second way to bound heights. In every lane, by every instruction set.
TEST(OptimalMesh, EstimatesAreWhatExactModelsProve) {
    int quiet = 0, equal = 0;
    for (int round = 0; round < 400; ++round) {
        Random random(std::uint64_t(4000 + round));
        std::vector<std::vector<Point>> net(4, std::vector<Point>(4));
        for (int i = 0; i < 4; ++i)
            for (int j = 0; j < 4; ++j) net[std::size_t(i)][std::size_t(j)] = Point{double(i), double(j), 0} + random.vector(0.3);
        const Patch patch = make_bezier_patch(net);
        const PolynomialCell cell(patch, {{0, 1}, {0, 1}});
        const double tolerance = random.number(0.001, 0.1), size = random.number(0.01, 0.4);
        EstimateLanes lanes;
        std::array<TriangleBound, EstimateLanes::size> proved;
        std::array<double, EstimateLanes::size> slack;
        for (std::size_t lane = 0; lane < proved.size(); ++lane) {
            Places p;
            const Vec2 m{random.number(0.5 * size, 1 - 0.5 * size), random.number(0.5 * size, 1 - 0.5 * size)};
            const double turn = random.number(0, 6);
            for (int k = 0; k < 3; ++k) {
                const double angle = turn + 2 * k + random.number(-0.5, 0.5);
                p.uv[k] = {m.x + 0.5 * size * std::cos(angle), m.y + 0.5 * size * std::sin(angle)}, p.x[k] = patch.point(p.uv[k].x, p.uv[k].y);
            }
            slack[lane] = p.slack = random.number(0, 1e-9);
            const Box box = box_of(p.uv);
            SecondDerivatives model = cell(box);
            model.h_rad = {}, model.t_rad = {};
            model.add_sizes(0.5 * (box.u.hi - box.u.lo), 0.5 * (box.v.hi - box.v.lo));
            lanes.set(lane, model, p);
            proved[lane] = bound_triangle(model, p.corners(), Measure::geometric);
        }
        std::array<Estimate, EstimateLanes::size> baseline;
        for (const Isa isa : all_isas) {
            if (!runs(isa)) continue;
            std::array<Estimate, EstimateLanes::size> all;
            for (int n = 1; n <= EstimateLanes::size; ++n) {
                std::array<Estimate, EstimateLanes::size> some;
                estimate_lanes(isa, lanes, n, tolerance, some.data());
                const Estimate& e = all[std::size_t(n - 1)] = some[std::size_t(n - 1)];
                if (isa == all_isas[0]) baseline[std::size_t(n - 1)] = e;
                const Estimate& as = baseline[std::size_t(n - 1)];
                EXPECT_TRUE(e.quiet == as.quiet && (!e.quiet || (e.normal == as.normal && e.beside == as.beside && e.across == as.across && e.unit == as.unit))) << to_text(isa);
            }
            for (std::size_t lane = 0; lane < all.size(); ++lane) {
                const Estimate& e = all[lane];
                const TriangleBound& b = proved[lane];
                ASSERT_EQ(e.quiet, b.quiet);
                if (!e.quiet) continue;
                const auto length_of = [&](double x) { return x * tolerance - slack[lane]; };
                ++quiet, equal += length_of(e.normal) <= b.normal * (1 + 1e-6);
                EXPECT_GE(length_of(e.normal), b.normal * (1 - 1e-6) - 1e-8);
                EXPECT_LT(length(e.unit - b.unit), 1e-12);
                for (std::size_t k = 0; k < 3; ++k) {
                    EXPECT_NEAR(e.across[k] * tolerance, b.across[k], 1e-6 * b.across[k] + 1e-8);
                    EXPECT_LE(length_of(e.beside[k]), b.beside[k] * (1 + 1e-6) + 1e-8);
                }
            }
        }
    }
    EXPECT_GT(quiet, 2000);
    EXPECT_GT(equal, 0.9 * quiet);
}

// (Q2) for a constant second derivative: the derivative of the map at barycentric coordinates w is then exact.
TEST(Quiet, KeepsOrientationOnlyWhereTheJacobianIsPositive) {
    Random random(11);
    int kept = 0, refused = 0, turned = 0;
    for (int i = 0; i < 4000; ++i) {
        const std::array<Point, 3> v{random.vector(), random.vector(), random.vector()};
        const std::array<Point, 3> x{v[1] - v[0], v[2] - v[1], v[0] - v[2]};
        const Point normal = cross(x[0], x[1]), n = normalized(normal);
        // H[a,b] for vectors in coordinates along edges 0 and 1; edge 2 is (-1,-1).
        const Point h00 = random.vector(), h01 = random.vector(), h11 = random.vector();
        const auto h = [&](const Vec2& a, const Vec2& b) { return a.x * b.x * h00 + (a.x * b.y + a.y * b.x) * h01 + a.y * b.y * h11; };
        const Vec2 e[3] = {{1, 0}, {0, 1}, {-1, -1}}, corner[3] = {{0, 0}, {1, 0}, {1, 1}};
        std::array<Point, 3> b;
        std::array<double, 3> bend;
        for (int k = 0; k < 3; ++k) b[k] = h(e[k], e[k]), bend[k] = length(b[k]);
        const bool keeps = keeps_orientation(n, x, b, {0, 0, 0}, bend, 0);
        double least = HUGE_VAL;
        for (int p = 0; p <= 12; ++p)
            for (int q = 0; q <= 12 - p; ++q) {
                const double w0 = p / 12.0, w1 = q / 12.0, w2 = 1 - w0 - w1;
                const Vec2 at{w0 * corner[0].x + w1 * corner[1].x + w2 * corner[2].x, w0 * corner[0].y + w1 * corner[1].y + w2 * corner[2].y};
                // S(v_k+1) - S(v_k) is x_k, so the derivative at the middle of an edge along it is the chord.
                const auto along = [&](int k) {
                    const Vec2 &from = corner[k], &to = corner[(k + 1) % 3], d{at.x - 0.5 * (from.x + to.x), at.y - 0.5 * (from.y + to.y)};
                    return x[k] + h(d, e[k]);
                };
                least = std::min(least, dot(n, cross(along(0), along(1))));
            }
        EXPECT_TRUE(!keeps || least > 0) << i;
        kept += keeps, refused += !keeps, turned += least <= 0;
        EXPECT_FALSE(keeps_orientation(n, x, b, {9, 9, 9}, {9, 9, 9}, 0)) << "what H may be off by counts";
    }
    EXPECT_GT(kept, 200);
    EXPECT_GT(turned, 200);
    EXPECT_LT(refused - turned, refused / 4) << "most of those refused are turned over somewhere";
}

}  // namespace
}  // namespace isoparm::tests
