#include "batch/batch_kernel.h"

#include "batch/isa_loops.h"

namespace isoparm {
namespace {

/// Of one coordinate at one y: values and slopes in y of the rows sum_j c[i][j] y^j.
template <int N> struct Rows {
    double value[N + 1], slope[N + 1];
};
template <int N> ISOPARM_INLINE Rows<N> rows_at(const double* c, double y) {
    Rows<N> r;
#pragma GCC unroll 8
    for (int i = 0; i <= N; ++i) {
        double value = c[i * (N + 1) + N], slope = value;
#pragma GCC unroll 8
        for (int j = N - 1; j >= 0; --j) {
            if (j < N - 1) slope = slope * y + value;
            value = value * y + c[i * (N + 1) + j];
        }
        r.value[i] = value, r.slope[i] = slope;
    }
    return r;
}

struct Frame {
    double s, x, y;  // value, d/dx, d/dy
};
/// sum_i rows[i] x^i, by Horner's rule.
template <int N> ISOPARM_INLINE Frame along_x(const Rows<N>& rows, double x) {
    Frame f{rows.value[N], rows.value[N], rows.slope[N]};
#pragma GCC unroll 8
    for (int i = N - 1; i >= 0; --i) {
        if (i < N - 1) f.x = f.x * x + f.s;
        f.s = f.s * x + rows.value[i];
        f.y = f.y * x + rows.slope[i];
    }
    return f;
}

/// p / w, with w's reciprocal in w.s.
ISOPARM_INLINE Frame quotient(const Frame& p, const Frame& w) {
    const double s = p.s * w.s;
    return {s, (p.x - s * w.x) * w.s, (p.y - s * w.y) * w.s};
}

/// `row`: all points at v[0]. Pointers one by one, so that the compiler knows that they do not overlap.
template <int N, bool rational, bool row>
ISOPARM_INLINE void loop(const double* __restrict c, double middle_u, double middle_v, std::size_t n, const double* __restrict u,
                         const double* __restrict v, double* __restrict x, double* __restrict y, double* __restrict z, double* __restrict xu,
                         double* __restrict yu, double* __restrict zu, double* __restrict xv, double* __restrict yv, double* __restrict zv) {
    constexpr int size = (N + 1) * (N + 1);
    Rows<N> fixed[4];
    if constexpr (row)
        for (int axis = 0; axis < (rational ? 4 : 3); ++axis) fixed[axis] = rows_at<N>(c + axis * size, v[0] - middle_v);
    for (std::size_t k = 0; k < n; ++k) {
        const double s = u[k] - middle_u;
        const auto frame = [&](int axis) ISOPARM_INLINE_LAMBDA {
            if constexpr (row) return along_x<N>(fixed[axis], s);
            else return along_x<N>(rows_at<N>(c + axis * size, v[k] - middle_v), s);
        };
        Frame a = frame(0), b = frame(1), d = frame(2);
        if constexpr (rational) {
            Frame w = frame(3);
            w.s = 1 / w.s;
            a = quotient(a, w), b = quotient(b, w), d = quotient(d, w);
        }
        x[k] = a.s, y[k] = b.s, z[k] = d.s;
        xu[k] = a.x, yu[k] = b.x, zu[k] = d.x;
        xv[k] = a.y, yv[k] = b.y, zv[k] = d.y;
    }
}

#define ISOPARM_KERNEL(name, ...)                                                                                                \
    template <int N, bool rational, bool row>                                                                                    \
    __VA_ARGS__ void name(const double* c, double middle_u, double middle_v, std::size_t n, const double* u, const double* v,    \
                          double* const* o) {                                                                                    \
        loop<N, rational, row>(c, middle_u, middle_v, n, u, v, o[0], o[1], o[2], o[3], o[4], o[5], o[6], o[7], o[8]);            \
    }
ISOPARM_KERNEL(kernel_baseline)
#ifdef ISOPARM_ISA_LOOPS
ISOPARM_KERNEL(kernel_avx2, ISOPARM_FOR_AVX2)
ISOPARM_KERNEL(kernel_avx512, ISOPARM_FOR_AVX512)
#endif

template <int N, bool rational, bool row> BatchKernel kernel(Isa isa) {
#ifdef ISOPARM_ISA_LOOPS
    if (isa == Isa::avx512) return kernel_avx512<N, rational, row>;
    if (isa == Isa::avx2) return kernel_avx2<N, rational, row>;
#endif
    static_cast<void>(isa);
    return kernel_baseline<N, rational, row>;
}
template <int N> BatchKernel kernel(Isa isa, bool rational, bool row) {
    if (rational) return row ? kernel<N, true, true>(isa) : kernel<N, true, false>(isa);
    return row ? kernel<N, false, true>(isa) : kernel<N, false, false>(isa);
}

}  // namespace

BatchKernel batch_kernel(Isa isa, int degree, bool rational, bool row) {
    switch (degree) {
        case 1: return kernel<1>(isa, rational, row);
        case 2: return kernel<2>(isa, rational, row);
        case 3: return kernel<3>(isa, rational, row);
        case 5: return kernel<5>(isa, rational, row);
        case 7: return kernel<7>(isa, rational, row);
        default: return nullptr;
    }
}

bool runs(Isa isa) {
#ifdef ISOPARM_ISA_LOOPS
    if (isa == Isa::avx512) return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl");
    if (isa == Isa::avx2) return __builtin_cpu_supports("avx2");
#endif
    return isa == Isa::baseline;
}

}  // namespace isoparm
