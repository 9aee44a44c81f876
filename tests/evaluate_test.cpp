// evaluate_test.cpp -- what evaluate() says on breaks, and that curves run over another range stay in their domain.
#include <gtest/gtest.h>

#include "curves/interpolate.h"
#include "curves/line.h"
#include "curves/modify.h"
#include "patches/ruled.h"
#include "scalar/elementary.h"

namespace isoparm {
namespace {

const std::vector<Point> kPoints{{0, 0, 0}, {1, 0.4, 0.5}, {2, -0.3, 0.1}, {3, 0.2, 0.8}};

TEST(Evaluate, OnABreakDerivativesAreThoseOfTheCellOnItsRight) {
    const Curve c = make_interpolate(kPoints, SplineEnds::catmull_rom);  // C1
    const Patch patch = make_ruled(c, make_line({0, 2, 0}, {3, 2, 0}));
    const double u = reparametrized(c, 0, 1).breaks().front().t;
    const SurfacePoint at = evaluate(patch, u, 0.25), right = evaluate(patch, u + 1e-9, 0.25), left = evaluate(patch, u - 1e-9, 0.25);
    ASSERT_TRUE(at.duu && left.duu && right.duu);
    EXPECT_LT(distance(*at.duu, *right.duu), 1e-6);
    EXPECT_GT(distance(*at.duu, *left.duu), 1);
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
