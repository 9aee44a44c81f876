#include "network_fit.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "curves/closest_approach.h"
#include "curves/composed.h"
#include "curves/curve_doctor_parts.h"

namespace isoparm {
namespace {

using doctor::append;

constexpr double kAtAnEnd = 1e-10;   // of the domain: a crossing so near to an end is there
constexpr double kAtTheSeam = 1e-7;  // of a closed curve's size, or as far as the curves miss each other there: a crossing so near to its seam is at the seam

struct Family {
    std::string name;
    std::vector<Curve> curves;
    std::vector<int> order;      // place k takes the curve given as order[k]
    std::vector<bool> reversed;  // of the curve in place k
    bool closed(std::size_t k) const { return distance(curves[k](curves[k].begin()), curves[k](curves[k].end())) <= compatibility_tolerance * size_of({&curves[k]}); }
    std::string text(std::size_t k) const { return name + "[" + std::to_string(k) + "]"; }
};

/// Parameters of the crossings: at[k][l] on curve k, with curve l of the other family.
using Parameters = std::vector<std::vector<double>>;

std::string point_text(const Point& p) {
    std::string text = "(";
    for (int k = 0; k < 3; ++k) text += (k > 0 ? ", " : "") + short_text(p[k]);
    return text + ")";
}

std::vector<int> sorted_by(const std::vector<double>& t) {
    std::vector<int> order(t.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return t[std::size_t(a)] < t[std::size_t(b)]; });
    return order;
}

/// A crossing at the seam of a closed curve is at its begin and at its end: the first of two takes the begin, the second the end; a lone one too takes the
/// begin. Crossings next to an end of another are put there. `gaps`: as `at`.
void settle_ends(const Family& family, Parameters& at, const Parameters& gaps) {
    for (std::size_t k = 0; k < at.size(); ++k) {
        const Curve& c = family.curves[k];
        const double begin = c.begin(), end = c.end(), near = kAtAnEnd * (end - begin), size = size_of({&c});
        const bool closed = family.closed(k);
        int at_seam = 0;
        for (std::size_t l = 0; l < at[k].size(); ++l) {
            double& t = at[k][l];
            if (closed && distance(c(t), c(begin)) <= std::max(kAtTheSeam * size, gaps[k][l])) t = at_seam++ == 0 ? begin : end;
            else if (t <= begin + near || t >= end - near) t = t <= begin + near ? begin : end;
        }
    }
}

/// The order of the other family's curves along every curve of this one, which must be one order or its reverse.
void find_order(Family& family, Family& others, const Parameters& at) {
    others.order = sorted_by(at[0]);
    const auto backwards = std::vector<int>(others.order.rbegin(), others.order.rend());
    for (std::size_t k = 0; k < at.size(); ++k) {
        const auto order = sorted_by(at[k]);
        for (std::size_t l = 0; l + 1 < order.size(); ++l) {
            const auto a = std::size_t(order[l]), b = std::size_t(order[l + 1]);
            if (at[k][b] - at[k][a] <= kAtAnEnd * (family.curves[k].end() - family.curves[k].begin()))
                throw_input("found " + others.text(a) + " and " + others.text(b) + " at one point of " + family.text(k) + ", " + point_text(family.curves[k](at[k][a])) + ", expected curves that cross it at different points");
        }
        if (order != others.order && order != backwards)
            throw_input("found " + others.name + " in another order along " + family.text(k) + " than along " + family.text(0) + " (by the places of closest approach), expected one order: the curves are no network of a rectangle");
        family.reversed.push_back(order != others.order);
    }
}

/// Curves and parameters in their new places and directions.
void rearrange(Family& family, const Family& others, Parameters& at) {
    Family given = family;
    const Parameters before = at;
    for (std::size_t k = 0; k < family.order.size(); ++k) {
        const auto from = std::size_t(family.order[k]);
        const Curve& c = given.curves[from];
        family.reversed[k] = given.reversed[from];
        family.curves[k] = given.reversed[from] ? reversed(c) : c;
        for (std::size_t l = 0; l < at[k].size(); ++l) {
            const double t = before[from][std::size_t(others.order[l])];
            at[k][l] = given.reversed[from] ? c.begin() + (c.end() - t) : t;
        }
    }
}

/// Means of where the crossings are between the first and the last, over [0,1].
std::vector<double> nodes_of(const Parameters& at) {
    std::vector<double> nodes(at[0].size());
    for (const auto& t : at)
        for (std::size_t l = 0; l < t.size(); ++l) nodes[l] += (t[l] - t.front()) / (t.back() - t.front()) / double(at.size());
    nodes.front() = 0, nodes.back() = 1;
    return nodes;
}

/// How far curves are cut and how far their crossings move, as fractions of their domains.
struct Change {
    double cut = 0, moved = 0;
};

std::vector<Curve> run_to_nodes(const Family& family, const Parameters& at, const std::vector<double>& nodes, Change& change) {
    std::vector<Curve> list;
    for (std::size_t k = 0; k < family.curves.size(); ++k) {
        const Curve& c = family.curves[k];
        const auto& t = at[k];
        double moved = 0;
        for (std::size_t l = 0; l < t.size(); ++l) moved = std::max(moved, std::fabs((t[l] - t.front()) / (t.back() - t.front()) - nodes[l]));
        change.cut = std::max(change.cut, 1 - (t.back() - t.front()) / (c.end() - c.begin()));
        change.moved = std::max(change.moved, moved);
        if (moved > kAtAnEnd) {
            try {
                list.push_back(run_by_monotone_cubic(c, nodes, t));
            } catch (const Error& e) {
                throw Error(e.kind(), family.text(std::size_t(family.order[k])) + ": " + e.what());
            }
        } else {
            const Curve part = t.front() > c.begin() || t.back() < c.end() ? segment(c, t.front(), t.back(), false) : c;
            list.push_back(reparametrized(part, 0, 1));
        }
    }
    return list;
}

std::string changes_of(const Family& family) {
    std::string text;
    for (std::size_t k = 0; k < family.order.size(); ++k) append(text, doctor::change_text(family.text(k), family.text(std::size_t(family.order[k])), family.reversed[k]));
    return text;
}
std::string percent(double x) { return short_text(100 * x) + " %"; }

}  // namespace

