#include "rays/traced_scene.h"

#include <algorithm>
#include <cmath>
#include <map>
#if __has_include(<malloc.h>)
#include <malloc.h>
#endif

#include "drawing/drawn.h"
#include "error.h"
#include "grid_mesh.h"
#include "picture/palette.h"
#include "rays/shared_planes.h"
#include "rays/tubes.h"
#include "release.h"
#include "tessellate.h"

namespace isoparm {
namespace {

/// Whether the triangles wind about the hollow side. The front of what is closed, or nearly, is its outside, and of a
/// dome its convex side: that from which the signed volume over the middle is positive. A sheet that is neither keeps
/// its own.
bool inside_out(const Mesh& mesh) {
    double volume = 0, area = 0;
    Point middle;
    const auto each = [&](auto use) {
        for (const MeshPart& part : mesh.parts)
            for (const auto& t : part.triangles) {
                const Point &a = mesh.positions[part.vertex[t[0]]], &b = mesh.positions[part.vertex[t[1]]],
                            &c = mesh.positions[part.vertex[t[2]]];
                use(a, b, c, 0.5 * cross(b - a, c - a));
            }
    };
    each([&](const Point& a, const Point& b, const Point& c, const Point& n) {
        area += length(n);
        middle += (length(n) / 3) * (a + b + c);
    });
    if (!(area > 0)) return false;
    middle = middle / area;
    each([&](const Point& a, const Point&, const Point&, const Point& n) { volume += dot(a - middle, n) / 3; });
    return volume < -1e-3 * std::pow(area, 1.5);
}

/// Glass is clear where nothing else is said: a figure's colour, taken twice by what passes, is mud.
Color color_of(const SceneObject& o, const Color& otherwise) { return o.color.value_or(o.material.kind == Material::Kind::glass ? Color{1, 1, 1} : otherwise); }

/// What was freed and lies between what is in use still counts as the program's; a mesh leaves a lot of it.
void give_back_memory() {
#if defined(__GLIBC__)
    malloc_trim(0);
#endif
}

constexpr double kFrontTolerance = 2e-3;  // of meshes that only tell front from back, in sizes of the scene

class Builder {
public:
    Builder(const Scene& scene, const std::vector<SceneObject>& objects, double tolerance, const std::function<void(double)>& progress, bool exact, int grid, std::size_t large)
        : scene_(scene), objects_(objects), tolerance_(tolerance), progress_(progress), exact_(exact), grid_(grid), large_(large) {
        const Bounds box = bounding_box(scene);
        size_ = box.diagonal() > 0 ? box.diagonal() : 1;
        centre_ = 0.5 * (box.low + box.high);
        result_.embree = std::make_unique<EmbreeScene>(centre_);
        // Room for the rounding to float32, half a unit in the last place of each coordinate about the centre; a
        // tolerance below that cannot be kept, and certified_error will say so.
        const double float_error = 0x1.00001p-24 * 0.5 * size_;
        mesh_tolerance_ = exact ? kFrontTolerance * size_ : tolerance > 2 * float_error ? tolerance - float_error : tolerance;
    }

    TracedScene run() {
        planes_ = shared_planes(scene_, objects_, size_);
        for (done_ = 0; done_ < objects_.size(); ++done_) {
            report(0, objects_.size());
            add(objects_[done_], objects_.size());
            result_.later.push_back(static_cast<std::uint32_t>(result_.things.size()));
        }
        result_.embree->commit();
        // The traced mesh is the certified one moved by the rounding of its vertices.
        if (result_.triangles > 0)
            result_.certified_error = rounding::up(result_.certified_error + result_.embree->rounding());
        for (Thing& thing : result_.things)
            if (thing.mesh) thing.error = rounding::up(thing.error + result_.embree->rounding());
        return std::move(result_);
    }

private:
    void add(const SceneObject& o, std::size_t objects) {
        switch (o.kind) {
            case SceneObject::Kind::surface:
                return add_surface(o, objects);
            case SceneObject::Kind::curve:
                if (o.line.width > 0) return;  // drawn over the picture
                add_curves(o, {drawn(curve_of(scene_, o))}, color_of(o, curve_color()), o);
                return;
            case SceneObject::Kind::net:
                return add_net(o);
            case SceneObject::Kind::point:
                if (o.line.width > 0) return;
                return add_balls({o.point}, radius_of(o, size_), color_of(o, point_color()), o);
            case SceneObject::Kind::axes:
            case SceneObject::Kind::arrow:
                return;  // drawn over the picture
        }
    }

