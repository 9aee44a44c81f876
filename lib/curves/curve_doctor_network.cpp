#include <tuple>

#include "curves/closest_approach.h"
#include "curves/curve_doctor_parts.h"
#include "patches/gordon.h"

namespace isoparm {
namespace {

using doctor::append;

/// Beyond so many crossings no repair is looked for, and after so many comparisons the search is given up.
constexpr std::size_t kMostCrossings = 100000;
constexpr long kMostSteps = 2000000;
constexpr const char* kTooMany = "; there are too many curves to try every order and direction";
constexpr int kMostChangesTold = 12;

/// Points of every curve at the nodes, in both directions: candidate 2 k + r is curve k, reversed when r is 1.
struct Family {
    std::vector<Curve> curves;
    std::vector<std::vector<Point>> at;
    Family(const std::vector<double>& nodes, const std::vector<Curve>& given) : curves(run_over_nodes(given, nodes)) {
        for (const Curve& c : curves)
            for (const Curve& run : {c, reversed(c)}) {
                at.emplace_back();
                for (double t : nodes) at.back().push_back(run(std::clamp(t, run.begin(), run.end())));
            }
    }
    int places() const { return int(curves.size()); }
    double size(int candidate) const {
        const Curve c = candidate % 2 ? reversed(curves[candidate / 2]) : curves[candidate / 2];
        return size_of({&c});
    }
};

/// Places filled in turn, v and u by turns, each with a curve that meets those that stand; the cheapest whole wins.
class NetworkSearch {
public:
    NetworkSearch(const Family& u, const Family& v, double size, bool strict)
        : u_(u), v_(v), size_(size), strict_(strict), place_u_(u.places(), -1), place_v_(v.places(), -1) {}

    std::optional<NetworkRepair> best() {
        fill(0, {0, 0});
        return best_;
    }
    bool gave_up() const { return steps_ > kMostSteps; }

private:
    using Cost = std::tuple<int, int>;  // changes, reversals

    void fill(int filled, const Cost& cost) {
        if (steps_ > kMostSteps || (best_ && !(cost < best_cost_))) return;
        const int n = u_.places(), m = v_.places();
        if (filled == n + m) {
            if (strict_ && !fits()) return;
            best_ = NetworkRepair{false, repair_of(place_u_), repair_of(place_v_)};
            best_cost_ = cost;
            return;
        }
        const int both = 2 * std::min(n, m);
        const bool along_v = filled < both ? filled % 2 == 0 : m > n;
        const int place = filled < both ? filled / 2 : filled - std::min(n, m);
        auto& places = along_v ? place_v_ : place_u_;
        const int count = along_v ? m : n;
        std::vector<bool> taken(count);
        for (int k = 0; k < place; ++k) taken[places[k] / 2] = true;
        // The curve that stands here first, then the others in order: the first whole found is cheap, and the search is short.
        for (int k = -1; k < count; ++k)
            for (int r = 0; r < 2; ++r) {
                const int curve = k < 0 ? place : k;
                if ((k == place) || taken[curve] || !meets(along_v, place, 2 * curve + r)) continue;
                places[place] = 2 * curve + r;
                fill(filled + 1, {std::get<0>(cost) + (curve != place) + r, std::get<1>(cost) + r});
                places[place] = -1;
            }
    }
    bool meets(bool along_v, int place, int candidate) {
        const auto& mine = along_v ? v_ : u_;
        const auto& others = along_v ? u_ : v_;
        const auto& standing = along_v ? place_u_ : place_v_;
        for (std::size_t k = 0; k < standing.size() && standing[k] >= 0; ++k) {
            ++steps_;
            const Point &a = mine.at[candidate][k], &b = others.at[standing[k]][place];
            if (!(distance(a, b) <= doctor::tolerance_of(a, b, size_))) return false;
        }
        return true;
    }
    /// As make_network and make_gordon compare: by the size of the outermost curves.
    bool fits() const {
        const double size = std::max({u_.size(place_u_.front()), u_.size(place_u_.back()), v_.size(place_v_.front()), v_.size(place_v_.back())});
        for (int i = 0; i < v_.places(); ++i)
            for (int j = 0; j < u_.places(); ++j) {
                const Point &a = v_.at[place_v_[i]][j], &b = u_.at[place_u_[j]][i];
                if (!(distance(a, b) <= doctor::tolerance_of(a, b, size))) return false;
            }
        return true;
    }
    static Repair repair_of(const std::vector<int>& places) {
        Repair r;
        for (int c : places) r.order.push_back(c / 2), r.reversed.push_back(c % 2);
        return r;
    }

    const Family &u_, &v_;
    double size_;
    bool strict_;
    std::vector<int> place_u_, place_v_;
    std::optional<NetworkRepair> best_;
    Cost best_cost_;
    long steps_ = 0;
};

class NetworkDoctor {
public:
    explicit NetworkDoctor(const CurveNetwork& n) : n_(n) {}

