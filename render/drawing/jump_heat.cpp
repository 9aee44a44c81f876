#include "drawing/jump_heat.h"

#include <algorithm>
#include <cmath>

#include "continuity.h"
#include "topology.h"

namespace isoparm {
namespace {

constexpr int kSteps = 96;

/// A point of one side of an edge. Between cells: of the cell below the line, or of that above.
SurfacePoint on_side(const Composite& surface, const Joint::Side& side, Joint::Kind kind, bool below, double s) {
    const Patch& patch = surface[side.member].patch;
    const double t = side.t0 + s * (side.t1 - side.t0);
    if (kind != Joint::Kind::line) {
        const Vec2 at = patch.edge_point(side.edge, t);
        return evaluate(patch, at.x, at.y);
    }
    const Rect r = patch.rect();
    const double value = below ? std::nextafter(side.value, -INFINITY) : side.value;
    return side.edge == 0 ? evaluate(patch, value, r.v0 + t * (r.v1 - r.v0)) : evaluate(patch, r.u0 + t * (r.u1 - r.u0), value);
}

/// Normal curvature of the direction d in the tangent plane, toward the normal n.
double normal_curvature(const SurfacePoint& p, const Point& d, const Point& n) {
    if (!p.du || !p.dv || !p.duu || !p.duv || !p.dvv) return NAN;
    const double E = dot(*p.du, *p.du), F = dot(*p.du, *p.dv), G = dot(*p.dv, *p.dv), det = E * G - F * F;
    const double a = dot(*p.du, d), b = dot(*p.dv, d), u = (G * a - F * b) / det, v = (E * b - F * a) / det;
    return (u * u * dot(*p.duu, n) + 2 * u * v * dot(*p.duv, n) + v * v * dot(*p.dvv, n)) / dot(d, d);
}

/// Normals of two patches may point to different sides of the surface: the nearer directions are compared.
double jump(const SurfacePoint& a, const SurfacePoint& b, const Point& along, JumpHeat::Of of) {
    if (!a.normal || !b.normal) return NAN;
    const Point m = *a.normal, n = dot(m, *b.normal) < 0 ? -*b.normal : *b.normal;
    if (of == JumpHeat::Of::g1) return degrees_between(m, n);
    return std::fabs(normal_curvature(a, cross(m, along), m) - normal_curvature(b, cross(n, along), n));
}

HotEdge hot_edge(const Composite& surface, const Joint& joint, JumpHeat::Of of) {
    HotEdge edge;
    std::vector<SurfacePoint> a, b;
    for (int k = 0; k <= kSteps; ++k) {
        const double s = k / double(kSteps);
        a.push_back(on_side(surface, joint.a, joint.kind, true, s));
        Joint::Side other = joint.b;
        if (!joint.affine) {  // the nearest point of the other side
            const double t = nearest_on_edge(surface[other.member].patch, other.edge, a.back().position, std::min(other.t0, other.t1), std::max(other.t0, other.t1));
            other.t0 = other.t1 = t;
        }
        b.push_back(on_side(surface, other, joint.kind, false, s));
    }
    for (std::size_t k = 0; k < a.size(); ++k) {
        const Point along = a[std::min(k + 1, a.size() - 1)].position - a[k > 0 ? k - 1 : 0].position;
        edge.points.push_back(a[k].position);
        edge.jumps.push_back(jump(a[k], b[k], along, of));
    }
    return edge;
}

}  // namespace

std::vector<HotEdge> hot_edges(const Composite& surface, JumpHeat::Of of, double size) {
    ContinuityOptions options;
    options.size = size;
    options.tolerance = 1e-9 * size;
    options.curvature = options.tolerance / (size * size);
    options.max_halvings = 0;  // only where the joints are is of interest
    const Continuity joints = find_continuity(surface, options);
    std::vector<HotEdge> edges;
    for (const auto* list : {&joints.joints, &joints.lines})
        for (const Joint& j : *list) edges.push_back(hot_edge(surface, j, of));
    return edges;
}

ColorScale scale_of(const JumpHeat& heat, const std::vector<HotEdge>& edges, double size) {
    const bool angle = heat.of == JumpHeat::Of::g1;
    const double unit = angle ? 1 : 1 / size, rounding = 1e-6 * unit;
    double most = rounding;
    for (const HotEdge& e : edges)
        for (const double x : e.jumps)
            if (x > most && std::isfinite(x)) most = x;
    ColorScale scale;
    if (!(most > rounding)) most = unit;
    scale.name = angle ? "jump of the normal" : "jump of the curvature across";
    scale.unit = angle ? "degrees" : "";
    scale.by.legend = heat.legend;
    scale.high = heat.top ? *heat.top : rounded_up(most);
    scale.above = most > scale.high * (1 + 1e-9);
    return scale;
}

}  // namespace isoparm
