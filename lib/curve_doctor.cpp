#include "curve_doctor.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "curves/closest_approach.h"
#include "curves/curve_doctor_parts.h"

namespace isoparm {

std::vector<Curve> Repair::operator()(const std::vector<Curve>& given) const {
    std::vector<Curve> r;
    for (std::size_t k = 0; k < order.size(); ++k) r.push_back(reversed[k] ? isoparm::reversed(given[order[k]]) : given[order[k]]);
    return r;
}

namespace doctor {

const std::vector<Joint> frame_joints{{0, 0, 2, 0}, {0, 1, 3, 0}, {1, 0, 2, 1}, {1, 1, 3, 1}};

namespace {

/// Ends and size of a curve as given, and run backwards.
struct Ends {
    Point point[2];
    double size[2];  // as size_of measures it: from the first point
    explicit Ends(const Curve& c) : point{c(c.begin()), c(c.end())} {
        const Curve back = reversed(c);
        size[0] = size_of({&c}), size[1] = size_of({&back});
    }
    const Point& end(int which, bool backwards) const { return point[backwards ? 1 - which : which]; }
};

struct Fit {
    bool closes = true;
    int worst = 0;  // joint with the largest gap
    double gap = 0;
};

class LoopDoctor {
public:
    LoopDoctor(const Loop& loop, const std::vector<Curve>& curves) : loop_(loop), curves_(curves) {
        for (const Curve& c : curves) ends_.emplace_back(c);
    }

    Diagnosis<Repair> diagnose() const {
        const int n = int(curves_.size());
        Diagnosis<Repair> d;
        std::optional<Repair> nearest;
        std::tuple<int, int> cost, nearest_cost;
        double nearest_gap = INFINITY;
        int fitting = 0;
        for_each_repair(n, [&](const Repair& r) {
            for (int k = 0; k < n; ++k)
                if (r.reversed[k] && is_point(r.order[k])) return;  // the same
            const std::tuple<int, int> changes{changes_of(r), reversals_of(r)};
            const Fit fit = fit_of(r);
            if (changes == std::tuple{0, 0}) d.fits = fit.closes;
            if (fit.closes) {
                ++fitting;
                if (!d.repair || changes < cost) d.repair = r, cost = changes;
            }
            const double rounding = 1e-9 * nearest_gap;  // equal assignments of a symmetric loop
            if (!nearest || fit.gap < nearest_gap - rounding || (fit.gap <= nearest_gap + rounding && changes < nearest_cost))
                nearest = r, nearest_gap = std::min(nearest_gap, fit.gap), nearest_cost = changes;
        });
        if (d.fits) return {true, {}, {}, {}};
        d.misfit = open_joints();
        if (!d.repair) {
            d.misfit += advice(*nearest);
            return d;
        }
        d.changes = changes_text(*d.repair);
        if (const int others = fitting / loop_.symmetries - 1; others > 0)
            d.changes += " (" + std::to_string(others) + (others == 1 ? " other way fits too and spans another surface)" : " other ways fit too and span other surfaces)");
        return d;
    }

private:
    bool is_point(int curve) const { return ends_[curve].size[0] <= tolerance_of(ends_[curve].point[0], ends_[curve].point[0], 0); }

    Fit fit_of(const Repair& r) const {
        double size = 0;
        for (std::size_t k = 0; k < r.order.size(); ++k) size = std::max(size, ends_[r.order[k]].size[r.reversed[k]]);
        Fit fit;
        for (std::size_t j = 0; j < loop_.joints.size(); ++j) {
            const Joint& x = loop_.joints[j];
            const Point &a = ends_[r.order[x.a]].end(x.end_a, r.reversed[x.a]), &b = ends_[r.order[x.b]].end(x.end_b, r.reversed[x.b]);
            const double gap = distance(a, b);
            if (!(gap <= tolerance_of(a, b, size))) fit.closes = false;
            if (!(gap <= fit.gap)) fit.gap = gap, fit.worst = int(j);
        }
        return fit;
    }

