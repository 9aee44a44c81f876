#include "curves/piecewise_bezier.h"

#include <algorithm>
#include <array>

#include "error.h"

namespace isoparm {
namespace {

/// Taylor coefficients in s of the Bezier polynomial with these coordinates, by de Casteljau's triangle. Fixed: the degree when the
/// compiler is to know it, or 0.
template <int Fixed, class T> void de_casteljau(const double* coordinates, int given, const T& s, int order, T* out) {
    const int degree = Fixed > 0 ? Fixed : given;
    T b[(Fixed > 0 ? Fixed : max_degree) + 1];
    for (int i = 0; i <= degree; ++i) b[i] = T(coordinates[i]);
    const T r = T(1.0) - s;
    for (int level = 0;; ++level) {
        const int k = degree - level;  // k + 1 points are left: their k-th difference is the k-th derivative
        if (k <= order) {
            T d[(Fixed > 0 ? Fixed : max_degree) + 1];
            std::copy(b, b + k + 1, d);
            for (int m = 0; m < k; ++m)
                for (int i = 0; i < k - m; ++i) d[i] = d[i + 1] - d[i];
            out[k] = k == 0 ? d[0] : d[0] * T(binomial(degree, k));
        }
        if (k == 0) break;
        for (int i = 0; i < k; ++i) b[i] = r * b[i] + s * b[i + 1];
    }
    for (int k = degree + 1; k <= order; ++k) out[k] = T(0.0);
}
template <class T> void bezier_taylor(const double* coordinates, int degree, const T& s, int order, T* out) {
    switch (degree) {
        case 1: return de_casteljau<1>(coordinates, degree, s, order, out);
        case 2: return de_casteljau<2>(coordinates, degree, s, order, out);
        case 3: return de_casteljau<3>(coordinates, degree, s, order, out);
        case 4: return de_casteljau<4>(coordinates, degree, s, order, out);
        case 5: return de_casteljau<5>(coordinates, degree, s, order, out);
        default: return de_casteljau<0>(coordinates, degree, s, order, out);
    }
}

/// The same over a wide interval: all coefficients at the middle, then the exact expansion about it.
void bezier_taylor(const double* coordinates, int degree, const Interval& s, int order, Interval* out) {
    const double m = mid(s);
    std::array<Interval, max_degree + 1> a;
    bezier_taylor<Interval>(coordinates, degree, Interval(m), degree, a.data());
    shift_taylor(a.data(), degree, s - Interval(m), order, out);
}

/// For numbers and packs: order <= 3.
template <class T> void piece_taylor(const BezierPiece& piece, const T& t, int order, Vec3<T>* out) {
    const int n = piece.degree();
    const bool unit = piece.begin == 0 && piece.end == 1, rational = !piece.weights.empty();
    const T h = T(piece.end) - T(piece.begin);
    const T s = unit ? t : (t - T(piece.begin)) / h;
    T c[3][4], w[4];
    double weighted[max_degree + 1];
    for (int axis = 0; axis < 3; ++axis) {
        for (int i = 0; i <= n; ++i) weighted[i] = piece.points[i][axis] * (rational ? piece.weights[i] : 1.0);
        bezier_taylor(weighted, n, s, order, c[axis]);
    }
    if (rational) {  // x = N / w by the quotient recurrence
        bezier_taylor(piece.weights.data(), n, s, order, w);
        for (auto& x : c)
            for (int k = 0; k <= order; ++k) {
                for (int l = 0; l < k; ++l) x[k] = x[k] - x[l] * w[k - l];
                x[k] = x[k] / w[0];
            }
    }
    T scale(1.0);
    for (int k = 0; k <= order; ++k) {
        out[k] = {c[0][k], c[1][k], c[2][k]};
        if (unit) continue;
        if (k > 0) out[k] = out[k] / scale;
        scale = scale * h;
    }
}

/// Weighted coordinates round; over intervals that must be enclosed too.
template <> void piece_taylor(const BezierPiece& piece, const Interval& t, int order, Vec3<Interval>* out) {
    const int n = piece.degree();
    const Interval h = Interval(piece.end) - Interval(piece.begin);
    // Parameters lie in the piece; only rounding can put the ends of t outside.
    const Interval s = clip((t - Interval(piece.begin)) / h, {0, 1});
    Interval c[3][max_degree + 1], w[max_degree + 1];
    const bool rational = !piece.weights.empty();
    double low[max_degree + 1]{}, high[max_degree + 1]{};
    for (int axis = 0; axis < 3; ++axis) {
        bool exact = true;
        for (int i = 0; i <= n; ++i) {
            const Interval x = rational ? Interval(piece.points[i][axis]) * Interval(piece.weights[i]) : Interval(piece.points[i][axis]);
            low[i] = mid(x);
            high[i] = rad(x);
            exact = exact && high[i] == 0;
        }
        bezier_taylor(low, n, s, order, c[axis]);
        if (exact) continue;
        // The products were rounded: each Bezier coefficient is off by at most high[i], so each Taylor coefficient of
        // order k by at most binomial(n,k) 2^k times the largest of them.
        const double worst = *std::max_element(high, high + n + 1);
        double factor = 1;
        for (int k = 0; k <= order && k <= n; ++k) {
            const double e = rounding::up(worst * (factor * binomial(n, k)));
            c[axis][k] = c[axis][k] + Interval(-e, e);
            factor *= 2;
        }
    }
    if (rational) {
        bezier_taylor(piece.weights.data(), n, s, order, w);
        // Convex hull: over a wide interval the expansions may overshoot, even below 0 in the denominator.
        const auto [lightest, heaviest] = std::minmax_element(piece.weights.begin(), piece.weights.end());
        w[0] = intersection(w[0], {*lightest, *heaviest});
        for (int axis = 0; axis < 3; ++axis) {
            auto& x = c[axis];
            for (int k = 0; k <= order; ++k) {
                for (int l = 0; l < k; ++l) x[k] = x[k] - x[l] * w[k - l];
                x[k] = x[k] / w[0];
                if (k > 0) continue;
                const auto [a, b] = std::minmax_element(piece.points.begin(), piece.points.end(), [axis](const Point& p, const Point& q) { return p[axis] < q[axis]; });
                x[0] = intersection(x[0], {(*a)[axis], (*b)[axis]});
            }
        }
    }
    Interval scale(1.0);
    for (int k = 0; k <= order; ++k) {
        out[k] = {c[0][k] / scale, c[1][k] / scale, c[2][k] / scale};
        scale = scale * h;
    }
}

/// Of a rational piece: numerators over the denominator, each by de Casteljau's scheme.
struct RationalForm {
    Vec3<Polynomial> x;
    Polynomial w;
    RationalForm(const BezierPiece& piece, const Polynomial& t) {
        const Polynomial s = (t - Polynomial(piece.begin)) / Polynomial(Interval(piece.end) - Interval(piece.begin)), r = Polynomial(1) - s;
        const auto form = [&](auto coefficient) {
            std::vector<Polynomial> b;
            for (std::size_t i = 0; i < piece.points.size(); ++i) b.push_back(Polynomial(coefficient(i)));
            for (; b.size() > 1; b.pop_back())
                for (std::size_t i = 0; i + 1 < b.size(); ++i) b[i] = r * b[i] + s * b[i + 1];
            return b[0];
        };
        w = form([&](std::size_t i) { return Interval(piece.weights[i]); });
        for (int axis = 0; axis < 3; ++axis) x[axis] = form([&](std::size_t i) { return Interval(piece.weights[i]) * Interval(piece.points[i][axis]); });
    }
};

}  // namespace

PiecewiseBezier::PiecewiseBezier(std::vector<BezierPiece> pieces, std::vector<int> continuity)
    : pieces_(std::move(pieces)), continuity_(std::move(continuity)) {
    if (pieces_.empty()) throw_input("a curve needs at least one piece");
    continuity_.resize(pieces_.size() - 1, 0);
    for (const auto& p : pieces_) {
        if (p.points.empty()) throw_input("a Bezier curve needs at least one point");
        if (p.degree() > max_degree)
            throw_input("found a curve of degree " + std::to_string(p.degree()) + ", expected at most " + std::to_string(max_degree));
        if (!p.weights.empty() && p.weights.size() != p.points.size())
            throw_input("found " + std::to_string(p.weights.size()) + " weights for " + std::to_string(p.points.size()) +
                        " points, expected one weight a point");
        for (std::size_t i = 0; i < p.points.size(); ++i) {
            if (!finite(p.points[i])) throw_input("point " + std::to_string(i) + " is not finite");
            if (!p.weights.empty() && !(p.weights[i] > 0 && std::isfinite(p.weights[i])))
                throw_input("found weight " + to_text(p.weights[i]) + " at point " + std::to_string(i) + ", expected a positive number");
        }
        if (!(p.begin < p.end)) throw_input("found a curve over [" + to_text(p.begin) + ", " + to_text(p.end) + "], expected begin < end");
    }
}

std::vector<Break> PiecewiseBezier::breaks() const {
    std::vector<Break> list;
    for (std::size_t k = 0; k + 1 < pieces_.size(); ++k) list.push_back({pieces_[k].end, continuity_[k]});
    return list;
}

bool PiecewiseBezier::rational() const {
    return std::any_of(pieces_.begin(), pieces_.end(), [](const BezierPiece& p) { return !p.weights.empty(); });
}

std::size_t PiecewiseBezier::piece_at(double t) const {
    std::size_t k = 0;
    while (k + 1 < pieces_.size() && t >= pieces_[k].end) ++k;
    return k;
}

void PiecewiseBezier::taylor(double t, int order, Vec3<double>* out) const { piece_taylor(pieces_[piece_at(t)], t, order, out); }

void PiecewiseBezier::taylor(const Pack& t, int order, Vec3<Pack>* out) const {
    const std::size_t k = piece_at(t[0]);
    bool same = true;
    for (int i = 1; i < Pack::lanes; ++i) same = same && piece_at(t[i]) == k;
    if (same) return piece_taylor(pieces_[k], t, order, out);
    std::array<Vec3<double>, 4> one;
    for (int i = 0; i < Pack::lanes; ++i) {
        taylor(t[i], order, one.data());
        for (int j = 0; j <= order; ++j)
            for (int axis = 0; axis < 3; ++axis) out[j][axis].set(i, one[j][axis]);
    }
}

void PiecewiseBezier::taylor(const Interval& t, int order, Vec3<Interval>* out) const {
    // The pieces that meet the interval in more than a point; at a single point, the one to its right.
    const std::size_t first = piece_at(t.lo);
    std::size_t last = first;
    while (last + 1 < pieces_.size() && t.hi > pieces_[last].end) ++last;
    if (first == last) return piece_taylor(pieces_[first], t, order, out);
    int smooth = max_degree;
    std::array<Vec3<Interval>, max_degree + 1> one;
    for (std::size_t k = first; k <= last; ++k) {
        const Interval part(k == first ? t.lo : pieces_[k].begin, k == last ? t.hi : pieces_[k].end);
        piece_taylor(pieces_[k], part, order, one.data());
        for (int j = 0; j <= order; ++j)
            for (int axis = 0; axis < 3; ++axis) out[j][axis] = k == first ? one[j][axis] : hull(out[j][axis], one[j][axis]);
        if (k < last) smooth = std::min(smooth, continuity_[k]);
    }
    for (int j = smooth + 2; j <= order; ++j) out[j] = {Interval::all(), Interval::all(), Interval::all()};
}

/// The piece that holds the range of t.
const BezierPiece* PiecewiseBezier::piece_over(const Polynomial& t) const {
    if (!t.exists()) return nullptr;
    const Interval range = t.range();
    const auto& piece = pieces_[piece_at(mid(range))];
    const double slack = t.is_model() ? break_rounding * (end() - begin()) : 1e-9 * (piece.end - piece.begin);
    // A lone piece is the same function everywhere: on a triangle w = 1-u-v is one of a square, where it leaves [0,1].
    return pieces_.size() == 1 || (range.lo >= piece.begin - slack && range.hi <= piece.end + slack) ? &piece : nullptr;
}

Vec3<Quotient> PiecewiseBezier::quotient(const Polynomial& t) const {
    const BezierPiece* piece = piece_over(t);
    if (!piece || piece->weights.empty() || piece->degree() == 0) return Vec3<Quotient>(exact(t));
    const RationalForm form(*piece, t);
    return {Quotient(form.x.x, {form.w}), Quotient(form.x.y, {form.w}), Quotient(form.x.z, {form.w})};
}

Vec3<Polynomial> PiecewiseBezier::exact(const Polynomial& t) const {
    const Vec3<Polynomial> none{Polynomial::nothing(), Polynomial::nothing(), Polynomial::nothing()};
    const BezierPiece* found = piece_over(t);
    if (!found) return none;
    const BezierPiece& piece = *found;
    if (!piece.weights.empty()) {
        if (!t.is_model()) return none;
        const RationalForm form(piece, t);
        return {form.x.x / form.w, form.x.y / form.w, form.x.z / form.w};
    }
    const Interval range = t.range();
    const double m = std::clamp(mid(range), piece.begin, piece.end);
    std::array<Vec3<Interval>, max_degree + 1> a;
    piece_taylor(piece, Interval(m), piece.degree(), a.data());
    const Polynomial step = t - Polynomial(m);
    Vec3<Polynomial> r{Polynomial(a[piece.degree()].x), Polynomial(a[piece.degree()].y), Polynomial(a[piece.degree()].z)};
    for (int k = piece.degree() - 1; k >= 0; --k)
        for (int axis = 0; axis < 3; ++axis) r[axis] = r[axis] * step + Polynomial(a[k][axis]);
    return r;
}

Curve make_piecewise_bezier(std::vector<BezierPiece> pieces, std::vector<int> continuity) {
    return Curve(std::make_shared<PiecewiseBezier>(std::move(pieces), std::move(continuity)));
}

}  // namespace isoparm
