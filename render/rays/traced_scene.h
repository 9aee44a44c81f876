// traced_scene.h -- a scene turned into what rays meet: certified meshes, tubes and balls, each with its looks.
#pragma once
#include <array>
#include <deque>
#include <functional>
#include <memory>
#include <vector>

#include "picture/curvature_map.h"
#include "rays/embree_scene.h"
#include "scene/scene.h"

namespace isoparm {

/// One geometry of the EmbreeScene. Surfaces have a patch, and either a mesh that lies within `error` of it or, where rays meet the patch
/// itself, none.
struct Thing {
    Color front, back;  // colours of the two sides, linear
    double opacity = 1;
    Material material;
    double error = 0;         // scene units
    bool inside_out = false;  // triangles wind about the back
    bool flipped = false;     // without a mesh: its triangles would wind against S_u x S_v
    Isolines isolines;
    ColorScale scale;  // scale.by.what: none, or what the colour says
    bool shares_plane = false;  // EmbreeScene::Plane
    bool pane = false;          // thin glass in traced light: light passes it straight on
    const Patch* patch = nullptr;
    const Mesh* mesh = nullptr;
    const MeshPart* part = nullptr;
    const QuadPart* quads = nullptr;  // of a large mesh: it has the triangles and vertices, which mesh and part then have not
};
/// Geometric, not of unit length, to whichever side.
Point normal_at(const Thing& thing, const Hit& hit);
/// The triangle that was hit.
std::array<Point, 3> corners_of(const Thing& thing, std::uint32_t primitive);
std::array<Vec2, 3> parameters_of(const Thing& thing, std::uint32_t primitive);
/// Meshes that take the scene above so many triangles are large, by default.
inline constexpr std::size_t kLargeScene = 1'000'000;

/// A piece of a tube, or a ball: it lies within the convex hull of balls about the points.
struct Solid {
    std::array<Point, 4> points;
    double radius = 0;
};

struct TracedScene {
    std::deque<Mesh> meshes;
    std::deque<std::vector<QuadPart>> quads;  // of large ones
    std::deque<ExactPatch> patches;
    std::vector<Thing> things;  // by the number of the geometry
    std::vector<Solid> solids;  // of all tubes and balls
    std::vector<std::uint32_t> later;  // by object: the first geometry of those that were added after its own
    std::unique_ptr<EmbreeScene> embree;
    bool panes = false;  // there are some
    std::size_t triangles = 0;
    double certified_error = 0;  // of all meshes, float32 included
};

/// Tessellates every surface that is drawn, once each, within `tolerance` (scene units). Refers to patches of `scene`,
/// which must live as long. Throws what tessellate() throws, with the surface's name. `exact`: rays meet the patches themselves, and the
/// meshes, coarse ones, only tell which side is the front.
TracedScene build_traced_scene(const Scene& scene, double tolerance, const std::function<void(double)>& progress, bool exact = false);
/// Only some objects of the scene. `grid`: not 0 where patches are meshed by grids of so many cells each way (grid_mesh.h), of whose error nothing is proved: then
/// certified_error is infinite. `large`: meshes with which the scene has more triangles than that are kept as quads, in half of the memory (quad_part.h).
TracedScene build_traced_scene(const Scene& scene, const std::vector<SceneObject>& objects, double tolerance, const std::function<void(double)>& progress,
                               bool exact = false, int grid = 0, std::size_t large = kLargeScene);

}  // namespace isoparm
