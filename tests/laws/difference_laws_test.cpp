// Divided differences of curves that are hard to divide: against the quotient in 64 more bits, and inside their own enclosure.
#include <gtest/gtest.h>

#include "curves/bezier.h"
#include "curves/bspline.h"
#include "curves/difference.h"
#include "scalar/elementary.h"

namespace isoparm::tests {
namespace {

using Long = long double;
/// z = 2 W t (1-t) / w vanishes at both ends: the quotient is known in closed form.
TEST(Difference, OfARationalCurveIsExact) {
    for (const double W : {1e-3, 0.5, 10.0, 100.0, 1e3}) {
        const Curve c = make_bezier({{0, 1, 0}, {0, 0.5, 1}, {0, 0, 0}}, {1, W, 1});
        for (const CurveEnd end : {CurveEnd::first, CurveEnd::last}) {
            const Curve q = divided_difference(c, end);
            for (double t : {0.0, 1e-12, 1e-6, 0.001, 0.1, 0.25, 0.5, 0.75, 0.875, 0.9375, 0.999, 1 - 1e-9, 1.0}) {
                const Long w = (1 - Long(t)) * (1 - Long(t)) + 2 * Long(W) * t * (1 - Long(t)) + Long(t) * t;
                const double expected = double(end == CurveEnd::first ? 2 * Long(W) * (1 - Long(t)) / w : -2 * Long(W) * t / w);
                EXPECT_NEAR(q(t).z, expected, 1e-14 * (1 + std::fabs(expected))) << "weight " << W << " at " << t;
            }
        }
        const Curve slope = derivative_curve(c);
        for (double t : {0.0, 0.001, 0.25, 0.75, 1.0}) EXPECT_NEAR(slope(t).z, c.derivative(t).z, 1e-12 * (1 + W)) << W;
    }
}
TEST(Difference, OfARationalSplineIsTheQuotient) {
    const Curve c = make_bspline(3, {0, 0, 0, 0, 0.2, 0.5, 0.5, 1, 1, 1, 1}, {{0, 0, 1}, {1, 0, 0}, {2, 1, 0}, {2, 3, 1}, {4, 3, 0}, {4, 0, 2}, {5, 0, 1}}, {1, 100, 1, 0.01, 1, 3, 1});
    for (const CurveEnd end : {CurveEnd::first, CurveEnd::last}) {
        const double e = end == CurveEnd::first ? 0 : 1;
        const Curve q = divided_difference(c, end), qq = divided_difference(c, end, 2), slope = derivative_curve(c);
        ASSERT_NE(q.bezier(), nullptr);
        for (double t = 0.01; t < 1; t += 0.0625) {
            const Point quotient = (c(t) - c(e)) / (t - e);
            EXPECT_LE(distance(q(t), quotient), 1e-11) << t;
            EXPECT_LE(distance(qq(t), (quotient - c.derivative(e)) / (t - e)), 1e-8) << t;
            EXPECT_LE(distance(slope(t), c.derivative(t)), 1e-11 * (1 + length(slope(t)))) << t;
        }
        EXPECT_LE(distance(q(e), c.derivative(e)), 1e-10);
    }
}

struct Bump {
    double begin = 0, end = 1;
    bool corner = false;
    template <class S> S height(const S& t) const {
        if (corner) return absolute(S(t - 0.9)) - 0.9 + t * 0.8;
        return t * (1.0 - t) * exp(S(-square(S((t - 0.9) / 0.005))));
    }
    template <class S> Vec3<S> operator()(const S& t) const { return {S(0.0), S(1.0 - t), height(t)}; }
    Vec3<Polynomial> operator()(const Polynomial&) const { return {Polynomial::nothing(), Polynomial::nothing(), Polynomial::nothing()}; }
};
TEST(Difference, OfABumpOrACornerStaysInsideItsEnclosure) {
    for (const bool corner : {false, true}) {
        const Curve c = make_curve(Bump{0, 1, corner});
        for (const CurveEnd end : {CurveEnd::first, CurveEnd::last}) {
            const Curve q = divided_difference(c, end);
            for (int n = 0; n <= 1000; ++n) {
                const double t = n / 1000.0;
                Point x[3];
                Vec3<Interval> over[3];
                q.taylor(t, 2, x);
                q.taylor(Interval(t), 2, over);
                for (int k = 0; k < 3; ++k)
                    for (int axis = 0; axis < 3; ++axis)
                        if (!std::isnan(x[k][axis])) EXPECT_TRUE(over[k][axis].lo <= x[k][axis] && x[k][axis] <= over[k][axis].hi) << "order " << k << " at " << t;
                const double e = end == CurveEnd::first ? 0 : 1;
                if (std::fabs(t - e) > 1e-3) EXPECT_NEAR(x[0].z, (c(t).z - c(e).z) / (t - e), 2e-12) << t;
            }
        }
    }
}

}  // namespace
}  // namespace isoparm::tests
