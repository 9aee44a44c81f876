// curves/lane_by_lane.h -- curves that have no formula of their own on packs.
#pragma once
#include "curve.h"

namespace isoparm {

/// What a curve must answer on packs, by its answers on numbers.
template <class C> void lane_by_lane(const C& c, const Pack& t, int order, Vec3<Pack>* out) {
    Vec3<double> one[4];
    for (int i = 0; i < Pack::lanes; ++i) {
        c.taylor(t[i], order, one);
        for (int k = 0; k <= order; ++k)
            for (int axis = 0; axis < 3; ++axis) out[k][axis].set(i, one[k][axis]);
    }
}

}  // namespace isoparm
