// scalar/interval.h -- closed intervals of doubles, rounded outward.
//
// Every operation encloses the exact result for all points of its operands. Nothing touches the rounding mode: results
// are computed to nearest and moved outward by one unit in the last place with the branch-free predecessor and
// successor of Rump, Zimmermann, Boldo and Melquiond (BIT 49, 2009). Where a result may not exist or is not bounded
// (division by an interval that holds 0, infinite operands), the answer is all(): every real number. So a bound that
// cannot be proved shows itself as infinite, never as a number that is too small.
#pragma once
#include <algorithm>
#include <cmath>
#include <limits>

namespace isoparm {

namespace rounding {
inline constexpr double kUnit = 0x1p-53 * (1 + 0x1p-52);
inline constexpr double kTiny = std::numeric_limits<double>::min();
inline double down(double x) { return x == 0 ? 0 : x - (std::fabs(x) * kUnit + kTiny); }
inline double up(double x) { return x == 0 ? 0 : x + (std::fabs(x) * kUnit + kTiny); }
/// At least a * b; up(a * b) is not where the product underflows to 0.
inline double product_up(double a, double b) {
    const double p = a * b;
    return p == 0 && a != 0 && b != 0 ? kTiny : up(p);
}
/// At least sqrt(x^2 + y^2 + z^2), for x, y, z >= 0; NaN stays NaN. The sum is a bound too, where squares underflow.
inline double length_up(double x, double y, double z) {
    const double squares = up(up(up(x * x) + up(y * y)) + up(z * z));
    return squares < 1e-280 ? up(up(x + y) + z) : up(std::sqrt(squares));
}
}  // namespace rounding

struct Interval {
    double lo = 0, hi = 0;

    constexpr Interval() = default;
    constexpr Interval(double x) : lo(x), hi(x) {}  // NOLINT: a number is a point interval
    constexpr Interval(double low, double high) : lo(low), hi(high) {}

