// second_derivatives_lanes_kernel.h -- lanes of numbers, and PolynomialCell's SecondDerivatives on them; the first part of triangle_lanes_kernel.h.

typedef double Real __attribute__((vector_size(ISOPARM_LANES * 8)));
typedef decltype(Real{} < Real{}) Mask;

inline Real number(double x) { return x - Real{}; }
inline Real select(Mask m, Real a, Real b) { return m ? a : b; }
inline Mask choose(Mask m, Mask a, Mask b) { return (m & a) | (~m & b); }
inline Real max(Real a, Real b) { return select(a < b, b, a); }
inline Real min(Real a, Real b) { return select(b < a, b, a); }
inline Real absolute(Real a) { return (Real)((Mask)a & 0x7fffffffffffffff); }
inline bool any(Mask m) {
    bool found = false;
    for (int i = 0; i < ISOPARM_LANES; ++i) found = found || m[i];
    return found;
}
inline Real load(const double* x) {
    Real r;
    std::memcpy(&r, x, sizeof r);
    return r;
}

inline Real up(Real x) { return select(x == 0.0, Real{}, x + (absolute(x) * rounding::kUnit + rounding::kTiny)); }
inline Real safe(Real x) { return x * kSafe + kUnderflow; }
inline Real length_up(Real x, Real y, Real z) {
    const Real squares = up(up(up(x * x) + up(y * y)) + up(z * z));
    return select(squares < 1e-280, up(up(x + y) + z), up(square_root(squares)));
}

