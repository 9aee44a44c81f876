// exact_loops.h -- the loops of exact_kernel.h, in vectors of ISOPARM_LANES doubles. exact_kernel.cpp includes this once for each instruction
// set, in a namespace of its own and where the compiler may use that instruction set: hence neither #pragma once nor other headers here.

constexpr int kLanes = ISOPARM_LANES;
typedef double V __attribute__((vector_size(kLanes * sizeof(double))));
typedef std::int64_t I __attribute__((vector_size(kLanes * sizeof(double))));
typedef double InDoubles __attribute__((vector_size(kLanes * sizeof(double)), aligned(alignof(double)), may_alias));
typedef std::int64_t InIntegers __attribute__((vector_size(kLanes * sizeof(double)), aligned(alignof(double)), may_alias));

inline V load(const double* x) { return *reinterpret_cast<const InDoubles*>(x); }
inline I load(const std::int64_t* x) { return *reinterpret_cast<const InIntegers*>(x); }
inline void store(const V& x, double* to) { *reinterpret_cast<InDoubles*>(to) = x; }
inline void store(const I& x, std::int64_t* to) { *reinterpret_cast<InIntegers*>(to) = x; }
inline V all(double x) { return x - V{}; }
inline I all(std::int64_t x) { return x - I{}; }
inline V magnitude(const V& x) { return (V)((I)x & INT64_MAX); }
inline V larger(const V& x, const V& y) { return x > y ? x : y; }
inline V smaller(const V& x, const V& y) { return x < y ? x : y; }
inline V clamped(const V& x, double low, double high) { return smaller(larger(x, all(low)), all(high)); }
inline bool any(const I& x) {
    std::int64_t r = 0;
    for (int k = 0; k < kLanes; ++k) r |= x[k];
    return r != 0;
}
/// At least the length of (x,y), and at most 1.12 times that: (m + n/2)^2 >= m^2 + n^2 where m >= n >= 0.
inline V length_up(const V& x, const V& y) {
    const V a = magnitude(x), b = magnitude(y);
    return larger(a, b) + 0.5 * smaller(a, b);
}

struct V3 {
    V x, y, z;
};
inline V3 load(const double (*d)[RayPacket::lanes], int i) { return {load(&d[0][i]), load(&d[1][i]), load(&d[2][i])}; }
inline V dot(const V3& d, const V3& e) { return d.x * e.x + d.y * e.y + d.z * e.z; }
inline V dot(const V3& d, const Point& e) { return d.x * e.x + d.y * e.y + d.z * e.z; }

typedef float F __attribute__((vector_size(kLanes * sizeof(float))));
typedef float InFloats __attribute__((vector_size(kLanes * sizeof(float)), aligned(alignof(float)), may_alias));
inline void store(const V& x, float* to) { *reinterpret_cast<InFloats*>(to) = __builtin_convertvector(x, F); }

inline void enter(const Ray* rays, std::uint32_t active, int lanes, const Point& centre, double radius, double* start, const FloatRays& to, RayPacket* packet) {
    const int first = __builtin_ctz(active);
    for (int i = 0; i < lanes; i += kLanes) {
        V3 origin, d;
        V reach;
        for (int k = 0; k < kLanes; ++k) {
            const Ray& ray = rays[active >> (i + k) & 1 ? i + k : first];
            origin.x[k] = ray.origin.x, origin.y[k] = ray.origin.y, origin.z[k] = ray.origin.z;
            d.x[k] = ray.direction.x, d.y[k] = ray.direction.y, d.z[k] = ray.direction.z;
            reach[k] = ray.reach;
        }
        const V3 o{origin.x - centre.x, origin.y - centre.y, origin.z - centre.z};
        const V before = -dot(o, d) - 1.01 * radius, s = dot(o, o) <= radius * radius ? V{} : larger(before, V{});
        store(s, &start[i]);
        store(o.x + s * d.x, to.org_x + i), store(o.y + s * d.y, to.org_y + i), store(o.z + s * d.z, to.org_z + i);
        store(d.x, to.dir_x + i), store(d.y, to.dir_y + i), store(d.z, to.dir_z + i);
        store(larger(reach - s, V{}), to.tfar + i);
        if (!packet) continue;
        store(origin.x + s * d.x, &packet->origin[0][i]), store(origin.y + s * d.y, &packet->origin[1][i]), store(origin.z + s * d.z, &packet->origin[2][i]);
        store(d.x, &packet->direction[0][i]), store(d.y, &packet->direction[1][i]), store(d.z, &packet->direction[2][i]);
    }
}

