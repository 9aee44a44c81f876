// identity_test.cpp -- surfaces on a rectangle that are the same surface by different constructions, and what they reproduce:
// Coons patches, translational surfaces, control nets, Hermite data. Equal means to 1e-12 of the size, derivatives included.
#include "laws/identity.h"

#include <numbers>

#include "curves/bspline.h"
#include "curves/isocurve.h"
#include "curves/modify.h"
#include "patches/control_net.h"
#include "patches/gordon.h"
#include "patches/ruled.h"
#include "patches/tensor_bezier.h"
#include "patches/tensor_hermite.h"
#include "patches/translational.h"
#include "scalar/elementary.h"

namespace isoparm::tests {
namespace {

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
        expect_same(make_coons(boundary), patch);
        for (const auto& blend : {cubic_blend(), Function::polynomial({0, 0, 1}), make_function(SineBlend{})})
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
            const CoonsCurves border{make_bezier(c0), make_bezier(c1), make_bezier(p.front()), make_bezier(p.back())};
            expect_same(make_coons(border), make_bezier_patch(p));
        }
    });
}

TEST(Identity, GordonWithHatsReproducesTranslationalSurfaces) {
    each_seed([](Random& r) {
        const Point o = r.point();
        const Curve c = random_cubic(r, o, r.point({3, 0, 0})), d = random_cubic(r, o, r.point({0, 3, 0}));
        const auto moved = [&](const Curve& x, const Point& to) { return transformed(x, Transform::translate(to - o)); };
        const GordonNetwork lines{{c, moved(c, d(0.3)), moved(c, d(1))}, {0, 0.3, 1}, {d, moved(d, c(0.6)), moved(d, c(1))}, {0, 0.6, 1}};
        expect_same(make_gordon(lines, GordonBlend::hermite), make_translational(c, d));
    });
}

// ---- control nets ---------------------------------------------------------------------------------------------------
/// The net by formula, blended at the parameters s and t of its rows and columns.
Grid<Point> net_at(const ControlFrame& f, const std::vector<double>& s, const std::vector<double>& t) {
    Grid<Point> b;
    const auto &c0 = f.c0.points, &c1 = f.c1.points, &d0 = f.d0.points, &d1 = f.d1.points;
    for (std::size_t i = 0; i < s.size(); ++i) {
        b.emplace_back();
        for (std::size_t j = 0; j < t.size(); ++j) {
            const Point low = (1 - t[j]) * c0.front() + t[j] * c1.front(), high = (1 - t[j]) * c0.back() + t[j] * c1.back();
            b[i].push_back((1 - s[i]) * (d0[j] - low) + s[i] * (d1[j] - high) + (1 - t[j]) * c0[i] + t[j] * c1[i]);
        }
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

TEST(Identity, OctantOfTheSphereHasRadiusOne) {
    const double s = std::sqrt(0.5);
    const Grid<Point> poles{{{0, 0, 1}, {0, 0, 1}, {0, 0, 1}}, {{1, 0, 1}, {1, 1, 1}, {0, 1, 1}}, {{1, 0, 0}, {1, 1, 0}, {0, 1, 0}}};
    const Patch octant = make_bezier_patch(poles, {{1, s, 1}, {s, 0.5, s}, {1, s, 1}});
    Random r(1);
    for (int n = 0; n < 200; ++n) EXPECT_NEAR(length(octant.point(r.number(), r.number())), 1, 4e-16 * 4);
    const auto line = [&](Along along, double at) { return make_isocurve(octant, along, at); };
    const Patch coons = make_coons({line(Along::u, 0), line(Along::u, 1), line(Along::v, 0), line(Along::v, 1)});
    EXPECT_GE(std::abs(length(coons.point(0.5, 0.5)) - 1), 0.01) << "the Coons patch of the same arcs is no sphere";
}

}  // namespace
}  // namespace isoparm::tests
