#include "patches/transformed.h"

#include <cmath>

namespace isoparm {
namespace {

/// The map is affine, so it acts on Taylor coefficients: translation on the constant one only.
template <class T, int N> Vec3<JetUV<T, N>> moved(const Transform& map, const Vec3<JetUV<T, N>>& x) {
    Vec3<JetUV<T, N>> y;
    for (int k = 0; k < x.x.size; ++k) {
        const Vec3<T> c{x.x.c[k], x.y.c[k], x.z.c[k]};
        const Vec3<T> d = k == 0 ? map.point(c) : map.vector(c);
        for (int axis = 0; axis < 3; ++axis) y[axis].c[k] = d[axis];
    }
    return y;
}

class Transformed final : public Patch::Concept {
public:
    Transformed(Patch patch, const Transform& map) : patch_(std::move(patch)), map_(map) {}
    Domain domain() const override { return patch_.domain(); }
    Rect rect() const override { return patch_.rect(); }
    std::vector<double> breaks_u() const override { return patch_.breaks_u(); }
    std::vector<double> breaks_v() const override { return patch_.breaks_v(); }
    Point point(double u, double v) const override { return map_.point(patch_.point(u, v)); }
    PointJet jet(double u, double v) const override { return moved(map_, patch_.jet(u, v)); }
    PointFrame frame(double u, double v) const override { return moved(map_, patch_.frame(u, v)); }
    void points(std::size_t n, const double* u, const double* v, Point* out) const override {
        patch_.points(n, u, v, out);
        for (std::size_t i = 0; i < n; ++i) out[i] = map_.point(out[i]);
    }
    void frames(std::size_t n, const double* u, const double* v, PointFrame* out) const override {
        patch_.frames(n, u, v, out);
        for (std::size_t i = 0; i < n; ++i) out[i] = moved(map_, out[i]);
    }
    void frame_arrays(Isa isa, std::span<const double> u, std::span<const double> v, const FrameArrays& out) const override {
        patch_.frames(u, v, out, isa);
        const auto move = [&](const std::array<std::span<double>, 3>& x, auto map) {
            for (std::size_t k = 0; k < u.size(); ++k) {
                const Point p = map(Point{x[0][k], x[1][k], x[2][k]});
                x[0][k] = p.x, x[1][k] = p.y, x[2][k] = p.z;
            }
        };
        move(out.position, [&](const Point& p) { return map_.point(p); });
        for (const auto* d : {&out.du, &out.dv}) move(*d, [&](const Point& p) { return map_.vector(p); });
    }
    Enclosure enclose(const Box& box) const override {
        Enclosure e = patch_.enclose(box);
        e.centre = moved(map_, e.centre);
        e.over = moved(map_, e.over);
        return e;
    }

    Vec3<Interval> enclose_points(const Box& box) const override { return map_.point(patch_.enclose_points(box)); }
    std::vector<Polynomial> exact_cell(std::size_t i, std::size_t j) const override {
        const auto x = patch_.exact_cell(i, j);
        if (x.size() < 3) return x;  // nothing, or parts
        auto y = x;  // denominators stay
        for (std::size_t first = 0; first + 3 <= x.size(); first += 4)  // a position; after it, derivatives (has_line_form)
            for (std::size_t axis = 0; axis < 3; ++axis) {
                y[first + axis] = first > 0 ? Polynomial(0) : (x.size() >= 4 ? x[3] : Polynomial(1)) * Polynomial(map_.m[axis][3]);
                for (std::size_t k = 0; k < 3; ++k) y[first + axis] = y[first + axis] + x[first + k] * Polynomial(map_.m[axis][k]);
            }
        return y;
    }
    std::vector<Polynomial> model(const Box& box) const override {
        const auto x = patch_.model(box);
        auto y = x;
        for (std::size_t axis = 0; axis < x.size(); ++axis) {
            y[axis] = Polynomial(map_.m[axis][3]);
            for (std::size_t k = 0; k < 3; ++k) y[axis] = y[axis] + x[k] * Polynomial(map_.m[axis][k]);
        }
        return y;
    }
    std::optional<Point> singular_normal(double u, double v) const override {
        const auto n = patch_.singular_normal(u, v);
        if (!n) return {};
        const Point t = normalized(cross(std::fabs(n->x) < 0.6 ? Point{1, 0, 0} : Point{0, 1, 0}, *n));
        return normalized(cross(map_.vector(t), map_.vector(cross(*n, t))));
    }

private:
    Patch patch_;
    Transform map_;
};

}  // namespace

Patch transformed(const Patch& patch, const Transform& m) { return Patch(std::make_shared<Transformed>(patch, m)); }

}  // namespace isoparm
