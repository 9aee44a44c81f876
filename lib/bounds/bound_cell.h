// bound_cell.h -- one enclosure of a patch over a cell of its domain, which serves all triangles inside the cell.
//
// A cell knows the second derivatives at its centre and the range of the third ones over it, in plain doubles with their
// radii. The bound of a triangle then takes a few hundred operations of plain arithmetic, whose rounding is bounded beforehand.
// Cells form a tree that grows where a triangle would pass with sharper numbers. docs/certificates.md has the proof.
#pragma once
#include <atomic>
#include <memory>
#include <mutex>
#include <span>

#include "bound.h"
#include "bounds/model_source.h"
#include "bounds/second_derivatives.h"
#include "bounds/triangle_lanes.h"

namespace isoparm {

class BoundCell {
public:
    /// The cell of a box between breaks.
    BoundCell(const Patch& patch, const Box& box);
    ~BoundCell();
    BoundCell(const BoundCell&) = delete;
    BoundCell& operator=(const BoundCell&) = delete;

    /// Bounds a triangle of this cell. `cell` is the cell in the tree to begin with; it becomes the one that was used,
    /// which serves the triangle's parts too. Finer cells are made only where they may decide whether `tolerance` is kept.
    /// `turn`: the same for turn, none where it is to be bounded but may be anything, or unasked.
    /// `decide`: a bound above the tolerance may be any, or none; it is not asked then why, or which edge is the worst.
    /// Safe to call from several threads; the result does not depend on which cells exist.
    static TriangleBound bound(const Patch& patch, const BoundCell*& cell, const CornerData& triangle, double tolerance, Measure measure,
                               double turn = TriangleBound::none, bool decide = false);

    /// The cell of the tree below this one whose polynomial serves the box as well as a smaller cell's would; nullptr where there is none.
    const BoundCell* sharp_cell(const Patch& patch, const Box& box) const;
    /// Bounds triangles of this cell, which is a sharp_cell() of each, by their own boxes and so as sharply as the above can: eight
    /// at once. `tolerance` is that of the mesh, the slack of the triangles included; `bounds` has their number. `quick`: less sharply. Thread-safe.
    void bound_all(const Patch& patch, std::span<const CornerData> triangles, double tolerance, Measure measure, double turn, bool quick, TriangleBound* bounds) const;
    /// The sharper part of bound_all() where the first is done: `bounds` hold what bound_lanes() says of all these triangles, which are above the tolerance.
    void sharpen(const Patch& patch, std::span<const CornerData> triangles, double tolerance, Measure measure, double turn, TriangleBound* bounds) const;
    /// A cell of the tree below this one that is not much wider than the triangle.
    const BoundCell* around(const Patch& patch, const Box& box) const;

    /// Of a box in the cell, as sharp as can be; third derivatives are enclosed over parts x parts pieces.
    SecondDerivatives model_of(const Patch& patch, const Box& box, int parts = 1) const;
    const SecondDerivatives& model() const { return model_; }
    /// The surface, or near it; need not exist.
    const PolynomialCell& polynomial() const { return *polynomial_; }
    /// At least the distance of x from the surface at p, a point of the cell, which is one between breaks; infinite where that takes intervals.
    double quick_slack(const Vec2& p, const Point& x) const { return polynomial_->exact() ? polynomial_->slack(p, x) : source_->slack(p, x); }

private:
    BoundCell(const Patch& patch, const Box& box, const Box& reach, const BoundCell& parent);
    bool wider(const Box& box) const { return box_.u.hi - box_.u.lo > box.u.hi - box.u.lo && box_.v.hi - box_.v.lo > box.v.hi - box.v.lo; }
    /// The child whose reach holds the box, made if it is not there yet; nullptr where none holds it.
    const BoundCell* child(const Patch& patch, const Box& of) const;
    void sharpen(const Patch& patch, std::span<const CornerData> triangles, std::span<const int> which, double tolerance, const LanesAsked& asked, TriangleBound* bounds) const;
    Box box_;    // children halve it
    Box reach_;  // a margin wider: triangles that lie in here are served
    std::shared_ptr<const PolynomialCell> polynomial_;
    std::shared_ptr<const ModelSource> source_;  // none where the polynomial is exact
    bool sharp_;                                 // the polynomial serves all triangles in here, and all cells below
    SecondDerivatives model_;
    mutable std::array<std::atomic<BoundCell*>, 4> children_{};
    /// What model_of() was asked last, by whether in one piece: the two triangles of a quadrilateral mostly share their box.
    struct Last {
        Box box;
        int parts = 0;
        SecondDerivatives model;
    };
    mutable std::mutex last_guard_;
    mutable std::array<std::unique_ptr<const Last>, 2> last_;
};

/// The bound of a triangle in the box of the model, its turn left out where `turns` is false. `least`: what no finer cell could go below,
/// as far as the model tells; no bound.
TriangleBound bound_triangle(const SecondDerivatives& model, const CornerData& triangle, Measure measure, bool least = false, bool turns = true);

}  // namespace isoparm
