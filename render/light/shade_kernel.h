// shade_kernel.h -- the arithmetic of figures' light, surfels side by side; internal to shade.cpp.
//
// Each loop is compiled for several instruction sets, which give the same bits. A surfel's numbers do not depend on those beside it.
#pragma once
#include "batch.h"
#include "light/local_frame.h"
#include "light/studio.h"

namespace isoparm {

/// Lanes beyond the last surfel must hold some surfel too.
struct SurfelPacket {
    static constexpr int lanes = 16;
    alignas(64) double normal[3][lanes], view[3][lanes], color[3][lanes];
    double at_key[2][lanes], at_sky[2][lanes];      // points of the square, for the disc of the key light and for the sky
    double to_key[3][lanes], to_sky[3][lanes];      // unit
    double cosine[lanes];                           // of the normal and to_key
    double sky[3][lanes];                           // radiance from to_sky
    double key_light[lanes], sky_light[lanes];      // the part of light that comes from there
    double out[3][lanes];                           // light toward the viewer
};

struct ShadeKernel {
    /// Sets to_key, to_sky, cosine and sky. `key`: the frame of the key light.
    void (*directions)(const Studio& studio, const LocalFrame& key, SurfelPacket& p);
    /// Sets out.
    void (*colors)(SurfelPacket& p);
};
const ShadeKernel& shade_kernel(Isa isa);

constexpr double kBounce = 0.55;  // of the sky's light that comes back from what hides it

}  // namespace isoparm
