// studio.h -- a key light, a fill and a sky that come with the camera, so that every figure is lit like the next one. A white sheet
// that faces the key light gets just about 1.
#pragma once
#include "picture/camera.h"

namespace isoparm {

struct Studio {
    using Color = Vec3<double>;
    explicit Studio(const Camera& camera);

    /// Radiance of sky and fill.
    Color sky(const Point& direction) const;

    static constexpr double key_radius = 0.13;  // tangent of half the width of the key light's disc: soft shadows
    static const Color key_light;               // irradiance over pi at right angles to the light
    static const Color sky_top, sky_side, sky_below, fill_light;  // radiances that sky() is made of
    Point up, key, fill;                        // unit, toward the lights
};

}  // namespace isoparm
