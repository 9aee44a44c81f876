#include "joints/edge_jump.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "scalar/elementary.h"

namespace isoparm {
namespace {

using Sizes = JumpSizes;
using Models = Vec3<TaylorModel>;

constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr double kShortest = 0x1p-44;  // nor any other
constexpr int kFew = 8;                // halvings before a bound is taken for as good as it gets
const Interval kUnknown{0, kInfinite};

Models part(const EdgeSide::Jet& x, int n) { return {x.x.c[n], x.y.c[n], x.z.c[n]}; }
TaylorModel twice(const TaylorModel& x) { return x + x; }

/// Of the length of a vector, everywhere on the piece.
Interval length_of(const Models& v) {
    Interval by_part(0);
    for (int axis = 0; axis < 3; ++axis) {
        if (!v[axis].bounded()) return kUnknown;
        by_part = by_part + square(v[axis].range());
    }
    const Interval squares = dot(v, v).range();
    const double lo = std::max({0.0, by_part.lo, squares.lo}), hi = std::max(lo, squares.hi < by_part.hi ? squares.hi : by_part.hi);
    return sqrt(Interval(lo, hi));
}

/// Of the angle between two vectors: by their cross product over their dot product, which is sharp near 0 where the cosine is blind.
Interval angle_of(const Models& p, const Models& q) {
    const Models c = cross(p, q);
    const TaylorModel d = dot(p, q);
    const Interval y = length_of(c), x = d.range();
    if (x.lo > 0) {
        const Interval t = length_of({c.x / d, c.y / d, c.z / d});
        if (t.hi < kInfinite) return degrees_of(t, Interval(1));
    }
    return degrees_of(y, x);
}

/// The same of vectors whose sense does not count, 0 to 90.
Interval angle_of_lines(const Models& p, const Models& q) {
    const Interval angle = dot(p, q).range().hi < 0 ? angle_of(p, {-q.x, -q.y, -q.z}) : angle_of(p, q);
    return angle.hi <= 90 ? angle : Interval(std::max(0.0, std::min(angle.lo, (Interval(180) - angle).lo)), 90);
}

struct Normal {
    Models t, c, w;  // along, across, t x c
    explicit Normal(const EdgeSide::Jet& x) : t(part(x, 1)), c(part(x, 2)), w(EdgeSide::normal(x)) {}
};

/// Second fundamental form over first, in the direction x_c - (F/E) x_s: II(d,d) / I(d,d) = (L F^2 - 2 M E F + N E^2) / (E |w|^3), L, M, N with w
/// for the unit normal.
TaylorModel cross_curvature(const EdgeSide::Jet& x, const Normal& n) {
    const TaylorModel E = dot(n.t, n.t), F = dot(n.t, n.c), ww = dot(n.w, n.w);
    const TaylorModel L = twice(dot(part(x, 3), n.w)), M = dot(part(x, 4), n.w), N = twice(dot(part(x, 5), n.w));
    return ((L * F - twice(M * E)) * F + N * (E * E)) / (E * ww * sqrt(ww));
}

bool second_bounded(const EdgeSide::Jet& x) { return x.x.c[5].bounded() && x.y.c[5].bounded() && x.z.c[5].bounded(); }

class Bounder {
public:
    Bounder(const std::vector<EdgeSegment>& segments, const JumpLimits& limits) : segments_(segments), limits_(limits) {
        bounds_.fill({0, kInfinite, segments.front().a.at(0.5), {}, kInfinite});
        wanted_.fill(true);
    }

    std::array<JumpBound, kMeasures> run() {
        for (std::size_t k = 0; k < segments_.size(); ++k) {
            if (!segments_[k].singular) sample(k, 0), sample(k, 1);
            add(k, 0.5, 0.5);
        }
        for (int m; (m = first_open()) < kMeasures; ++halved_[m]) {
            const Piece p = pieces_[worst_[m]];
            pieces_[worst_[m]] = pieces_.back(), pieces_.pop_back();
            const double cut = cut_of(p, m), from = p.middle - p.half, to = p.middle + p.half;
            add(p.segment, 0.5 * (from + cut), 0.5 * (cut - from));
            add(p.segment, 0.5 * (cut + to), 0.5 * (to - cut));
        }
        for (JumpBound& b : bounds_) b.upper = b.singular.empty() ? b.inside : kInfinite;
        return bounds_;
    }

private:
    struct Piece {
        std::size_t segment;
        double middle, half;
        std::array<double, kMeasures> upper, middle_upper;  // middle_upper: of the jump in the middle alone, if measured; no piece around it has less
    };