/// Duff et al., JCGT 2017.
inline void planes(int n, RayPacket& r) {
    for (int i = 0; i < n; i += kLanes) {
        const V3 d = load(r.direction, i);
        const V s = d.z < 0 ? all(-1.0) : all(1.0), a = -1 / (s + d.z), b = d.x * d.y * a;
        store(1 + s * d.x * d.x * a, &r.n1[0][i]), store(s * b, &r.n1[1][i]), store(-s * d.x, &r.n1[2][i]);
        store(b, &r.n2[0][i]), store(s + d.y * d.y * a, &r.n2[1][i]), store(-d.y, &r.n2[2][i]);
    }
}

inline void aim(const LeafMap& l, const RayPacket& r, double border, const double* farthest, int n, AimPacket& out) {
    for (int i = 0; i < n; i += kLanes) {
        const V3 o = load(r.origin, i), direction = load(r.direction, i), n1 = load(r.n1, i), n2 = load(r.n2, i), to{l.s.x - o.x, l.s.y - o.y, l.s.z - o.z};
        const V f1 = dot(n1, to), f2 = dot(n2, to), d = dot(direction, to);
        const V a1 = dot(n1, l.a), a2 = dot(n2, l.a), b1 = dot(n1, l.b), b2 = dot(n2, l.b);
        const V reach = magnitude(dot(direction, l.a)) + magnitude(dot(direction, l.b)), size_to = magnitude(to.x) + magnitude(to.y) + magnitude(to.z);
        const V bend = (l.bend + border) + kRounding * size_to;
        // Seen from the ray, the leaf is a parallelogram, grown by bend: across its sides too, also where it is seen edge on. This is K(X)
        // that does not meet X, times det.
        const V det = a1 * b2 - a2 * b1, size = magnitude(det), a = length_up(a1, a2), b = length_up(b1, b2);
        const V af = a2 * f1 - a1 * f2, bf = b1 * f2 - b2 * f1;
        const I missed = (magnitude(f1) > magnitude(a1) + magnitude(b1) + bend) | (magnitude(f2) > magnitude(a2) + magnitude(b2) + bend) |
                         (d + reach + bend < 0) | (d - reach - bend > load(&farthest[i])) | (magnitude(bf) > size + b * bend) | (magnitude(af) > size + a * bend);
        store(missed ? all(AimPacket::miss) : all(AimPacket::open), &out.verdict[i]);
        if (!any(~missed)) continue;
        const V inverse = 1 / det, of_size = magnitude(inverse);
        const V q = (b * l.turn_u + a * l.turn_v) * of_size;  // |Y (J - J(c))| <= (b, a) (turn_u, turn_v) / det, entry by entry: of rank 1
        const I one = (q < kRegular) & (size > kEdgeOn * a * b) & ~missed;
        store(one ? all(AimPacket::one) : missed ? all(AimPacket::miss) : all(AimPacket::open), &out.verdict[i]);
        store(b2 * inverse, &out.y11[i]), store(-b1 * inverse, &out.y12[i]), store(-a2 * inverse, &out.y21[i]), store(a1 * inverse, &out.y22[i]);
        store(bf * inverse, &out.x[i]), store(af * inverse, &out.y[i]);
        store(b, &out.wx[i]), store(a, &out.wy[i]), store(1 / b, &out.per_wx[i]), store(1 / a, &out.per_wy[i]);
        store(1 / (1 - q), &out.growth[i]), store(border * of_size, &out.slack[i]), store(1e-15 * (size_to + l.size_s) * of_size, &out.noise[i]);
    }
}

/// The parameters of (x,y), or of the nearest place in the leaf and the domain.
inline void place(const LeafMap& l, const V& x, const V& y, int i, NewtonPacket& p) {
    const V cx = clamped(x, -1, 1), cy = clamped(y, -1, 1);
    const V u = clamped(l.u + cx * l.hu, l.box.u.lo, l.box.u.hi), v = clamped(l.v + cy * l.hv, l.box.v.lo, l.box.v.hi);
    store(x, &p.x[i]), store(y, &p.y[i]), store(cx, &p.cx[i]), store(u, &p.u[i]);
    const I beyond = (u + v > 1) & (l.slanted ? all(std::int64_t(-1)) : all(std::int64_t(0)));
    store(beyond ? ((1 - u) - l.v) / l.hv : cy, &p.cy[i]), store(beyond ? 1 - u : v, &p.v[i]);
}