    void add_surface(const SceneObject& o, std::size_t objects) {
        const Surface& surface = surface_of(scene_, o);
        const Known& known = mesh_of(surface, objects);
        const Mesh& mesh = *known.mesh;
        Thing thing;
        thing.front = color_of(o, surface_color(surfaces_++));
        // Both sides of a translucent sheet look alike, so that it keeps its colour where several lie over each other; and glass has one colour of what passes.
        thing.back = o.back.value_or(o.opacity < 1 || (scene_.lighting && o.material.kind == Material::Kind::glass) ? thing.front : back_color(thing.front));
        thing.opacity = o.opacity;
        thing.material = o.material;
        thing.pane = scene_.lighting && o.opacity > 0 && o.material.kind == Material::Kind::glass && o.material.thin;
        result_.panes = result_.panes || thing.pane;
        thing.isolines = o.isolines;
        if (o.color_by.what != ColorBy::What::none) {
            std::vector<char> flipped(surface.patches.size());
            for (const MeshPart& part : mesh.parts) flipped[part.member] = part.flipped;
            thing.scale = settled(o.color_by, surface.patches, flipped);
            if (!o.color) thing.front = Color{0.87, 0.87, 0.87};
            if (!o.back) thing.back = thing.front;
        }
        thing.mesh = &mesh;
        thing.inside_out = known.inside_out;
        if (o.opacity > 0) {
            const EmbreeScene::Sheet sheet(thing.opacity, thing.pane);
            std::vector<EmbreeScene::Plane> planes;
            for (const MeshPart& part : mesh.parts) planes.push_back(planes_[done_].empty() ? EmbreeScene::Plane{} : planes_[done_][part.member]);
            if (known.quads) result_.embree->add_quads(*known.quads, sheet, planes);
            else if (!exact_) result_.embree->add_mesh(mesh, sheet, planes);
            for (const MeshPart& part : mesh.parts) {
                const EmbreeScene::Plane& plane = planes[std::size_t(&part - mesh.parts.data())];
                thing.shares_plane = plane.shared();
                thing.part = &part;
                if (known.quads) thing.quads = &(*known.quads)[std::size_t(&part - mesh.parts.data())];
                thing.patch = &surface.patches[part.member].patch;
                thing.error = grid_ > 0 ? errors_[&surface][std::size_t(&part - mesh.parts.data())] : part.certified_error;
                result_.things.push_back(thing);
                if (exact_) add_patch(result_.things.back(), surface, sheet, plane);
            }
            ++group_;
        }
        if (o.boundary && !(o.line.width > 0)) add_boundary(o, surface);
    }

    void add_patch(Thing& thing, const Surface& surface, const EmbreeScene::Sheet& sheet, const EmbreeScene::Plane& plane) {
        const ExactPatch*& known = exact_of_[thing.patch];
        try {
            if (!known) known = &result_.patches.emplace_back(*thing.patch, size_);
        } catch (const Error& e) {
            throw Error(e.kind(), "surface \"" + surface.name + "\": " + e.what());
        }
        result_.embree->add_patch(*known, group_, sheet, plane);
        thing.flipped = thing.part->flipped;
        thing.error = 0;
        thing.mesh = nullptr;
        thing.part = nullptr;
    }