    Sizes measure(std::size_t k, double middle, double half) const {
        const EdgeSegment& e = segments_[k];
        if (e.singular && !(e.a.exact() && e.b.exact())) {
            const Vec3<Interval> apart = e.a.positions(middle, half) - e.b.positions(middle, half);
            return {length_of({apart.x, apart.y, apart.z}), kUnknown, kUnknown, kUnknown, kUnknown};
        }
        if (e.curve) {
            Sizes s;
            s[kC0] = e.derivative == kNormal ? angle_of_lines(e.a.normal(middle, half), e.curve(middle, half)) : length_of(part(e.a.jet(middle, half), e.derivative == 1 ? 2 : 0) - e.curve(middle, half));
            return s;
        }
        const EdgeSide::Jet x = e.a.jet(middle, half);
        const EdgeSide::Jet y = e.matched ? e.b.jet(e.matched(middle, half)) : e.b.jet(middle, half);
        const auto jump = [&](int n) { return part(x, n) - part(y, n); };
        if (e.singular) return {length_of(jump(0)), kUnknown, kUnknown, kUnknown, kUnknown};
        Sizes s = estimate_jumps(x, y);
        const auto open = [&](int m) { return wanted_[m] && !(s[m].hi <= 0.01 * limits_.tolerance[m] || (half == 0 && s[m].hi - s[m].lo <= 1e-3 * s[m].hi)); };
        if (open(kC0)) s[kC0] = length_of(jump(0));
        if (open(kC1)) s[kC1] = length_of(jump(2));
        if (open(kC2)) s[kC2] = length_of(jump(5)) * Interval(2);
        if (open(kG1)) s[kG1] = e.matched ? angle_of(e.a.normal(middle, half), EdgeSide::normal(y)) : angle_of(e.a.normal(middle, half), e.b.normal(middle, half));
        if (open(kG2) && second_bounded(x) && second_bounded(y)) {
            const Normal p(x), q(y);
            const Interval r = (cross_curvature(x, p) - cross_curvature(y, q)).range();
            s[kG2] = r.bounded() ? abs(r) : kUnknown;
        }
        return s;
    }

    Sizes sample(std::size_t k, double s) {
        Sizes sizes = measure(k, s, 0);
        if (wanted_[kC0] && segments_[k].distance) sizes[kC0].lo = std::min(sizes[kC0].lo, segments_[k].distance(s));
        for (int m = 0; m < kMeasures; ++m)
            if (wanted_[m] && sizes[m].lo > bounds_[m].lower) bounds_[m].lower = sizes[m].lo, bounds_[m].at = segments_[k].a.at(s);
        return sizes;
    }
    void add(std::size_t k, double middle, double half) {
        Piece p{k, middle, half, {}, {}};
        if (pieces_.size() < 256) {  // by then the lower bounds are as good as they get
            const Sizes sizes = sample(k, middle);
            for (int m = 0; m < kMeasures; ++m) p.middle_upper[m] = sizes[m].hi;
        }
        const Sizes sizes = measure(k, middle, half);
        for (int m = 0; m < kMeasures; ++m) {
            // What is not wanted any more is known for the piece's parent already; its bound has been settled.
            p.upper[m] = wanted_[m] ? (sizes[m].hi <= std::numeric_limits<double>::max() ? sizes[m].hi : kInfinite) : 0;
        }
        pieces_.push_back(p);
    }

    /// Too short to be halved, and nothing known: the end of an edge at a pole or a singular corner.
    bool at_tip(const Piece& p) const {
        return segments_[p.segment].singular || (p.half <= kTip / 2 && ((p.segment == 0 && p.middle - p.half <= 0) || (p.segment + 1 == segments_.size() && p.middle + p.half >= 1)));
    }

    /// Its middle; at a singular end, just what has no bound is cut off.
    double cut_of(const Piece& p, int m) const {
        const bool none = p.upper[m] == kInfinite && p.half > kTip && segments_[p.segment].a.exact() && segments_[p.segment].b.exact();
        if (none && p.segment == 0 && p.middle - p.half <= 0) return kTip;
        if (none && p.segment + 1 == segments_.size() && p.middle + p.half >= 1) return 1 - kTip;
        return p.middle;
    }