    Diagnosis<NetworkRepair> diagnose() const {
        Diagnosis<NetworkRepair> d;
        const std::size_t u = n_.u_curves.size(), v = n_.v_curves.size();
        const bool as_given = u == n_.v_nodes.size() && v == n_.u_nodes.size(), exchanged = v == n_.v_nodes.size() && u == n_.u_nodes.size();
        if (std::min(u, v) < 2 || !(as_given || exchanged)) return d;
        std::string advice;
        if (as_given) {
            const Family fu(n_.u_nodes, n_.u_curves), fv(n_.v_nodes, n_.v_curves);
            advice = look(fu, fv, d);
            if (d.fits) return d;
        } else {
            d.misfit = std::to_string(u) + " curves " + n_.u_name + " stand for " + std::to_string(n_.v_nodes.size()) + " nodes";
        }
        if (exchanged && !d.repair && u * v <= kMostCrossings) {
            const Family fu(n_.u_nodes, n_.v_curves), fv(n_.v_nodes, n_.u_curves);
            d.repair = NetworkSearch(fu, fv, size_of_all(fu, fv), true).best();
            if (d.repair) d.repair->swapped = true;
        }
        if (d.repair) d.changes = changes_text(*d.repair);
        else d.misfit += advice;
        return d;
    }

private:
    /// The families as they stand. Answers with what comes nearest to a repair when there is none.
    std::string look(const Family& u, const Family& v, Diagnosis<NetworkRepair>& d) const {
        const double outermost = std::max({u.size(0), u.size(2 * u.places() - 2), v.size(0), v.size(2 * v.places() - 2)});
        std::vector<std::array<int, 2>> open;
        double widest = -1;
        std::string which;
        for (int i = 0; i < v.places(); ++i)
            for (int j = 0; j < u.places(); ++j) {
                const Point &a = v.at[2 * i][j], &b = u.at[2 * j][i];
                const double gap = distance(a, b);
                if (!(gap <= doctor::tolerance_of(a, b, outermost))) open.push_back({j, i});
                if (gap > widest) widest = gap, which = u_text(j) + " and " + v_text(i);
            }
        d.fits = open.empty();
        if (d.fits) return "";
        std::string advice;
        const std::size_t crossings = std::size_t(u.places()) * std::size_t(v.places());
        d.misfit = std::to_string(open.size()) + " of " + std::to_string(crossings) + " crossings are open, widest " + which + ", " + short_text(widest) + " apart";
        if (crossings > kMostCrossings) {
            advice = kTooMany;
        } else {
            const double size = size_of_all(u, v);
            NetworkSearch search(u, v, size, true);
            d.repair = search.best();
            if (d.repair) return "";
            advice = search.gave_up() ? kTooMany : "; no order and direction of the curves closes them";
            for (double loose : {1e3, 1e6, 1e7})  // 1e-6, 1e-3, 1e-2 of the size: the order that was meant
                if (const auto near = NetworkSearch(u, v, loose * size, false).best()) {
                    advice += nearly(u, v, *near);
                    break;
                }
        }
        constexpr std::size_t kTold = 3;
        for (std::size_t k = 0; k < std::min(kTold, open.size()); ++k) advice += "; " + meeting(u, v, open[k][0], open[k][1], outermost);
        if (open.size() > kTold) advice += "; and " + std::to_string(open.size() - kTold) + " more";
        return advice;
    }
    static double size_of_all(const Family& u, const Family& v) {
        double size = 0;
        for (const Family* f : {&u, &v})
            for (int k = 0; k < 2 * f->places(); ++k) size = std::max(size, f->size(k));
        return size;
    }
    std::string u_text(int j) const { return n_.u_name + "[" + std::to_string(j) + "]"; }
    std::string v_text(int i) const { return n_.v_name + "[" + std::to_string(i) + "]"; }

    std::string nearly(const Family& u, const Family& v, const NetworkRepair& r) const {
        double gap = -1;
        int worst_i = 0, worst_j = 0;
        for (int i = 0; i < v.places(); ++i)
            for (int j = 0; j < u.places(); ++j) {
                const double x = distance(v.at[2 * r.v.order[i] + r.v.reversed[i]][j], u.at[2 * r.u.order[j] + r.u.reversed[j]][i]);
                if (x > gap) gap = x, worst_i = r.v.order[i], worst_j = r.u.order[j];
            }
        const std::string changes = changes_text(r);
        return std::string(changes.empty() ? ": as given" : ": with " + changes) + " they come near, " + u_text(worst_j) + " and " + v_text(worst_i) + " staying " + short_text(gap) + " apart";
    }
    /// Where two curves that miss each other at their nodes really meet.
    std::string meeting(const Family& u, const Family& v, int j, int i, double size) const {
        const Approach x = closest_approach(u.curves[j], v.curves[i]);
        const Point p = u.curves[j](x.s);
        const std::string where = "u = " + short_text(x.s) + ", v = " + short_text(x.t), node = "u = " + short_text(n_.u_nodes[i]) + ", v = " + short_text(n_.v_nodes[j]);
        if (!(x.distance <= doctor::tolerance_of(p, p, size)))
            return u_text(j) + " and " + v_text(i) + " do not meet (sampled): they come no nearer than " + short_text(x.distance) + ", at " + where + ", the node being " + node;
        return u_text(j) + " meets " + v_text(i) + " (distance " + short_text(x.distance) + ", sampled) at " + where + ", but the node is " + node + ": reparametrise " +
               (n_.nodes_are_given ? "it or move the node" : "it");
    }
    std::string changes_text(const NetworkRepair& r) const {
        std::string text;
        int count = 0;
        const auto list = [&](const Repair& f, bool along_u) {
            for (std::size_t k = 0; k < f.order.size(); ++k) {
                const auto name = [&](bool u, int index) { return u ? u_text(index) : v_text(index); };
                const std::string change = doctor::change_text(name(along_u, int(k)), name(along_u != r.swapped, f.order[k]), f.reversed[k]);
                if (!change.empty() && ++count <= kMostChangesTold) append(text, change);
            }
        };
        list(r.u, true);
        list(r.v, false);
        if (count > kMostChangesTold) append(text, "and " + std::to_string(count - kMostChangesTold) + " more");
        return text;
    }

    const CurveNetwork& n_;
};

}  // namespace

Diagnosis<NetworkRepair> diagnose_network(const CurveNetwork& network) { return NetworkDoctor(network).diagnose(); }

}  // namespace isoparm
