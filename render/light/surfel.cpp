#include "light/surfel.h"

#include <algorithm>
#include <array>
#include <span>

#include "drawing/isolines.h"
#include "light/surfel_kernel.h"

namespace isoparm {
namespace {

Point at_lane(const double (*d)[SurfelLanes::lanes], int i) { return {d[0][i], d[1][i], d[2][i]}; }
void put(const Point& p, double (*to)[SurfelLanes::lanes], int i) { to[0][i] = p.x, to[1][i] = p.y, to[2][i] = p.z; }

/// Parameters of the hit: those of the corners, weighted as the hit is.
Vec2 parameters(Domain domain, const Rect& r, const Thing& thing, const Hit& hit) {
    const auto [a, b, c] = parameters_of(thing, hit.primitive);
    const double w = 1 - hit.u - hit.v;
    Vec2 p{std::clamp(w * a.x + hit.u * b.x + hit.v * c.x, r.u0, r.u1),
           std::clamp(w * a.y + hit.u * b.y + hit.v * c.y, r.v0, r.v1)};
    if (domain == Domain::triangle && p.x + p.y > 1) p.y = 1 - p.x;
    return p;
}

/// The frames of the patches that were hit, each patch asked once; `at` are the parameters.
void set_frames(const TracedScene& scene, const Hit* hits, int n, Vec2* at, SurfelLanes& p) {
    bool done[EmbreeScene::packet] = {};
    for (int first = 0; first < n; ++first) {
        const Patch* patch = scene.things[hits[first].geometry].patch;
        if (!patch || done[first]) continue;
        const Domain domain = patch->domain();
        const Rect rect = patch->rect();
        int which[EmbreeScene::packet], count = 0;
        double u[EmbreeScene::packet], v[EmbreeScene::packet];
        double some[9][EmbreeScene::packet];
        for (int i = first; i < n; ++i) {
            const Thing& thing = scene.things[hits[i].geometry];
            if (thing.patch != patch) continue;
            at[i] = thing.mesh ? parameters(domain, rect, thing, hits[i]) : Vec2{hits[i].u, hits[i].v};
            u[count] = at[i].x, v[count] = at[i].y;
            which[count++] = i;
            done[i] = true;
        }
        const std::size_t size = static_cast<std::size_t>(count);
        auto* const found = count == n ? p.frame : some;
        const auto three = [&](int of) { return std::array<std::span<double>, 3>{{{found[of], size}, {found[of + 1], size}, {found[of + 2], size}}}; };
        patch->frames({u, size}, {v, size}, {three(0), three(3), three(6)});
        if (found == p.frame) return;
        for (int row = 0; row < 9; ++row)
            for (int k = 0; k < count; ++k) p.frame[row][which[k]] = some[row][k];
    }
}

/// The triangle that was met.
void set_corners(const Thing& thing, const Hit& hit, int i, SurfelLanes& p) {
    const auto corners = corners_of(thing, hit.primitive);
    for (int k = 0; k < 3; ++k) put(corners[k], p.corner[k], i);
    p.u[i] = hit.u, p.v[i] = hit.v;
}

/// So far from surfaces rays begin, beside what meshes may be off.
double clear_of(const TracedScene& scene) { return 4e-6 * scene.embree->radius(); }

/// What is no point of a mesh of a patch with a normal: tubes and balls, patches themselves, poles. Second derivatives are needed only for the limit where
/// the first ones do not span a plane.
void set_otherwise(const Thing& thing, const Ray& ray, const Hit& hit, const Vec2& at, int i, SurfelLanes& p) {
    const Point place = ray.origin + hit.distance * ray.direction;
    if (!thing.patch) {
        const Point n = normalized(hit.normal);
        put(place, p.frame, i), put(place, p.on_mesh, i), put(n, p.outward, i), put(n, p.normal, i);
        return;
    }
    const Point otherwise = thing.mesh ? at_lane(p.outward, i) : -ray.direction;
    const Point du = at_lane(p.frame + 3, i), dv = at_lane(p.frame + 6, i), across = cross(du, dv);
    const double size = dot(across, across);
    if (!(size > 1e-18 * dot(du, du) * dot(dv, dv) && std::isfinite(size))) put(unit_normal(*thing.patch, thing.patch->jet(at.x, at.y), at.x, at.y).value_or(otherwise), p.normal, i);
    if (!thing.mesh) {
        const Point n = at_lane(p.normal, i);
        put(place, p.on_mesh, i), put(thing.flipped ? -n : n, p.outward, i);
    }
    if (!finite(at_lane(p.frame, i))) put(at_lane(p.on_mesh, i), p.frame, i);
}

/// Colours that stand for numbers are not lit, so that the legend has the same ones: only darker where the surface turns away.
void color_by_curvature(const Thing& thing, Surfel& s) {
    constexpr double kDark = 0.66;
    const bool flipped = thing.part ? thing.part->flipped : thing.flipped;
    const double value = curvature_of(*thing.patch, s.at, thing.scale.by.what, flipped);
    const Color color = std::isfinite(value) ? thing.scale.color(value) : thing.front;
    const Color here = (kDark + (1 - kDark) * std::fabs(dot(s.normal, s.view))) * color;
    s.ink = s.ink_cover * s.ink + (1 - s.ink_cover) * here;
    s.ink_cover = s.opacity;
    s.opacity = 0;
}

/// Into what was just constructed: copies take longer than all the rest.
void make_surfel(const Thing& thing, std::uint32_t geometry, const Camera& camera, const Vec2& at, const SurfelLanes& p, int i, Surfel& s) {
    s.view = at_lane(p.view, i);
    s.opacity = thing.opacity;
    s.material = &thing.material;
    if (thing.shares_plane) s.over = geometry;
    s.position = at_lane(p.frame, i);
    s.geometric = at_lane(p.geometric, i);
    s.shading = at_lane(p.shading, i);
    s.normal = at_lane(p.facing, i);
    s.origin = at_lane(p.origin, i);
    s.beneath = at_lane(p.beneath, i);
    s.front = (p.toward[i] != 0) != thing.inside_out;
    s.color = s.front ? thing.front : thing.back;
    if (!thing.patch) return;
    s.at = at;
    const Point du = at_lane(p.frame + 3, i), dv = at_lane(p.frame + 6, i);
    if ((thing.isolines.u > 0 || thing.isolines.v > 0) && finite(du) && finite(dv)) {
        s.ink = thing.isolines.color;
        s.ink_cover = isoline_cover(thing.isolines, {thing.patch->domain(), thing.patch->rect(), at.x, at.y, du, dv},
                                    camera, s.position, -s.view);
    }
    if (thing.scale.by.curvature()) color_by_curvature(thing, s);
    else if (thing.scale.by.striped() && in_dark_stripe(thing.scale.by, s.normal, -s.view, camera)) s.color = 0.06 * s.color;
}

}  // namespace

void surfels_at(const TracedScene& scene, const Camera& camera, const Ray* rays, const Hit* hits, int n, Surfel* out) {
    static_assert(SurfelLanes::lanes == EmbreeScene::packet);
    if (n == 0) return;
    const SurfelKernel& kernel = surfel_kernel(chosen_isa());
    SurfelLanes p;
    Vec2 at[EmbreeScene::packet];
    const int lanes = (n + SurfelLanes::group - 1) / SurfelLanes::group * SurfelLanes::group;
    const double clear = clear_of(scene);
    set_frames(scene, hits, n, at, p);
    for (int i = 0; i < lanes; ++i) {
        const int k = i < n ? i : 0;
        const Thing& thing = scene.things[hits[k].geometry];
        put(-rays[k].direction, p.view, i);
        p.clear[i] = clear + thing.error;
        if (thing.mesh) set_corners(thing, hits[k], i, p);
        else put({}, p.corner[0], i), put({}, p.corner[1], i), put({}, p.corner[2], i), p.u[i] = p.v[i] = 0;
        if (i >= n || !thing.patch)
            for (auto& row : p.frame) row[i] = thing.patch ? row[0] : 0;
    }
    kernel.normals(lanes, p);
    for (int i = 0; i < n; ++i)
        if (const Thing& thing = scene.things[hits[i].geometry]; !thing.mesh || !p.regular[i]) set_otherwise(thing, rays[i], hits[i], at[i], i, p);
    kernel.places(lanes, p);
    for (int i = 0; i < n; ++i) make_surfel(scene.things[hits[i].geometry], hits[i].geometry, camera, at[i], p, i, out[i]);
}

Surfel ground_surfel(const Ground& ground, const Ray& ray, double distance, const TracedScene& scene) {
    static const Material paper{Material::Kind::diffuse};
    Surfel s;
    s.ground = true;
    s.view = -ray.direction;
    s.position = ray.origin + distance * ray.direction;
    s.normal = s.shading = s.geometric = ground.up;
    const double clear = clear_of(scene);
    s.origin = s.position + clear * s.normal, s.beneath = s.position - clear * s.normal;
    s.color = {1, 1, 1};
    s.material = &paper;
    return s;
}

}  // namespace isoparm
