// identity_test.cpp -- surfaces on a rectangle that are the same surface by different constructions, and what they reproduce.
// Random data, fixed seeds; equal means to 1e-12 of the size, second derivatives included.
#include <gtest/gtest.h>

#include <functional>
#include <numbers>

#include "curves/bezier.h"
#include "curves/bspline.h"
#include "curves/hermite.h"
#include "curves/isocurve.h"
#include "curves/modify.h"
#include "patches/basis.h"
#include "patches/control_net.h"
#include "patches/coons.h"
#include "patches/coons_hermite.h"
#include "patches/generalized_coons.h"
#include "patches/gordon.h"
#include "patches/lagrange.h"
#include "patches/network.h"
#include "patches/ruled.h"
#include "patches/tensor_bezier.h"
#include "patches/tensor_hermite.h"
#include "patches/translational.h"
#include "samples.h"
#include "scalar/elementary.h"

namespace isoparm::tests {
namespace {

constexpr double kTolerance = 1e-12;
constexpr int kSeeds = 4;

/// Largest difference of positions, in units of the size.
double difference(const Patch& a, const Patch& b) {
    Random r(99);
    double worst = 0;
    for (int n = 0; n < 80; ++n) {
        Vec2 p = random_parameter(r, a);
        if (n % 4 == 0) p = a.edge_point(n % 3, r.number());
        worst = std::max(worst, distance(a.point(p.x, p.y), b.point(p.x, p.y)));
    }
    return worst / size_of_sample(a);
}
/// Positions, first and second derivatives.
void expect_same(const Patch& a, const Patch& b) {
    EXPECT_LE(difference(a, b), kTolerance);
    Random r(98);
    const double size = size_of_sample(a);
    for (int n = 0; n < 30; ++n) {
        const Vec2 p = random_parameter(r, a, 1e-3);
        const PointJet x = a.jet(p.x, p.y), y = b.jet(p.x, p.y);
        for (int axis = 0; axis < 3; ++axis)
            for (int k = 0; k < x.x.size; ++k)
                EXPECT_NEAR(x[axis].c[k], y[axis].c[k], 10 * kTolerance * (size + std::abs(y[axis].c[k])))
                    << "coefficient " << k << " at " << p.x << ", " << p.y;
    }
}
template <class F> void each_seed(F law) {
    for (int seed = 1; seed <= kSeeds; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        Random r(seed);
        law(r);
    }
}
CoonsCurves frame(Random& r) {
    const Frame e = random_frame(r);
    return {e.c0, e.c1, e.d0, e.d1};
}
using Kind = Functional::Kind;

/// Lagrange polynomial of a node, as a blend.
Function lagrange(const std::vector<double>& nodes, std::size_t k) {
    std::vector<double> c{1};
    for (std::size_t s = 0; s < nodes.size(); ++s) {
        if (s == k) continue;
        const double scale = 1 / (nodes[k] - nodes[s]);
        std::vector<double> next(c.size() + 1);
        for (std::size_t i = 0; i < c.size(); ++i) next[i] -= c[i] * nodes[s] * scale, next[i + 1] += c[i] * scale;
        c = next;
    }
    return Function::polynomial(c);
}
/// (17) of Chashnikov 2008: the C1 hat of a node, by its value or its slope there; 0 beyond the neighbours.
struct Hat {
    double node;
    bool slope;
    template <class S> S operator()(const S& t) const {
        const S right = t - node, left = right + 1.0, zero(0.0);
        const auto h = hermite_polynomials(right), g = hermite_polynomials(left);
        const S rise = choose(Comparison::less, left, zero, zero, slope ? g[2] : g[3], true),
                fall = choose(Comparison::greater, right, S(1.0), zero, slope ? h[1] : h[0], true);
        return choose(Comparison::less, right, zero, rise, fall, true);
    }
    Polynomial operator()(const Polynomial&) const { return Polynomial::nothing(); }
};

// ---- Coons and translational surfaces -------------------------------------------------------------------------------
struct SineBlend {
    template <class S> S operator()(const S& t) const {
        using std::cos;
        return 0.5 * (1.0 - cos(t * std::numbers::pi));
    }
    Polynomial operator()(const Polynomial&) const { return Polynomial::nothing(); }
};

TEST(Identity, TranslationalSurfaceIsTheCoonsPatchOfItsBoundaryForEveryBlend) {
    each_seed([](Random& r) {
        const Point a = r.point();
        const Curve c = random_cubic(r, a, r.point({3, 0, 0})), d = random_cubic(r, a, r.point({0, 3, 0}));
        const auto moved = [](const Curve& curve, const Point& by) { return transformed(curve, Transform::translate(by)); };
        const CoonsCurves boundary{c, moved(c, d(1) - a), d, moved(d, c(1) - a)};
        const Patch patch = make_translational(c, d);
        for (const auto& blend : {std::optional<Function>{}, {cubic_blend()}, {Function::polynomial({0, 0, 1})}, {make_function(SineBlend{})}})
            expect_same(make_coons(boundary, blend), patch);
    });
}
TEST(Identity, ConvexCombinationOfTranslationalSurfacesIsTheBilinearCoonsPatch) {
    each_seed([](Random& r) {
        const CoonsCurves c = frame(r);
        expect_same(make_translational_blend(c), make_coons(c));
        EXPECT_GE(difference(make_translational_blend(c), make_coons(c, cubic_blend())), 1e-3) << "and no other";
    });
}
TEST(Identity, RuledSurfaceIsAProjectorOfTheCoonsPatch) {
    each_seed([](Random& r) {
        const CoonsCurves c = frame(r);
        expect_same(make_ruled(c.c0, c.c1), make_coons(c, {}, Part::P2));
    });
}
TEST(Identity, CoonsReproducesWhatIsLinearInOneParameter) {
    each_seed([](Random& r) {
        for (const auto& [rows, columns] : {std::pair{6, 2}, {2, 6}}) {
            const auto p = random_net(r, rows, columns);
            std::vector<Point> c0, c1;
            for (const auto& row : p) c0.push_back(row.front()), c1.push_back(row.back());
            expect_same(make_coons({make_bezier(c0), make_bezier(c1), make_bezier(p.front()), make_bezier(p.back())}), make_bezier_patch(p));
        }
    });
}

// ---- control nets ---------------------------------------------------------------------------------------------------
/// The net by formula, blended at the parameters s and t of its rows and columns.
Grid<Point> net_at(const ControlFrame& f, const std::vector<double>& s, const std::vector<double>& t) {
    Grid<Point> b;
    const auto &c0 = f.c0.points, &c1 = f.c1.points, &d0 = f.d0.points, &d1 = f.d1.points;
    for (std::size_t i = 0; i < s.size(); ++i) {
        b.emplace_back();
        for (std::size_t j = 0; j < t.size(); ++j)
            b[i].push_back((1 - s[i]) * d0[j] + s[i] * d1[j] + (1 - t[j]) * c0[i] + t[j] * c1[i] -
                           ((1 - s[i]) * ((1 - t[j]) * c0.front() + t[j] * c1.front()) + s[i] * ((1 - t[j]) * c0.back() + t[j] * c1.back())));
    }
    return b;
}
std::vector<double> uniform(std::size_t count) {
    std::vector<double> t;
    for (std::size_t i = 0; i < count; ++i) t.push_back(double(i) / double(count - 1));
    return t;
}
/// Control polygons of the given knots that meet at the corners.
ControlFrame control_frame(Random& r, int p, const std::vector<double>& ku, int q, const std::vector<double>& kv) {
    const int m = int(ku.size()) - p - 1, n = int(kv.size()) - q - 1;
    const auto net = random_net(r, m, n);
    ControlFrame f{{p, ku, {}}, {p, ku, {}}, {q, kv, net.front()}, {q, kv, net.back()}};
    for (const auto& row : net) f.c0.points.push_back(row.front()), f.c1.points.push_back(row.back());
    return f;
}
CoonsCurves curves(const ControlFrame& f) {
    const auto spline = [](const SplineCurve& c) { return reparametrized(make_bspline(c.degree, c.knots, c.points), 0, 1); };
    return {spline(f.c0), spline(f.c1), spline(f.d0), spline(f.d1)};
}
TEST(Identity, DiscreteCoonsNetOfBezierCurvesIsTheCoonsPatch) {
    each_seed([](Random& r) {
        const ControlFrame f = control_frame(r, 4, {0, 0, 0, 0, 0, 1, 1, 1, 1, 1}, 3, {0, 0, 0, 0, 1, 1, 1, 1});
        expect_same(make_control_net(f), make_coons(curves(f)));
        expect_same(make_control_net(f), make_bezier_patch(net_at(f, uniform(5), uniform(4))));  // i/m are Bezier's own abscissae
    });
}
TEST(Identity, DiscreteCoonsNetOfSplinesIsTheCoonsPatchAtGrevilleAbscissaeOnly) {
    each_seed([](Random& r) {
        const std::vector<double> ku{0, 0, 0, 0, 0.2, 0.3, 1, 1, 1, 1}, kv{0, 0, 0, 0.6, 1, 1, 1};
        const ControlFrame f = control_frame(r, 3, ku, 2, kv);
        const Patch coons = make_coons(curves(f));
        expect_same(make_control_net(f), coons);
        const auto net = coons_net(f), by_formula = net_at(f, {0, 0.2 / 3, 0.5 / 3, 0.5, 1.3 / 3 + 1 / 3.0, 1}, {0, 0.3, 0.8, 1});
        ASSERT_EQ(net.size(), 6u);
        for (std::size_t i = 0; i < 6; ++i)
            for (std::size_t j = 0; j < 4; ++j) EXPECT_LE(distance(net[i][j], by_formula[i][j]), 1e-13) << i << ", " << j;
        const Patch even = make_bspline_patch(3, 2, ku, kv, net_at(f, uniform(6), uniform(4)));
        EXPECT_GE(difference(coons, even), 0.01) << "rows at i/m are another surface";
        const Curve edge = curves(f).c0;
        EXPECT_LE(distance(even.point(0.37, 0), edge(0.37)), 1e-13) << "with the same boundary";
    });
}

// ---- Hermite Coons patches ------------------------------------------------------------------------------------------
/// Boundary and cross derivatives of a Bezier patch.
HermiteData hermite_data(const Grid<Point>& p) {
    const std::size_t m = p.size() - 1, n = p[0].size() - 1;
    std::array<std::vector<Point>, 4> f, g;
    for (std::size_t j = 0; j <= n; ++j) {
        f[0].push_back(p[0][j]), f[1].push_back(double(m) * (p[1][j] - p[0][j]));
        f[2].push_back(double(m) * (p[m][j] - p[m - 1][j])), f[3].push_back(p[m][j]);
    }
    for (std::size_t i = 0; i <= m; ++i) {
        g[0].push_back(p[i][0]), g[1].push_back(double(n) * (p[i][1] - p[i][0]));
        g[2].push_back(double(n) * (p[i][n] - p[i][n - 1])), g[3].push_back(p[i][n]);
    }
    return {{make_bezier(f[0]), make_bezier(f[1]), make_bezier(f[2]), make_bezier(f[3])},
            {make_bezier(g[0]), make_bezier(g[1]), make_bezier(g[2]), make_bezier(g[3])}};
}
TEST(Identity, HermiteCoonsReproducesWhatIsCubicInOneParameter) {
    each_seed([](Random& r) {
        for (const auto& [rows, columns] : {std::pair{8, 4}, {4, 8}}) {
            const auto p = random_net(r, rows, columns);
            for (auto twist : {Twist::compatible, Twist::gregory, Twist::average})
                expect_same(make_coons_hermite(hermite_data(p), twist), make_bezier_patch(p));
        }
        const auto p = random_net(r, 5, 5);
        EXPECT_GE(difference(make_coons_hermite(hermite_data(p)), make_bezier_patch(p)), 1e-4) << "quartic in both";
    });
}

/// Random data at the nodes (i,j) of [0,m] x [0,n].
struct Nodes {
    Grid<Point> x, u, v, uv;
    Nodes(Random& r, int m, int n) : x(m + 1), u(m + 1), v(m + 1), uv(m + 1) {
        for (int i = 0; i <= m; ++i)
            for (int j = 0; j <= n; ++j) {
                x[i].push_back(r.point({double(i), double(j), 0}, 0.3));
                u[i].push_back(r.vector()), v[i].push_back(r.vector()), uv[i].push_back(r.vector());
            }
    }
    static std::vector<Point> column(const Grid<Point>& g, std::size_t j) {
        std::vector<Point> list;
        for (const auto& row : g) list.push_back(row[j]);
        return list;
    }
    Network network() const {
        Network net;
        for (std::size_t i = 0; i < x.size(); ++i) net.a.push_back(make_hermite(x[i], v[i]));
        for (std::size_t j = 0; j < x[0].size(); ++j) net.b.push_back(make_hermite(column(x, j), column(u, j)));
        return net;
    }
    CrossDerivatives cross() const {
        CrossDerivatives c;
        for (std::size_t i = 0; i < x.size(); ++i) c.A.push_back(make_hermite(u[i], uv[i]));
        for (std::size_t j = 0; j < x[0].size(); ++j) c.B.push_back(make_hermite(column(v, j), column(uv, j)));
        return c;
    }
};
TEST(Identity, TensorHermiteIsTheCoonsPatchOfItsOwnCurves) {
    each_seed([](Random& r) {
        const Nodes d(r, 1, 1);
        const Network net = d.network();
        const CrossDerivatives c = d.cross();
        const HermiteData data{{net.a[0], c.A[0], c.A[1], net.a[1]}, {net.b[0], c.B[0], c.B[1], net.b[1]}};
        const Patch tensor = make_tensor_hermite(d.x, d.u, d.v, d.uv);
        expect_same(make_coons_hermite(data), tensor);
        for (auto part : {Part::P1, Part::P2, Part::P1P2})  // 1 + 1 - 1: each projector makes the whole
            expect_same(make_coons_hermite(data, Twist::compatible, part), tensor);
    });
}
TEST(Identity, TensorHermiteIsTheNetworkOfItsOwnCurves) {
    each_seed([](Random& r) {
        const Nodes d(r, 3, 2);
        const Patch tensor = make_tensor_hermite(d.x, d.u, d.v, d.uv);
        expect_same(make_network(d.network(), d.cross(), Twist::compatible), tensor);
        expect_same(make_network(d.network(), from_twists(d.network(), d.uv), Twist::compatible), tensor);
    });
}

// ---- Gordon surfaces and Lagrange surfaces --------------------------------------------------------------------------
GordonNetwork lines_of(const Patch& patch, const std::vector<double>& u, const std::vector<double>& v) {
    GordonNetwork net{{}, v, {}, u};
    for (double t : v) net.u_curves.push_back(make_isocurve(patch, Along::u, t));
    for (double t : u) net.v_curves.push_back(make_isocurve(patch, Along::v, t));
    return net;
}
const std::vector<double> kU{0, 0.3, 0.55, 1}, kV{0, 0.4, 1};

TEST(Identity, GordonReproducesDegreesBelowItsNumberOfCurves) {
    each_seed([](Random& r) {
        for (const auto& [rows, columns] : {std::pair{4, 7}, {8, 3}}) {  // cubic in u through four curves, quadratic in v through three
            const Patch patch = make_bezier_patch(random_net(r, rows, columns));
            expect_same(make_gordon(lines_of(patch, kU, kV)), patch);
        }
        const Patch patch = make_bezier_patch(random_net(r, 6, 5));
        EXPECT_GE(difference(make_gordon(lines_of(patch, kU, kV)), patch), 1e-5) << "degree (5,4)";
    });
}
TEST(Identity, GordonIsTheSumOfItsProjectors) {
    each_seed([](Random& r) {
        const Patch source = make_bezier_patch(random_net(r, 6, 6));
        const GordonNetwork net = lines_of(source, kU, kV);
        const Patch gordon = make_gordon(net);
        Random at(7);
        for (int n = 0; n < 30; ++n) {
            const double u = at.number(), v = at.number();
            Point g1, g2, g12;
            for (std::size_t i = 0; i < kU.size(); ++i) g1 += lagrange(kU, i)(u) * net.v_curves[i](v);
            for (std::size_t j = 0; j < kV.size(); ++j) g2 += lagrange(kV, j)(v) * net.u_curves[j](u);
            for (std::size_t i = 0; i < kU.size(); ++i)
                for (std::size_t j = 0; j < kV.size(); ++j) g12 += lagrange(kU, i)(u) * lagrange(kV, j)(v) * source.point(kU[i], kV[j]);
            EXPECT_LE(distance(gordon.point(u, v), g1 + g2 - g12), kTolerance * size_of_sample(gordon));
            EXPECT_LE(distance(make_gordon(net, GordonBlend::lagrange, Part::P1).point(u, v), g1), kTolerance * 10);
            EXPECT_LE(distance(make_gordon(net, GordonBlend::lagrange, Part::P2).point(u, v), g2), kTolerance * 10);
            EXPECT_LE(distance(make_gordon(net, GordonBlend::lagrange, Part::P1P2).point(u, v), g12), kTolerance * 10);
        }
    });
}
TEST(Identity, LagrangeSurfaceIsAProjectorOfGordons) {
    each_seed([](Random& r) {
        const GordonNetwork net = lines_of(make_bezier_patch(random_net(r, 6, 6)), kU, kV);
        expect_same(make_lagrange(net.u_curves, kV), make_gordon(net, GordonBlend::lagrange, Part::P2));
    });
}

// ---- generalised Coons surfaces -------------------------------------------------------------------------------------
TEST(Identity, GeneralisedWithTwoFunctionalsIsTheBilinearCoonsPatch) {
    each_seed([](Random& r) {
        const CoonsCurves c = frame(r);
        const std::vector<Functional> ends{{Kind::value, 0}, {Kind::value, 1}};
        const std::vector<Function> linear{Function::polynomial({1, -1}), Function::polynomial({0, 1})};
        expect_same(make_generalized_coons({ends, ends, linear, linear, {c.d0, c.d1}, {c.c0, c.c1}}), make_coons(c));
    });
}
TEST(Identity, GeneralisedWithFourFunctionalsIsTheHermiteCoonsPatch) {
    each_seed([](Random& r) {
        const HermiteData d = hermite_data(random_net(r, 6, 5));
        const std::vector<Functional> ends{{Kind::value, 0}, {Kind::derivative, 0}, {Kind::derivative, 1}, {Kind::value, 1}};
        const std::vector<Function> blends{Function::polynomial({1, 0, -3, 2}), Function::polynomial({0, 1, -2, 1}),
                                           Function::polynomial({0, 0, -1, 1}), Function::polynomial({0, 0, 3, -2})};
        expect_same(make_generalized_coons({ends, ends, blends, blends, {d.f.begin(), d.f.end()}, {d.g.begin(), d.g.end()}}),
                    make_coons_hermite(d));
    });
}
TEST(Identity, GeneralisedWithLagrangeBlendsIsGordons) {
    each_seed([](Random& r) {
        const GordonNetwork net = lines_of(make_bezier_patch(random_net(r, 6, 6)), kU, kV);
        GeneralizedCoons data;
        for (std::size_t i = 0; i < kU.size(); ++i) data.u.push_back({Kind::value, kU[i]}), data.blend_u.push_back(lagrange(kU, i));
        for (std::size_t j = 0; j < kV.size(); ++j) data.v.push_back({Kind::value, kV[j]}), data.blend_v.push_back(lagrange(kV, j));
        data.f = net.v_curves, data.g = net.u_curves;
        expect_same(make_generalized_coons(data), make_gordon(net));
    });
}
/// Section 5 of Chashnikov 2008: values and slopes at all nodes.
GeneralizedCoons as_generalised(const Network& net, const CrossDerivatives& cross) {
    GeneralizedCoons d;
    const auto add = [](const std::vector<Curve>& value, const std::vector<Curve>& slope, auto& functionals, auto& blends, auto& list) {
        for (std::size_t i = 0; i < value.size(); ++i)
            for (bool s : {false, true}) {
                functionals.push_back({s ? Kind::derivative : Kind::value, double(i)});
                blends.push_back(make_function(Hat{double(i), s}));
                list.push_back(s ? slope[i] : value[i]);
            }
    };
    add(net.a, cross.A, d.u, d.blend_u, d.f);
    add(net.b, cross.B, d.v, d.blend_v, d.g);
    return d;
}
/// b (t (t-1) ... (t-end))^2: bends a curve between the nodes, and keeps its values and slopes there.
struct Bump {
    Point b;
    double end, begin = 0;
    template <class S> Vec3<S> operator()(const S& t) const {
        S p = t;
        for (int k = 1; k <= end; ++k) p = p * (t - double(k));
        return square(p) * b;
    }
};
TEST(Identity, CompositeIsGeneralisedWithHats) {  // Proposition 2
    each_seed([](Random& r) {
        const Nodes d(r, 3, 2);
        Network net = d.network();
        CrossDerivatives cross = d.cross();
        for (auto* list : {&net.a, &net.b, &cross.A, &cross.B})
            for (auto& c : *list) c = linear_combination({1, 1}, {c, make_curve(Bump{r.vector(), c.end()})});
        const Patch composite = make_network(net, cross, Twist::compatible);
        expect_same(make_generalized_coons(as_generalised(net, cross)), composite);
        EXPECT_GE(difference(composite, make_tensor_hermite(d.x, d.u, d.v, d.uv)), 1e-3) << "the bumps count";
    });
}

// ---- every boolean sum ----------------------------------------------------------------------------------------------
TEST(Identity, PartsOfEveryBooleanSumAddUp) {
    each_seed([](Random& r) {
        const CoonsCurves c = frame(r);
        const HermiteData h = hermite_data(random_net(r, 5, 4));
        const GordonNetwork g = lines_of(make_bezier_patch(random_net(r, 6, 6)), kU, kV);
        const Nodes d(r, 3, 2);
        const Network net = d.network();
        const CrossDerivatives cross = d.cross();
        const std::function<Patch(Part)> types[] = {
            [&](Part p) { return make_coons(c, {}, p); },
            [&](Part p) { return make_coons(c, cubic_blend(), p); },
            [&](Part p) { return make_coons_hermite(h, Twist::compatible, p); },
            [&](Part p) { return make_coons_hermite(h, Twist::gregory, p); },
            [&](Part p) { return make_coons_hermite(h, Twist::zero, p); },
            [&](Part p) { return make_gordon(g, GordonBlend::lagrange, p); },
            [&](Part p) { return make_gordon(g, GordonBlend::hermite, p); },
            [&](Part p) { return make_network(net, Twist::average, p); },
            [&](Part p) { return make_network(net, Twist::gregory, p); },
            [&](Part p) { return make_network(net, cross, Twist::compatible, p); },
            [&](Part p) { return make_generalized_coons(as_generalised(net, cross), p); },
        };
        for (std::size_t k = 0; k < std::size(types); ++k) {
            SCOPED_TRACE("type " + std::to_string(k));
            const Patch sum = types[k](Part::sum), p1 = types[k](Part::P1), p2 = types[k](Part::P2), p12 = types[k](Part::P1P2);
            Random at(5);
            for (int n = 0; n < 40; ++n) {
                const Vec2 p = random_parameter(at, sum);
                const Point expected = p1.point(p.x, p.y) + p2.point(p.x, p.y) - p12.point(p.x, p.y);
                EXPECT_LE(distance(sum.point(p.x, p.y), expected), kTolerance * size_of_sample(sum));
            }
        }
    });
}

TEST(Identity, OctantOfTheSphereHasRadiusOne) {
    const double s = std::sqrt(0.5);
    const Patch octant = make_bezier_patch({{{0, 0, 1}, {0, 0, 1}, {0, 0, 1}}, {{1, 0, 1}, {1, 1, 1}, {0, 1, 1}}, {{1, 0, 0}, {1, 1, 0}, {0, 1, 0}}},
                                           {{1, s, 1}, {s, 0.5, s}, {1, s, 1}});
    Random r(1);
    for (int n = 0; n < 200; ++n) EXPECT_NEAR(length(octant.point(r.number(), r.number())), 1, 4e-16 * 4);
    const Patch coons = make_coons({make_isocurve(octant, Along::u, 0), make_isocurve(octant, Along::u, 1), make_isocurve(octant, Along::v, 0),
                                    make_isocurve(octant, Along::v, 1)});
    EXPECT_GE(std::abs(length(coons.point(0.5, 0.5)) - 1), 0.01) << "the Coons patch of the same arcs is no sphere";
}

}  // namespace
}  // namespace isoparm::tests
