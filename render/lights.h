// lights.h -- the lights of a scene, as paths of light find them: a direction toward one, or one by chance.
#pragma once
#include "light.h"
#include "studio.h"

namespace isoparm {

/// Immutable; safe to query from every thread.
class Lights {
public:
    using Color = Vec3<double>;
    Lights(const std::vector<Light>& lights, const Camera& camera);

    struct Sample {
        Point direction;  // unit
        double distance = 0;
        Color radiance;      // over the density, that of choosing the light counted
        double density = 0;  // over solid angle, likewise; 0: of one direction only, which nothing else finds
    };
    /// None that shines on `from`: radiance 0. `pick` in [0,1) chooses the light.
    Sample sample(const Point& from, double pick, const Vec2& s) const;

    /// Light that comes along a ray from lights but the sky that it meets before `end`. `density` is that with which the ray
    /// was chosen over solid angle: what sample() finds as well counts in part (Veach's power heuristic); 0: it does not.
    Color met(const Ray& ray, double end, double density) const;
    /// The sky's light.
    Color sky(const Point& direction) const;

private:
    /// Radiance and distance along the ray; distance is negative when it does not meet the light.
    struct Meeting {
        Color radiance;
        double distance = -1;
    };
    Meeting meet(const Light& light, const Point& from, const Point& direction) const;
    Sample sample(const Light& light, const Point& from, const Vec2& s) const;
    /// Density over solid angle of sample() for this light and a direction that meets it, at that distance.
    double density(const Light& light, const Point& from, const Point& direction, double distance) const;

    std::vector<Light> sampled_, skies_;
    Studio studio_;
};

}  // namespace isoparm
