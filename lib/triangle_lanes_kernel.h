// triangle_lanes_kernel.h -- TriangleShape::bound() on lanes of numbers; included by triangle_lanes.cpp once for each instruction set, in a namespace of
// its own that defines ISOPARM_LANES. No include guard, and nothing of vec.h or quiet.h: functions of theirs would be compiled for the machine that the
// whole library is built for. Every operation is the one that second_derivatives.cpp, triangle_shape.cpp, quiet.cpp and bound.cpp do, in their order,
// both sides of their branches where lanes differ: the results are theirs to the bit, and so are the proofs.

#include "second_derivatives_lanes_kernel.h"

// quiet.cpp

struct Flat {
    Real x, y;
};

struct Cubic {
    Real form[3], rest;

    Real largest(const Real* q) const { return 0.5 * largest_form(form, q) + rest; }
    Real beside(int k, const Real* q, Real wide) const {
        const Real size[3] = {absolute(form[0]) + q[0], absolute(form[1]) + q[1], absolute(form[2]) + q[2]};
        return 0.125 * size[k] + 0.5 * wide * max(size[kNext[k]], size[kNext[kNext[k]]]) + rest;
    }
};

inline Real blossom(const Real* f, Flat x, Flat y, Flat z) {
    const Real uu = x.x * y.x, uv = x.x * y.y + x.y * y.x, vv = x.y * y.y;
    return z.x * (uu * f[0] + uv * f[1] + vv * f[2]) + z.y * (uu * f[1] + uv * f[2] + vv * f[3]);
}

inline Cubic cubic_of(V3 n, const Real* b, const V3* t, const Flat* uv, Flat m) {
    Cubic cubic;
    const Real f[4] = {dot(n, t[0]), dot(n, t[1]), dot(n, t[2]), dot(n, t[3])};
    const Flat g{(uv[0].x + uv[1].x + uv[2].x) * kThird, (uv[0].y + uv[1].y + uv[2].y) * kThird};
    Flat v[3];
    Real corner[3];
    for (int c = 0; c < 3; ++c) v[c] = {uv[c].x - g.x, uv[c].y - g.y}, corner[c] = blossom(f, v[c], v[c], v[c]);
    Real inner = 6.0 * ((corner[0] + corner[1] + corner[2]) * kThird - blossom(f, v[0], v[1], v[2])), odd{};
    for (int k = 0; k < 3; ++k) {
        const Flat x = v[k], y = v[kNext[k]], e{y.x - x.x, y.y - x.y};
        const Real first = (2.0 * corner[k] + corner[kNext[k]]) * kThird - blossom(f, x, x, y), second = (corner[k] + 2.0 * corner[kNext[k]]) * kThird - blossom(f, x, y, y);
        const Real even = 1.5 * (first + second);
        cubic.form[k] = b[k] + blossom(f, e, e, {g.x - m.x, g.y - m.y}) + even * kThird;
        inner -= even;
        odd += 1.5 * absolute(first - second);
    }
    cubic.rest = absolute(inner) * kInner + kOdd / 6 * odd;
    return cubic;
}

inline void along_edge(int k, const V3* x, const V3* b, V3* at) {
    const int after = kNext[k], last = kNext[after];
    at[k] = x[k] - 0.5 * b[k];
    at[after] = x[k] + 0.5 * b[k];
    at[last] = x[k] + 0.5 * (b[last] - b[after]);
}

