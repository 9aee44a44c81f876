#include "patches/generalized_coons.h"

#include "patches/compatibility.h"
#include "patches/edge_scalar.h"

namespace isoparm {
namespace {

constexpr double kTolerance = 1e-9;

template <class F> auto apply(const Functional& l, const F& f) {
    using Value = decltype(f(0.0));
    Value a[2];
    f.taylor(l.at, l.kind == Functional::Kind::value ? 0 : 1, a);
    return l.kind == Functional::Kind::value ? a[0] : a[1];
}

std::string name(const char* family, std::size_t k) { return std::string(family) + "[" + std::to_string(k) + "]"; }

/// L_i(H_k) = 1 when i = k, else 0.
void require_biorthogonal(const std::string& direction, const std::vector<Functional>& functionals, const std::vector<Function>& blends) {
    for (std::size_t i = 0; i < functionals.size(); ++i)
        for (std::size_t k = 0; k < blends.size(); ++k) {
            const double expected = i == k ? 1 : 0, found = apply(functionals[i], blends[k]), gap = std::abs(found - expected);
            if (!(gap <= kTolerance))
                throw IncompatibleError(direction + ": functional " + std::to_string(i) + " of blend " + std::to_string(k) + " = " + to_text(expected) + " (found " +
                                            to_text(found) + ")",
                                        gap, kTolerance);
        }
}

/// Where the sum of the blends of values is farthest from 1, of all places where that is not proved to be within kTolerance.
struct Sum {
    double at = 0, gap = 0;
};
Sum worst_sum(const std::vector<Functional>& functionals, const std::vector<Function>& blends, const Interval& t, int depth = 0) {
    const double c = mid(t);
    Interval at[4]{Interval(-1)}, over[4];
    for (std::size_t i = 0; i < blends.size(); ++i) {
        if (functionals[i].kind != Functional::Kind::value) continue;
        Interval a[4];
        blends[i].taylor(Interval(c), 3, a);
        for (int k = 0; k < 4; ++k) at[k] = at[k] + a[k];
        blends[i].taylor(t, 3, a);
        for (int k = 0; k < 4; ++k) over[k] = over[k] + a[k];
    }
    const double gap = std::max(std::abs(at[0].lo), std::abs(at[0].hi));
    if (!(gap <= kTolerance)) return {c, gap};
    const Interval h = t - Interval(c);
    const Interval sum = at[0] + h * (at[1] + h * (at[2] + h * over[3]));
    constexpr int most = 12;  // where third derivatives jump or are unbounded no depth proves it: then samples decide
    if (std::max(std::abs(sum.lo), std::abs(sum.hi)) <= kTolerance || depth == most) return {c, 0};
    const Sum left = worst_sum(functionals, blends, {t.lo, c}, depth + 1), right = worst_sum(functionals, blends, {c, t.hi}, depth + 1);
    return left.gap >= right.gap ? left : right;
}

void require_sizes(const char* direction, std::size_t functionals, std::size_t blends, const char* curves, std::size_t data) {
    if (functionals == 0 || functionals != blends || functionals != data)
        throw_input(std::string(direction) + ": found " + std::to_string(functionals) + " functionals, " + std::to_string(blends) + " blends and " +
                    std::to_string(data) + " curves " + curves + ", expected the same number of each");
}

/// All over the domain of the first.
void require_domain(const char* family, const std::vector<Curve>& curves) {
    for (std::size_t k = 1; k < curves.size(); ++k)
        if (curves[k].begin() != curves[0].begin() || curves[k].end() != curves[0].end())
            throw_input(name(family, k) + ": found the domain [" + to_text(curves[k].begin()) + ", " + to_text(curves[k].end()) + "], expected [" +
                        to_text(curves[0].begin()) + ", " + to_text(curves[0].end()) + "] as for " + name(family, 0));
}

/// Sorted places of functionals strictly inside the domain, each once.
std::vector<double> nodes_inside(const std::string& direction, const std::vector<Functional>& functionals, double begin, double end) {
    std::vector<double> list;
    for (std::size_t i = 0; i < functionals.size(); ++i) {
        const double at = functionals[i].at;
        if (!(begin <= at && at <= end))
            throw_input(direction + ": functional " + std::to_string(i) + ": found " + to_text(at) + ", expected a parameter in the domain [" + to_text(begin) + ", " + to_text(end) +
                        "] of the curves");
        if (begin < at && at < end) list.push_back(at);
    }
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
    return list;
}

}  // namespace

Patch make_generalized_coons(const GeneralizedCoons& data, Part part) {
    const auto &f = data.f, &g = data.g;
    require_sizes("u", data.u.size(), data.blend_u.size(), "f", f.size());
    require_sizes("v", data.v.size(), data.blend_v.size(), "g", g.size());
    require_domain("f", f);
    require_domain("g", g);
    const Rect rect{g[0].begin(), g[0].end(), f[0].begin(), f[0].end()};
    const FunctionBasis basis_u{data.blend_u, nodes_inside("u", data.u, rect.u0, rect.u1)}, basis_v{data.blend_v, nodes_inside("v", data.v, rect.v0, rect.v1)};
    require_biorthogonal("u", data.u, data.blend_u);
    require_biorthogonal("v", data.v, data.blend_v);
    const Sum u = worst_sum(data.u, data.blend_u, {rect.u0, rect.u1}), v = worst_sum(data.v, data.blend_v, {rect.v0, rect.v1});
    if (u.gap > 0 && v.gap > 0)
        throw IncompatibleError("partition of unity: the blends of values sum to 1, in u or in v (in u they miss it by " + to_text(u.gap) + " at " + to_text(u.at) +
                                    ", in v by " + to_text(v.gap) + " at " + to_text(v.at) + "), so that the surface moves with its curves",
                                std::min(u.gap, v.gap), kTolerance);

    double size = 0;
    for (const auto* list : {&f, &g})
        for (const Curve& c : *list) size = std::max({size, size_of({&c}), distance(c(c.begin()), (*list)[0]((*list)[0].begin()))});
    Grid<Point> corner(f.size(), std::vector<Point>(g.size()));
    for (std::size_t i = 0; i < f.size(); ++i)
        for (std::size_t j = 0; j < g.size(); ++j) {
            corner[i][j] = apply(data.u[i], g[j]);
            require_equal("u functional " + std::to_string(i) + " of " + name("g", j) + " = v functional " + std::to_string(j) + " of " + name("f", i), corner[i][j],
                          apply(data.v[j], f[i]), size);
        }
    return make_patch_with_edges(BooleanSum<FunctionBasis>{basis_u, basis_v, f, g, corner, part, rect});
}

}  // namespace isoparm