struct V3 {
    Real x, y, z;
};
inline V3 operator+(V3 a, V3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline V3 operator-(V3 a, V3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline V3 operator*(Real s, V3 a) { return {s * a.x, s * a.y, s * a.z}; }
inline V3 operator*(double s, V3 a) { return {s * a.x, s * a.y, s * a.z}; }
inline V3 operator/(V3 a, Real s) { return {a.x / s, a.y / s, a.z / s}; }
inline Real dot(V3 a, V3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline V3 cross(V3 a, V3 b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
inline Real length(V3 a) { return square_root(dot(a, a)); }
inline V3 select(Mask m, V3 a, V3 b) { return {select(m, a.x, b.x), select(m, a.y, b.y), select(m, a.z, b.z)}; }
inline Real size_of(V3 a) { return length_up(absolute(a.x), absolute(a.y), absolute(a.z)); }

inline Real simplex_maximum(Real a, Real b, Real c) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    const Mask nan = (a != a) | (b != b) | (c != c);
    const Real largest = max(max(a, b), c), edge = largest / 4.0, slack = -1e-12 * largest;
    const Mask finite = largest < infinity;
    const Mask concave = (min(min(a, b), c) > 0.0) & finite & ~((a + c - b < slack) | (a + b - c < slack) | (b + c - a < slack));
    const Real third = up(largest * kThird), scale = 1.0 / largest;
    const Real p = max(a * scale, number(1e-7)), q = max(b * scale, number(1e-7)), r = max(c * scale, number(1e-7));
    const Real D = 2.0 * (p * q + q * r + r * p) - (p * p + q * q + r * r);
    const Real inner = select((scale < infinity) & (D > 3e-7), max(edge, min(third, largest * (p * q * r / D) * (1 + 2e-8))), third);
    const Real bound = select(concave, inner, select(finite, edge, number(infinity)));
    return select(nan, number(infinity), select(largest <= 0.0, Real{}, bound));
}
inline Real largest_form(const Real* b, const Real* q) {
    return max(simplex_maximum(q[0] + b[0], q[1] + b[1], q[2] + b[2]), simplex_maximum(q[0] - b[0], q[1] - b[1], q[2] - b[2]));
}

// second_derivatives.cpp

struct Range {
    Real lo, hi;
};
inline Real mid(Range x) {
    const Real m = 0.5 * x.lo + 0.5 * x.hi;
    return select(m < x.lo, x.lo, select(x.hi < m, x.hi, m));
}
inline Range cut(Range x, int k, int parts) {
    const Real low = k == 0 ? x.lo : x.lo + (x.hi - x.lo) * double(k) / double(parts);
    return {low, k + 1 == parts ? x.hi : x.lo + (x.hi - x.lo) * double(k + 1) / double(parts)};
}

struct Model {
    V3 h[3], t[4];
    Real h_rad[3], t_rad[4], t_size[4], h_size[3];
    Mask bounded;
};

inline Mask in_scale(Real half) { return (half == 0.0) | ((half >= 1e-25) & (half <= 1e60)); }

inline void add_sizes(Model& m, Real ru, Real rv) {
    for (int k = 0; k < 4; ++k) m.t_size[k] = safe(size_of(m.t[k]) + m.t_rad[k]);
    for (int k = 0; k < 3; ++k) m.h_size[k] = safe(absolute(m.h[k].x) + absolute(m.h[k].y) + absolute(m.h[k].z) + m.t_size[k] * ru + m.t_size[k + 1] * rv);
    const Real all = m.h_size[0] + m.h_size[1] + m.h_size[2] + m.t_size[0] + m.t_size[1] + m.t_size[2] + m.t_size[3] + m.h_rad[0] + m.h_rad[1] + m.h_rad[2];
    m.bounded = (all < kLargestDerivative) & in_scale(ru) & in_scale(rv);
}

/// P and Q are the degrees, or -1.
template <int P, int Q> inline void model_over(const PolynomialForm& form, Range box_u, Range box_v, Model& m, Real& ru, Real& rv) {
    constexpr int order = 4, size = PolynomialCell::max_degree + 1;
    const int p = P < 0 ? form.p : P, q = Q < 0 ? form.q : Q, stride = q + 1;
    const Real mu = mid(box_u), mv = mid(box_v);
    ru = up(max(box_u.hi - mu, mu - box_u.lo)), rv = up(max(box_v.hi - mv, mv - box_v.lo));
    V3 a[P < 0 ? size * size : (P + 1) * (Q + 1)];
    const Real du = mu - form.u, dv = mv - form.v;
    for (int n = 0; n < (p + 1) * stride; ++n) a[n] = {number(form.c[n][0]), number(form.c[n][1]), number(form.c[n][2])};
    for (int k = 0; k < p; ++k)
        for (int i = p - 1; i >= k; --i)
            for (int j = 0; j <= q; ++j) a[i * stride + j] = a[i * stride + j] + du * a[(i + 1) * stride + j];
    for (int i = 0; i <= p; ++i)
        for (int k = 0; k < q; ++k)
            for (int j = q - 1; j >= k; --j) a[i * stride + j] = a[i * stride + j] + dv * a[i * stride + j + 1];
    const V3 zero{Real{}, Real{}, Real{}};
    for (int k = 0; k < 3; ++k) {
        const double scale = k == 1 ? 1 : 2;
        const bool there = 2 - k <= p && k <= q;
        const int n = (2 - k) * stride + k;
        m.h[k] = there ? scale * a[n] : zero, m.h_rad[k] = safe(number(scale * (there ? form.error[n] : 0)));
    }
    Real power_u[size] = {number(1)}, power_v[size] = {number(1)};
    for (int k = 1; k < size; ++k) power_u[k] = power_u[k - 1] * ru, power_v[k] = power_v[k - 1] * rv;
    constexpr double factorial[order] = {1, 1, 2, 6};
    for (int k = 0; k < order; ++k) {
        const int i = 3 - k, j = k;
        const double scale = factorial[i] * factorial[j];
        const bool there = i <= p && j <= q;
        V3 middle = there ? a[i * stride + j] : zero, off = zero;
        Real rest = number(there ? form.error[i * stride + j] : 0);
        for (int s = i; s <= p; ++s)
            for (int t = s == i ? j + 1 : j; t <= q; ++t) {
                const V3& c = a[s * stride + t];
                const Real weight = max(kBinomial[s][i] * kBinomial[t][j] * power_u[s - i] * power_v[t - j], number(rounding::kTiny));
                const bool one_sided = (s - i) % 2 == 0 && (t - j) % 2 == 0;
                const Real half = one_sided ? 0.5 * weight : weight;
                if (one_sided) middle = middle + half * c;
                off = off + half * V3{absolute(c.x), absolute(c.y), absolute(c.z)};
                rest += weight * form.error[s * stride + t];
            }
        m.t[k] = scale * middle;
        const Real moved = 64 * 0x1p-53 * (absolute(middle.x) + absolute(middle.y) + absolute(middle.z) + off.x + off.y + off.z);
        m.t_rad[k] = safe(scale * (length_up(off.x, off.y, off.z) + rest + moved));
    }
    add_sizes(m, ru, rv);
}
inline void model_over(const PolynomialForm& form, Range u, Range v, Model& m, Real& ru, Real& rv) {
    if (form.p == 3 && form.q == 3) model_over<3, 3>(form, u, v, m, ru, rv);
    else model_over<-1, -1>(form, u, v, m, ru, rv);
}

inline void model_of(const PolynomialForm& form, Range u, Range v, int parts, Model& m) {
    Real ru, rv;
    model_over(form, u, v, m, ru, rv);
    if (parts == 1) return;
    Real most[4]{};
    for (int i = 0; i < parts; ++i)
        for (int j = 0; j < parts; ++j) {
            Model piece;
            Real pu, pv;
            model_over(form, cut(u, i, parts), cut(v, j, parts), piece, pu, pv);
            for (int k = 0; k < 4; ++k) most[k] = max(most[k], safe(size_of(piece.t[k] - m.t[k]) + piece.t_rad[k] + 0x1p-52 * (piece.t_size[k] + m.t_size[k])));
        }
    for (int k = 0; k < 4; ++k) m.t_rad[k] = min(m.t_rad[k], most[k]);
    add_sizes(m, ru, rv);
}
