#include "dice.h"

#include <algorithm>
#include <cmath>

namespace isoparm {
namespace {

constexpr int kSamples = Bends::samples;
constexpr double kUse = 0.9;          // of the tolerance: the rest is left to third derivatives and to neighbours
constexpr double kBisected = 2.2;     // what a triangle above the tolerance costs: bisection overshoots
constexpr double kStep = 1.19;        // between the numbers of lines that are tried

/// Error of a triangle whose edges bend by a, b, c.
double error_of(const Point& a, const Point& b, const Point& c, Measure measure) {
    if (measure == Measure::parametric) return 0.5 * simplex_maximum(length(a), length(b), length(c));
    return 0.5 * std::max(simplex_maximum(a.x, b.x, c.x), simplex_maximum(-a.x, -b.x, -c.x));
}

/// Triangles that will come of one with this error.
double outcome(double error, double tolerance) {
    const double excess = error / (kUse * tolerance);
    return excess <= 1 ? 1 : kBisected * excess;
}

/// Density of lines in each of the columns of samples: the root of the mean bend, of mean 1, within a factor of 4 of it.
template <class F> std::vector<double> densities(F bend) {
    std::vector<double> density(kSamples);
    double sum = 0;
    for (int i = 0; i < kSamples; ++i) {
        double squares = 0;
        for (int k = 0; k < kSamples; ++k) squares += std::pow(bend(i, k), 2);
        sum += density[i] = std::pow(squares / kSamples, 0.25);
    }
    double total = 0;
    for (double& x : density) total += x = sum > 0 ? std::clamp(x * kSamples / sum, 0.25, 4.0) : 1;
    for (double& x : density) x *= kSamples / total;
    return density;
}

/// n + 1 lines from a to b with these densities.
std::vector<double> lines(double a, double b, int n, const std::vector<double>& density) {
    std::vector<double> list{a};
    double reached = 0;  // of kSamples
    int column = 0;
    for (int i = 1; i < n; ++i) {
        const double target = double(i) * kSamples / n;
        while (column + 1 < kSamples && reached + density[column] < target) reached += density[column++];
        const double x = (column + std::min(1.0, (target - reached) / density[column])) / kSamples, at = a + x * (b - a);
        if (at > list.back() && at < b) list.push_back(at);
    }
    list.push_back(b);
    return list;
}

/// Steps on from a pair while that makes cost(a, b) smaller.
template <class F> std::pair<int, int> search(std::pair<int, int> best, F cost, double most) {
    const auto next = [](int n, int way) { return way == 0 ? n : way > 0 ? std::max(n + 1, int(n * kStep)) : std::max(1, std::min(n - 1, int(std::ceil(n / kStep)))); };
    double least = cost(best.first, best.second);
    for (bool better = true; better;) {
        better = false;
        for (const auto& [da, db] : {std::pair{1, 1}, {1, 0}, {0, 1}, {-1, 0}, {0, -1}, {1, -1}, {-1, 1}}) {
            const int a = next(best.first, da), b = next(best.second, db);
            if (2.0 * a * b > most) continue;
            const double c = cost(a, b);
            if (c < least * (1 - 1e-9)) best = {a, b}, least = c, better = true;
        }
    }
    return best;
}

}  // namespace

Bends::Bends(const Patch& patch, const Box& box, Measure measure) : box_(box) {
    const double width_u = box.u.hi - box.u.lo, width_v = box.v.hi - box.v.lo;
    for (int i = 0; i < samples; ++i)
        for (int k = 0; k < samples; ++k) {
            double u = box.u.lo + width_u * (i + 0.5) / samples, v = box.v.lo + width_v * (k + 0.5) / samples;
            if (patch.domain() == Domain::triangle && u + v > 1) {  // the same place of the other half of the square
                const double w = u;
                u = 1 - v, v = 1 - w;
            }
            const PointJet j = patch.jet(u, v);
            const auto d = [&](int p, int q) { return Point{j.x.coefficient(p, q), j.y.coefficient(p, q), j.z.coefficient(p, q)}; };
            Bend b{2 * width_u * width_u * d(2, 0), width_u * width_v * d(1, 1), 2 * width_v * width_v * d(0, 2)};
            const Point n = normalized(cross(d(1, 0), d(0, 1)));
            if (measure == Measure::geometric && finite(n)) b = {Point{dot(n, b.uu), 0, 0}, Point{dot(n, b.uv), 0, 0}, Point{dot(n, b.vv), 0, 0}};
            exist_ = exist_ && finite(b.uu) && finite(b.uv) && finite(b.vv);
            bend_[i * samples + k] = b;
        }
}

bool Bends::less(const Vec2& p, const Vec2& q, const Vec2& r, const Vec2& s) const {
    const double wu = box_.u.hi - box_.u.lo, wv = box_.v.hi - box_.v.lo;
    const auto way = [&](const Vec2& a, const Vec2& b) { return Vec2{(b.x - a.x) / wu, (b.y - a.y) / wv}; };
    const Vec2 d = way(p, q), e = way(r, s);
    if (!exist_) return d.x * d.x + d.y * d.y < (e.x * e.x + e.y * e.y) * (1 - 1e-9);
    const auto index = [](double x, const Interval& range) { return std::clamp(int((x - range.lo) / (range.hi - range.lo) * samples), 0, samples - 1); };
    const Bend& b = (*this)(index(0.25 * (p.x + q.x + r.x + s.x), box_.u), index(0.25 * (p.y + q.y + r.y + s.y), box_.v));
    return b.along(d) < b.along(e) * (1 - 1e-9);
}

DiceGrid dice(const Bends& bends, const Box& box, double tolerance, Measure measure, double most) {
    if (!bends.exist()) return {{box.u.lo, box.u.hi}, {box.v.lo, box.v.hi}};
    const auto du = densities([&](int i, int k) { return length(bends(i, k).uu); }), dv = densities([&](int j, int k) { return length(bends(k, j).vv); });
    const auto cost = [&](int nu, int nv) {
        double sum = 0;
        for (int i = 0; i < kSamples; ++i)
            for (int j = 0; j < kSamples; ++j) {
                const Bend& b = bends(i, j);
                const double a = 1 / (nu * du[i]), c = 1 / (nv * dv[j]);
                const Point uu = a * a * b.uu, vv = c * c * b.vv, uv = 2 * a * c * b.uv, plus = uu + vv + uv, minus = uu + vv - uv;
                sum += du[i] * dv[j] * outcome(error_of(uu, vv, dot(plus, plus) < dot(minus, minus) ? plus : minus, measure), tolerance);
            }
        return sum * nu * nv;
    };
    // To begin with, edges along u and v that use 3/4 of the tolerance each.
    double uu = 0, vv = 0;
    for (int i = 0; i < kSamples; ++i)
        for (int j = 0; j < kSamples; ++j) uu += dot(bends(i, j).uu, bends(i, j).uu), vv += dot(bends(i, j).vv, bends(i, j).vv);
    const double nu0 = std::max(1.0, std::sqrt(std::sqrt(uu) / kSamples / (6 * tolerance))), nv0 = std::max(1.0, std::sqrt(std::sqrt(vv) / kSamples / (6 * tolerance)));
    if (!(2 * nu0 * nv0 <= most)) return {{box.u.lo, box.u.hi}, {box.v.lo, box.v.hi}};
    const auto [nu, nv] = search({int(nu0), int(nv0)}, cost, most);
    return {lines(box.u.lo, box.u.hi, nu, du), lines(box.v.lo, box.v.hi, nv, dv)};
}

int dice_triangle(const Bends& bends, double tolerance, Measure measure, double most) {
    if (!bends.exist()) return 1;
    std::vector<double> errors;
    for (int i = 0; i < kSamples; ++i)
        for (int j = 0; j < kSamples; ++j) errors.push_back(error_of(bends(i, j).uu, bends(i, j).vv, bends(i, j).uu + bends(i, j).vv - 2.0 * bends(i, j).uv, measure));
    const double worst = *std::max_element(errors.begin(), errors.end());
    int best = 1;
    double least = std::numeric_limits<double>::infinity();
    for (int n = 1; double(n) * n <= most && n <= 2 + std::sqrt(worst / (kUse * tolerance)); ++n) {
        double cost = 0;
        for (const double e : errors) cost += double(n) * n * outcome(e / (double(n) * n), tolerance);
        if (cost < least) best = n, least = cost;
    }
    return best;
}

}  // namespace isoparm