    struct Known {
        const Mesh* mesh = nullptr;
        bool inside_out = false;
        const std::vector<QuadPart>* quads = nullptr;
    };
    const Known& mesh_of(const Surface& surface, std::size_t objects) {
        Known& known = mesh_of_[&surface];
        if (known.mesh) return known;
        Mesh& mesh = grid_ > 0 ? grid_of(surface) : tessellated(surface, objects);
        known = {&mesh, inside_out(mesh), result_.triangles > large_ ? &to_quads(mesh) : nullptr};
        return known;
    }

    /// Patch by patch, so that there is never all of it twice. The mesh loses its vertices and triangles.
    const std::vector<QuadPart>& to_quads(Mesh& mesh) {
        std::vector<QuadPart>& quads = result_.quads.emplace_back();
        quads.reserve(mesh.parts.size());
        for (MeshPart& part : mesh.parts) quads.emplace_back(mesh, part, centre_);
        release(mesh.positions);
        give_back_memory();
        return quads;
    }

    Mesh& tessellated(const Surface& surface, std::size_t objects) {
        TessellationOptions options;
        options.tolerance = mesh_tolerance_;
        options.study = false;
        options.progress = [&](double fraction) { report(fraction, objects); };
        Tessellation t = [&] {
            try {
                return tessellate(surface.patches, options);
            } catch (const Error& e) {
                throw Error(e.kind(), "surface \"" + surface.name + "\": " + e.what());
            }
        }();
        if (!exact_) {
            result_.certified_error = std::max(result_.certified_error, t.certified_error);
            result_.triangles += t.mesh.triangle_count();
        }
        return result_.meshes.emplace_back(std::move(t.mesh));
    }

    /// Errors that are seen, where others have proved ones.
    Mesh& grid_of(const Surface& surface) {
        GridMesh grid = grid_mesh(surface.patches, static_cast<std::uint32_t>(grid_), join_tolerance(1e-4 * size_, size_));
        for (std::size_t k = 0; k < grid.mesh.parts.size(); ++k) errors_[&surface].push_back(grid.sampled_error[k]);
        result_.certified_error = HUGE_VAL;
        result_.triangles += grid.mesh.triangle_count();
        return result_.meshes.emplace_back(std::move(grid.mesh));
    }

    void add_boundary(const SceneObject& o, const Surface& surface) {
        add_curves(o, drawn_edges(surface.patches, size_), curve_color(), {});
    }

    void add_curves(const SceneObject& o, const std::vector<DrawnCurve>& curves, const Color& color, const SceneObject& look) {
        const double radius = radius_of(o, size_);
        std::vector<CubicPiece> pieces;
        std::vector<Point> joints;  // balls close the ends and round the corners
        for (const DrawnCurve& curve : curves) {
            const auto some = cubic_pieces(curve, std::min(0.25 * tolerance_, 0.02 * radius));
            if (some.empty()) {
                if (o.kind == SceneObject::Kind::curve) joints.push_back(curve.position(curve.begin));
                continue;
            }
            joints.push_back(some.front()[0]);
            for (std::size_t i = 0; i < some.size(); ++i)
                if (i + 1 == some.size() || kink(some[i], some[i + 1])) joints.push_back(some[i][3]);
            pieces.insert(pieces.end(), some.begin(), some.end());
        }
        add_tubes(pieces, radius, color, look);
        add_balls(joints, radius, color, look);
    }
    static bool kink(const CubicPiece& a, const CubicPiece& b) {
        const Point in = a[3] - a[2], out = b[1] - b[0];
        return !(dot(in, out) > 0.9999 * length(in) * length(out));
    }

    void add_net(const SceneObject& o) {
        const double radius = radius_of(o, size_);
        std::vector<CubicPiece> rods;
        for (const auto& [i, j] : o.net.rods) {
            const Point a = o.net.points.at(i), d = o.net.points.at(j);
            if (distance(a, d) > 1e-9 * size_) rods.push_back(straight(a, d));
        }
        const Color color = color_of(o, net_color());
        if (!(o.line.width > 0)) add_tubes(rods, radius, color, o);
        add_balls(o.net.points, kNetBall * radius, color, o);
    }

