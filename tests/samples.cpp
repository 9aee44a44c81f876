// samples.cpp -- all types of surfaces, and random data to build them with.
#include "samples_parts.h"

#include <algorithm>

#include "curves/bezier.h"

namespace isoparm::tests {
const std::vector<PatchType>& patch_types() {
    static const std::vector<PatchType> list = [] {
        std::vector<PatchType> all = quad_types();
        for (const auto* more : {&network_types(), &triangle_types()}) all.insert(all.end(), more->begin(), more->end());
        return all;
    }();
    return list;
}

Vec2 random_parameter(Random& random, const Patch& patch, double margin) {
    if (patch.domain() == Domain::triangle) {
        double a = random.number(), b = random.number();
        if (a + b > 1) a = 1 - a, b = 1 - b;
        return {margin + (1 - 3 * margin) * a, margin + (1 - 3 * margin) * b};
    }
    const Rect r = patch.rect();
    return {r.u0 + (r.u1 - r.u0) * random.number(margin, 1 - margin),
            r.v0 + (r.v1 - r.v0) * random.number(margin, 1 - margin)};
}

double size_of_sample(const Patch& patch, const Point& origin) {
    Random random(1);
    double size = 0;
    for (int k = 0; k < 20; ++k) {
        const Vec2 p = random_parameter(random, patch);
        size = std::max(size, distance(patch.point(p.x, p.y), origin));
    }
    return size;
}
double size_of_sample(const Curve& curve, const Point& origin) {
    double size = 0;
    for (int k = 0; k <= 20; ++k)
        size = std::max(size, distance(curve(curve.begin() + (curve.end() - curve.begin()) * k / 20), origin));
    return size;
}

// ---- data to build with -----------------------------------------------------------------------------------------------
std::vector<Point> random_points(Random& r, int count) {
    std::vector<Point> list;
    for (int i = 0; i < count; ++i) list.push_back(r.point({0.7 * i, 0, 0}));
    return list;
}
std::vector<double> random_weights(Random& r, int count) {
    std::vector<double> list;
    for (int i = 0; i < count; ++i) list.push_back(r.number(0.4, 2.5));
    return list;
}
Grid<double> random_weights(Random& r, int rows, int columns) {
    Grid<double> grid;
    for (int i = 0; i < rows; ++i) grid.push_back(random_weights(r, columns));
    return grid;
}
Transform random_map(Random& r) {
    return Transform::translate(r.offset()) * Transform::mirror(r.vector() + Point{0, 0, 2}, 0.3) *
           Transform::rotate({1, 2, 3}, r.number(0, 360)) * Transform::scale({1.5, 0.5, 2});
}
Curve random_cubic(Random& r, const Point& from, const Point& to) {
    return make_bezier({from, 0.7 * from + 0.3 * to + r.vector(0.5), 0.3 * from + 0.7 * to + r.vector(0.5), to});
}
Frame random_frame(Random& r, Curve (*between)(Random&, const Point&, const Point&)) {
    const Point p00 = r.point({0, 0, 0}, 0.3), p10 = r.point({2, 0, 0}, 0.3), p01 = r.point({0, 2, 0}, 0.3),
                p11 = r.point({2, 2, 0}, 0.3);
    const Curve c0 = between(r, p00, p10), c1 = between(r, p01, p11), d0 = between(r, p00, p01),
                d1 = between(r, p10, p11);
    return {c0, c1, d0, d1};
}
std::array<Curve, 3> random_triangle(Random& r, Curve (*between)(Random&, const Point&, const Point&)) {
    const Point a = r.point({2, 0, 0}, 0.3), b = r.point({0, 2, 0}, 0.3), c = r.point({0, 0, 0}, 0.3);
    const Curve e1 = between(r, b, c), e2 = between(r, c, a), e3 = between(r, a, b);
    return {e1, e2, e3};
}
std::array<Curve, 3> random_cross(Random& r, const std::array<Curve, 3>& e, double spread) {
    std::vector<Curve> d;
    for (int k = 0; k < 3; ++k) {
        const Curve &own = e[k], &before = e[(k + 2) % 3], &after = e[(k + 1) % 3];
        const Point first = -before.derivative(1) - 0.5 * own.derivative(0), last = after.derivative(0) + 0.5 * own.derivative(1);
        d.push_back(make_bezier({first, 0.5 * (first + last) + r.vector(spread), last}));
    }
    return {d[0], d[1], d[2]};
}
std::array<Curve, 3> normals_of(const std::array<Curve, 3>& e, const std::array<Curve, 3>& d) {
    std::vector<Curve> list;
    for (int k = 0; k < 3; ++k) {
        Point x[4], y[4], n[5]{};
        e[k].taylor(0.0, 3, x);
        d[k].taylor(0.0, 3, y);
        for (int i = 0; i <= 2; ++i)
            for (int j = 0; j <= 2; ++j) n[i + j] += (i + 1.0) * cross(x[i + 1], y[j]);
        std::vector<Point> b(5);  // powers to Bezier
        for (int i = 0; i <= 4; ++i)
            for (int j = 0; j <= i; ++j) b[i] += (binomial(i, j) / binomial(4, j)) * n[j];
        list.push_back(make_bezier(b));
    }
    return {list[0], list[1], list[2]};
}
std::vector<std::vector<Point>> random_net(Random& r, int rows, int columns) {
    std::vector<std::vector<Point>> p(rows);
    for (int i = 0; i < rows; ++i)
        for (int j = 0; j < columns; ++j) p[i].push_back(r.point({double(i), double(j), 0}, 0.4));
    return p;
}

}  // namespace isoparm::tests
