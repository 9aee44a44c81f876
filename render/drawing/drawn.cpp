#include "drawing/drawn.h"

#include <cmath>

#include "drawing/comb.h"
#include "drawing/twist_arrows.h"
#include "error.h"

namespace isoparm {
namespace {

// Default radii, as parts of the diagonal of the scene's box.
constexpr double kTube = 0.004, kRod = 0.0022, kBall = 0.012;

void sample(const Patch& patch, std::vector<Point>& out) {
    constexpr int n = 16;
    const Rect r = patch.rect();
    for (int i = 0; i <= n; ++i)
        for (int j = 0; j <= (patch.domain() == Domain::quad ? n : n - i); ++j)
            out.push_back(patch.point(r.u0 + (r.u1 - r.u0) * i / n, r.v0 + (r.v1 - r.v0) * j / n));
}

void add_around(const Point& p, double radius, std::vector<Point>& out) {
    for (const Point& d : {Point{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}) {
        out.push_back(p + radius * d);
        out.push_back(p - radius * d);
    }
}

/// Balls may be as large as the scene: of what their six ends do not hold, the diagonals hold two thirds.
void add_ball(const Point& p, double radius, std::vector<Point>& out) {
    add_around(p, radius, out);
    const double d = radius / std::sqrt(3.0);
    for (int corner = 0; corner < 8; ++corner) out.push_back(p + Point{corner & 1 ? d : -d, corner & 2 ? d : -d, corner & 4 ? d : -d});
}

}  // namespace

const Surface& surface_of(const Scene& scene, const SceneObject& o) {
    if (const Surface* s = scene.find_surface(o.name)) return *s;
    throw_input("there is no surface named \"" + o.name + "\" to draw");
}
const Curve& curve_of(const Scene& scene, const SceneObject& o) {
    if (const Curve* c = scene.find_curve(o.name)) return *c;
    throw_input("there is no curve named \"" + o.name + "\" to draw");
}

double radius_of(const SceneObject& o, double size) {
    const double part = o.kind == SceneObject::Kind::net ? kRod : o.kind == SceneObject::Kind::point ? kBall : kTube;
    return o.radius && !o.radius->points ? double(*o.radius) : part * size;
}

std::vector<SceneObject> drawn_objects(const Scene& scene) {
    if (!scene.objects.empty()) return scene.objects;
    std::vector<SceneObject> all;
    for (const Surface& s : scene.surfaces) {
        SceneObject& o = all.emplace_back();
        o.kind = SceneObject::Kind::surface;
        o.name = s.name;
    }
    for (const auto& [name, curve] : scene.curves) {
        SceneObject& o = all.emplace_back();
        o.kind = SceneObject::Kind::curve;
        o.name = name;
    }
    return all;
}

std::vector<Point> drawn_points(const Scene& scene) { return drawn_points(scene, drawn_objects(scene)); }

std::vector<Point> drawn_points(const Scene& scene, const std::vector<SceneObject>& objects) {
    const double size = bounding_box(scene).diagonal();
    std::vector<Point> points;
    for (const SceneObject& o : objects) {
        const double radius = radius_of(o, size);
        switch (o.kind) {
            case SceneObject::Kind::surface:
                for (const Member& m : surface_of(scene, o).patches) sample(m.patch, points);
                for (const TwistArrow& t : twist_arrows(surface_of(scene, o), o.twists, size)) points.push_back(t.tip_f), points.push_back(t.tip_g);
                break;
            case SceneObject::Kind::curve: {
                const Curve& c = curve_of(scene, o);
                for (int i = 0; i <= 64; ++i) add_around(c(c.begin() + (c.end() - c.begin()) * i / 64), o.line.width > 0 ? 0 : radius, points);
                for (const auto& tooth : comb_teeth(c, o.comb, size)) points.push_back(tooth[1]);
                break;
            }
            case SceneObject::Kind::net:
                for (const Point& p : o.net.points) add_around(p, kNetBall * radius, points);
                break;
            case SceneObject::Kind::point:
                add_ball(o.point, o.line.width > 0 ? 0 : radius, points);
                break;
            case SceneObject::Kind::axes:
                for (const Point& p : ends_of(o.axes)) points.push_back(p);
                break;
            case SceneObject::Kind::arrow:
                points.insert(points.end(), {o.arrow.tail, o.arrow.tip});
        }
    }
    std::erase_if(points, [](const Point& p) { return !finite(p); });
    return points;
}

}  // namespace isoparm
