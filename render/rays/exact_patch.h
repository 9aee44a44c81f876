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

#include "patch.h"
#include "rays/exact_kernel.h"
#include "rays/exact_pieces.h"

namespace isoparm {

/// Where a ray meets the patch. Without initial values: there are many of them in every packet.
struct Root {
    double distance, u, v;
    double error;  // proved, scene units: the exact point is no farther than this from S(u,v); infinite: not proved
};

/// What a ray meets in one leaf.
struct Roots {
    static constexpr int most = 8;
    int count;
    bool undecided;  // some place was neither proved to be met nor to be missed
    Root root[most];
};

class ExactPatch {
public:
    static constexpr int packet = RayPacket::lanes;
    using Lanes = std::uint32_t;  // a bit for each ray of a packet

    /// `size`: diagonal of the scene. A ray counts as meeting the border of the patch where it passes within slack(size) of it, so that
    /// nothing shines through between neighbours. Refers to the patch. Throws Error(input) where the patch cannot be bounded.
    ExactPatch(const Patch& patch, double size);
    static double slack(double size) { return 1e-10 * size; }

    std::size_t leaves() const { return leaves_.size(); }
    /// Holds the patch over that leaf.
    Bounds box(std::size_t leaf) const { return leaves_[leaf].values; }
    const LeafMap& map(std::size_t leaf) const { return leaves_[leaf]; }
    std::uint32_t cell(std::size_t leaf) const { return leaves_[leaf].cell; }
    const Patch& patch() const { return patch_; }
    double slack() const { return slack_; }
    /// How many boxes were halved for single rays until now: what takes long.
    std::uint64_t halved() const { return halved_.load(std::memory_order_relaxed); }
    /// Where rays meet a leaf, at distances from 0 to farthest[i]: those of the first n lanes that have a bit in `active`. `farthest` has
    /// numbers for all lanes.
    void meet(std::size_t leaf, const RayPacket& rays, const double* farthest, int n, Lanes active, Roots* found) const;
    /// The roots of rays that surely meet one leaf each, once, in it, about (x,y) of its map; the lanes of those that can be proved so.
    Lanes certify(const std::uint32_t* leaf, const RayPacket& rays, const float* x, const float* y, Lanes active, Root* root) const;

private:
    struct Leaf : LeafMap {
        Bounds values;
        std::uint32_t cell = 0;  // of the patch
        std::uint32_t top = 0;   // the leaf that it is a part of
        int depth = 0;           // bisections below a leaf
        mutable std::array<std::atomic<const Leaf*>, 2> halves{};  // made when a ray first needs them

        Leaf() = default;
        Leaf(const Leaf&) = delete;
        Leaf& operator=(const Leaf&) = delete;
        ~Leaf();
    };
    void set(Leaf& leaf, const Box& box, std::uint32_t cell) const;
    void add_leaves(const Box& box, std::uint32_t cell, int depth);
    static std::array<Box, 2> halves(const Leaf& leaf);
    bool outside(const Box& box) const { return patch_.domain() == Domain::triangle && box.u.lo + box.v.lo >= 1; }
    /// Half `k` of a leaf, in `kept` where it is too small to be kept for other rays; nullptr outside the domain.
    const Leaf* half_of(const Leaf& leaf, int k, std::vector<std::unique_ptr<const Leaf>>& kept) const;
    void aim(const Leaf& leaf, const RayPacket& rays, const double* farthest, int n, AimPacket& out) const;
    void frames(const Leaf& leaf, const ExactPiece* quotient, int n, NewtonPacket& p) const;
    void solve(const Leaf& leaf, const RayPacket& rays, const double* farthest, const AimPacket& aim, int n, Roots* found) const;
    double proved_error(const Leaf& leaf, const RayPacket& rays, const AimPacket& aim, const NewtonPacket& p, int lane) const;
    double enclosed_error(int lane, const RayPacket& rays, const CertainPacket& p) const;
    /// In which S is known to an error where the patch is no polynomial; nullptr where there is none.
    const ExactPiece* piece(std::size_t leaf, double u, double v) const { return pieces_ ? pieces_->at(leaf, leaves_[leaf].box, leaves_[leaf].cell, u, v) : nullptr; }
    const ExactPiece* quotient(const Leaf& leaf) const { return pieces_ ? pieces_->quotient(leaf.top, leaves_[leaf.top].box, leaf.cell) : nullptr; }
    const ExactPiece* rough(const Leaf& leaf) const { return pieces_ ? pieces_->rough(leaf.top, leaves_[leaf.top].box, leaf.cell) : nullptr; }
    Lanes set_frames(const std::uint32_t* leaf, Lanes active, CertainPacket& p) const;
    Lanes visit(const Leaf& leaf, const RayPacket& rays, const double* farthest, int n, Lanes active, Roots* found) const;
    void search(const Leaf& leaf, const RayPacket& rays, const double* farthest, int n, Lanes active, Roots* found) const;
    void settle(const Leaf& leaf, const RayPlanes& ray, double farthest, Roots& found) const;

    Patch patch_;
    const PolynomialCells own_cells_;  // where the patch has none of its own
    const PolynomialCells* cells_;     // of the patch, or nullptr
    const ExactKernel& kernel_;
    const std::vector<double> lines_u_, lines_v_;  // between cells, ends included
    double size_, slack_;
    std::unique_ptr<ExactPieces> pieces_;  // where there are no cells
    std::deque<Leaf> leaves_;
    mutable std::atomic<std::size_t> kept_{0};  // halves
    mutable std::atomic<std::uint64_t> halved_{0};
};

}  // namespace isoparm