    static constexpr Interval all() {
        return {-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
    }
    bool contains(double x) const { return lo <= x && x <= hi; }
    bool bounded() const { return lo > -std::numeric_limits<double>::infinity() && hi < std::numeric_limits<double>::infinity(); }
};

/// The largest absolute value.
inline double mag(const Interval& a) { return std::max(std::fabs(a.lo), std::fabs(a.hi)); }
/// A double inside, near the middle.
inline double mid(const Interval& a) { return std::clamp(0.5 * a.lo + 0.5 * a.hi, a.lo, a.hi); }
/// At least the distance from mid(a) to either end.
inline double rad(const Interval& a) {
    const double m = mid(a);
    return rounding::up(std::max(a.hi - m, m - a.lo));
}
inline Interval hull(const Interval& a, const Interval& b) { return {std::min(a.lo, b.lo), std::max(a.hi, b.hi)}; }

/// Results that are no interval of finite numbers become all().
inline Interval checked(double lo, double hi) {
    if (lo >= -std::numeric_limits<double>::max() && hi <= std::numeric_limits<double>::max() && lo <= hi) return {lo, hi};
    return Interval::all();
}

inline Interval operator-(const Interval& a) { return {-a.hi, -a.lo}; }
// A sum in the subnormal range is exact and a sum that is 0 is exact, so down(0) = 0 is right here. Beyond the largest
// number an outer end becomes infinite, which is right, and an inner one NaN, which fails the comparison.
inline Interval operator+(const Interval& a, const Interval& b) {
    const double lo = rounding::down(a.lo + b.lo), hi = rounding::up(a.hi + b.hi);
    return lo <= hi ? Interval(lo, hi) : Interval::all();
}
inline Interval operator-(const Interval& a, const Interval& b) { return a + (-b); }

namespace interval_detail {
/// Products with a factor that is 0 or not bounded, or that leave the range of doubles.
inline Interval product_with_care(const Interval& a, const Interval& b) {
    using namespace rounding;
    if ((a.lo == 0 && a.hi == 0 && b.bounded()) || (b.lo == 0 && b.hi == 0 && a.bounded())) return {0, 0};
    const double p = a.lo * b.lo, q = a.lo * b.hi, r = a.hi * b.lo, s = a.hi * b.hi;
    double lo = std::min(std::min(p, q), std::min(r, s)), hi = std::max(std::max(p, q), std::max(r, s));
    if (!(p - p == 0 && q - q == 0 && r - r == 0 && s - s == 0)) return Interval::all();
    // A product that underflowed to 0 may have either sign; factors that do not change sign keep theirs.
    const bool same = (a.lo >= 0 && b.lo >= 0) || (a.hi <= 0 && b.hi <= 0);
    const bool opposite = (a.lo >= 0 && b.hi <= 0) || (a.hi <= 0 && b.lo >= 0);
    lo = lo == 0 ? (same ? 0 : -kTiny) : down(lo);
    hi = hi == 0 ? (opposite ? 0 : kTiny) : up(hi);
    return checked(lo, hi);
}
}  // namespace interval_detail

inline Interval operator*(const Interval& a, const Interval& b) {
    const double p = a.lo * b.lo, q = a.lo * b.hi, r = a.hi * b.lo, s = a.hi * b.hi;
    const double lo = std::min(std::min(p, q), std::min(r, s)), hi = std::max(std::max(p, q), std::max(r, s));
    const double sum = (p + q) + (r + s);  // finite only if all products are
    if (lo == 0 || hi == 0 || !(sum - sum == 0)) return interval_detail::product_with_care(a, b);
    return {rounding::down(lo), rounding::up(hi)};
}
inline Interval reciprocal(const Interval& b) {
    if (b.lo <= 0 && b.hi >= 0) return Interval::all();
    const double lo = 1 / b.hi, hi = 1 / b.lo;
    return checked(lo == 0 ? (b.lo > 0 ? 0 : -rounding::kTiny) : rounding::down(lo),
                   hi == 0 ? (b.hi < 0 ? 0 : rounding::kTiny) : rounding::up(hi));
}
inline Interval operator/(const Interval& a, const Interval& b) {
    using namespace rounding;
    if (!(b.lo > 0 || b.hi < 0)) return Interval::all();
    if (a.lo == 0 && a.hi == 0) return {0, 0};
    const double p = a.lo / b.lo, q = a.lo / b.hi, r = a.hi / b.lo, s = a.hi / b.hi;
    double lo = std::min(std::min(p, q), std::min(r, s)), hi = std::max(std::max(p, q), std::max(r, s));
    if (!(p - p == 0 && q - q == 0 && r - r == 0 && s - s == 0)) return Interval::all();
    const bool same = (a.lo >= 0 && b.lo > 0) || (a.hi <= 0 && b.hi < 0);
    const bool opposite = (a.lo >= 0 && b.hi < 0) || (a.hi <= 0 && b.lo > 0);
    lo = lo == 0 ? (same ? 0 : -kTiny) : down(lo);
    hi = hi == 0 ? (opposite ? 0 : kTiny) : up(hi);
    return checked(lo, hi);
}
inline Interval& operator+=(Interval& a, const Interval& b) { return a = a + b; }
inline Interval& operator-=(Interval& a, const Interval& b) { return a = a - b; }
inline Interval& operator*=(Interval& a, const Interval& b) { return a = a * b; }

inline Interval square(const Interval& a) {
    const Interval s = a * a;
    return {s.lo > 0 && (a.lo > 0 || a.hi < 0) ? s.lo : (a.lo <= 0 && a.hi >= 0 ? 0 : std::max(s.lo, 0.0)), s.hi};
}
/// Square root of the part of a that is not negative (sqrt is correctly rounded, so one step outward is enough).
inline Interval sqrt(const Interval& a) {
    if (a.hi < 0) return Interval::all();
    return checked(a.lo <= 0 ? 0 : rounding::down(std::sqrt(a.lo)), rounding::up(std::sqrt(a.hi)));
}
inline Interval abs(const Interval& a) {
    if (a.lo >= 0) return a;
    if (a.hi <= 0) return -a;
    return {0, mag(a)};
}
inline Interval min(const Interval& a, const Interval& b) { return {std::min(a.lo, b.lo), std::min(a.hi, b.hi)}; }
inline Interval max(const Interval& a, const Interval& b) { return {std::max(a.lo, b.lo), std::max(a.hi, b.hi)}; }
/// What both enclosures of the same number leave; a alone should rounding have parted them.
inline Interval intersection(const Interval& a, const Interval& b) {
    const Interval c(std::max(a.lo, b.lo), std::min(a.hi, b.hi));
    return c.lo <= c.hi ? c : a;
}
/// The common part; where there is none by rounding, the nearest point of b.
inline Interval clip(const Interval& a, const Interval& b) {
    return {std::clamp(a.lo, b.lo, b.hi), std::clamp(a.hi, b.lo, b.hi)};
}

}  // namespace isoparm
