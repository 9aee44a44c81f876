// embree_scene.h -- what rays meet. Embree itself is known to embree_scene.cpp and embree_patches.cpp only.
//
// Embree computes in float32: everything is stored relative to `centre`, and rays begin where they enter the scene.
// Immutable after commit(), and then safe to query from every thread; queries set the processor to flush subnormal
// numbers for their own duration only.
#pragma once
#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include "mesh.h"
#include "picture/camera.h"
#include "rays/exact_patch.h"
#include "rays/quad_part.h"

namespace isoparm {

struct Hit {
    static constexpr std::uint32_t none = ~0u;
    double distance = std::numeric_limits<double>::infinity();
    std::uint32_t geometry = none, primitive = 0;  // of a QuadPart: the half
    double u = 0, v = 0;  // of triangles and halves: weights of corners 1 and 2; of patches: parameters
    Point normal;         // geometric, outward, not of unit length; not of patches
    double error = 0;     // of patches: Root::error
    bool found() const { return geometry != none; }
};

/// What the rays of a packet met, in Embree's own numbers: a Hit is made of them one by one.
struct HitLanes {
    std::uint32_t found;  // a bit for each ray that met something; nothing else holds of others
    alignas(64) double start[RayLanes::lanes];
    alignas(64) float distance[RayLanes::lanes], u[RayLanes::lanes], v[RayLanes::lanes], normal[3][RayLanes::lanes];  // distance: from `start` on
    std::uint32_t geometry[RayLanes::lanes], primitive[RayLanes::lanes];
    std::uint32_t exact;  // rays that met a patch itself:
    union {
        Hit of_patch[RayLanes::lanes];
    };

    HitLanes() {}  // intersect() sets what is read
    Hit operator[](int i) const;
};

class EmbreeScene {
public:
    static constexpr int packet = 16;  // rays a call
    /// What a surface does to rays.
    struct Sheet {
        double opacity;
        bool pane;  // rays may go on behind it, unbent, whatever its opacity: see crossed()
        Sheet(double its_opacity, bool is_pane = false) : opacity(its_opacity), pane(is_pane) {}
    };
    /// What is known of a plane in which flat surfaces lie that cover each other: the one that was added last lies over the others, and rays look behind each of them.
    struct Plane {
        Point normal;       // of unit length
        double within;      // hits so close to each other along it are at one place, scene units; 0: the plane is not shared
        Plane(const Point& its_normal = {}, double its_width = 0) : normal(its_normal), within(its_width) {}
        bool shared() const { return within > 0; }
    };

    explicit EmbreeScene(const Point& centre);
    ~EmbreeScene();
    EmbreeScene(const EmbreeScene&) = delete;
    EmbreeScene& operator=(const EmbreeScene&) = delete;

    /// One geometry a part, numbered one after the other; returns the first. All parts share the vertices, so that rays
    /// do not slip through between them. `planes`: by part; empty where none is shared.
    std::uint32_t add_mesh(const Mesh& mesh, const Sheet& sheet, const std::vector<Plane>& planes = {});
    /// The same of a mesh in less than half of the memory, which rays take longer to meet. Its parts must live as long, in their places; and they have the scene's centre.
    std::uint32_t add_quads(const std::vector<QuadPart>& parts, const Sheet& sheet, const std::vector<Plane>& planes = {});
    /// The patch itself, which must live as long; its neighbours are those of the same `group`.
    std::uint32_t add_patch(const ExactPatch& patch, std::uint32_t group, const Sheet& sheet, const Plane& plane = {});
    /// Round tubes about cubic Bezier curves; returns the geometry's number.
    std::uint32_t add_tubes(const std::vector<std::array<Point, 4>>& pieces, double radius, double opacity);
    std::uint32_t add_balls(const std::vector<Point>& centres, double radius, double opacity);
    /// Builds the hierarchy; call once, when everything is added.
    void commit();

    /// Radius about the centre of everything that was added.
    double radius() const;
    /// Some geometry lets light through: use layers().
    bool translucent() const;
    /// Largest distance between a vertex as given and as stored.
    double rounding() const;

    /// Rays against patches so far, and how they ended.
    struct Count {
        std::uint64_t rays = 0, undecided = 0;
    };
    Count count() const;

    /// The nearest hit of each of n <= packet rays; none, of none. Not of a scene that is translucent().
    void intersect(const Ray* rays, int n, Hit* hits) const;
    void intersect(const RayLanes& rays, int n, HitLanes& hits) const;
    /// The nearest hit of one ray, whatever its opacity.
    Hit first(const Ray& ray) const;
    /// Every hit from the nearest to the first opaque one that is no pane, in order. A tube or ball that lets light through counts
    /// once. `under`: of what lies in the plane of that geometry, which shares it, only what lies under it.
    void layers(const Ray& ray, std::vector<Hit>& hits, std::uint32_t under = Hit::none) const;
    /// The same of a ray that has an end; false, and hits mean nothing, where something opaque that is no pane is before it.
    bool crossed(const Ray& ray, std::vector<Hit>& hits) const;
    /// How dark the shadow of a sheet is: as its opacity asks for, or, as in figures, lighter, so that sheets under sheets keep their colours.
    enum class Shadows { light, physical };
    /// The part of light that passes along each of n <= packet rays; 1 where `active` has no bit.
    void transmittance(const Ray* rays, int n, std::uint32_t active, double* result, Shadows shadows = Shadows::light) const;
    void transmittance(const RayLanes& rays, int n, std::uint32_t active, double* result, Shadows shadows = Shadows::light) const;

private:
    /// Rays: Ray* or RayLanes.
    template <class Rays> void trace(const Rays& rays, int n, HitLanes& hits) const;
    template <class Rays> void shadows(const Rays& rays, int n, std::uint32_t active, double* result, Shadows shadows) const;

    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace isoparm