inline void begin(const LeafMap& l, const AimPacket& aim, int n, NewtonPacket& p) {
    for (int i = 0; i < n; i += kLanes) {
        const I one = load(&aim.verdict[i]) == all(AimPacket::one);
        store(one ? all(NewtonPacket::active) : all(NewtonPacket::gone), &p.state[i]);
        store(all(kInfinity), &p.before[i]);
        place(l, one ? clamped(load(&aim.x[i]), -1, 1) : V{}, one ? clamped(load(&aim.y[i]), -1, 1) : V{}, i, p);
    }
}

/// Beyond the leaf, S goes on as S(nearest place) + a (x - cx) + b (y - cy), whose difference quotients have the same bounds.
/// A lane that is done keeps its x and y, and so all its numbers.
inline bool step(const LeafMap& l, const RayPacket& r, const AimPacket& aim, bool newton, int n, NewtonPacket& p) {
    const double skew = l.hu / l.hv;
    I left{};
    for (int i = 0; i < n; i += kLanes) {
        const I was = load(&p.state[i]);
        if (!any(was == all(NewtonPacket::active))) continue;
        const V x = load(&p.x[i]), y = load(&p.y[i]), px = x - load(&p.cx[i]), py = y - load(&p.cy[i]);
        const V3 o = load(r.origin, i), n1 = load(r.n1, i), n2 = load(r.n2, i), s = load(p.frame, i), su = load(p.frame + 3, i), sv = load(p.frame + 6, i);
        const V3 to{s.x - o.x + px * l.a.x + py * l.b.x, s.y - o.y + px * l.a.y + py * l.b.y, s.z - o.z + px * l.a.z + py * l.b.z};
        const V f1 = dot(n1, to), f2 = dot(n2, to);
        const V wx = load(&aim.wx[i]), wy = load(&aim.wy[i]), noise = load(&aim.noise[i]);
        const V sx = load(&aim.y11[i]) * f1 + load(&aim.y12[i]) * f2, sy = load(&aim.y21[i]) * f1 + load(&aim.y22[i]) * f2;
        const V mx = magnitude(sx) * load(&aim.per_wx[i]), my = magnitude(sy) * load(&aim.per_wy[i]), move = larger(mx, my), before = load(&p.before[i]);
        store(dot(load(r.direction, i), to), &p.distance[i]), store(sx, &p.step_x[i]), store(sy, &p.step_y[i]);

        const I known = mx + my < kInfinity;                                      // the formula has a value here
        const V wide = move * load(&aim.growth[i]) + load(&aim.slack[i]);  // the root is that close, the border counted
        const I slanted = l.slanted ? all(std::int64_t(-1)) : all(std::int64_t(0));
        const I gone = (magnitude(x) > 1 + wide * wx) | (magnitude(y) > 1 + wide * wy) | (slanted & (py > wide * (wy + skew * wx)));
        const I there = (move <= noise) | ((move < 1e3 * noise) & (move > 0.25 * before));
        const I going = (was == all(NewtonPacket::active)) & known & ~gone & ~there;
        const I end = ~known ? all(NewtonPacket::undecided) : gone ? all(NewtonPacket::gone) : there ? all(NewtonPacket::found) : all(NewtonPacket::active);
        store(was == all(NewtonPacket::active) ? end : was, &p.state[i]);

        const I in_u = px == 0, in_v = py == 0;
        const V a1 = in_u ? l.hu * dot(n1, su) : dot(n1, l.a), a2 = in_u ? l.hu * dot(n2, su) : dot(n2, l.a);
        const V b1 = in_v ? l.hv * dot(n1, sv) : dot(n1, l.b), b2 = in_v ? l.hv * dot(n2, sv) : dot(n2, l.b);
        const V inverse = 1 / (a1 * b2 - a2 * b1), dx = (b2 * f1 - b1 * f2) * inverse, dy = (a1 * f2 - a2 * f1) * inverse;
        const I usable = (newton ? all(std::int64_t(-1)) : all(std::int64_t(0))) & (magnitude(dx) + magnitude(dy) < kInfinity);
        store(going ? move : before, &p.before[i]);
        place(l, going ? x - (usable ? dx : sx) : x, going ? y - (usable ? dy : sy) : y, i, p);
        left |= going;
    }
    return any(left);
}

constexpr ExactKernel kernel{enter, planes, aim, begin, step};
