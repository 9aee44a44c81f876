// identity_gordon_test.cpp -- Gordon, Lagrange and generalised Coons surfaces as each other and as Coons patches and composite
// surfaces, and the parts of every boolean sum. Equal means to 1e-12 of the size, derivatives included.
#include <functional>

#include "curves/isocurve.h"
#include "curves/modify.h"
#include "laws/identity.h"
#include "patches/basis.h"
#include "patches/generalized_coons.h"
#include "patches/gordon.h"
#include "patches/lagrange.h"
#include "patches/tensor_hermite.h"
#include "scalar/elementary.h"

namespace isoparm::tests {
namespace {

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

}  // namespace
}  // namespace isoparm::tests
