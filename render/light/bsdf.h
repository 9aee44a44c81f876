// bsdf.h -- how light is scattered at a point of a surface. Directions are unit, point away from the surface, and are given
// relative to its normal, which is z. Energy is never gained: what comes out in all directions is at most what came in.
#pragma once
#include "light/light.h"
#include "light/sampler.h"

namespace isoparm {

class Bsdf {
public:
    using Color = Vec3<double>;
    /// `color` is linear, in [0,1]. `inside`: the viewer is in the body that the surface bounds (glass).
    Bsdf(const Material& material, const Color& color, bool inside);

    /// Light from `in` that leaves toward `out`, times the cosine of `in`; both above the surface.
    Color value(const Point& out, const Point& in) const;
    /// The part of it that the base scatters evenly, not the coat.
    Color spread(const Point& out, const Point& in) const;
    /// Density over solid angle with which sample() finds `in`.
    double density(const Point& out, const Point& in) const;
    /// Mirrors and glass: value() and density() are zero, sample() finds the one direction.
    bool specular() const { return material_.kind == Material::Kind::glass; }

    struct Sample {
        Point direction;  // below the surface, z < 0, when light passes through
        Color weight;     // value / density; 0 when the sample came to nothing
        double density = 0;
        bool spread = false;  // evenly: by the base, not by coat, metal or glass
    };
    /// `lobe` in [0,1) decides between coat and base, reflection and refraction.
    Sample sample(const Point& out, double lobe, const Vec2& s) const;
    /// What a mirror would make of it.
    static Sample mirrored(const Point& out) { return {{-out.x, -out.y, out.z}, {1, 1, 1}, 1, false}; }

private:
    double coat_density(const Point& out, const Point& in) const;
    Color coat(const Point& out, const Point& in) const;
    Color between_facets(const Point& out, const Point& in) const;
    Color base(const Point& out, const Point& in) const;
    Sample refracted(const Point& out, double lobe) const;

    Material material_;
    Color color_;
    bool inside_;
    double alpha_;           // width of the distribution of micro-facets
    double coat_share_ = 0;  // of samples
    double entering_ = 0;    // of even light, through a coat
};

/// What a smooth dielectric of relative index `ior` (inside over outside) reflects of unpolarised light; cosine on the side it comes from.
double fresnel(double cosine, double ior);
/// The same of a pane, to and fro between its two sides.
double pane_fresnel(double cosine, double ior);
/// That of one side on average over a hemisphere of light from outside; ior > 1.
double mean_fresnel(double ior);

}  // namespace isoparm