    /// Opacity and material are those of `look`.
    void add_tubes(const std::vector<CubicPiece>& pieces, double radius, const Color& color, const SceneObject& look) {
        if (pieces.empty() || !(radius > 0) || !(look.opacity > 0)) return;
        result_.embree->add_tubes(pieces, radius, look.opacity);
        for (const CubicPiece& piece : pieces) result_.solids.push_back({piece, radius});
        add_plain(color, look, radius);
    }
    void add_balls(const std::vector<Point>& centres, double radius, const Color& color, const SceneObject& look) {
        if (centres.empty() || !(radius > 0) || !(look.opacity > 0)) return;
        result_.embree->add_balls(centres, radius, look.opacity);
        for (const Point& p : centres) result_.solids.push_back({{p, p, p, p}, radius});
        add_plain(color, look, radius);
    }
    void add_plain(const Color& color, const SceneObject& look, double radius) {
        Thing thing;
        thing.front = thing.back = color;
        thing.opacity = look.opacity;
        thing.material = look.material;
        thing.error = 0.01 * radius;  // Embree's own error is far below
        result_.things.push_back(thing);
    }

    void report(double fraction, std::size_t objects) const {
        if (progress_) progress_((static_cast<double>(done_) + fraction) / static_cast<double>(objects));
    }

    const Scene& scene_;
    const std::vector<SceneObject>& objects_;
    double tolerance_, mesh_tolerance_ = 0, size_ = 1;
    const std::function<void(double)>& progress_;
    TracedScene result_;
    bool exact_;
    int grid_;
    std::size_t large_;
    Point centre_;
    std::uint32_t group_ = 0;
    std::map<const Surface*, Known> mesh_of_;
    std::map<const Surface*, std::vector<double>> errors_;  // of grids
    std::map<const Patch*, const ExactPatch*> exact_of_;
    std::size_t done_ = 0, surfaces_ = 0;
    std::vector<std::vector<EmbreeScene::Plane>> planes_;
};

}  // namespace

TracedScene build_traced_scene(const Scene& scene, double tolerance, const std::function<void(double)>& progress, bool exact) {
    return build_traced_scene(scene, drawn_objects(scene), tolerance, progress, exact);
}
TracedScene build_traced_scene(const Scene& scene, const std::vector<SceneObject>& objects, double tolerance, const std::function<void(double)>& progress,
                               bool exact, int grid, std::size_t large) {
    return Builder(scene, objects, tolerance, progress, exact, grid, large).run();
}

Point normal_at(const Thing& thing, const Hit& hit) {
    if (!thing.patch || thing.mesh) return hit.normal;
    const PointFrame f = thing.patch->frame(hit.u, hit.v);
    return cross(Point{f.x.coefficient(1, 0), f.y.coefficient(1, 0), f.z.coefficient(1, 0)}, Point{f.x.coefficient(0, 1), f.y.coefficient(0, 1), f.z.coefficient(0, 1)});
}

std::array<Point, 3> corners_of(const Thing& thing, std::uint32_t primitive) {
    if (thing.quads) {
        const auto [a, b, c] = thing.quads->corners(primitive);
        return {thing.quads->vertices()[a], thing.quads->vertices()[b], thing.quads->vertices()[c]};
    }
    const auto at = [&](std::uint32_t corner) { return thing.mesh->positions[thing.part->vertex[corner]]; };
    const auto [a, b, c] = thing.part->triangles[primitive];
    return {at(a), at(b), at(c)};
}

std::array<Vec2, 3> parameters_of(const Thing& thing, std::uint32_t primitive) {
    if (thing.quads) {
        const auto [a, b, c] = thing.quads->corners(primitive);
        return {thing.quads->uv(a), thing.quads->uv(b), thing.quads->uv(c)};
    }
    const auto [a, b, c] = thing.part->triangles[primitive];
    return {thing.part->uv[a], thing.part->uv[b], thing.part->uv[c]};
}

}  // namespace isoparm
