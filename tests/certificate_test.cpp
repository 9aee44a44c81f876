// Certificates: the checker proves those of every type of surface, and nothing that is wrong in any way.
#include <gtest/gtest.h>

#include <cmath>

#include "certificate.h"
#include "samples.h"
#include "shapes.h"
#include "tessellation_options.h"

namespace isoparm::tests {
namespace {

Certificate certificate_of(const Composite& surface, double relative, Measure measure) {
    TessellationOptions options = options_of(surface, relative, measure);
    options.bounds = true, options.study = false;
    return make_certificate(surface, tessellate(surface, options), measure == Measure::geometric);
}

std::string first_problem(const CertificateCheck& check) {
    if (!check.faults.empty()) return check.faults.front();
    if (check.failures.empty()) return "";
    const auto& f = check.failures.front();
    return std::string(f.exceeded ? "exceeded" : "undecided") + ", triangle " + std::to_string(f.triangle);
}

class Certified : public testing::TestWithParam<PatchType> {};

TEST_P(Certified, MeshesAreProvedAgain) {
    Random random(4000);
    const Composite surface{{"S", GetParam().make(random).patch}};
    for (const Measure measure : {Measure::geometric, Measure::parametric}) {
        const Certificate c = certificate_of(surface, surface[0].patch.domain() == Domain::triangle ? 0.3 : 0.1, measure);
        const CertificateCheck check = check_certificate(surface, c);
        EXPECT_TRUE(check.proved()) << first_problem(check);
        EXPECT_EQ(check.checked, c.triangle_count());
        EXPECT_LE(c.certified_error, c.tolerance);
        if (c.triangle_count() > 100) break;  // once for those that take long
    }
}
INSTANTIATE_TEST_SUITE_P(Types, Certified, testing::ValuesIn(patch_types()), name_of);

/// The largest distance at equal parameters that n points a side show, and an inner bound for what they may miss.
double seen(const Patch& patch, const Certificate& c, const CertifiedTriangle& t, int n) {
    const CertifiedPatch& p = c.patches[0];
    double most = 0;
    for (int i = 0; i <= n; ++i)
        for (int j = 0; i + j <= n; ++j) {
            const double l[3] = {double(i) / n, double(j) / n, double(n - i - j) / n};
            Vec2 q;
            Point x;
            for (int k = 0; k < 3; ++k) q = {q.x + l[k] * p.uv[t.corner[k]].x, q.y + l[k] * p.uv[t.corner[k]].y}, x += l[k] * c.points[p.vertex[t.corner[k]]];
            most = std::max(most, distance(patch.point(q.x, q.y), x));
        }
    return most;
}

TEST(CertificateCheck, ABoundOnePercentBelowTheErrorIsCaughtAndOneAboveItIsProved) {
    Random random(4001);
    for (const char* name : {"coons", "sphere_octant", "side_vertex_t2", "bspline"})
        for (const PatchType& type : patch_types()) {
            if (std::string(name) != type.name) continue;
            const Composite surface{{"S", type.make(random).patch}};
            Certificate c = certificate_of(surface, 0.01, Measure::parametric);
            auto& triangles = c.patches[0].triangles;
            for (std::size_t i = 0; i < triangles.size(); i += triangles.size() / 12 + 1) {
                const double before = triangles[i].bound, error = seen(surface[0].patch, c, triangles[i], 60);
                if (!(error > 1e-9)) continue;
                triangles[i].bound = 0.99 * error;
                const CertificateCheck below = check_certificate(surface, c);
                ASSERT_EQ(below.failures.size(), 1u) << name << " " << i;
                EXPECT_TRUE(below.failures[0].exceeded) << name << " " << i;
                EXPECT_EQ(below.failures[0].triangle, i);
                EXPECT_GT(below.failures[0].distance, 0.99 * error);
                triangles[i].bound = std::min(1.01 * error, c.certified_error);
                EXPECT_TRUE(check_certificate(surface, c).proved()) << name << " " << i;
                triangles[i].bound = before;
            }
        }
}

TEST(CertificateCheck, NoTriangleTakesMoreThanItsBudget) {
    // Bounds just below what can be proved: some pieces of a triangle hold, others never do.
    const Composite surface{{"S", make_bezier_patch({{{1e9, 0, 0}, {1e9, 1, 0.5}, {1e9, 2, 0}}, {{1e9 + 1, 0, 0.7}, {1e9 + 1, 1, 1}, {1e9 + 1, 2, 0}}, {{1e9 + 2, 0, 0}, {1e9 + 2, 1, 0.2}, {1e9 + 2, 2, 0.4}}})}};
    Certificate c = certificate_of(surface, 0.01, Measure::geometric);
    for (auto& t : c.patches[0].triangles) {
        t.bound = 0;
        each_sample(c.patches[0], t, [&](const Vec2& q, const std::array<double, 3>& l) {
            Point x;
            for (int k = 0; k < 3; ++k) x += l[k] * c.points[c.patches[0].vertex[t.corner[k]]];
            t.bound = std::max(t.bound, distance(surface[0].patch.point(q.x, q.y), x));
        });
    }
    for (std::size_t budget = 1; budget < 24; ++budget) {
        const CertificateCheck check = check_certificate(surface, c, budget);
        EXPECT_FALSE(check.proved());
        EXPECT_LE(check.pieces, (budget + 30) * c.triangle_count()) << budget;  // the last ones may hold, as many as there are left
    }
}

TEST(CertificateCheck, WhateverIsTamperedWithIsRefused) {
    Random random(4002);
    const Composite surface{{"S", make_bezier_patch({{{0, 0, 0}, {0, 1, 0.5}, {0, 2, 0}}, {{1, 0, 0.7}, {1, 1, 1}, {1, 2, 0}}, {{2, 0, 0}, {2, 1, 0.2}, {2, 2, 0.4}}})}};
    const Certificate good = certificate_of(surface, 0.005, Measure::geometric);
    ASSERT_TRUE(check_certificate(surface, good).proved()) << first_problem(check_certificate(surface, good));
    const auto refused = [&](const char* what, const char* message, auto tamper) {
        Certificate c = good;
        tamper(c);
        const CertificateCheck check = check_certificate(surface, c);
        EXPECT_FALSE(check.proved()) << what;
        EXPECT_NE(first_problem(check).find(message), std::string::npos) << what << ": " << first_problem(check);
    };
    auto inner = [&](Certificate& c) -> CertifiedTriangle& {  // no edge on the border
        for (auto& t : c.patches[0].triangles) {
            bool border = false;
            for (const auto k : t.corner) border = border || c.patches[0].uv[k].x * (1 - c.patches[0].uv[k].x) * c.patches[0].uv[k].y * (1 - c.patches[0].uv[k].y) == 0;
            if (!border) return t;
        }
        throw std::logic_error("no inner triangle");
    };
    refused("a vertex moved by twice the tolerance", "exceeded", [&](Certificate& c) { c.points[c.patches[0].vertex[inner(c).corner[0]]].z += 2 * c.tolerance; });
    refused("a triangle missing", "one triangle only", [&](Certificate& c) { c.patches[0].triangles.erase(c.patches[0].triangles.begin() + (&inner(c) - c.patches[0].triangles.data())); });
    refused("a triangle missing at the border", "", [&](Certificate& c) { c.patches[0].triangles.erase(c.patches[0].triangles.begin()); });
    refused("a triangle twice", "overlap", [&](Certificate& c) { c.patches[0].triangles.push_back(inner(c)); });
    refused("two corners swapped", "counter-clockwise", [&](Certificate& c) { std::swap(inner(c).corner[0], inner(c).corner[1]); });
    refused("another vertex at a corner", "exceeded", [&](Certificate& c) { c.patches[0].vertex[inner(c).corner[0]] = c.patches[0].vertex[0]; });
    refused("a triangle that overlaps others", "", [&](Certificate& c) {
        const CertifiedTriangle& t = inner(c);
        c.patches[0].uv.push_back(c.patches[0].uv[t.corner[0]]), c.patches[0].vertex.push_back(c.patches[0].vertex[t.corner[0]]);
        CertifiedTriangle more = t;
        more.corner[0] = std::uint32_t(c.patches[0].uv.size() - 1);
        c.patches[0].triangles.push_back(more);
    });
    refused("the whole below the largest bound", "not within the certified error", [](Certificate& c) {
        double most = 0;
        for (const auto& t : c.patches[0].triangles) most = std::max(most, t.bound);
        c.certified_error = 0.999 * most;
    });
    refused("the whole above the tolerance", "not within the tolerance", [](Certificate& c) { c.certified_error = 1.001 * c.tolerance; });
    refused("a bound that is no number", "not within", [&](Certificate& c) { inner(c).bound = std::nan(""); });
    refused("a slide of one side only", "differently", [&](Certificate& c) { inner(c).slide[0][0].x += 1e-9; });
    refused("a slide off the border", "slides off it", [](Certificate& c) {
        for (auto& t : c.patches[0].triangles)
            for (int k = 0; k < 3; ++k)
                if (c.patches[0].uv[t.corner[k]].y == 0 && c.patches[0].uv[t.corner[(k + 1) % 3]].y == 0) return void(t.slide[k][0].y += 1e-6);
    });
    refused("a slide out of the domain", "out of the domain", [&](Certificate& c) { inner(c).slide[1][1].y -= 5; });
    refused("a corner out of the domain", "leaves the domain", [&](Certificate& c) { c.patches[0].uv[inner(c).corner[0]].x = 1.5; });
    refused("a corner that does not exist", "names corner", [&](Certificate& c) { inner(c).corner[0] = 1u << 30; });
    refused("a vertex that does not exist", "names no vertex", [](Certificate& c) { c.patches[0].vertex[0] = 1u << 30; });
    refused("no patch", "patches", [](Certificate& c) { c.patches.clear(); });
    refused("no triangle", "not covered", [](Certificate& c) { c.patches[0].triangles.clear(); });
    Composite other = surface;
    other[0].patch = octant();
    EXPECT_FALSE(check_certificate(other, good).proved());
}

TEST(CertificateCheck, PartsWithoutAreaMustBeEdgesOfOtherTriangles) {
    const Composite surface = sphere();
    Certificate c = certificate_of(surface, 0.01, Measure::geometric);
    ASSERT_TRUE(check_certificate(surface, c).proved());  // with triangles at the poles that are segments
    // All vertices of an octant become one: its triangles are points, and no part of the mesh.
    Certificate one = c;
    one.certified_error = one.tolerance = 10;
    for (auto& v : one.patches[0].vertex) v = std::uint32_t(one.points.size());
    one.points.push_back({0.1, 0.1, 0.1});
    for (auto& p : one.patches)
        for (auto& t : p.triangles) t.bound = 10;
    const CertificateCheck check = check_certificate(surface, one);
    EXPECT_NE(first_problem(check).find("without area"), std::string::npos) << first_problem(check);
}

TEST(CertificateCheck, TrianglesAcrossABreakAreRefused) {
    Random random(4000);
    for (const PatchType& type : patch_types()) {
        if (std::string("bspline") != type.name) continue;
        const Composite surface{{"S", type.make(random).patch}};
        const Rect r = surface[0].patch.rect();
        ASSERT_FALSE(surface[0].patch.breaks_u().empty());
        Certificate c;
        c.tolerance = c.certified_error = 1e9;
        c.patches.push_back({"S", {{r.u0, r.v0}, {r.u1, r.v0}, {r.u1, r.v1}, {r.u0, r.v1}}, {0, 1, 2, 3}, {{{0, 1, 2}, {}, 1e9}, {{0, 2, 3}, {}, 1e9}}});
        for (const Vec2& p : c.patches[0].uv) c.points.push_back(surface[0].patch.point(p.x, p.y));
        EXPECT_NE(first_problem(check_certificate(surface, c)).find("crosses a break"), std::string::npos);
    }
}

}  // namespace
}  // namespace isoparm::tests