inline Mask keeps_orientation(V3 n, const V3* x, const V3* b, const Real* q, const Real* bend, const Real* side, Real tilt) {
    const Mask zero = (side[0] >= side[1]) & (side[0] >= side[2]), one = ~zero & (side[1] >= side[2]);
    V3 xs[3], bs[3];  // beginning with the longest edge
    Real sides[3], qs[3], bends[3];
    for (int k = 0; k < 3; ++k) {
        const int k1 = kNext[k], k2 = kNext[k1];
        xs[k] = select(zero, x[k], select(one, x[k1], x[k2])), bs[k] = select(zero, b[k], select(one, b[k1], b[k2]));
        sides[k] = select(zero, side[k], select(one, side[k1], side[k2])), qs[k] = select(zero, q[k], select(one, q[k1], q[k2]));
        bends[k] = select(zero, bend[k], select(one, bend[k1], bend[k2]));
    }
    V3 along_i[3], along_j[3];
    along_edge(1, xs, bs, along_i), along_edge(2, xs, bs, along_j);
    Real least = dot(n, cross(along_i[0], along_j[0]));
    for (int c = 0; c < 3; ++c) {
        const int d = kNext[c];
        least = min(min(least, dot(n, cross(along_i[c], along_j[c]))), 0.5 * (dot(n, cross(along_i[c], along_j[d])) + dot(n, cross(along_i[d], along_j[c]))));
    }
    const Real all_bends = bend[0] + bend[1] + bend[2], all_q = q[0] + q[1] + q[2];
    const Real mi = sides[1] + 0.5 * (all_bends + bends[1]), mj = sides[2] + 0.5 * (all_bends + bends[2]);
    const Real oi = 0.5 * (all_q + qs[1]), oj = 0.5 * (all_q + qs[2]);
    return (mi * oj + mj * oi + oi * oj + (tilt + 1e-13) * mi * mj + 2.0 * tilt * dot(n, cross(xs[1], xs[2]))) * kSafe + kUnderflow < least;
}

// triangle_shape.cpp

inline Real turn_of(V3 n, const V3* x, const V3* b, const Real* q, const Real* side, Real slack, Real& worst) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    V3 first[3], second[3], normal[3];
    along_edge(0, x, b, first), along_edge(1, x, b, second);
    Mask known = Real{} == Real{};
    for (int c = 0; c < 3; ++c) {
        const V3 across = cross(first[c], second[c]);
        normal[c] = across / length(across);
        known = known & (absolute(normal[c].x) < infinity) & (absolute(normal[c].y) < infinity) & (absolute(normal[c].z) < infinity);
    }
    const Real extent = max(max(side[0], side[1]), side[2]);
    Real turned[3];
    for (int k = 0; k < 3; ++k) turned[k] = select(known, length(normal[kNext[k]] - normal[k]), Real{}) + 0.3 * side[k] / extent;
    worst = select((turned[0] >= turned[1]) & (turned[0] >= turned[2]), Real{}, select(turned[1] >= turned[2], number(1), number(2)));
    Real longest[2]{}, off[2];
    for (int c = 0; c < 3; ++c) longest[0] = max(longest[0], length(first[c])), longest[1] = max(longest[1], length(second[c]));
    for (int k = 0; k < 2; ++k) off[k] = 0.5 * (q[0] + q[1] + q[2] + q[k]) + 2.0 * slack + kRounding * (side[k] + longest[k]);
    const Real loose = safe(longest[0] * off[1] + longest[1] * off[0] + off[0] * off[1] + kRounding * longest[0] * longest[1]);
    Real turn{};
    Mask proved = Real{} == Real{};
    for (int c = 0; c < 3; ++c)
        for (int d = c; d < 3; ++d) {
            const V3 m = 0.5 * (cross(first[c], second[d]) + cross(first[d], second[c]));
            const Real above = dot(n, m) - loose;
            proved = proved & (above > 0.0);
            turn = max(turn, safe((length(m - dot(n, m) * n) + loose) / above));
        }
    return select(proved, turn, number(infinity));
}

inline Real choose_edge(const Real* score, const Real* uu, const Real* vv) {
    Real best{}, best_score = score[0], best_size = uu[0] + vv[0];
    for (int k = 1; k < 3; ++k) {
        const Real size = uu[k] + vv[k];
        const Mask better = (score[k] > best_score * (1 + 1e-9)) | ((score[k] >= best_score * (1 - 1e-9)) & (size > best_size * (1 + 1e-9)));
        best = select(better, number(k), best), best_score = select(better, score[k], best_score), best_size = select(better, size, best_size);
    }
    return best;
}

