// evaluate.cpp -- points and derivatives of a bicubic Bezier patch, a bilinear Coons patch and a bicubic (Hermite)
// Coons patch, beside loops written by hand for them. All surfaces and parameters come from a fixed seed.
#include <memory>
#include <random>
#include <stdexcept>

#include "by_hand.h"
#include "cases.h"
#include "curves/bezier.h"
#include "patches/coons.h"
#include "patches/coons_hermite.h"
#include "patches/tensor_bezier.h"

namespace isoparm::bench {
namespace {

constexpr std::size_t kPoints = 4096;  // fit the second-level cache with their parameters

/// A bicubic surface over the square [0,3]^2 with a lively height.
HandBezier bicubic() {
    std::mt19937_64 random(20260101);
    std::uniform_real_distribution<double> height(-1, 1);
    HandBezier s;
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j) s.p[i][j] = {i + 0.3 * height(random), j + 0.3 * height(random), height(random)};
    return s;
}

Cubic column(const HandBezier& s, int j) { return {s.p[0][j], s.p[1][j], s.p[2][j], s.p[3][j]}; }
/// 3 (b - a): the derivative across an edge whose points are a, b the next row inside.
Cubic across(const Cubic& a, const Cubic& b) {
    return {3.0 * (b[0] - a[0]), 3.0 * (b[1] - a[1]), 3.0 * (b[2] - a[2]), 3.0 * (b[3] - a[3])};
}
Curve curve(const Cubic& c) { return make_bezier({c[0], c[1], c[2], c[3]}); }

HandCoons<2> bilinear_coons(const HandBezier& s) {
    return {{s.p[0], s.p[3]}, {column(s, 0), column(s, 3)}, {{{s.p[0][0], s.p[0][3]}, {s.p[3][0], s.p[3][3]}}}};
}
/// The Hermite Coons patch of a bicubic surface's edges and cross derivatives: that surface again.
HandCoons<4> hermite_coons(const HandBezier& s) {
    HandCoons<4> h;
    h.f = {s.p[0], across(s.p[0], s.p[1]), across(s.p[2], s.p[3]), s.p[3]};
    const Cubic c0 = column(s, 0), c1 = column(s, 1), c2 = column(s, 2), c3 = column(s, 3);
    h.g = {c0, across(c0, c1), across(c2, c3), c3};
    for (int i = 0; i < 4; ++i)  // value, derivative at 0, derivative, value at 1 of f_i
        h.m[i] = {h.f[i][0], 3.0 * (h.f[i][1] - h.f[i][0]), 3.0 * (h.f[i][3] - h.f[i][2]), h.f[i][3]};
    return h;
}

template <class S> struct Pair {
    S by_hand;
    Patch patch;
    std::vector<double> u, v;
    std::vector<Point> out = std::vector<Point>(kPoints), other = out;

    Pair(const S& s, Patch p) : by_hand(s), patch(std::move(p)) {
        std::mt19937_64 random(7);
        std::uniform_real_distribution<double> unit(0, 1);
        for (std::size_t i = 0; i < kPoints; ++i) u.push_back(unit(random)), v.push_back(unit(random));
    }

    /// A rate counts only if both compute the same.
    void compare() {
        const auto check = [](const Point& a, const Point& b) {
            if (!(distance(a, b) <= 1e-12 * (1 + length(a))))
                throw std::logic_error("the loop written by hand and the patch differ");
        };
        patch.points(kPoints, u.data(), v.data(), out.data());
        for (const bool side_by_side : {false, true}) {
            (side_by_side ? points_side_by_side(by_hand, kPoints, u.data(), v.data(), other.data())
                          : points(by_hand, kPoints, u.data(), v.data(), other.data()));
            for (std::size_t i = 0; i < kPoints; ++i) check(out[i], other[i]);
        }
        for (std::size_t i = 0; i < kPoints; ++i) {
            const PointJet jet = patch.jet(u[i], v[i]);
            const Derivatives d = derivatives(by_hand, u[i], v[i]);
            constexpr int at[6][2] = {{0, 0}, {1, 0}, {0, 1}, {2, 0}, {1, 1}, {0, 2}};
            for (int k = 0; k < 6; ++k) {
                const auto [p, q] = at[k];
                const double factor = p == 2 || q == 2 ? 2 : 1;
                check(d[k], factor * Point{jet.x.coefficient(p, q), jet.y.coefficient(p, q), jet.z.coefficient(p, q)});
            }
        }
    }
};

template <class J> Point sum(const Vec3<J>& jet) {
    Point r;
    for (int k = 0; k < J::size; ++k) r += Point{jet.x.c[k], jet.y.c[k], jet.z.c[k]};
    return r;
}

template <class S> void add(std::vector<Case>& cases, const std::string& surface, const S& by_hand, Patch patch) {
    const auto pair = std::make_shared<Pair<S>>(by_hand, std::move(patch));
    const auto add_one = [&](const std::string& table, const std::string& name, auto run, bool reference = false) {
        Case c{"evaluation: " + surface + ", " + table, name, "points", [pair, run] {
                   run(*pair);
                   return Work{double(kPoints)};
               }};
        c.reference = reference;
        c.prepare = [pair] { pair->compare(); };
        cases.push_back(std::move(c));
    };
    using P = Pair<S>;
    add_one(
        "positions", "by hand, one by one",
        [](P& p) { points(p.by_hand, kPoints, p.u.data(), p.v.data(), p.out.data()); }, true);
    add_one(
        "positions", "by hand, eight lanes",
        [](P& p) { points_side_by_side(p.by_hand, kPoints, p.u.data(), p.v.data(), p.out.data()); }, true);
    add_one("positions", "Patch::points", [](P& p) { p.patch.points(kPoints, p.u.data(), p.v.data(), p.out.data()); });
    add_one("positions", "Patch::point", [](P& p) {
        for (std::size_t i = 0; i < kPoints; ++i) p.out[i] = p.patch.point(p.u[i], p.v[i]);
    });

    // Everything that was computed is added up, so that the compiler leaves none of it out.
    add_one(
        "derivatives to second order", "by hand",
        [](P& p) {
            for (std::size_t i = 0; i < kPoints; ++i) {
                const Derivatives d = derivatives(p.by_hand, p.u[i], p.v[i]);
                p.out[i] = d[0] + d[1] + d[2] + d[3] + d[4] + d[5];
            }
        },
        true);
    add_one("derivatives to second order", "Patch::jet", [](P& p) {
        for (std::size_t i = 0; i < kPoints; ++i) p.out[i] = sum(p.patch.jet(p.u[i], p.v[i]));
    });
    add_one("derivatives to second order", "Patch::frame, to first order", [](P& p) {
        for (std::size_t i = 0; i < kPoints; ++i) p.out[i] = sum(p.patch.frame(p.u[i], p.v[i]));
    });
}

}  // namespace

std::vector<Case> evaluation_cases() {
    const HandBezier s = bicubic();
    std::vector<Case> cases;

    Grid<Point> net;
    for (const Cubic& row : s.p) net.emplace_back(row.begin(), row.end());
    add(cases, "bicubic Bezier", s, make_bezier_patch(net));

    const HandCoons<2> coons = bilinear_coons(s);
    add(cases, "bilinear Coons, cubic edges", coons,
        make_coons({curve(coons.g[0]), curve(coons.g[1]), curve(coons.f[0]), curve(coons.f[1])}));

    const HandCoons<4> hermite = hermite_coons(s);
    const auto curves = [](const std::array<Cubic, 4>& c) -> std::array<Curve, 4> {
        return {curve(c[0]), curve(c[1]), curve(c[2]), curve(c[3])};
    };
    add(cases, "Hermite Coons, cubic edges", hermite, make_coons_hermite({curves(hermite.f), curves(hermite.g)}));
    return cases;
}

}  // namespace isoparm::bench
