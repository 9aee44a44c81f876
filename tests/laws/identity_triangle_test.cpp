// identity_triangle_test.cpp -- surfaces on a triangle that are the same surface by different constructions, their degrees and
// what they reproduce. Random data, fixed seeds; equal means to 1e-12 of the size.
#include <gtest/gtest.h>

#include <functional>

#include "curves/bezier.h"
#include "patches/bbg.h"
#include "patches/bezier_triangle.h"
#include "patches/nielson.h"
#include "patches/side_vertex.h"
#include "patches/three_curves.h"
#include "samples.h"

namespace isoparm::tests {
namespace {

constexpr double kTolerance = 1e-12;
constexpr int kSeeds = 4;
using Kind = BbgForm::Kind;
using Surface = std::function<Point(double, double, double)>;

/// Largest difference inside and on the boundary, in units of the size.
double difference(const Patch& a, const Surface& b) {
    double worst = 0;
    const int n = 14;
    for (int i = 0; i <= n; ++i)
        for (int j = 0; i + j <= n; ++j) {
            const double u = double(i) / n, v = double(j) / n, w = double(n - i - j) / n;
            worst = std::max(worst, distance(a.point(u, v), b(u, v, w)));
        }
    return worst / size_of_sample(a);
}
double difference(const Patch& a, const Patch& b) {
    return difference(a, [&](double u, double v, double) { return b.point(u, v); });
}
template <class F> void each_seed(F law) {
    for (int seed = 1; seed <= kSeeds; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        Random r(seed);
        law(r);
    }
}

/// Points b_ijk of a Bezier triangle, i + j + k = n.
struct Net {
    int n;
    std::vector<Point> points;
    Net(int degree, Random& r) : n(degree) {
        for (int k = 0; k <= n; ++k)
            for (int j = 0; j <= n - k; ++j) points.push_back(r.point({3.0 * (n - k - j) / n, 3.0 * j / n, 1}, 0.4));
    }
    Point& operator()(int, int j, int k) { return points[std::size_t(k * (n + 1) - k * (k - 1) / 2 + j)]; }
    Patch patch() const { return make_bezier_triangle(n, points); }
    std::array<Curve, 3> edges() {
        std::vector<Point> e1, e2, e3;
        for (int s = 0; s <= n; ++s) {
            e1.push_back((*this)(0, n - s, s)), e2.push_back((*this)(s, 0, n - s));
            e3.push_back((*this)(n - s, s, 0));
        }
        return {make_bezier(e1), make_bezier(e2), make_bezier(e3)};
    }
    /// D_k: derivative along E_k in the direction of the median; b_ijk - b_.. by its differences.
    std::array<Curve, 3> cross() {
        std::array<std::vector<Point>, 3> d;
        for (int s = 0; s < n; ++s) {
            const int t = n - 1 - s;
            const auto median = [&](const Point& to, const Point& p, const Point& q) { return double(n) * (to - 0.5 * (p + q)); };
            d[0].push_back(median((*this)(1, t, s), (*this)(0, t + 1, s), (*this)(0, t, s + 1)));
            d[1].push_back(median((*this)(s, 1, t), (*this)(s + 1, 0, t), (*this)(s, 0, t + 1)));
            d[2].push_back(median((*this)(t, s, 1), (*this)(t + 1, s, 0), (*this)(t, s + 1, 0)));
        }
        return {make_bezier(d[0]), make_bezier(d[1]), make_bezier(d[2])};
    }
};
struct Corners {
    Point A, B, C;
    explicit Corners(const std::array<Curve, 3>& e) : A(e[2](0)), B(e[0](0)), C(e[1](0)) {}
    Point linear(double u, double v, double w) const { return u * A + v * B + w * C; }
};
/// Is x a polynomial of this degree? Its next difference along lines in any direction says so, and the same one lower does not.
void expect_degree(const Patch& x, int degree) {
    const auto differences = [&](int order) {
        double worst = 0;
        for (const auto& [du, dv] : {std::pair{1.0, 0.4}, {1.0, -0.2}, {-0.3, 1.0}}) {
            Point sum;
            double binomial = 1;
            for (int k = 0; k <= order; ++k) {
                const double t = 0.25 * k / order;  // stays inside the triangle
                sum += (k % 2 ? -binomial : binomial) * x.point(0.32 + t * du, 0.2 + t * dv);
                binomial = binomial * (order - k) / (k + 1);
            }
            worst = std::max(worst, length(sum));
        }
        return worst;
    };
    EXPECT_LE(differences(degree + 1), kTolerance);
    EXPECT_GE(differences(degree), 1e-5);
}

// ---- side-vertex and three curves -----------------------------------------------------------------------------------
TEST(Identity, SideVertexOfQuadraticsIsTheBezierTriangle) {  // Proposition 2
    each_seed([](Random& r) {
        Net b(2, r);
        for (auto form : {SideVertexForm::seed, SideVertexForm::delta})
            EXPECT_LE(difference(make_side_vertex(b.edges(), Function::polynomial({0, 0, 1}), form), b.patch()), kTolerance);
    });
}
TEST(Identity, SideVertexFormsAgreeForQuadraticBlendsOnly) {
    each_seed([](Random& r) {
        const auto e = Net(3, r).edges();
        const auto gap = [&](const Function& H) {
            return difference(make_side_vertex(e, H), make_side_vertex(e, H, SideVertexForm::seed));
        };
        for (double c : {0.0, 1.0, -1.5, 0.3}) EXPECT_LE(gap(Function::polynomial({0, 1 + c, -c})), kTolerance) << c;
        EXPECT_GE(gap(Function::polynomial({0, 0, 0, 2, -1})), 1e-3);
        EXPECT_GE(gap(Function::polynomial({0, 0, 3, -2})), 1e-3);
    });
}
TEST(Identity, SideVertexWithTIsTheBooleanSumOfThreeRuledSurfaces) {
    // P1 (+) P2 (+) P3 = P1 + P2 + P3 - P1P2 - P2P3 - P1P3 + P1P2P3, and every product is the flat triangle.
    each_seed([](Random& r) {
        const auto e = Net(3, r).edges();
        const Corners c(e);
        const auto ratio = [](double a, double b) { return a + b == 0 ? 0 : a / (a + b); };
        EXPECT_LE(difference(make_side_vertex(e, Function::polynomial({0, 1})),
                             [&](double u, double v, double w) {
                                 return u * c.A + (1 - u) * e[0](ratio(w, v)) + v * c.B + (1 - v) * e[1](ratio(u, w)) + w * c.C +
                                        (1 - w) * e[2](ratio(v, u)) - 2.0 * c.linear(u, v, w);
                             }),
                  kTolerance);
    });
}
TEST(Identity, ThreeCurvesOfQuadraticsIsBezierWithABump) {
    each_seed([](Random& r) {
        Net b(2, r);
        const Patch bezier = b.patch();
        const Point bump = 2.0 * (b(0, 1, 1) + b(1, 0, 1) + b(1, 1, 0)) - 2.0 * (b(2, 0, 0) + b(0, 2, 0) + b(0, 0, 2));
        EXPECT_LE(difference(make_three_curves(b.edges()),
                             [&](double u, double v, double w) { return bezier.point(u, v) + u * v * w * bump; }),
                  kTolerance);
    });
}
TEST(Identity, DegreesOverCubicCurves) {
    each_seed([](Random& r) {
        const auto e = Net(3, r).edges();
        expect_degree(make_three_curves(e), 4);
        expect_degree(make_bbg(e, {Kind::convex}), 4);
        expect_degree(make_bbg(e, {Kind::symmetric}), 3);
        for (const auto& [i, j] : {std::pair{1, 2}, {2, 1}, {2, 3}, {3, 1}}) expect_degree(make_bbg(e, {Kind::boolean, i, j}), 3);
        expect_degree(make_side_vertex(e, Function::polynomial({0, 0, 0, 1})), 3);
    });
}

// ---- Barnhill, Birkhoff and Gordon ----------------------------------------------------------------------------------
TEST(Identity, BbgFormsAreCombinationsOfTheirProjectors) {
    each_seed([](Random& r) {
        const auto e = Net(4, r).edges();
        const Corners c(e);
        const Patch P[] = {make_bbg(e, {Kind::projector, 1}), make_bbg(e, {Kind::projector, 2}), make_bbg(e, {Kind::projector, 3})};
        EXPECT_LE(difference(make_bbg(e, {Kind::convex}),
                             [&](double u, double v, double w) {
                                 return u * P[0].point(u, v) + v * P[1].point(u, v) + w * P[2].point(u, v);
                             }),
                  kTolerance);
        EXPECT_LE(difference(make_bbg(e, {Kind::symmetric}),
                             [&](double u, double v, double w) {
                                 return 0.5 * (P[0].point(u, v) + P[1].point(u, v) + P[2].point(u, v) - c.linear(u, v, w));
                             }),
                  kTolerance);
        EXPECT_LE(difference(make_bbg(e, {Kind::boolean, 1, 2}),
                             [&](double u, double v, double w) {
                                 if (u == 1) return c.A;
                                 return P[1].point(u, v) + w / (1 - u) * (e[1](u) - u * c.A - (1 - u) * c.C);
                             }),
                  kTolerance);
    });
}
TEST(Identity, SymmetricBbgOfCubicsIsACubicBezierTriangle) {
    each_seed([](Random& r) {
        Net b(3, r);
        const auto e = b.edges();
        b(1, 1, 1) = 0.25 * (b(2, 1, 0) + b(1, 2, 0) + b(0, 2, 1) + b(0, 1, 2) + b(1, 0, 2) + b(2, 0, 1)) -
                     (b(3, 0, 0) + b(0, 3, 0) + b(0, 0, 3)) / 6.0;
        EXPECT_LE(difference(make_bbg(e, {Kind::symmetric}), b.patch()), kTolerance);
    });
}
TEST(Identity, PrecisionOfTheC0Surfaces) {
    each_seed([](Random& r) {
        Net one(1, r), two(2, r), three(3, r);
        using Make = std::function<Patch(const std::array<Curve, 3>&)>;
        const auto gap = [](Net& b, const Make& make) { return difference(make(b.edges()), b.patch()); };
        const Make linear[] = {[](const auto& e) { return make_three_curves(e); },
                               [](const auto& e) { return make_bbg(e, {Kind::convex}); },
                               [](const auto& e) { return make_side_vertex(e, Function::polynomial({0, 1})); },
                               [](const auto& e) { return make_side_vertex(e, Function::polynomial({0, 0, 3, -2})); },
                               [](const auto& e) { return make_side_vertex(e, Function::polynomial({0, 0, 0, 2, -1})); }},
                   quadratic[] = {[](const auto& e) { return make_bbg(e, {Kind::boolean, 1, 2}); },
                                  [](const auto& e) { return make_bbg(e, {Kind::boolean, 3, 2}); },
                                  [](const auto& e) { return make_bbg(e, {Kind::symmetric}); },
                                  [](const auto& e) { return make_side_vertex(e, Function::polynomial({0, 0, 1})); }};
        for (const auto& make : linear) {
            EXPECT_LE(gap(one, make), kTolerance);
            EXPECT_GE(gap(two, make), 1e-4);
        }
        for (const auto& make : quadratic) {
            EXPECT_LE(gap(one, make), kTolerance);
            EXPECT_LE(gap(two, make), kTolerance);
            EXPECT_GE(gap(three, make), 1e-4);
        }
    });
}

// ---- C1 -------------------------------------------------------------------------------------------------------------
TEST(Identity, C1SurfacesReproduceCubics) {
    each_seed([](Random& r) {
        for (int degree = 1; degree <= 4; ++degree) {
            Net b(degree, r);
            for (const Patch& p : {make_bbg_c1(b.edges(), b.cross()), make_nielson_c1(b.edges(), b.cross())}) {
                if (degree <= 3) EXPECT_LE(difference(p, b.patch()), kTolerance) << "degree " << degree;
                else EXPECT_GE(difference(p, b.patch()), 1e-4);
            }
        }
    });
}
TEST(Identity, C1SurfacesAreCombinationsOfTheirParts) {
    each_seed([](Random& r) {
        Net b(4, r);
        const auto e = b.edges(), d = b.cross();
        const Patch P[] = {make_bbg_c1(e, d, TrianglePart::of_A), make_bbg_c1(e, d, TrianglePart::of_B), make_bbg_c1(e, d, TrianglePart::of_C)},
                    T[] = {make_nielson_c1(e, d, TrianglePart::of_A), make_nielson_c1(e, d, TrianglePart::of_B), make_nielson_c1(e, d, TrianglePart::of_C)};
        const auto weight = [](double a, double b2, double c) { return a * a * (3 - 2 * a + 6 * b2 * c); };
        EXPECT_LE(difference(make_bbg_c1(e, d),
                             [&](double u, double v, double w) {
                                 const double p = weight(u, v, w), q = weight(v, w, u), s = weight(w, u, v);
                                 EXPECT_NEAR(p + q + s, 1, 1e-14);
                                 return p * P[0].point(u, v) + q * P[1].point(u, v) + s * P[2].point(u, v);
                             }),
                  kTolerance);
        const Corners c(e);
        EXPECT_LE(difference(make_nielson_c1(e, d),
                             [&](double u, double v, double w) {
                                 const double p = v * v * w * w, q = w * w * u * u, s = u * u * v * v, sum = p + q + s;
                                 if (sum == 0) return c.linear(u, v, w);  // a vertex
                                 return p / sum * T[0].point(u, v) + q / sum * T[1].point(u, v) + s / sum * T[2].point(u, v);
                             }),
                  kTolerance);
    });
}

}  // namespace
}  // namespace isoparm::tests
