// curve_doctor_parts.h -- what the files of curve_doctor share.
#pragma once
#include <numeric>

#include "curve_doctor.h"
#include "curves/modify.h"
#include "patches/compatibility.h"
#include "text/short_text.h"

namespace isoparm::doctor {


inline double tolerance_of(const Point& a, const Point& b, double size) { return compatibility_tolerance * size + rounding_of(a, b); }

/// "c1 from d0 reversed", empty when place and direction are as given.
inline std::string change_text(const std::string& place, const std::string& source, bool reversed, bool negated = false) {
    return place == source && !reversed && !negated ? "" : place + (place == source ? "" : " from " + source) + (reversed ? " reversed" : "") + (negated ? " negated" : "");
}
inline void append(std::string& list, const std::string& item) {
    if (!item.empty()) list += (list.empty() ? "" : ", ") + item;
}

inline int changes_of(const Repair& r) {
    int n = 0;
    for (std::size_t k = 0; k < r.order.size(); ++k) n += (r.order[k] != int(k)) + r.reversed[k];
    return n;
}
inline int reversals_of(const Repair& r) { return int(std::count(r.reversed.begin(), r.reversed.end(), true)); }

/// All orders and directions of n curves, orders growing, fewer and earlier reversals first.
template <class F> void for_each_repair(int n, F f) {
    Repair r{std::vector<int>(n), std::vector<bool>(n)};
    std::iota(r.order.begin(), r.order.end(), 0);
    do {
        for (int mask = 0; mask < 1 << n; ++mask) {
            for (int k = 0; k < n; ++k) r.reversed[k] = mask >> k & 1;
            f(r);
        }
    } while (std::next_permutation(r.order.begin(), r.order.end()));
}

/// Two ends of curves that must be one point: c0(1) = d1(0).
struct Joint {
    int a, end_a, b, end_b;
};
/// Curves whose ends must meet, and how many orders and directions describe the same surface.
struct Loop {
    std::vector<std::string> names;
    std::vector<Joint> joints;
    int symmetries;
    std::string whole;  // "the frame"
};
Diagnosis<Repair> diagnose_loop(const Loop& loop, const std::vector<Curve>& curves);
extern const std::vector<Joint> frame_joints;  // of x(u,0), x(u,1), x(0,v), x(1,v)

}  // namespace isoparm::doctor