    std::string changes_text(const Repair& r) const {
        std::string text;
        for (std::size_t k = 0; k < r.order.size(); ++k) append(text, change_text(loop_.names[k], loop_.names[r.order[k]], r.reversed[k]));
        return text;
    }
    std::string end_text(int curve, int end) const { return loop_.names[curve] + (end ? "(1)" : "(0)"); }

    std::string open_joints() const {
        std::string list;
        const double size = [&] {
            double s = 0;
            for (const Ends& e : ends_) s = std::max(s, e.size[0]);
            return s;
        }();
        for (const Joint& x : loop_.joints) {
            const Point &a = ends_[x.a].point[x.end_a], &b = ends_[x.b].point[x.end_b];
            if (const double gap = distance(a, b); !(gap <= tolerance_of(a, b, size))) append(list, end_text(x.a, x.end_a) + " and " + end_text(x.b, x.end_b) + " are " + short_text(gap) + " apart");
        }
        return list;
    }

    /// When no order and direction closes the loop: the best there is, the end nearest to its worst one, and whether the curves cross.
    std::string advice(const Repair& r) const {
        const Fit fit = fit_of(r);
        const Joint& x = loop_.joints[fit.worst];
        const int a = r.order[x.a], b = r.order[x.b], end_a = r.reversed[x.a] ? 1 - x.end_a : x.end_a, end_b = r.reversed[x.b] ? 1 - x.end_b : x.end_b;
        const std::string how = changes_text(r);
        std::string text = "; no order and direction of the curves closes " + loop_.whole + ": at best" + (how.empty() ? " (as given) " : " (" + how + ") ") + end_text(a, end_a) + " and " +
                           end_text(b, end_b) + " stay " + short_text(fit.gap) + " apart";
        const Point& p = ends_[a].point[end_a];
        int nearest = -1, nearest_end = 0;
        for (int k = 0; k < int(ends_.size()); ++k)
            for (int e = 0; e < 2; ++e)
                if (k != a && (nearest < 0 || distance(p, ends_[k].point[e]) < distance(p, ends_[nearest].point[nearest_end]))) nearest = k, nearest_end = e;
        text += "; the end nearest to " + end_text(a, end_a) + " is " + end_text(nearest, nearest_end) + ", " + short_text(distance(p, ends_[nearest].point[nearest_end])) + " away";
        const Approach meet = closest_approach(curves_[a], curves_[b]);
        if (meet.distance <= tolerance_of(p, p, std::max(ends_[a].size[0], ends_[b].size[0]))) {
            std::string cuts;
            const auto cut = [&](int curve, double t) {
                const double begin = curves_[curve].begin(), end = curves_[curve].end(), rounding = 1e-9 * (end - begin);
                if (t > begin + rounding && t < end - rounding) cuts += (cuts.empty() ? "cut " : " and ") + loop_.names[curve] + " at its parameter " + short_text(t);
            };
            cut(a, meet.s);
            cut(b, meet.t);
            text += "; " + loop_.names[a] + " and " + loop_.names[b] + " cross (sampled)" + (cuts.empty() ? "" : ": " + cuts);
        }
        return text;
    }

    const Loop& loop_;
    const std::vector<Curve>& curves_;
    std::vector<Ends> ends_;
};

}  // namespace

Diagnosis<Repair> diagnose_loop(const Loop& loop, const std::vector<Curve>& curves) { return LoopDoctor(loop, curves).diagnose(); }

}  // namespace doctor

Diagnosis<Repair> diagnose_frame(const CoonsCurves& c) {
    return doctor::diagnose_loop({{"c0", "c1", "d0", "d1"}, doctor::frame_joints, 8, "the frame"}, {c.c0, c.c1, c.d0, c.d1});
}
Diagnosis<Repair> diagnose_triangle(const std::array<Curve, 3>& edges) {
    return doctor::diagnose_loop({{"E1", "E2", "E3"}, {{0, 1, 1, 0}, {1, 1, 2, 0}, {2, 1, 0, 0}}, 6, "the triangle"}, {edges[0], edges[1], edges[2]});
}
Diagnosis<Repair> diagnose_common_start(const Curve& c, const Curve& d) {
    return doctor::diagnose_loop({{"c", "d"}, {{0, 0, 1, 0}}, 2, "the start"}, {c, d});
}

}  // namespace isoparm