struct Shape {
    const Model& s;
    bool least;
    Flat uv[3], middle;
    Real ru, rv, aspect[2], uu[3], uv_[3], vv[3], noise[3], side[3], twice_area, per_area, longest, slack;
    V3 x[3], b[3], n;
    Mask flat;

    Shape(const Model& model, const TriangleLanes& in, int lane, Range box_u, Range box_v, bool ask_least);
    void stray(const Real* size, Real* q) const;
    void stray_along(V3 f, Real* q) const;
    void stray_vaguely(Real* q) const;
    Real rounding() const { return 8.0 * (noise[0] + noise[1] + noise[2]); }
    Real parametric(const Real* q) const;
    V3 third(Flat e, Flat d) const {
        return e.x * e.x * (d.x * s.t[0] + d.y * s.t[1]) + 2.0 * e.x * e.y * (d.x * s.t[1] + d.y * s.t[2]) + e.y * e.y * (d.x * s.t[2] + d.y * s.t[3]);
    }
};

inline Shape::Shape(const Model& model, const TriangleLanes& in, int lane, Range box_u, Range box_v, bool ask_least) : s(model), least(ask_least) {
    middle = {mid(box_u), mid(box_v)};
    ru = max(box_u.hi - middle.x, middle.x - box_u.lo), rv = max(box_v.hi - middle.y, middle.y - box_v.lo);
    const Mask wide = (ru > 0.0) & (rv > 0.0);
    aspect[0] = select(wide, rv / ru, number(1)), aspect[1] = select(wide, ru / rv, number(1));
    slack = load(in.slack + lane);
    V3 points[3];
    for (int k = 0; k < 3; ++k) {
        uv[k] = {load(in.u[k] + lane), load(in.v[k] + lane)};
        points[k] = {load(in.x[k][0] + lane), load(in.x[k][1] + lane), load(in.x[k][2] + lane)};
    }
    for (int k = 0; k < 3; ++k) {
        const Real eu = uv[kNext[k]].x - uv[k].x, ev = uv[kNext[k]].y - uv[k].y;
        uu[k] = eu * eu, uv_[k] = eu * ev, vv[k] = ev * ev;
        b[k] = uu[k] * s.h[0] + 2.0 * uv_[k] * s.h[1] + vv[k] * s.h[2];
        noise[k] = kRounding * (uu[k] * s.h_size[0] + 2.0 * absolute(uv_[k]) * s.h_size[1] + vv[k] * s.h_size[2]);
        x[k] = points[kNext[k]] - points[k];
        side[k] = length(x[k]);
    }
    const V3 normal = cross(x[0], x[1]);
    twice_area = length(normal), per_area = 1.0 / twice_area, longest = max(max(side[0], side[1]), side[2]);
    flat = (twice_area > 1e-9 * longest * longest) & (twice_area > 1e-140);
    n = select(flat, per_area * normal, V3{Real{}, Real{}, Real{}});
}

inline void Shape::stray(const Real* size, Real* q) const {
    const double sign = least ? -1 : 1;
    const Real suu = s.h_rad[0] * sign + size[0] * ru + size[1] * rv, suv = s.h_rad[1] * sign + size[1] * ru + size[2] * rv;
    const Real svv = s.h_rad[2] * sign + size[2] * ru + size[3] * rv, quu = suu + suv * aspect[0], qvv = svv + suv * aspect[1];
    for (int k = 0; k < 3; ++k) q[k] = safe(quu * uu[k] + qvv * vv[k] + noise[k]);
}
inline void Shape::stray_along(V3 f, Real* q) const {
    Real along[4];
    for (int k = 0; k < 4; ++k) along[k] = max(Real{}, absolute(dot(f, s.t[k])) + (least ? -s.t_rad[k] : s.t_rad[k]) + 4 * 0x1p-53 * s.t_size[k]);
    stray(along, q);
}
inline void Shape::stray_vaguely(Real* q) const {
    Real vague[4];
    for (int k = 0; k < 4; ++k) vague[k] = least ? -s.t_rad[k] : s.t_rad[k];
    stray(vague, q);
}

