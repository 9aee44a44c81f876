#include "light/sample_points.h"

#include <cmath>
#include <cstdint>

#include "batch.h"
#include "batch/isa_loops.h"

namespace isoparm {
namespace {

constexpr int kLanes = kSamplePacket;

struct Points {
    alignas(64) std::uint32_t seed[kLanes];
    std::uint32_t sample[kLanes];
    int bits;
    double x[kLanes], y[kLanes];
};

ISOPARM_INLINE std::uint32_t reversed(std::uint32_t x) {
    x = ((x >> 1) & 0x55555555u) | ((x & 0x55555555u) << 1);
    x = ((x >> 2) & 0x33333333u) | ((x & 0x33333333u) << 2);
    x = ((x >> 4) & 0x0f0f0f0fu) | ((x & 0x0f0f0f0fu) << 4);
    x = ((x >> 8) & 0x00ff00ffu) | ((x & 0x00ff00ffu) << 8);
    return (x >> 16) | (x << 16);
}
/// sampling::owen_scrambled() of what is reversed already, likewise.
ISOPARM_INLINE std::uint32_t scrambled(std::uint32_t x, std::uint32_t seed) {
    x ^= x * 0x3d20adeau;
    x += seed;
    x *= (seed >> 16) | 1;
    x ^= x * 0x05526c56u;
    return x ^ (x * 0x53a22864u);
}
ISOPARM_INLINE std::uint32_t mixed(std::uint32_t x) {
    x = (x ^ (x >> 16)) * 0x7feb352du;
    x = (x ^ (x >> 15)) * 0x846ca68bu;
    return x ^ (x >> 16);
}

/// Backwards: the scrambling of the index and the matrix of Sobol' run from the lowest bit of what is reversed, so that only what is looked at from the front has to be turned.
ISOPARM_INLINE void points_loop(Points& p) {
    const int shift = 32 - p.bits;
    std::uint32_t turned[kLanes], index[kLanes] = {}, y[kLanes] = {};
    for (int i = 0; i < kLanes; ++i) turned[i] = scrambled(reversed(p.sample[i]) >> shift, p.seed[i]);
    for (std::uint32_t bit = 0, v = 1; bit < static_cast<std::uint32_t>(p.bits); ++bit, v ^= v << 1)
        for (int i = 0; i < kLanes; ++i) {
            const std::uint32_t all = 0 - (turned[i] >> (p.bits - 1 - bit) & 1);
            index[i] |= all & (1u << bit), y[i] ^= all & v;
        }
    for (int i = 0; i < kLanes; ++i) {
        p.x[i] = reversed(scrambled(index[i], mixed(p.seed[i] ^ 0x68bc21ebu))) * 0x1p-32;
        p.y[i] = reversed(scrambled(y[i], mixed(p.seed[i] ^ 0x02e5be93u))) * 0x1p-32;
    }
}

/// Camera::ray() of perspective cameras, of directions that are pixels aside.
ISOPARM_INLINE void directions_loop(const Point& right, const Point& up, const Point& forward, double scale, RayLanes& d) {
    for (int i = 0; i < kLanes; ++i) {
        const double a = scale * d.direction[0][i], b = scale * d.direction[1][i];
        const double x = forward.x + (a * right.x - b * up.x), y = forward.y + (a * right.y - b * up.y), z = forward.z + (a * right.z - b * up.z);
        const double size = std::sqrt(x * x + y * y + z * z);
        d.direction[0][i] = x / size, d.direction[1][i] = y / size, d.direction[2][i] = z / size;
    }
}

void points(Points& p) { points_loop(p); }
void directions(const Point& right, const Point& up, const Point& forward, double scale, RayLanes& d) { directions_loop(right, up, forward, scale, d); }
#ifdef ISOPARM_ISA_LOOPS
ISOPARM_FOR_AVX2 void kernel_avx2_points(Points& p) { points_loop(p); }
ISOPARM_FOR_AVX512 void kernel_avx512_points(Points& p) { points_loop(p); }
ISOPARM_FOR_AVX2 void kernel_avx2_directions(const Point& right, const Point& up, const Point& forward, double scale, RayLanes& d) { directions_loop(right, up, forward, scale, d); }
ISOPARM_FOR_AVX512 void kernel_avx512_directions(const Point& right, const Point& up, const Point& forward, double scale, RayLanes& d) { directions_loop(right, up, forward, scale, d); }
#endif

}  // namespace

void sample_points(const SampleOf* of, const int* dimension, int n, Vec2* out) {
    if (n == 0) return;
    Points p;
    p.bits = of[0].sampler->bits();
    for (int i = 0; i < kLanes; ++i) {
        const SampleOf& one = of[i < n ? i : 0];
        p.sample[i] = static_cast<std::uint32_t>(one.number);
        p.seed[i] = one.sampler->seed_of(dimension[i < n ? i : 0]);
    }
    switch (chosen_isa()) {
#ifdef ISOPARM_ISA_LOOPS
        case Isa::avx512: kernel_avx512_points(p); break;
        case Isa::avx2: kernel_avx2_points(p); break;
#endif
        default: points(p);
    }
    for (int i = 0; i < n; ++i) out[i] = {p.x[i], p.y[i]};
}

void camera_rays(const Camera& camera, const Vec2* at, int n, RayLanes& out) {
    if (camera.orthographic) {
        for (int i = 0; i < kLanes; ++i) out.set(i, camera.ray(at[i < n ? i : 0].x, at[i < n ? i : 0].y));
        return;
    }
    for (int i = 0; i < kLanes; ++i) {
        const Vec2& p = at[i < n ? i : 0];
        out.direction[0][i] = p.x - camera.shift.x - 0.5 * camera.width, out.direction[1][i] = p.y - camera.shift.y - 0.5 * camera.height;
        for (int k = 0; k < 3; ++k) out.origin[k][i] = camera.eye[k];
    }
    const double scale = 2 * camera.half_height / camera.height;
    switch (chosen_isa()) {
#ifdef ISOPARM_ISA_LOOPS
        case Isa::avx512: kernel_avx512_directions(camera.right, camera.up, camera.forward, scale, out); break;
        case Isa::avx2: kernel_avx2_directions(camera.right, camera.up, camera.forward, scale, out); break;
#endif
        default: directions(camera.right, camera.up, camera.forward, scale, out);
    }
}

}  // namespace isoparm
