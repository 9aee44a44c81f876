#include "tessellation/dice.h"

#include <algorithm>
#include <cmath>

namespace isoparm {
namespace {

constexpr int kSamples = Bends::samples;
constexpr double kUse = 0.84;          // of the tolerance: the rest is left to third derivatives and to neighbours
constexpr double kBisected = 1.7;     // what a triangle above the tolerance costs: bisection overshoots
constexpr double kFew = 1.05, kMany = 0.75;  // of the vertices wanted on a line
constexpr double kPeak = 64;          // times the median of all samples
constexpr double kStep = 1.19;        // between the numbers of lines that are tried
constexpr int kInVain = 2;            // steps that do not help end the search
constexpr double kCounted = 1e7;      // triangles of a cell; where there are more, their number is told from that of a coarser tolerance

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

/// Bends with the two parameters exchanged if `columns`.
struct Oriented {
    const Bends& bends;
    bool columns;
    Bend operator()(int i, int j) const {
        if (!columns) return bends(i, j);
        const Bend& b = bends(j, i);
        return {b.vv, b.uv, b.uu};
    }
};

double error_of(const Bend& b, double a, double c, Measure measure) {
    if (measure == Measure::geometric) {  // along the normal alone
        const double uu = a * a * b.uu.x, vv = c * c * b.vv.x, uv = 2 * a * c * b.uv.x, plus = uu + vv + uv, minus = uu + vv - uv;
        const double diagonal = std::fabs(plus) < std::fabs(minus) ? plus : minus;
        return 0.5 * std::max(simplex_maximum(uu, vv, diagonal), simplex_maximum(-uu, -vv, -diagonal));
    }
    const Point uu = a * a * b.uu, vv = c * c * b.vv, uv = 2 * a * c * b.uv, plus = uu + vv + uv, minus = uu + vv - uv;
    return error_of(uu, vv, dot(plus, plus) < dot(minus, minus) ? plus : minus, measure);
}

/// The largest a, from 1e-4 to 1, whose error is at most the target, to about 0.3 % of what it may be short of it. Errors are from (a a |uu|)/8 to
/// (a a |uu| + c c |vv|)/6; false position in between.
double widest(const Bend& b, double c, double target, Measure measure) {
    const double uu = length(b.uu), vv = c * c * length(b.vv);
    double low = 1e-4, high = uu > 0 ? std::clamp(std::sqrt(8 * target / uu), low, 1.0) : 1;
    double error_high = error_of(b, high, c, measure);
    if (error_high <= target) return high;
    if (uu > 0 && 6 * target > vv) low = std::clamp(std::sqrt((6 * target - vv) / uu), low, high);
    double error_low = error_of(b, low, c, measure);
    for (int step = 0; step < 6 && error_low < 0.997 * target && error_high > error_low; ++step) {
        const double a = low + (high - low) * (target - error_low) / (error_high - error_low), error = error_of(b, a, c, measure);
        (error <= target ? low : high) = a, (error <= target ? error_low : error_high) = error;
    }
    return low;
}

/// n lines across a box: how dense vertices on them are at each sample, and about how many triangles come of it all.
struct Plan {
    int n = 0;
    double triangles = std::numeric_limits<double>::infinity();
    std::array<std::array<double, kSamples>, kSamples> density{};  // [i][j]: vertices per width, along line j
};

/// Given up, with more than `most` triangles, as soon as there are more.
Plan plan(const Oriented& bends, const std::vector<double>& dv, int n, double tolerance, Measure measure, double most) {
    Plan p;
    p.n = n, p.triangles = 0;
    for (int i = 0; i < kSamples; ++i)
        for (int j = 0; j < kSamples; ++j) {
            const Bend b = bends(i, j);
            const double c = 1 / (n * dv[j]);
            // The widest triangle that passes; where none does, because lines are too far apart, one that does not add much.
            const double target = std::max(kUse * tolerance, 1.3 / 8 * c * c * length(b.vv)), low = widest(b, c, target, measure);
            p.density[i][j] = 1 / low;
            p.triangles += 2 * n * dv[j] / low * outcome(target, tolerance) / (kSamples * kSamples);
            if (p.triangles > most) return p;
        }
    return p;
}

DiceGrid grid_of(const Plan& p, const std::vector<double>& dv, bool columns, const Box& box) {
    DiceGrid grid;
    grid.columns = columns;
    const Interval &along = columns ? box.v : box.u, &across = columns ? box.u : box.v;
    grid.lines = lines(across.lo, across.hi, p.n, dv);
    for (const double x : grid.lines) {
        const double place = std::clamp((x - across.lo) / (across.hi - across.lo) * kSamples - 0.5, 0.0, kSamples - 1.0);
        const int j = std::min(int(place), kSamples - 2);
        std::vector<double> density(kSamples);
        double sum = 0;
        for (int i = 0; i < kSamples; ++i) sum += density[i] = p.density[i][j] + (place - j) * (p.density[i][j + 1] - p.density[i][j]);
        for (double& d : density) d *= kSamples / sum;
        // The same as on the line before if that is about right: straight columns make the best triangles.
        const double wanted = sum / kSamples;
        const bool same = !grid.rows.empty() && wanted <= kFew * double(grid.rows.back().size() - 1) && wanted >= kMany * double(grid.rows.back().size() - 1);
        grid.rows.push_back(same ? grid.rows.back() : lines(along.lo, along.hi, std::max(1, int(std::ceil(wanted - 0.25))), density));
    }
    return grid;
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
    if (exist_) cut_peaks();
}

/// A bend far above the others is that of a place narrower than the distance of samples: bisection finds its way there, while rows as
/// dense as that over the whole width of a sample would be too many.
void Bends::cut_peaks() {
    const auto size = [](const Bend& b) { return length(b.uu) + length(b.uv) + length(b.vv); };
    std::array<double, samples * samples> sizes;
    std::transform(bend_.begin(), bend_.end(), sizes.begin(), size);
    const auto median = sizes.begin() + sizes.size() / 2;
    std::nth_element(sizes.begin(), median, sizes.end());
    const double most = kPeak * *median;
    for (Bend& b : bend_)
        if (const double s = size(b); s > most) b = {most / s * b.uu, most / s * b.uv, most / s * b.vv};
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

DiceGrid DiceGrid::single(const Box& box) { return {false, {box.v.lo, box.v.hi}, {{box.u.lo, box.u.hi}, {box.u.lo, box.u.hi}}}; }

double DiceGrid::triangles() const {
    double sum = 0;
    for (std::size_t j = 0; j + 1 < rows.size(); ++j) sum += double(rows[j].size() + rows[j + 1].size()) - 2;
    return sum;
}

namespace {

/// The lines that need the fewest triangles.
struct Choice {
    Plan plan;
    std::vector<double> density;  // of the lines
    bool columns = false;
};

/// Of infinitely many triangles where there are clearly more than `most`.
Choice choose(const Bends& bends, double tolerance, Measure measure, double most) {
    Choice best;
    for (const bool columns : {false, true}) {
        const Oriented turned{bends, columns};
        const auto dv = densities([&](int j, int k) { return length(turned(k, j).vv); });
        // Lines so far apart that edges across them would use 3/4 of the tolerance, and fewer and more of them.
        double squares = 0;
        for (int i = 0; i < kSamples; ++i)
            for (int j = 0; j < kSamples; ++j) squares += dot(bends(i, j).uu, bends(i, j).uu) * columns + dot(bends(i, j).vv, bends(i, j).vv) * !columns;
        const double usual = std::sqrt(std::sqrt(squares) / kSamples / (6 * tolerance));
        if (!(usual * usual <= most)) continue;  // a surface that bends one way only needs few lines the other way
        const auto better = [&](double n) {
            const Plan p = plan(turned, dv, int(n), tolerance, measure, best.plan.triangles);
            const bool found = p.triangles < best.plan.triangles * (1 - 1e-9);
            if (found) best = {p, dv, columns};
            return found;
        };
        // From there to more of them, or to fewer, as long as that helps; a second step may help where the first does not, as numbers are whole.
        const double first = std::max(1.0, usual);
        better(first);
        for (const bool more : {true, false}) {
            int in_vain = 0;
            for (double n = first; in_vain < kInVain;) {
                const double next = more ? std::max(std::floor(n) + 1, n * kStep) : std::min(std::ceil(n) - 1, n / kStep);
                if (next < 1) break;
                in_vain = better(n = next) ? 0 : in_vain + 1;
            }
        }
    }
    return best;
}

}  // namespace

DiceGrid dice(const Bends& bends, const Box& box, double tolerance, Measure measure, double most) {
    if (!bends.exist()) return DiceGrid::single(box);
    const Choice best = choose(bends, tolerance, measure, most);
    if (!(best.plan.triangles <= most)) {
        DiceGrid none = DiceGrid::single(box);
        none.too_many = true;
        return none;
    }
    return grid_of(best.plan, best.density, best.columns, box);
}

double dice_triangles(const Bends& bends, double tolerance, Measure measure) {
    if (!bends.exist()) return 1;
    for (double coarser = 1;; coarser *= 16)
        if (const double n = choose(bends, coarser * tolerance, measure, kCounted).plan.triangles; n <= kCounted) return n * coarser;
}

namespace {

/// About how many triangles n parts of each side end with.
double outcome(const std::vector<double>& errors, double n, double tolerance) {
    double cost = 0;
    for (const double e : errors) cost += n * n * outcome(e / (n * n), tolerance);
    return cost;
}

std::vector<double> triangle_errors(const Bends& bends, Measure measure) {
    std::vector<double> errors;
    for (int i = 0; i < kSamples; ++i)
        for (int j = 0; j < kSamples; ++j) errors.push_back(error_of(bends(i, j).uu, bends(i, j).vv, bends(i, j).uu + bends(i, j).vv - 2.0 * bends(i, j).uv, measure));
    return errors;
}

}  // namespace

int dice_triangle(const Bends& bends, double tolerance, Measure measure, double most) {
    if (!bends.exist()) return 1;
    const std::vector<double> errors = triangle_errors(bends, measure);
    const double worst = *std::max_element(errors.begin(), errors.end());
    int best = 1;
    double least = std::numeric_limits<double>::infinity();
    for (int n = 1; double(n) * n <= most && n <= 2 + std::sqrt(worst / (kUse * tolerance)); ++n)
        if (const double cost = outcome(errors, n, tolerance); cost < least) best = n, least = cost;
    return best;
}

double dice_triangle_triangles(const Bends& bends, double tolerance, Measure measure) {
    if (!bends.exist()) return 1;
    const std::vector<double> errors = triangle_errors(bends, measure);
    const double most = 2 + std::sqrt(*std::max_element(errors.begin(), errors.end()) / (kUse * tolerance));
    double least = std::numeric_limits<double>::infinity();
    for (double n = 1; n <= most && n < 1e150; n *= 1.02) least = std::min(least, outcome(errors, n, tolerance));
    return 0.6 * least / double(errors.size());  // bends of a triangle are less even: bisection needs 0.67 of what uniform parts would
}

}  // namespace isoparm
