#include "picture/view_rendering.h"

#include <algorithm>
#include <limits>

#include "drawing/drawn.h"
#include "drawing/overlay.h"
#include "error.h"
#include "picture/camera.h"
#include "picture/fireflies.h"
#include "picture/picture_pieces.h"
#include "picture/resolve.h"

namespace isoparm {
namespace {

double in_scene_units(const Tolerance& t, const Camera& camera, const Bounds& box) {
    const double size =
        box.diagonal() > 0 ? box.diagonal() : 1;  // a single ball: nothing to tessellate, but tubes to round
    const double absolute = t.absolute(size, finest_pixel(camera, box));
    if (!(absolute > 0) || !std::isfinite(absolute))
        throw_input("the tolerance comes to " + to_text(absolute) + " scene units, expected more than 0");
    return absolute;
}

std::unique_ptr<const Lighting> lighting_of(const Scene& scene, const Camera& camera, const EnvironmentImages& environments, const std::optional<Ground>& ground) {
    if (scene.lighting) return std::make_unique<PathLighting>(*scene.lighting, camera, environments, ground, scene.image.background.value_or(Color{1, 1, 1}));
    return std::make_unique<FigureLighting>(camera, ground);
}

/// So far beneath its height, in radii of the scene, the ground is met: what lies in it hides it.
constexpr double kBeneath = 1e-5;

/// The height of the ground: under everything that is drawn, when the scene does not say.
std::optional<double> height_of(const Ground& ground, const Scene& scene, const std::vector<SceneObject>& objects, const TracedScene& traced) {
    if (ground.height) return ground.height;
    double low = std::numeric_limits<double>::infinity();
    const auto add = [&](const Point& p, double radius) { low = std::min(low, dot(p, ground.up) - radius); };
    for (const Mesh& mesh : traced.meshes)
        for (const Point& p : mesh.positions) add(p, 0);
    for (const std::vector<QuadPart>& parts : traced.quads)
        for (const QuadPart& part : parts)
            for (std::size_t i = 0; i < part.vertices().size(); ++i) add(part.vertices()[i], 0);
    const double size = bounding_box(scene).diagonal();
    for (const SceneObject& o : objects) {
        const bool tubes = o.kind == SceneObject::Kind::surface && o.boundary && !(o.line.width > 0);
        const double radius = tubes ? radius_of(o, size) : 0;  // of other things it is counted already
        if (o.kind != SceneObject::Kind::axes)
            for (const Point& p : drawn_points(scene, {o})) add(p, radius);
    }
    if (!std::isfinite(low)) return {};
    return low;
}
std::optional<Ground> ground_of(const Scene& scene, const std::vector<SceneObject>& objects, const TracedScene& traced) {
    if (!scene.ground) return {};
    const auto height = height_of(*scene.ground, scene, objects, traced);
    if (!height) return {};
    std::optional<Ground> ground = scene.ground;
    ground->height = *height - kBeneath * traced.embree->radius();
    return ground;
}

/// Does anything mirror or bend what is seen? Then parameter lines are traced, so that they are seen in it too.
bool mirrors(const Scene& scene, const std::vector<SceneObject>& objects) {
    return scene.lighting && std::any_of(objects.begin(), objects.end(), [](const SceneObject& o) { return o.material.kind == Material::Kind::metal || o.material.kind == Material::Kind::glass; });
}

/// With what the pixels of the area may depend on.
Area area_of_film(const Area& area, const View& view, bool spread) {
    if (!spread) return area;
    return common({area.x0 - kFireflyReach, area.y0 - kFireflyReach, area.x1 + kFireflyReach, area.y1 + kFireflyReach}, {0, 0, view.width, view.height});
}

}  // namespace

ViewRendering::ViewRendering(const Scene& scene, const View& view, const Area& area, const Quality& how, const EnvironmentImages& environments, const std::function<void(double)>& progress)
    : scene_(scene),
      view_(view),
      area_(area),
      how_(how),
      camera_(camera_of(view)),
      tolerance_(in_scene_units(how.tolerance, camera_, bounding_box(scene))),
      lines_(how.vectors && !mirrors(scene, view.objects)),
      spread_(scene.lighting && scene.lighting->fireflies == LightingSettings::Fireflies::spread),
      traced_(build_traced_scene(scene, view.objects, tolerance_, progress, how.exact, how.grid)),
      ground_(ground_of(scene, view.objects, traced_)),
      lighting_(lighting_of(scene, camera_, environments, ground_)),
      film_(area_of_film(area, view, spread_), how.samples, how.noise, {how.statistics, spread_}),
      tracer_(traced_, camera_, *lighting_, how.samples, scene.image.background, ground_) {
    for (Thing& thing : traced_.things) thing.isolines.width = lines_ ? 0 : thing.isolines.width * how.pixel;
}

Picture ViewRendering::picture(const std::vector<Aov>& aovs) const {
    Picture p;
    p.tolerance = tolerance_;
    p.certified_error = traced_.certified_error;
    p.triangles = traced_.triangles;
    for (const ExactPatch& patch : traced_.patches) p.leaves += patch.leaves();
    p.image = blank(area_.width(), area_.height(), {});
    p.layers = blank_layers(area_.width(), area_.height(), aovs);
    const auto resolved = [&](const Film& film) { resolve(tracer_, film, AovReader(scene_, traced_, camera_, aovs), area_, p.image, p.layers); };
    if (spread_) resolved(without_fireflies(film_));
    else resolved(film_);
    p.rays = {film_.rays.rays, film_.rays.undecided};
    put_over(overlay(scene_, view_.objects, traced_, camera_, how_.pixel, view_.letter, lines_, {view_.inset.has_value(), view_.covered}), -area_.x0, -area_.y0, view_.width, view_.height, how_.vectors, scene_.image.background, p);
    return p;
}

}  // namespace isoparm