NetworkFit fit_network(const std::vector<Curve>& u_curves, const std::vector<Curve>& v_curves) {
    if (u_curves.size() < 2 || v_curves.size() < 2) throw_input("found " + std::to_string(u_curves.size()) + " u_curves and " + std::to_string(v_curves.size()) + " v_curves, expected two of each at least");
    Family u{"u_curves", u_curves, {}, {}}, v{"v_curves", v_curves, {}, {}};
    const std::size_t n = u_curves.size(), m = v_curves.size();
    Parameters on_u(n, std::vector<double>(m)), on_v(m, std::vector<double>(n)), gaps_u = on_u, gaps_v = on_v;
    tbb::parallel_for(std::size_t(0), n * m, [&](std::size_t pair) {
        const std::size_t j = pair / m, i = pair % m;
        const Approach x = closest_approach(u.curves[j], v.curves[i]);
        on_u[j][i] = x.s, on_v[i][j] = x.t;
        gaps_u[j][i] = gaps_v[i][j] = x.distance;
    });
    settle_ends(u, on_u, gaps_u), settle_ends(v, on_v, gaps_v);
    find_order(u, v, on_u), find_order(v, u, on_v);
    rearrange(u, v, on_u), rearrange(v, u, on_v);

    NetworkFit fit;
    Change change;
    const auto u_nodes = nodes_of(on_u), v_nodes = nodes_of(on_v);
    auto along_u = run_to_nodes(u, on_u, u_nodes, change), along_v = run_to_nodes(v, on_v, v_nodes, change);
    fit.size = std::max(size_of({&along_u.front(), &along_u.back()}), size_of({&along_v.front(), &along_v.back()}));  // as make_gordon() compares
    double widest = -1;
    for (std::size_t j = 0; j < n; ++j)
        for (std::size_t i = 0; i < m; ++i) {
            const Point a = u.curves[j](on_u[j][i]), b = v.curves[i](on_v[i][j]);
            const double gap = distance(a, b);
            fit.open += !(gap <= doctor::tolerance_of(a, b, fit.size));
            if (!(gap > widest)) continue;
            widest = fit.gap = gap;
            fit.where = u.text(std::size_t(u.order[j])) + " and " + v.text(std::size_t(v.order[i])) + ", near " + point_text(0.5 * (a + b));
        }
    append(fit.changes, changes_of(u));
    append(fit.changes, changes_of(v));
    if (change.cut > kAtAnEnd) append(fit.changes, "cut at the first and last crossing by up to " + percent(change.cut) + " of their parameters");
    if (change.moved > kAtAnEnd) append(fit.changes, "run at another speed, so that crossings move by up to " + percent(change.moved));
    fit.network = {std::move(along_u), v_nodes, std::move(along_v), u_nodes};
    return fit;
}

}  // namespace isoparm