inline Real Shape::parametric(const Real* q) const {
    const Mask unit = absolute(dot(n, n) - 1.0) < 4e-15;
    const Real first = select(absolute(n.x) < 0.6, number(1), Real{});
    const V3 across = cross(V3{first, 1.0 - first, Real{}}, n), t = across / length(across), other = cross(n, t);
    const Real zero{}, one = number(1);
    const V3 frame[3] = {select(unit, n, V3{zero, zero, one}), select(unit, t, V3{one, zero, zero}), select(unit, other, V3{zero, one, zero})};
    Real most[3];
    for (int f = 0; f < 3; ++f) {
        const Real along[3] = {dot(frame[f], b[0]), dot(frame[f], b[1]), dot(frame[f], b[2])};
        most[f] = largest_form(along, least ? q : noise);
    }
    return safe(0.5 * (length_up(most[0], most[1], most[2]) + simplex_maximum(q[0], q[1], q[2])));
}

struct Result {
    Real parametric, normal, beside[3], across[3], tilt, turn, worst_edge, worst_turn, worst_across;
    V3 unit;
    Mask quiet;
};

inline void bound_shape(const Shape& shape, const LanesAsked& ask, Result& result) {
    const Real none = number(TriangleBound::none);
    const bool least = shape.least;
    const Model& s = shape.s;
    Real size[4], q[3], bend[3];
    for (int k = 0; k < 4; ++k) size[k] = least ? max(Real{}, s.t_size[k] - 2.0 * s.t_rad[k]) : s.t_size[k];
    shape.stray(size, q);
    for (int k = 0; k < 3; ++k) bend[k] = safe(length(shape.b[k]) + q[k]);
    const Mask planar = shape.flat & (Real{} == number(ask.measure == Measure::geometric ? 0 : 1));
    result.worst_across = choose_edge(bend, shape.uu, shape.vv);
    const V3 n = shape.n;
    const Real slack = shape.slack, longest = shape.longest;
    result.tilt = safe((8.1 * slack * (longest + slack) + 33 * 0x1p-53 * longest * longest) * shape.per_area + 6 * 0x1p-53);
    result.turn = none, result.worst_turn = Real{};
    if (ask.turns && !least) result.turn = turn_of(n, shape.x, shape.b, q, shape.side, slack, result.worst_turn);
    Real qn[3], bn[3], score[3], lens[3];
    shape.stray_along(n, qn);
    for (int k = 0; k < 3; ++k) bn[k] = dot(n, shape.b[k]), score[k] = absolute(bn[k]) + qn[k];
    result.worst_edge = select(planar, choose_edge(score, shape.uu, shape.vv), result.worst_across);
    Mask quiet = planar & (result.tilt <= 1e-3);
    for (int k = 0; k < 3; ++k) {
        const Flat from = shape.uv[k], to = shape.uv[kNext[k]], e{to.x - from.x, to.y - from.y}, m = shape.middle;
        const double sign = least ? -1 : 1;
        Real r[4];
        for (int i = 0; i < 4; ++i) r[i] = least ? Real{} : s.t_rad[i];
        const Real off = shape.uu[k] * (s.h_rad[0] * sign + r[0] * shape.ru + r[1] * shape.rv) + 2.0 * absolute(shape.uv_[k]) * (s.h_rad[1] * sign + r[1] * shape.ru + r[2] * shape.rv) +
                         shape.vv[k] * (s.h_rad[2] * sign + r[2] * shape.ru + r[3] * shape.rv);
        const V3 middle = shape.b[k] + shape.third(e, {0.5 * ((from.x - m.x) + (to.x - m.x)), 0.5 * ((from.y - m.y) + (to.y - m.y))}), end = 0.5 * shape.third(e, e);
        const Real rest = max(Real{}, off) + 8.0 * shape.noise[k];
        const V3 inward = (1.0 / shape.side[k]) * cross(n, shape.x[k]);
        const Real largest = safe(length(middle) + length(end) + rest);
        const Real along_inward = absolute(dot(inward, middle)) + absolute(dot(inward, end)) * kThird + rest, along_n = absolute(dot(n, middle)) + absolute(dot(n, end)) * kThird + rest;
        const Real across = safe(along_inward + 2.0 * result.tilt * largest);
        lens[k] = safe(across + 0.32 * (along_n + result.tilt * largest)) * shape.side[k] / (2.0 * shape.side[k] - largest);
        quiet = quiet & (largest <= shape.side[k]) & (bend[k] <= 1.5 * longest);
        result.across[k] = safe(0.125 * across);
    }
    for (int c = 0; c < 3; ++c) {
        const int before = kNext[kNext[c]];
        quiet = quiet & ((lens[c] * shape.side[before] + lens[before] * shape.side[c]) * kSafe <= 2 * kLens * shape.twice_area);
    }
    quiet = quiet & keeps_orientation(n, shape.x, shape.b, q, bend, shape.side, result.tilt);
    result.parametric = safe(0.5 * simplex_maximum(bend[0], bend[1], bend[2]));
    if (any(~quiet)) {
        const Real sharp = shape.parametric(q);
        result.parametric = select(quiet, result.parametric, select(planar, min(result.parametric, sharp), sharp));
    }
    const Cubic cubic = cubic_of(n, bn, s.t, shape.uv, shape.middle);
    Real off[3];
    shape.stray_vaguely(off);
    const Real rounding = shape.rounding() + result.tilt * result.parametric;
    result.normal = safe(min(0.5 * largest_form(bn, qn), cubic.largest(off)) + rounding);
    for (int k = 0; k < 3; ++k) {
        const Real wide = safe(1.06 * result.parametric * shape.side[k] * shape.per_area);
        result.beside[k] = select(quiet, min(result.normal, safe(cubic.beside(k, off, wide) + rounding)), none);
        result.across[k] = select(quiet, result.across[k], Real{});
    }
    result.normal = select(quiet, result.normal, none);
    result.unit = select(planar, n, V3{Real{}, Real{}, Real{}});
    result.tilt = select(planar, result.tilt, none), result.turn = select(planar, result.turn, none);
    result.worst_turn = select(planar, result.worst_turn, Real{});
    result.quiet = quiet;
}