    void add_end(JumpBound& b, const Piece& p) const {
        const EdgeSegment& e = segments_[p.segment];
        const Vec2 end = e.singular ? *e.singular : e.a.at(p.middle < 0.5 ? 0 : 1);
        if (std::none_of(b.singular.begin(), b.singular.end(), [&](const Vec2& x) { return x.x == end.x && x.y == end.y; })) b.singular.push_back(end);
    }

    /// Sets the bound of a measure from its pieces, and says which of them is the worst.
    void find_worst(int m) {
        if (settled_[m]) return;
        JumpBound& b = bounds_[m];
        b.inside = -1, b.singular.clear();
        for (std::size_t i = 0; i < pieces_.size(); ++i) {
            const Piece& p = pieces_[i];
            if (p.upper[m] == kInfinite && at_tip(p)) add_end(b, p);
            else if (p.upper[m] > b.inside) b.inside = p.upper[m], worst_[m] = i;
        }
        b.inside = std::max(b.inside, b.lower);
        if (b.lower == 0) b.at = segments_[pieces_[worst_[m]].segment].a.at(pieces_[worst_[m]].middle);
    }
    /// The first measure that more pieces can make sharper.
    int first_open() {
        for (int m = 0; m < kMeasures; ++m) {
            if (settled_[m]) continue;
            find_worst(m);
            const JumpBound& b = bounds_[m];
            const bool enough = b.inside <= 0.01 * limits_.tolerance[m] || (b.inside < kInfinite && b.inside - b.lower <= limits_.relative * b.inside) || (b.inside <= limits_.tolerance[m] && halved_[m] >= kFew);
            const double rounding = pieces_[worst_[m]].middle_upper[m], tolerance = limits_.tolerance[m];
            const bool hopeless = b.lower <= tolerance && b.inside <= 3 * rounding && (b.inside <= tolerance || rounding > tolerance);
            // Around an extraordinary vertex the surface is known by a box: shorter pieces have the same.
            const bool box = b.inside <= tolerance && segments_[pieces_[worst_[m]].segment].singular;
            const double shortest = b.inside < kInfinite ? kShortest : kTip;
            if (!enough && !hopeless && !box && pieces_[worst_[m]].half > shortest / 2 && halved_[m] < limits_.max_halvings && !stalled(m)) return m;
            settled_[m] = true, wanted_[m] = false;
        }
        return kMeasures;
    }

    /// Going on as in the last two doublings of the pieces, would the budget end before anything is decided? Or is what is left near the tolerance rounding,
    /// which does not fall at all? Two of them, as a maximum falls in stairs: all the pieces that are as bad must be halved first.
    bool stalled(int m) {
        if (halved_[m] == 0) started_[m] = static_cast<int>(pieces_.size());
        if (halved_[m] < std::max(kFew / 2, started_[m]) || (halved_[m] & (halved_[m] - 1)) != 0) return false;
        const JumpBound& b = bounds_[m];
        const bool disproved = b.lower > limits_.tolerance[m];
        const double excess = disproved ? b.inside - b.lower : b.inside, goal = disproved ? limits_.relative * b.inside : limits_.tolerance[m];
        const double rate = excess / before_[m], at_end = excess * std::pow(rate, std::log2(double(limits_.max_halvings) / halved_[m]));
        before_[m] = excess;
        const bool rounding = !disproved && rate > 0.95 && b.inside <= 1e3 * limits_.tolerance[m], slow = halved_[m] >= 128 && (!(rate < 0.67) || at_end > 2 * goal);
        stalls_[m] = rounding || slow ? stalls_[m] + 1 : 0;
        return stalls_[m] == 2;
    }

    const std::vector<EdgeSegment>& segments_;
    const JumpLimits& limits_;
    std::vector<Piece> pieces_;
    std::array<JumpBound, kMeasures> bounds_;
    std::array<std::size_t, kMeasures> worst_{};
    std::array<int, kMeasures> halved_{}, started_{}, stalls_{};
    std::array<double, kMeasures> before_{kInfinite, kInfinite, kInfinite, kInfinite, kInfinite};
    std::array<bool, kMeasures> wanted_{}, settled_{};
};

}  // namespace

std::array<JumpBound, kMeasures> bound_jumps(const std::vector<EdgeSegment>& segments, const JumpLimits& limits) {
    return Bounder(segments, limits).run();
}

}  // namespace isoparm
