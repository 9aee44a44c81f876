// gregory_edges.cpp -- Gregory's surfaces at the edges of their cells, where they are rational with denominators that have no zeros.
//
// The term of a corner, with p and q the distances from its edges u = const and v = const, is c p^2 q / (p + q) (1-p)^2 (1-q)^2. For a fixed inner point of an edge,
//   along p = 0:  p^2 q / (p + q) = p^2 + O(p^3)               along q = 0:  p^2 q / (p + q) = p q - q^2 + O(q^3)
//   along p = 1:  (1-p)^2 q / (1 + q) (1-q)^2 + O((1-p)^3)     along q = 1:  (1-q)^2 p^2 / (1 + p) (1-p)^2 + O((1-q)^3)
// so that with these in its place position, first and second derivatives on the edge are the same. At the corner itself second derivatives do not exist; those of the forms are their limits along the edge.
#include "patches/hermite_surface.h"

#include "exact_parts.h"
#include "patch_model.h"
#include "patches/forwarding.h"

namespace isoparm {
namespace {

class WithEdgeForms final : public ForwardingPatch {
public:
    WithEdgeForms(HermiteSurface surface, Patch model)
        : ForwardingPatch(std::move(model)), surface_(std::move(surface)), lines_u_(patch_.lines_u()), lines_v_(patch_.lines_v()) {}

    std::vector<Polynomial> exact_cell(std::size_t i, std::size_t j) const override {
        const std::size_t cells = lines_u_.size() - 1;
        if (i >= cells) return form_at(i % cells, j, static_cast<int>(i / cells) - 1);
        auto form = patch_.exact_cell(i, j);
        return form.empty() ? std::vector<Polynomial>(2, Polynomial(0)) : form;
    }

private:
    /// x, y, z and the denominator, beside edge k of cell (m,n).
    std::vector<Polynomial> form_at(std::size_t m, std::size_t n, int k) const {
        const Polynomial u = Polynomial::variable_u({lines_u_[m], lines_u_[m + 1]}), v = Polynomial::variable_v({lines_v_[n], lines_v_[n + 1]}), one(1);
        const Vec3<Polynomial> sum = surface_.sum(u, v);
        if (!sum.x.exists() || !sum.y.exists() || !sum.z.exists()) return {};
        const bool is_u = k == 1 || k == 3;  // the edge is u = const
        const std::size_t side = k == 1 || k == 2 ? 1 : 0;
        const Polynomial s = surface_.sum.basis_u.cells.local(m, u), t = surface_.sum.basis_v.cells.local(n, v), low = is_u ? t : s;
        const Polynomial factor[2] = {one + low, Polynomial(2) - low}, all = factor[0] * factor[1];  // 1 + the distance from either end of the edge
        Vec3<Polynomial> x{sum.x * all, sum.y * all, sum.z * all};
        for (std::size_t i = 0; i < 2; ++i)
            for (std::size_t j = 0; j < 2; ++j) {
                const Point& step = surface_.jump[m + i][n + j];
                if (step == Point{}) continue;
                const Polynomial p = i == 0 ? s : one - s, q = j == 0 ? t : one - t, p_far = one - p, q_far = one - q;
                const bool near = (is_u ? i : j) == side;
                const Polynomial& other = factor[1 - (is_u ? j : i)];  // all of the denominator but the corner's own factor
                const Polynomial ratio = near ? (is_u ? p * p : p * q - q * q) * all : (is_u ? q : p * p) * other;
                const Polynomial weight = ratio * (p_far * p_far) * (q_far * q_far) * Polynomial(i == j ? -1.0 : 1.0);
                for (int axis = 0; axis < 3; ++axis) x[axis] = x[axis] + weight * Polynomial(step[axis]);
            }
        return {x.x, x.y, x.z, all};
    }

    HermiteSurface surface_;
    std::vector<double> lines_u_, lines_v_;
};

}  // namespace

Patch with_edge_forms(HermiteSurface surface, Patch model) {
    if (surface.jump.empty() || surface.sum.part != Part::sum) return model;
    return Patch(std::make_shared<WithEdgeForms>(std::move(surface), std::move(model)));
}

}  // namespace isoparm
