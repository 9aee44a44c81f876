// interval_test.cpp -- every operation on intervals encloses the exact result, checked in quadruple precision; what has
// no bound says so.
#include "scalar/interval.h"

#include <gtest/gtest.h>

#include "error.h"
#include "samples.h"
#include "scalar/elementary.h"

namespace isoparm {
namespace {

using tests::Random;

constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr double kMax = std::numeric_limits<double>::max();
constexpr double kMin = std::numeric_limits<double>::min();
constexpr double kDenormal = std::numeric_limits<double>::denorm_min();
const std::vector<double> kEdges{0.0,         -0.0,
                                 1,           -1,
                                 kDenormal,   -kDenormal,
                                 kMin,        -kMin,
                                 kMax,        -kMax,
                                 1e308,       -1e308,
                                 1e-160,      -1e-160,
                                 1e-300,      3.0,
                                 1.0 / 3,     -1.0 / 3,
                                 1e16,        1 + 0x1p-52,
                                 1 - 0x1p-53, 123456789.123456789,
                                 0x1p-1060};

// Quadruple precision holds the product of two doubles exactly, and rounds monotonically: where the law below holds for
// the exact result it holds for the rounded one.
#ifdef __SIZEOF_FLOAT128__
using Wide = __float128;
#else
using Wide = long double;
#endif

/// Doubles of all sizes and signs, some of them special.
double any_double(Random& r) {
    if (r.integer(0, 4) == 0) return kEdges[r.integer(0, int(kEdges.size()) - 1)];
    return std::ldexp(r.number(-1, 1), r.integer(0, 3) == 0 ? r.integer(-1073, 1023) : r.integer(-6, 6));
}
Interval any_interval(Random& r) {
    const double a = any_double(r), b = r.integer(0, 3) == 0 ? a : any_double(r);
    return {std::min(a, b), std::max(a, b)};
}
double inside(Random& r, const Interval& a) {
    switch (r.integer(0, 3)) {
        case 0:
            return a.lo;
        case 1:
            return a.hi;
        case 2:
            return a.contains(0) ? 0 : mid(a);
        default:
            return std::clamp(a.lo * 0.5 + a.hi * 0.5 + r.number(-1, 1) * (a.hi * 0.5 - a.lo * 0.5), a.lo, a.hi);
    }
}
void expect_holds(const Interval& result, Wide exact, const char* what, double x, double y) {
    EXPECT_TRUE(Wide(result.lo) <= exact && exact <= Wide(result.hi))
        << what << " of " << to_text(x) << ", " << to_text(y) << " is not in [" << to_text(result.lo) << ", "
        << to_text(result.hi) << "]";
    EXPECT_LE(result.lo, result.hi);
}

TEST(IntervalLaw, ArithmeticEnclosesTheExactResult) {
    for (int seed = 1; seed <= 20; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        Random r(seed);
        for (int n = 0; n < 2000; ++n) {
            const Interval a = any_interval(r), b = any_interval(r);
            const double x = inside(r, a), y = inside(r, b);
            expect_holds(a + b, Wide(x) + Wide(y), "sum", x, y);
            expect_holds(a - b, Wide(x) - Wide(y), "difference", x, y);
            expect_holds(a * b, Wide(x) * Wide(y), "product", x, y);
            expect_holds(-a, -Wide(x), "negative", x, y);
            expect_holds(square(a), Wide(x) * Wide(x), "square", x, y);
            expect_holds(abs(a), x < 0 ? -Wide(x) : Wide(x), "abs", x, y);
            expect_holds(min(a, b), std::min(x, y), "min", x, y);
            expect_holds(max(a, b), std::max(x, y), "max", x, y);
            expect_holds(hull(a, b), x, "hull", x, y);
            if (y != 0) {
                expect_holds(a / b, Wide(x) / Wide(y), "quotient", x, y);
                expect_holds(reciprocal(b), 1 / Wide(y), "reciprocal", x, y);
            }
            if (x >= 0) {  // lo^2 <= x <= hi^2 tells that the root is between
                const Interval s = sqrt(a);
                EXPECT_TRUE(s.lo >= 0 && Wide(s.lo) * s.lo <= x && x <= Wide(s.hi) * s.hi) << "root of " << to_text(x);
            }
            EXPECT_TRUE(a.contains(mid(a)));
            const double radius = rad(a);
            EXPECT_TRUE(Wide(radius) >= Wide(a.hi) - mid(a) && Wide(radius) >= Wide(mid(a)) - a.lo);
        }
    }
}

TEST(IntervalLaw, RoundingMovesByAboutOneUnit) {
    Random r(5);
    for (int n = 0; n < 10000; ++n) {
        const double x = any_double(r), low = rounding::down(x), high = rounding::up(x);
        if (x == 0) continue;  // exact
        EXPECT_LT(low, x);
        EXPECT_GT(high, x);
        if (std::abs(x) > 1e-290 && std::abs(x) < 1e308) {
            EXPECT_GE(low, std::nextafter(std::nextafter(x, -kInf), -kInf));
            EXPECT_LE(high, std::nextafter(std::nextafter(x, kInf), kInf));
        }
    }
}

TEST(IntervalLaw, ZeroStaysZeroAndSignsStay) {
    const Interval zero(0), wide(-3, 5), positive(0, 2);
    for (const Interval& z :
         {zero * wide, wide * zero, zero / Interval(2, 3), zero + zero, zero - zero, square(zero), sqrt(zero)})
        EXPECT_TRUE(z.lo == 0 && z.hi == 0);
    EXPECT_EQ((positive * positive).lo, 0);
    EXPECT_EQ((positive / Interval(1, 2)).lo, 0);
    EXPECT_EQ(square(wide).lo, 0);
    EXPECT_EQ((Interval(kDenormal) * Interval(kDenormal)).lo, 0);
    EXPECT_GT((Interval(kDenormal) * Interval(kDenormal)).hi, 0);
}

TEST(IntervalLaw, WhatHasNoBoundIsAll) {
    const auto is_all = [](const Interval& x) { return x.lo == -kInf && x.hi == kInf; };
    const Interval all = Interval::all(), one(1), across(-1, 2);
    EXPECT_FALSE(all.bounded());
    EXPECT_TRUE(one.bounded());
    for (const Interval& x : {one / across,
                              one / Interval(0),
                              one / Interval(0, 1),
                              one / Interval(-1, 0),
                              reciprocal(across),
                              reciprocal(Interval(0)),
                              Interval(0) / across,
                              Interval(kMax) + Interval(kMax),
                              Interval(kMax) * Interval(2),
                              Interval(1e300) / Interval(1e-300),
                              all + one,
                              one - all,
                              all * one,
                              all * Interval(0),
                              Interval(0) * all,
                              all / one,
                              one / all,
                              all * all,
                              sqrt(Interval(-2, -1)),
                              Interval(kInf) + one,
                              Interval(NAN) + one,
                              Interval(NAN) * one,
                              Interval(NAN) / one,
                              one / Interval(NAN),
                              Interval(kInf) * Interval(0),
                              Interval(kInf) - Interval(kInf),
                              -all})
        EXPECT_TRUE(is_all(x)) << "[" << x.lo << ", " << x.hi << "]";
    EXPECT_EQ((Interval(-kMax, kMax) - Interval(kMax)).lo, -kInf);  // the other end has a bound
    EXPECT_EQ(square(all).hi, kInf);
    EXPECT_FALSE(sqrt(all).bounded());
    EXPECT_TRUE(is_all(log(Interval(0, 1))));
    EXPECT_TRUE(is_all(pow(Interval(0, 1), -0.5)));
    EXPECT_FALSE(exp(Interval(0, 1000)).bounded());
    EXPECT_TRUE(sin(all).lo == -1 && sin(all).hi == 1 && cos(all).lo == -1 && cos(all).hi == 1);
}

TEST(IntervalLaw, ElementaryFunctionsEncloseTheirValues) {
    // Against long double, whose error is far below the margin on machines where it is wider than double.
    for (int seed = 1; seed <= 10; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        Random r(seed);
        for (int n = 0; n < 2000; ++n) {
            const double size = std::pow(10, r.number(-12, n % 5 ? 1.5 : 12)), a = r.number(-size, size),
                         w = r.integer(0, 2) * std::pow(10, r.number(-16, 1));
            const Interval t(a, a + w);
            const double x = inside(r, t);
            const auto holds = [&](const Interval& y, long double exact, const char* what) {
                EXPECT_TRUE(static_cast<long double>(y.lo) <= exact && exact <= static_cast<long double>(y.hi))
                    << what << " of " << to_text(x) << " is not in [" << to_text(y.lo) << ", " << to_text(y.hi) << "]";
            };
            holds(sin(t), std::sin(static_cast<long double>(x)), "sin");
            holds(cos(t), std::cos(static_cast<long double>(x)), "cos");
            if (x < 700) holds(exp(t), std::exp(static_cast<long double>(x)), "exp");
            if (x > 0) {
                holds(log(t), std::log(static_cast<long double>(x)), "log");
                for (double p : {0.5, 1.7, -0.3, 2.1})
                    holds(pow(t, p), std::pow(static_cast<long double>(x), static_cast<long double>(p)), "pow");
            }
        }
    }
}

TEST(IntervalLaw, TrigonometricExtremaAreInside) {
    for (int k = -20; k <= 20; ++k) {
        const double crest = (2 * k + 0.5) * M_PI, zero = 2 * k * M_PI;
        for (double w : {1e-17, 1e-9, 0.1, 2.0}) {
            EXPECT_EQ(sin(Interval(crest - w, crest + w)).hi, 1);
            EXPECT_EQ(cos(Interval(zero - w, zero + w)).hi, 1);
            EXPECT_EQ(cos(Interval(zero + M_PI - w, zero + M_PI + w)).lo, -1);
            EXPECT_EQ(sin(Interval(crest - M_PI - w, crest - M_PI + w)).lo, -1);
        }
        EXPECT_LT(sin(Interval(zero, zero + 1)).hi, 0.85);
        EXPECT_GT(cos(Interval(zero, zero + 1)).lo, 0.5);
    }
}

}  // namespace
}  // namespace isoparm
