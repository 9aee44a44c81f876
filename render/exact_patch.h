// exact_patch.h -- rays against a patch itself, without triangles (Toth, On ray tracing parametric surfaces, SIGGRAPH 1985).
//
// The domain is cut into leaves, boxes over which S is a linear map plus a remainder with a proved bound. A ray is two planes through
// it: f_i = n_i.(S(u,v) - o), i = 1, 2. Krawczyk's operator K(X) = c - Y f(c) + (I - Y J(X)) (X - c), J a bound of the derivatives over
// the leaf and Y the inverse of its middle, proves that a ray misses a leaf (K does not meet X) or that f is one to one on it, so that
// Newton's method finds the only root; the same operator about what Newton found proves that there is one. Leaves where neither can be
// shown, most of them seen edge on, are halved on the spot. docs/exact.md has the argument.
//
// Safe from every thread. Halves are made once and kept, whichever ray asks first: results do not depend on it.
#pragma once
#include <array>
#include <atomic>
#include <cstdint>
#include <deque>
#include <memory>
#include <vector>

#include "camera.h"
#include "patch.h"

namespace isoparm {

/// A ray as the two planes through it.
struct RayPlanes {
    Point origin, direction, n1, n2;  // unit, at right angles
    RayPlanes() = default;
    explicit RayPlanes(const Ray& ray);
};

/// Where a ray meets the patch.
struct Root {
    double distance = 0, u = 0, v = 0;
    double error = 0;  // proved, scene units: the exact point is no farther than this from S(u,v); infinite: not proved
};

/// What a ray meets in one leaf.
struct Roots {
    static constexpr int most = 8;
    Root root[most];
    int count = 0;
    bool undecided = false;  // some place was neither proved to be met nor to be missed
};

class ExactPatch {
public:
    static constexpr int packet = 16;

    /// `size`: diagonal of the scene. A ray counts as meeting the border of the patch where it passes within slack(size) of it, so that
    /// nothing shines through between neighbours. Refers to the patch. Throws Error(input) where the patch cannot be bounded.
    ExactPatch(const Patch& patch, double size);
    static double slack(double size) { return 1e-10 * size; }

    std::size_t leaves() const { return leaves_.size(); }
    /// Holds the patch over that leaf.
    Bounds box(std::size_t leaf) const { return leaves_[leaf].values; }
    /// How many boxes were halved for single rays until now: what takes long.
    std::uint64_t halved() const { return halved_.load(std::memory_order_relaxed); }
    /// Where n <= packet rays meet a leaf, at distances from 0 to farthest[i].
    void meet(std::size_t leaf, const RayPlanes* const* rays, const double* farthest, int n, Roots* found) const;

private:
    /// S(u + x hu, v + y hv) = s + a x + b y, up to `bend`, for -1 <= x, y <= 1 in the domain.
    struct Leaf {
        Box box;
        double u = 0, v = 0, hu = 0, hv = 0;
        Point s, a, b;
        double bend = 0;                // infinite where derivatives have no bound
        double turn_u = 0, turn_v = 0;  // at least |S_u hu - a|, |S_v hv - b| anywhere, infinite likewise
        double uu = 0, uv = 0, vv = 0;  // at least |S_uu| hu^2, |S_uv| hu hv, |S_vv| hv^2, infinite likewise
        Bounds values;
        bool slanted = false;           // u + v = 1 runs through it
        int depth = 0;                  // bisections below a leaf
        mutable std::array<std::atomic<const Leaf*>, 2> halves{};  // made when a ray first needs them

        Leaf() = default;
        Leaf(const Leaf&) = delete;
        Leaf& operator=(const Leaf&) = delete;
        ~Leaf();
    };
    /// A ray against the linear map of a leaf.
    struct Aim {
        enum class Verdict { miss, one, open } verdict = Verdict::open;
        double y11 = 0, y12 = 0, y21 = 0, y22 = 0;  // Y
        double x = 0, y = 0;                        // where the linear map meets the ray
        double wx = 1, wy = 1;                      // weights of the norm max(|x| / wx, |y| / wy)
        double q = 0;                               // at least |I - Y J| in that norm
        double slack = 0, noise = 0;                // of it: of the border, and what rounding may make of a step
    };
    void set(Leaf& leaf, const Box& box) const;
    void add_leaves(const Box& box, int depth);
    static std::array<Box, 2> halves(const Leaf& leaf);
    bool outside(const Box& box) const { return patch_.domain() == Domain::triangle && box.u.lo + box.v.lo >= 1; }
    /// Half `k` of a leaf, in `kept` where it is too small to be kept for other rays; nullptr outside the domain.
    const Leaf* half_of(const Leaf& leaf, int k, std::vector<std::unique_ptr<const Leaf>>& kept) const;
    Aim aim(const Leaf& leaf, const RayPlanes& ray, double farthest) const;
    Vec2 place(const Leaf& leaf, double x, double y, double& cx, double& cy) const;
    void solve(const Leaf& leaf, const RayPlanes* const* rays, const double* farthest, const Aim* aims, int n, Roots* const* found) const;
    void prove(const Leaf& leaf, const RayPlanes& ray, const Aim& aim, double x, double y, Root& root) const;
    void search(const Leaf& leaf, const RayPlanes& ray, double farthest, Roots& found) const;
    void settle(const Leaf& leaf, const RayPlanes& ray, double farthest, Roots& found) const;

    Patch patch_;
    double size_, slack_;
    std::deque<Leaf> leaves_;
    mutable std::atomic<std::size_t> kept_{0};  // halves
    mutable std::atomic<std::uint64_t> halved_{0};
};

}  // namespace isoparm
