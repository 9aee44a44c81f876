#include "surfel.h"

#include <algorithm>
#include <array>
#include <span>

#include "isolines.h"

namespace isoparm {
namespace {

Point coefficient(const PointFrame& f, int i, int k) {
    return {f.x.coefficient(i, k), f.y.coefficient(i, k), f.z.coefficient(i, k)};
}

/// Parameters of the hit: those of the corners, weighted as the hit is.
Vec2 parameters(const Patch& patch, const MeshPart& part, const std::array<std::uint32_t, 3>& corners, const Hit& hit) {
    const Vec2 &a = part.uv[corners[0]], &b = part.uv[corners[1]], &c = part.uv[corners[2]];
    const double w = 1 - hit.u - hit.v;
    const Rect r = patch.rect();
    Vec2 p{std::clamp(w * a.x + hit.u * b.x + hit.v * c.x, r.u0, r.u1),
           std::clamp(w * a.y + hit.u * b.y + hit.v * c.y, r.v0, r.v1)};
    if (patch.domain() == Domain::triangle && p.x + p.y > 1) p.y = 1 - p.x;
    return p;
}

/// Unit; not yet turned to the viewer. `otherwise` where the patch has no normal. Second derivatives are needed only for
/// the limit where the first ones do not span a plane.
Point normal_of(const Patch& patch, const Point& du, const Point& dv, const Vec2& at, const Point& otherwise) {
    const Point n = cross(du, dv);
    const double nn = dot(n, n);
    if (nn > 1e-18 * dot(du, du) * dot(dv, dv) && std::isfinite(nn)) return n / std::sqrt(nn);
    return unit_normal(patch, patch.jet(at.x, at.y), at.x, at.y).value_or(otherwise);
}

/// A mesh's silhouette shows the surface a little beyond its own: bent just enough to face the viewer.
Point facing(const Point& normal, const Point& view) {
    constexpr double kLeast = 0.01;
    const double c = dot(normal, view);
    return c >= kLeast ? normal : normalized(normal + (kLeast - c) * view);
}

/// The frames of the patches that were hit, each patch asked once; `at` are the parameters.
void frames_of(const TracedScene& scene, const Hit* hits, int n, Vec2* at, PointFrame* frames) {
    bool done[EmbreeScene::packet] = {};
    for (int first = 0; first < n; ++first) {
        const Patch* patch = scene.things[hits[first].geometry].patch;
        if (!patch || done[first]) continue;
        int which[EmbreeScene::packet], count = 0;
        double u[EmbreeScene::packet], v[EmbreeScene::packet];
        double found[9][EmbreeScene::packet];
        for (int i = first; i < n; ++i) {
            const Thing& thing = scene.things[hits[i].geometry];
            if (thing.patch != patch) continue;
            at[i] = thing.mesh ? parameters(*patch, *thing.part, thing.part->triangles[hits[i].primitive], hits[i]) : Vec2{hits[i].u, hits[i].v};
            u[count] = at[i].x, v[count] = at[i].y;
            which[count++] = i;
            done[i] = true;
        }
        const std::size_t size = static_cast<std::size_t>(count);
        const auto three = [&](int of) { return std::array<std::span<double>, 3>{{{found[of], size}, {found[of + 1], size}, {found[of + 2], size}}}; };
        patch->frames({u, size}, {v, size}, {three(0), three(3), three(6)});
        for (int k = 0; k < count; ++k)
            for (int axis = 0; axis < 3; ++axis)
                for (int c = 0; c < 3; ++c) frames[which[k]][axis].c[c] = found[3 * c + axis][k];
    }
}

/// Where the ray met, and the normal that tells front from back.
struct Met {
    Point at, outward;
};
Met on_triangle(const Thing& thing, const Hit& hit) {
    const auto& corners = thing.part->triangles[hit.primitive];
    const auto vertex = [&](int i) -> const Point& { return thing.mesh->positions[thing.part->vertex[corners[i]]]; };
    const Point e1 = vertex(1) - vertex(0), e2 = vertex(2) - vertex(0);
    return {vertex(0) + hit.u * e1 + hit.v * e2, normalized(cross(e1, e2))};
}
Met on_patch(const Thing& thing, const Ray& ray, const Hit& hit, const Vec2& at, const Point& du, const Point& dv) {
    const Point n = normal_of(*thing.patch, du, dv, at, -ray.direction);
    return {ray.origin + hit.distance * ray.direction, thing.flipped ? -n : n};
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
void make_surfel(const TracedScene& scene, const Camera& camera, const Ray& ray, const Hit& hit, const Vec2& at, const PointFrame& frame, Surfel& s) {
    const Thing& thing = scene.things[hit.geometry];
    const double clear = 4e-6 * scene.embree->radius() + thing.error;
    s.view = -ray.direction;
    s.opacity = thing.opacity;
    s.material = &thing.material;
    if (!thing.patch) {
        const Point n = normalized(hit.normal);
        s.front = dot(n, s.view) >= 0;
        s.shading = s.geometric = s.front ? n : -n;
        s.normal = facing(s.shading, s.view);
        s.position = ray.origin + hit.distance * ray.direction;
        s.origin = s.position + clear * s.normal;
        s.beneath = s.position - clear * s.normal;
        s.color = thing.front;
        return;
    }
    const Point du = coefficient(frame, 1, 0), dv = coefficient(frame, 0, 1);
    const auto [on_mesh, outward] = thing.mesh ? on_triangle(thing, hit) : on_patch(thing, ray, hit, at, du, dv);
    const bool toward = dot(outward, s.view) >= 0, front = toward != thing.inside_out;
    const Point geometric = toward ? outward : -outward;

    Point position = coefficient(frame, 0, 0);
    if (!finite(position)) position = on_mesh;
    const Point n = normal_of(*thing.patch, du, dv, at, geometric);
    s.at = at;
    s.position = position;
    s.geometric = geometric;
    s.shading = dot(n, geometric) < 0 ? -n : n;
    s.normal = facing(s.shading, s.view);
    // Above both the surface and the mesh: no facet shadows its own surface.
    s.origin = position + (clear + std::max(0.0, dot(on_mesh - position, s.normal))) * s.normal;
    s.beneath = position - (clear + std::max(0.0, dot(position - on_mesh, s.normal))) * s.normal;
    s.front = front;
    s.color = front ? thing.front : thing.back;
    if (finite(du) && finite(dv)) {
        s.ink = thing.isolines.color;
        s.ink_cover = isoline_cover(thing.isolines, {thing.patch->domain(), thing.patch->rect(), at.x, at.y, du, dv},
                                    camera, position, ray.direction);
    }
    if (thing.scale.by.curvature()) color_by_curvature(thing, s);
    else if (thing.scale.by.striped() && in_dark_stripe(thing.scale.by, s.normal, ray.direction, camera)) s.color = 0.06 * s.color;
}

}  // namespace

void surfels_at(const TracedScene& scene, const Camera& camera, const Ray* rays, const Hit* hits, int n, Surfel* out) {
    Vec2 at[EmbreeScene::packet];
    PointFrame frames[EmbreeScene::packet];
    frames_of(scene, hits, n, at, frames);
    for (int i = 0; i < n; ++i) make_surfel(scene, camera, rays[i], hits[i], at[i], frames[i], out[i]);
}

}  // namespace isoparm
