#include "joints/edge_side.h"

#include <algorithm>

#include "exact_parts.h"
#include "joints/edge_cells.h"

namespace isoparm {
namespace {

using Jet2 = JetUV<TaylorModel, 2>;
constexpr int kMostDegree = TaylorModel::order;

Jet2 variable(const Interval& from, const Interval& step, double cross, const TaylorModel& s) {
    Jet2 x;
    x.c[0] = TaylorModel(from) + TaylorModel(step) * s;
    x.c[1] = TaylorModel(step);
    x.c[2] = TaylorModel(cross);
    return x;
}

Jet2 evaluate(const Polynomial& p, const Jet2& x, const Jet2& y) {
    Jet2 sum;
    for (int i = p.degree_u(); i >= 0; --i) {
        Jet2 row;
        for (int j = p.degree_v(); j >= 0; --j) {
            if (j < p.degree_v()) row = row * y;
            row.c[0] = row.c[0] + TaylorModel(p.coefficient(i, j));
        }
        sum = i < p.degree_u() ? sum * x + row : row;
    }
    return sum;
}

/// Taylor coefficients about (x,y) of a polynomial, those of u^i v^j at i (degree of v + 1) + j.
std::vector<Interval> recentred(const Polynomial& f, const Interval& x, const Interval& y) {
    const int p = f.degree_u(), q = f.degree_v(), row = q + 1;
    std::vector<Interval> c(std::size_t((p + 1) * row));
    for (int i = 0; i <= p; ++i)
        for (int j = 0; j <= q; ++j) c[std::size_t(i * row + j)] = f.coefficient(i, j);
    const auto zero = [](const Interval& t) { return t.lo == 0 && t.hi == 0; };
    for (int k = 0; k < p && !zero(x); ++k)  // repeated synthetic division
        for (int i = p - 1; i >= k; --i)
            for (int j = 0; j <= q; ++j) c[std::size_t(i * row + j)] += c[std::size_t((i + 1) * row + j)] * x;
    for (int i = 0; i <= p; ++i)
        for (int k = 0; k < q && !zero(y); ++k)
            for (int j = q - 1; j >= k; --j) c[std::size_t(i * row + j)] += c[std::size_t(i * row + j + 1)] * y;
    return c;
}

/// Bit for bit, as whoever made it multiplied.
bool is_square(const Polynomial& a, const Polynomial& of) {
    const Polynomial b = of * of;
    bool same = a.degree_u() == b.degree_u() && a.degree_v() == 0 && b.degree_v() == 0;
    for (int k = 0; same && k <= a.degree_u(); ++k) same = a.coefficient(k, 0).lo == b.coefficient(k, 0).lo && a.coefficient(k, 0).hi == b.coefficient(k, 0).hi;
    return same;
}

Interval step_of(double from, double to) { return Interval(to) - Interval(from); }
Interval power(const Interval& x, int n) {
    Interval r(1);
    for (int k = 0; k < n; ++k) r = r * x;
    return r;
}

/// Coefficients of a^k b^l in f(a * along + b * across), k + l <= 3, from the Taylor coefficients of f in (u,v).
class Directional {
public:
    Directional(const Interval (&along)[2], const double (&across)[2]) {
        for (int k = 0; k <= 3; ++k)
            for (int l = 0; k + l <= 3; ++l)
                for (int i = 0; i <= k + l; ++i) {
                    const int j = k + l - i;
                    for (int m = std::max(0, k - j); m <= std::min(i, k); ++m)
                        factor_[k][l][i] += Interval(binomial(i, m) * binomial(j, k - m)) * power(along[0], m) * power(across[0], i - m) * power(along[1], k - m) * power(across[1], j - k + m);
                }
    }
    Interval operator()(const JetUV<Interval, 3>& f, int k, int l) const {
        Interval sum(0);
        for (int i = 0; i <= k + l; ++i)
            if (const Interval& x = factor_[k][l][i]; x.lo != 0 || x.hi != 0) sum += x * f.coefficient(i, k + l - i);
        return sum;
    }

private:
    Interval factor_[4][4][4];  // of f_ij, j = k + l - i
};

/// f(c + D) = sum at[k] D^k, the highest coefficient anywhere in over[k]; of the orders that are bounded, the one with the least rest.
TaylorModel expanded(const Interval* at, const Interval* over, int most, const TaylorModel& D) {
    TaylorModel best(Interval::all()), sum, powers(1.0);
    double least = HUGE_VAL;
    for (int k = 0; k <= most; ++k) {
        const Interval rest = (over[k] - Interval(at[k].bounded() ? mid(at[k]) : 0)) * powers.range();
        const double size = rest.bounded() ? mag(rest) : HUGE_VAL;
        if (size <= least && size < HUGE_VAL) {
            least = size;
            best = sum + TaylorModel(Interval(at[k].bounded() ? mid(at[k]) : 0)) * powers;
            best.widen(rest);
        }
        if (!at[k].bounded()) break;
        sum = sum + TaylorModel(at[k]) * powers;
        powers = powers * D;
    }
    return best;
}

/// Is this vector 0 at d = end, as far as rounding lets one see, and not everywhere?
bool vanishes(const Vec3<TaylorModel>& t, double end) {
    double size = 0, value = 0;
    for (int axis = 0; axis < 3; ++axis) {
        for (int k = 0; k <= t[axis].degree(); ++k) size = std::max(size, mag(t[axis].coefficient(k)));
        const Interval at = t[axis].at(end);
        if (!at.contains(0)) return false;
        value = std::max(value, mag(at));
    }
    return value <= 1e-11 * size && size > 0;
}
/// t / (1 + d) or t / (1 - d), when t is 0 at d = end = -1 or 1.
TaylorModel without_zero(const TaylorModel& t, double end) {
    std::array<Interval, TaylorModel::order + 1> q;
    const int n = t.degree();
    if (n < 1) return 0.0;
    q[std::size_t(n - 1)] = t.coefficient(n);
    for (int k = n - 1; k >= 1; --k) q[std::size_t(k - 1)] = t.coefficient(k) + Interval(end) * q[std::size_t(k)];
    const TaylorModel r = TaylorModel::polynomial(q.data(), n - 1);
    return end < 0 ? r : -r;
}

}  // namespace

ParameterLine edge_line(const Patch& patch, int edge, double t0, double t1) {
    static constexpr Vec2 quad[] = {{0, 1}, {-1, 0}, {0, -1}, {1, 0}}, triangle[] = {{1, -0.5}, {-0.5, 1}, {-0.5, -0.5}};
    return {patch.edge_point(edge, t0), patch.edge_point(edge, t1), patch.domain() == Domain::quad ? quad[edge] : triangle[edge]};
}

EdgeSide::EdgeSide(Patch patch, const ParameterLine& line, const Vec2& side) : patch_(std::move(patch)), line_(line) {
    const CellForm cell = form_beside(patch_, line.from, line.to, side);
    cell_ = cell.cell, exact_ = cell.form;
    if (exact_.empty()) return;
    if (has_line_form(exact_)) {
        if (patch_.domain() == Domain::triangle) sign_ = line.cross.x * side.x + line.cross.y * side.y > 0 ? 1 : -1;
        else sign_ = line.from.x == line.to.x ? line.cross.x : line.cross.y;
        square_of_first_ = is_square(exact_[11], exact_[7]);
    }
    whole_ = along_all();
    for (const Jet2& x : whole_)
        for (const TaylorModel& c : x.c)
            if (!c.exact()) {
                whole_.clear();
                return;
            }
    // A denominator that vanishes at an end, as at the vertices of side-vertex surfaces, has a quotient there that its form does not tell.
    if (whole_.size() == 4 && !(whole_[3].c[0].at(-1).lo > 0 && whole_[3].c[0].at(1).lo > 0)) {
        whole_.clear(), exact_.clear();
        return;
    }
    find_directions();
}

// With (x,y) = middle + d step + b cross: the powers of b to the second are polynomials in d = 2 s - 1, whose derivatives are those by s, halved.
std::vector<Jet2> EdgeSide::along_all() const {
    if (has_line_form(exact_)) {
        auto form = form_at(TaylorModel::linear(0.5, 0.5));
        for (std::size_t k = 4; k < form.size(); ++k) form[k].c[3] = 0.0;  // nobody asks for these
        for (std::size_t k = 8; k < form.size(); ++k) form[k].c[1] = 0.0;
        return form;
    }
    const auto middle = [](double from, double to, double u0, double u1) {
        return Interval(0.5) * (Interval(from) + Interval(to)) - Interval(mid(Interval(u0, u1)));
    };
    const Interval x = middle(line_.from.x, line_.to.x, cell_.u0, cell_.u1), y = middle(line_.from.y, line_.to.y, cell_.v0, cell_.v1);
    const Interval step[] = {Interval(0.5) * step_of(line_.from.x, line_.to.x), Interval(0.5) * step_of(line_.from.y, line_.to.y)};
    const Interval across[] = {Interval(line_.cross.x), Interval(line_.cross.y)};
    const auto most_power = [](const Interval& x) { return x.lo == 0 && x.hi == 0 ? 0 : 1000; };  // of 0 only the 0th is none
    const int most[] = {most_power(step[0]), most_power(step[1]), most_power(across[0]), most_power(across[1])};
    std::vector<Jet2> form;
    for (const Polynomial& f : exact_) {
        if (f.degree_u() + f.degree_v() > kMostDegree) return form_at(TaylorModel::linear(0.5, 0.5));
        const auto c = recentred(f, x, y);
        std::array<std::array<Interval, kMostDegree + 3>, 3> powers{};  // [l][k]: of b^l d^k
        for (int i = 0; i <= f.degree_u(); ++i)
            for (int j = 0; j <= f.degree_v(); ++j)
                for (int l = 0; l <= std::min(2, i + j); ++l) {
                    Interval weight(0);
                    for (int m = std::max(0, l - j); m <= std::min(i, l); ++m)
                        if (i - m <= most[0] && j - l + m <= most[1] && m <= most[2] && l - m <= most[3]) weight += Interval(binomial(i, m) * binomial(j, l - m)) * power(across[0], m) * power(step[0], i - m) * power(across[1], l - m) * power(step[1], j - l + m);
                    powers[std::size_t(l)][std::size_t(i + j - l)] += weight * c[std::size_t(i * (f.degree_v() + 1) + j)];
                }
        const auto derivative = [](const auto& of) {  // by s
            auto d = of;
            for (std::size_t k = 0; k + 1 < of.size(); ++k) d[k] = of[k + 1] * Interval(2.0 * double(k + 1));
            d.back() = Interval(0);
            return d;
        };
        const auto model = [](const auto& of) { return TaylorModel::polynomial(of.data(), kMostDegree); };
        const auto first = derivative(powers[0]);
        Jet2 jet;
        jet.c[0] = model(powers[0]), jet.c[1] = model(first), jet.c[2] = model(powers[1]), jet.c[4] = model(derivative(powers[1])), jet.c[5] = model(powers[2]);
        auto second = derivative(first);
        for (Interval& k : second) k = k * Interval(0.5);
        jet.c[3] = model(second);
        form.push_back(jet);
    }
    return form;
}

// Of a rational surface X/w the derivatives have the directions of X' w - X w', which are polynomials.
void EdgeSide::find_directions() {
    for (const int n : {1, 2}) {
        Vec3<TaylorModel>& t = directions_[std::size_t(n - 1)];
        for (int axis = 0; axis < 3; ++axis) {
            const auto& x = whole_[std::size_t(axis)].c;
            if (n == 2 && has_line_form(exact_)) t[axis] = TaylorModel(sign_) * whole_[std::size_t(4 + axis)].c[0];
            else t[axis] = whole_.size() == 3 ? x[n] : x[n] * whole_[3].c[0] - x[0] * whole_[3].c[n];
            if (!t[axis].exact()) return;
        }
        for (const double end : {-1.0, 1.0})
            while (vanishes(t, end))
                for (int axis = 0; axis < 3; ++axis) t[axis] = without_zero(t[axis], end);
    }
    has_directions_ = true;
}

Vec3<TaylorModel> EdgeSide::normal(const Jet& x) {
    return cross(Vec3<TaylorModel>{x.x.c[1], x.y.c[1], x.z.c[1]}, Vec3<TaylorModel>{x.x.c[2], x.y.c[2], x.z.c[2]});
}
Vec3<TaylorModel> EdgeSide::normal(double middle, double half) const {
    if (!has_directions_) return normal(jet(middle, half));
    auto t = directions_;
    for (auto& v : t)
        for (int axis = 0; axis < 3; ++axis) v[axis] = v[axis].restricted(2 * middle - 1, 2 * half);
    return cross(t[0], t[1]);
}

EdgeSide::Jet EdgeSide::jet(double middle, double half) const {
    if (whole_.empty()) return jet(TaylorModel::linear(middle, half));
    auto form = whole_;
    for (Jet2& x : form)
        for (TaylorModel& c : x.c) c = c.restricted(2 * middle - 1, 2 * half);
    return of_form(form);
}

EdgeSide::Jet EdgeSide::jet(const TaylorModel& s) const {
    if (!exact_.empty()) return of_form(form_at(s));
    const auto model = modelled(s);
    return model ? *model : enclosed(s);
}

EdgeSide::Jet EdgeSide::of_form(const std::vector<Jet2>& form) const {
    if (has_line_form(exact_)) return of_line_form(form);
    if (form.size() == 3) return {form[0], form[1], form[2]};
    return {form[0] / form[3], form[1] / form[3], form[2] / form[3]};
}

std::vector<Jet2> EdgeSide::form_at(const TaylorModel& s) const {
    if (has_line_form(exact_)) {
        // On a triangle t runs as the second barycentric coordinate falls: on E1 v, on E2 w, on E3 u.
        const bool along_u = line_.from.y == line_.to.y, falls = patch_.domain() == Domain::triangle && !along_u && line_.from.x == line_.to.x;
        const double a = along_u ? line_.from.x : line_.from.y, b = along_u ? line_.to.x : line_.to.y;
        const Interval from = (falls ? Interval(1) - Interval(a) : Interval(a)) - Interval(mid(part_of_edge(exact_)));
        const Jet2 t = variable(from, falls ? step_of(b, a) : step_of(a, b), 0, s);
        std::vector<Jet2> form;
        for (std::size_t k = 0; k < 16; ++k) form.push_back(evaluate(exact_[k], t, t));
        return form;
    }
    const Jet2 x = variable(Interval(line_.from.x) - Interval(mid(Interval(cell_.u0, cell_.u1))), step_of(line_.from.x, line_.to.x), line_.cross.x, s);
    const Jet2 y = variable(Interval(line_.from.y) - Interval(mid(Interval(cell_.v0, cell_.v1))), step_of(line_.from.y, line_.to.y), line_.cross.y, s);
    std::vector<Jet2> form;
    for (const Polynomial& p : exact_) form.push_back(evaluate(p, x, y));
    return form;
}

Box EdgeSide::box(const Interval& s) const {
    // On the far side of the cell the patch would answer with the next one: the box reaches a little into this one.
    const auto inside = [](Interval x, double low, double high) {
        x = clip(x, {low, high});
        return x.lo == high ? Interval(std::nextafter(high, low), high) : x;
    };
    return {inside(Interval(line_.from.x) + step_of(line_.from.x, line_.to.x) * s, cell_.u0, cell_.u1),
            inside(Interval(line_.from.y) + step_of(line_.from.y, line_.to.y) * s, cell_.v0, cell_.v1)};
}
Vec3<Interval> EdgeSide::positions(double middle, double half) const {
    return patch_.enclose_points(box(Interval(middle) + Interval(-half, half)));
}

EdgeSide::Jet EdgeSide::enclosed(const TaylorModel& s) const {
    const double centre = mid(s.coefficient(0));
    const Interval reach = s.range();
    const TaylorModel D = s - TaylorModel(centre);
    const Interval along[] = {step_of(line_.from.x, line_.to.x), step_of(line_.from.y, line_.to.y)};
    const double across[] = {line_.cross.x, line_.cross.y};
    const auto at = patch_.enclose(box(Interval(centre))).over, over = patch_.enclose(box(reach)).over;
    const Directional directional(along, across);
    Jet r;
    for (int axis = 0; axis < 3; ++axis) {
        Interval a_all[4][4], b_all[4][4];
        for (int k = 0; k <= 3; ++k)
            for (int l = 0; l <= 2 && k + l <= 3; ++l) a_all[k][l] = directional(at[axis], k, l), b_all[k][l] = directional(over[axis], k, l);
        for (int n = 0; n < Jet2::size; ++n) {
            const auto [k, l] = Jet2::powers[std::size_t(n)];
            Interval a[4], b[4];
            const int most = 3 - k - l;
            for (int m = 0; m <= most; ++m) {
                const Interval times(binomial(k + m, k));
                a[m] = times * a_all[k + m][l];
                b[m] = times * b_all[k + m][l];
            }
            r[axis].c[n] = expanded(a, b, most, D);
        }
    }
    return r;
}

}  // namespace isoparm