void bound_lanes(const PolynomialForm& form, const TriangleLanes& in, int n, const LanesAsked& ask, TriangleBound* out) {
    for (int lane = 0; lane < n; lane += ISOPARM_LANES) {
        Real u[3], v[3];
        for (int k = 0; k < 3; ++k) u[k] = load(in.u[k] + lane), v[k] = load(in.v[k] + lane);
        const Range box_u{min(min(u[0], u[1]), u[2]), max(max(u[0], u[1]), u[2])}, box_v{min(min(v[0], v[1]), v[2]), max(max(v[0], v[1]), v[2])};
        Model model;
        model_of(form, box_u, box_v, ask.parts, model);
        Result r;
        bound_shape(Shape(model, in, lane, box_u, box_v, ask.least), ask, r);
        for (int i = 0; i < ISOPARM_LANES && lane + i < n; ++i) {
            TriangleBound& b = out[lane + i];
            b = {};
            if (!model.bounded[i]) continue;
            b.parametric = r.parametric[i], b.normal = r.normal[i], b.tilt = r.tilt[i], b.turn = r.turn[i], b.quiet = r.quiet[i] != 0;
            for (int k = 0; k < 3; ++k) b.beside[k] = r.beside[k][i], b.across[k] = r.across[k][i];
            b.unit = {r.unit.x[i], r.unit.y[i], r.unit.z[i]};
            b.worst_edge = int(r.worst_edge[i]), b.worst_turn = int(r.worst_turn[i]), b.worst_across = int(r.worst_across[i]);
        }
    }
}
