// exact_quick.h -- rays against the leaves of a patch in float32, sixteen side by side: what is surely missed, what surely met, and what only
// double precision can tell; internal to exact_patch.cpp and the callbacks of Embree.
//
// Bounds hold the rounding of float32 and the distance of a leaf's polynomial from the surface (docs/exact.md, "In float32"). The numbers of a ray are the same
// alone and in any packet, and with every instruction set.
#pragma once
#include <cstdint>
#include <vector>

#include "rays/exact_patch.h"

namespace isoparm {

/// Rays relative to the centre of the scene: origins and directions are those that Embree has.
struct QuickRays {
    static constexpr int lanes = RayPacket::lanes;
    const float* origin[3] = {};
    const float* direction[3] = {};
    alignas(64) float n1[3][lanes], n2[3][lanes];

    /// Takes n1 and n2; origins and directions are given separately.
    void set_planes(const RayPacket& rays);
};

/// LeafMap in float32, relative to the centre. S = s + Q / w for -1 <= x, y <= 1, Q and w (1 unless rational) of coefficients at x^i y^j.
struct QuickLeaf {
    enum Kind : std::uint32_t { none, quadric, rational_quadric, cubic, rational_cubic };
    float s[3], a[3], b[3], second[3][3];
    float bend;              // of s + a x + b y
    float turn_u, turn_v, uu, uv, vv;
    float size_a, size_b;    // at least |S_u hu|, |S_v hv| anywhere
    float sum_a, sum_b;      // |a|_1, |b|_1
    float area;              // seen smaller than that, the leaf is left to double precision
    float error, slope_error;  // of the polynomials, as they are computed, and of their derivatives
    float slant_u, slant_v, slant;  // the leaf is where slant_u x + slant_v y + slant <= 0
    std::uint32_t kind, first;      // coefficient
};

/// Of the rays that surely meet a leaf: about where, and between which distances.
struct QuickHits {
    alignas(64) float x[QuickRays::lanes], y[QuickRays::lanes], near[QuickRays::lanes], far[QuickRays::lanes];
    std::uint32_t met, open;  // lanes; open: whether they meet it is not known
};

/// Where the lanes with valid[i] != 0 meet a leaf; those that do so beyond tfar[i] may be left out.
using QuickKernel = void (*)(const QuickLeaf& leaf, const float* coefficients, const QuickRays& rays, const float* tfar, const int* valid, QuickHits& hits);
const QuickKernel* quick_kernels(Isa isa);  // by QuickLeaf::Kind

/// The leaves of a patch in a scene about `centre`. Immutable.
class QuickPatch {
public:
    QuickPatch(const ExactPatch& patch, const Point& centre);
    const QuickLeaf& leaf(std::size_t i) const { return leaves_[i]; }
    const float* coefficients(std::size_t i) const { return coefficients_.data() + leaves_[i].first; }
    /// False where there is only double precision for this leaf.
    bool meet(std::size_t leaf, const QuickRays& rays, const float* tfar, const int* valid, QuickHits& hits) const {
        const QuickLeaf& l = leaves_[leaf];
        if (l.kind == QuickLeaf::none) return false;
        kernels_[l.kind](l, coefficients_.data() + l.first, rays, tfar, valid, hits);
        return true;
    }

private:
    void add(std::size_t leaf, const Point& centre);

    const ExactPatch& patch_;
    const QuickKernel* kernels_;
    std::vector<QuickLeaf> leaves_;
    std::vector<float> coefficients_;
};

}  // namespace isoparm
