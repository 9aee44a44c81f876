// light.h -- what light comes from and how surfaces scatter it, as a scene says it. Radiances and irradiances are linear RGB.
#pragma once
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "scalar/vec.h"

namespace isoparm {

/// How traced light (docs/light.md) is scattered. The colour is the object's.
struct Material {
    enum class Kind {
        diffuse,  // Lambert
        plastic,  // a rough dielectric coat over it
        metal,    // the colour is what it reflects at right angles
        glass     // smooth; the colour is what passes
    } kind = Kind::plastic;
    double roughness = 0.3;  // 0: a mirror; the width of the GGX distribution is its square. Not of diffuse and glass
    double ior = 1.5;        // of plastic and glass, above 1
    bool thin = false;       // glass: a sheet, which does not bend light, instead of the border of a body
};

struct Light {
    enum class Kind {
        studio,       // what comes with the camera: a soft key light, a sky, a fill
        environment,  // from all directions
        directional,  // from far away: a disc of the sky, or one direction
        sphere,
        rectangle     // shines on the side of edges[0] x edges[1]
    } kind = Kind::studio;
    Vec3<double> power{1, 1, 1};  // studio: factor; environment, sphere, rectangle: radiance; directional: irradiance at right angles to it
    Point at;                     // sphere: centre; rectangle: corner
    Point direction{0, 0, 1};     // directional: unit, toward the light; environment: unit, up in its image
    std::string image;            // environment: the path of an image of it (environment.h), times `power`; empty: the same from everywhere
    std::string place;            // of the image in the scene's file, for messages
    double turn = 0;              // radians, about `direction`, of the image
    bool seen = false;            // environment: by the camera, where nothing is
    double radius = 0;            // sphere: scene units; directional: radians, half the width of the disc, 0 for one direction
    std::array<Point, 2> edges;   // rectangle
};

/// Traced light instead of the figures' own.
struct LightingSettings {
    int bounces = 8;        // after the first surface; 0: direct light only
    bool caustics = false;  // what lights of some place throw by mirrors and through glass onto other surfaces
    enum class Fireflies { keep, spread } fireflies = Fireflies::keep;  // single bright pixels (fireflies.h)
    std::vector<Light> lights;
};

/// A plane that shows the shadow that falls on it, from above; else the picture is as if it were not there. It throws no light onto the scene.
struct Ground {
    Point up{0, 0, 1};             // unit
    std::optional<double> height;  // along `up`, scene units; none: of the lowest point that is drawn
    double shadow = 1;             // how much of the shadow shows

    /// Where a ray meets it from above; negative: nowhere. With a height.
    double meet(const Point& origin, const Point& along) const {
        const double above = dot(origin, up) - *height, down = -dot(along, up);
        return above > 0 && down > 0 ? above / down : -1;
    }
};

}  // namespace isoparm
