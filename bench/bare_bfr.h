// bare_bfr.h -- OpenSubdiv's limit surface of one regular face, evaluated as its documentation says. bare_bfr.cpp is the only file here
// that includes OpenSubdiv.
#pragma once
#include <memory>

#include "patches/tensor_bezier.h"

namespace isoparm::bench {

class BareBfr {
public:
    /// The middle face of a cage of 4 x 4 vertices: the uniform bicubic B-spline over [0,1]^2 with these control points.
    explicit BareBfr(const Grid<Point>& net);
    ~BareBfr();

    /// p, p + 3, p + 6: position, d/du, d/dv.
    void evaluate(double u, double v, double* p) const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace isoparm::bench
