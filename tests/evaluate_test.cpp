// evaluate_test.cpp -- what evaluate() says where derivatives jump, and that curves run over another range stay in their domain.
#include <gtest/gtest.h>

#include "curves/bspline.h"
#include "curves/interpolate.h"
#include "curves/line.h"
#include "curves/modify.h"
#include "patches/ruled.h"
#include "scalar/elementary.h"

namespace isoparm {
namespace {

const std::vector<Point> kPoints{{0, 0, 0}, {1, 0.4, 0.5}, {2, -0.3, 0.1}, {3, 0.2, 0.8}};

Patch ruled_over(const Curve& c) { return make_ruled(c, make_interpolate({{0, 2, 0}, {1, 2, 1}, {2, 2, 0}, {3, 2, 1}}, SplineEnds::natural)); }

TEST(Evaluate, SecondDerivativesThatJumpAreNotGiven) {
    const SurfacePoint p = evaluate(ruled_over(make_interpolate(kPoints, SplineEnds::catmull_rom)), 1 / 3.0, 0.25);
    EXPECT_TRUE(p.du && p.dv && p.duv && p.dvv && p.normal);
    EXPECT_FALSE(p.duu || p.gaussian || p.mean) << "the spline is C1";
}
TEST(Evaluate, SecondDerivativesThatGoOnAreGivenAtBreaks) {
    const SurfacePoint p = evaluate(ruled_over(make_interpolate(kPoints, SplineEnds::natural)), 1 / 3.0, 0.25);
    EXPECT_TRUE(p.du && p.duu && p.duv && p.normal && p.gaussian) << "the spline is C2";
}
TEST(Evaluate, NothingAcrossACreaseButThePosition) {
    const Curve corner = make_bspline(1, {0, 0, 1, 2, 2}, {{0, 0, 0}, {1, 0, 1}, {2, 0, 0}});
    const SurfacePoint p = evaluate(make_ruled(corner, make_line({0, 1, 0}, {2, 1, 0})), 0.5, 0.5);
    EXPECT_EQ(p.position, (Point{1, 0.5, 0.5}));
    EXPECT_FALSE(p.du || p.normal);
    EXPECT_TRUE(p.dv);
}

/// Defined for t <= -0.23 only.
struct Root {
    double begin = -1.9, end = -0.23;
    template <class S> Vec3<S> operator()(const S& t) const { return {t, S(0.0), sqrt(S(-0.23 - t))}; }
    Vec3<Polynomial> operator()(const Polynomial&) const { return {Polynomial::nothing(), Polynomial::nothing(), Polynomial::nothing()}; }
};
TEST(Evaluate, RunOverAnotherRangeACurveStaysInItsDomain) {
    for (const Curve& c : {reparametrized(make_curve(Root{}), 0, 1), reversed(reparametrized(make_curve(Root{}), 0, 1)), segment(make_curve(Root{}), -1, -0.23)})
        for (const double t : {c.begin(), c.end()}) {
            EXPECT_TRUE(finite(c(t)));
            Vec3<Interval> box;
            c.taylor(Interval(t), 0, &box);
            EXPECT_LT(box.z.hi, 2);
        }
}

}  // namespace
}  // namespace isoparm
