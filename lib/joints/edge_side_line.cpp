#include "joints/edge_side.h"

namespace isoparm {

using Jet2 = JetUV<TaylorModel, 2>;

// From the four parts of has_line_form(), functions along the line. Numbers are denominators 1, and no f3.
EdgeSide::Jet EdgeSide::of_line_form(const std::vector<Jet2>& form) const {
    const auto has = [&](std::size_t k) { return exact_[4 * k + 3].degree_u() > 0; };
    const auto inverse = [&](std::size_t k) { return TaylorModel(1.0) / form[4 * k + 3].c[0]; };
    const TaylorModel sign(sign_), along = has(0) ? inverse(0) : TaylorModel(), first = has(1) ? inverse(1) : TaylorModel(), extra = has(3) ? inverse(3) : TaylorModel();
    const TaylorModel second = !has(2) ? TaylorModel() : square_of_first_ ? first * first : inverse(2);
    const Jet2& w = form[3];
    Jet r;
    for (int axis = 0; axis < 3; ++axis) {
        const auto part = [&](std::size_t k) -> const Jet2& { return form[4 * k + std::size_t(axis)]; };
        Jet2 f0 = part(0);
        if (has(0)) {
            auto& f = f0.c;
            f[0] = f[0] * along, f[1] = (f[1] - f[0] * w.c[1]) * along, f[3] = (f[3] - f[1] * w.c[1] - f[0] * w.c[3]) * along;
        }
        TaylorModel f1 = part(1).c[0], slope = part(1).c[1], f2 = part(2).c[0];
        if (has(1)) f1 = f1 * first, slope = (slope - f1 * form[7].c[1]) * first;
        if (has(2)) f2 = f2 * second;
        if (has(3)) f2 = f2 + part(3).c[0] * extra;
        auto& c = r[axis].c;
        c[0] = f0.c[0], c[1] = f0.c[1], c[2] = sign * f1, c[3] = f0.c[3], c[4] = sign * slope, c[5] = f2;
    }
    return r;
}

}  // namespace isoparm
