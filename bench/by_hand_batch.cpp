#include "by_hand_batch.h"

#include <stdexcept>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace isoparm::bench {

#if defined(__x86_64__)
namespace {

/// Horner's rule in both directions with fused multiply-add, of which isoparm makes no use: results would differ between machines.
#define ISOPARM_LOOP(name, isa, lanes, Vector, p)                                                                              \
    [[gnu::target(isa)]] void name(const HandBicubic& s, std::size_t n, const double* u, const double* v, double* const (&x)[9]) { \
        for (std::size_t k = 0; k < n; k += lanes) {                                                                           \
            const Vector a = p##_loadu_pd(u + k), b = p##_loadu_pd(v + k);                                                     \
            for (int axis = 0; axis < 3; ++axis) {                                                                             \
                Vector row[4], slope[4];                                                                                       \
                for (int i = 0; i < 4; ++i) {                                                                                  \
                    const auto& c = s.c[axis][i];                                                                              \
                    const Vector c3 = p##_set1_pd(c[3]), r2 = p##_fmadd_pd(c3, b, p##_set1_pd(c[2]));                          \
                    const Vector r1 = p##_fmadd_pd(r2, b, p##_set1_pd(c[1]));                                                  \
                    row[i] = p##_fmadd_pd(r1, b, p##_set1_pd(c[0]));                                                           \
                    slope[i] = p##_fmadd_pd(p##_fmadd_pd(c3, b, r2), b, r1);                                                   \
                }                                                                                                              \
                const Vector s2 = p##_fmadd_pd(row[3], a, row[2]), s1 = p##_fmadd_pd(s2, a, row[1]);                           \
                p##_storeu_pd(x[axis] + k, p##_fmadd_pd(s1, a, row[0]));                                                       \
                p##_storeu_pd(x[3 + axis] + k, p##_fmadd_pd(p##_fmadd_pd(row[3], a, s2), a, s1));                              \
                const Vector t1 = p##_fmadd_pd(p##_fmadd_pd(slope[3], a, slope[2]), a, slope[1]);                              \
                p##_storeu_pd(x[6 + axis] + k, p##_fmadd_pd(t1, a, slope[0]));                                                 \
            }                                                                                                                  \
        }                                                                                                                      \
    }
ISOPARM_LOOP(frames_avx2, "avx2,fma", 4, __m256d, _mm256)
ISOPARM_LOOP(frames_avx512, "avx512f", 8, __m512d, _mm512)

}  // namespace

void frames(Isa isa, const HandBicubic& s, std::size_t n, const double* u, const double* v, double* const (&x)[9]) {
    if (n % 8 != 0 || isa == Isa::baseline) throw std::logic_error("no loop for this");
    (isa == Isa::avx512 ? frames_avx512 : frames_avx2)(s, n, u, v, x);
}
#else
void frames(Isa, const HandBicubic&, std::size_t, const double*, const double*, double* const (&)[9]) { throw std::logic_error("no loop for this"); }
#endif

}  // namespace isoparm::bench
