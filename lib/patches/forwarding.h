// patches/forwarding.h -- a patch that is another one, but for what a derived class says.
#pragma once
#include "patch.h"

namespace isoparm {

class ForwardingPatch : public Patch::Concept {
public:
    explicit ForwardingPatch(Patch patch) : patch_(std::move(patch)) {}
    Domain domain() const override { return patch_.domain(); }
    Rect rect() const override { return patch_.rect(); }
    std::vector<double> breaks_u() const override { return patch_.breaks_u(); }
    std::vector<double> breaks_v() const override { return patch_.breaks_v(); }
    Point point(double u, double v) const override { return patch_.point(u, v); }
    PointJet jet(double u, double v) const override { return patch_.jet(u, v); }
    PointFrame frame(double u, double v) const override { return patch_.frame(u, v); }
    void points(std::size_t n, const double* u, const double* v, Point* out) const override { patch_.points(n, u, v, out); }
    void frames(std::size_t n, const double* u, const double* v, PointFrame* out) const override { patch_.frames(n, u, v, out); }
    void frame_arrays(Isa isa, std::span<const double> u, std::span<const double> v, const FrameArrays& out) const override { patch_.frames(u, v, out, isa); }
    Enclosure enclose(const Box& box) const override { return patch_.enclose(box); }
    Vec3<Interval> enclose_points(const Box& box) const override { return patch_.enclose_points(box); }
    std::vector<Polynomial> model(const Box& box) const override { return patch_.model(box); }
    const PolynomialCells* batch() const override { return patch_.batch(); }
    std::vector<Polynomial> exact_cell(std::size_t i, std::size_t j) const override { return patch_.exact_cell(i, j); }
    std::optional<Point> singular_normal(double u, double v) const override { return patch_.singular_normal(u, v); }

protected:
    Patch patch_;
};

}  // namespace isoparm
