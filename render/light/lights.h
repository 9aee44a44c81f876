// lights.h -- the lights of a scene, as paths of light find them: a direction toward one, or one by chance.
#pragma once
#include "light/environment.h"
#include "light/light.h"
#include "light/local_frame.h"
#include "light/studio.h"

namespace isoparm {

/// Immutable; safe to query from every thread.
class Lights {
public:
    using Color = Vec3<double>;
    /// `images`: of each light, null for those without.
    Lights(const std::vector<Light>& lights, const Camera& camera, const EnvironmentImages& images);

    struct Sample {
        Point direction;  // unit
        double distance = 0;
        Color radiance;      // over the density, that of choosing the light counted
        double density = 0;  // over solid angle, likewise; 0: of one direction only, which nothing else finds
        double sky = 0;      // the part of the radiance that is of a sky
    };
    /// None that shines on `from`: radiance 0. `pick` in [0,1) chooses the light.
    Sample sample(const Point& from, double pick, const Vec2& s) const;

    /// Light that comes along a ray from what sample() finds, skies (`sky`) or other lights, suns in images among them, and what it meets before `end`. `density` is that with which the ray
    /// was chosen over solid angle: what sample() finds as well counts in part (Veach's power heuristic); 0: it does not.
    Color met(const Ray& ray, double end, double density, bool sky) const;
    /// The light of images alone, skies and suns, as if the ray met nothing; `density` as above.
    Color behind(const Ray& ray, double density) const;
    /// The light of skies that sample() does not find.
    Color sky(const Point& direction) const;

    /// What the camera sees of environments where nothing is.
    std::optional<Color> backdrop(const Point& direction) const;

    /// Irradiance of a plane through `at` with the unit normal `up` from sample()'s lights but environments, nothing in between.
    Color irradiance(const Point& at, const Point& up) const;
    /// The same from all skies, by quadrature: slow, and good to some 1e-3.
    Color sky_irradiance(const Point& up) const;

private:
    struct Lamp : Light {
        std::shared_ptr<const EnvironmentImage> image;
        LocalFrame frame{{0, 0, 1}};
        Point to_image(const Point& d) const;
        Point from_image(const Point& d) const;
    };
    /// Radiance and distance along the ray; distance is negative when it does not meet the light.
    struct Meeting {
        Color radiance;
        double distance = -1;
    };
    Meeting meet(const Lamp& light, const Point& from, const Point& direction) const;
    Sample sample(const Lamp& light, const Point& from, const Vec2& s) const;
    /// Density over solid angle of sample() for this light and a direction that meets it, at that distance.
    double density(const Lamp& light, const Point& from, const Point& direction, double distance) const;

    std::vector<Lamp> sampled_, skies_;
    Studio studio_;
};

}  // namespace isoparm
