// order_test.cpp -- approximation orders: data taken from a smooth surface over a cell of size h, and how fast the error of
// what is spanned over them falls with h. One row a surface; docs/surfaces.md lists the same orders.
#include <gtest/gtest.h>

#include <numbers>

#include "curves/bezier.h"
#include "patches/bbg.h"
#include "patches/control_net.h"
#include "patches/coons.h"
#include "patches/coons_hermite.h"
#include "patches/gordon.h"
#include "patches/lagrange.h"
#include "patches/nielson.h"
#include "patches/ruled.h"
#include "patches/side_vertex.h"
#include "patches/tensor_hermite.h"
#include "patches/three_curves.h"
#include "patches/translational.h"
#include "samples.h"
#include "scalar/elementary.h"

namespace isoparm::tests {
namespace {

Vec2 operator+(const Vec2& a, const Vec2& b) { return {a.x + b.x, a.y + b.y}; }
Vec2 operator-(const Vec2& a, const Vec2& b) { return {a.x - b.x, a.y - b.y}; }
Vec2 operator*(double s, const Vec2& a) { return {s * a.x, s * a.y}; }

/// The smooth surface: in each coordinate a sum of waves a sin(p x + q y + r). Its derivative in the direction d is the same
/// sum with the amplitudes a (p d.x + q d.y) and a quarter of a turn more, so every derivative is exact.
struct Wave {
    double a, p, q, r;
};
constexpr Wave kWaves[3][2] = {{{1.1, 0.6, 0.9, 0.2}, {0.3, 1.9, -1.4, 1.0}},
                               {{1.3, -0.8, 0.7, 0.5}, {0.25, 1.5, 1.8, 2.0}},
                               {{0.9, 1.1, 0.5, 1.3}, {0.35, -1.6, 1.7, 0.4}}};

/// t -> derivative in the `directions` of the smooth surface at from + t (to - from).
struct Along2d {
    Vec2 from, to;
    std::vector<Vec2> directions;
    double begin = 0, end = 1;

    template <class S> Vec3<S> operator()(const S& t) const { return {coordinate(0, t), coordinate(1, t), coordinate(2, t)}; }
    Vec3<Polynomial> operator()(const Polynomial&) const {
        return {Polynomial::nothing(), Polynomial::nothing(), Polynomial::nothing()};
    }

private:
    template <class S> S coordinate(int axis, const S& t) const {
        using std::sin;
        S sum(0.0);
        for (const Wave& w : kWaves[axis]) {
            double a = w.a, phase = w.r + w.p * from.x + w.q * from.y;
            for (const Vec2& d : directions) a *= w.p * d.x + w.q * d.y, phase += std::numbers::pi / 2;
            sum = sum + a * sin(t * (w.p * (to.x - from.x) + w.q * (to.y - from.y)) + phase);
        }
        return sum;
    }
};
Curve curve(const Vec2& from, const Vec2& to, const std::vector<Vec2>& directions = {}) {
    return make_curve(Along2d{from, to, directions});
}
Point smooth(const Vec2& at, const std::vector<Vec2>& directions = {}) { return Along2d{at, at, directions}(0.0); }

/// Data over a cell: the parallelogram o + u U + v V, or the triangle A = o, B = o + U, C = o + V.
struct Cell {
    Vec2 o, U, V;
    Vec2 at(double u, double v) const { return o + u * U + v * V; }
    Curve along_u(double v, const std::vector<Vec2>& d = {}) const { return curve(at(0, v), at(1, v), d); }
    Curve along_v(double u, const std::vector<Vec2>& d = {}) const { return curve(at(u, 0), at(u, 1), d); }
    CoonsCurves frame() const { return {along_u(0), along_u(1), along_v(0), along_v(1)}; }
    HermiteData hermite() const {
        return {{along_v(0), along_v(0, {U}), along_v(1, {U}), along_v(1)}, {along_u(0), along_u(0, {V}), along_u(1, {V}), along_u(1)}};
    }
    Grid<Point> nodes(const std::vector<Vec2>& d = {}) const {
        return {{smooth(at(0, 0), d), smooth(at(0, 1), d)}, {smooth(at(1, 0), d), smooth(at(1, 1), d)}};
    }
    GordonNetwork gordon() const {
        const std::vector<double> t{0, 0.5, 1};
        return {{along_u(0), along_u(0.5), along_u(1)}, t, {along_v(0), along_v(0.5), along_v(1)}, t};
    }
    /// Cubics with the ends and end tangents of the boundary curves.
    ControlFrame control() const {
        const auto cubic = [&](const Vec2& from, const Vec2& to) {
            const Point p = smooth(from), q = smooth(to), a = smooth(from, {to - from}), b = smooth(to, {to - from});
            return SplineCurve{3, {0, 0, 0, 0, 1, 1, 1, 1}, {p, p + a / 3.0, q - b / 3.0, q}};
        };
        return {cubic(at(0, 0), at(1, 0)), cubic(at(0, 1), at(1, 1)), cubic(at(0, 0), at(0, 1)), cubic(at(1, 0), at(1, 1))};
    }
    Patch lagrange(int n) const {
        std::vector<Curve> curves;
        std::vector<double> nodes;
        for (int k = 0; k <= n; ++k) nodes.push_back(double(k) / n), curves.push_back(along_u(nodes.back()));
        return make_lagrange(curves, nodes);
    }
    Vec2 vertex(int k) const { return k % 3 == 0 ? o : k % 3 == 1 ? o + U : o + V; }
    std::array<Curve, 3> edges() const { return {edge(0), edge(1), edge(2)}; }
    /// D_k along E_k: in the direction of the median, from the middle of the edge to the vertex opposite.
    std::array<Curve, 3> cross() const {
        const auto median = [&](int k) { return vertex(k) - 0.5 * (vertex(k + 1) + vertex(k + 2)); };
        return {edge(0, {median(0)}), edge(1, {median(1)}), edge(2, {median(2)})};
    }
    Curve edge(int k, const std::vector<Vec2>& d = {}) const { return curve(vertex(k + 1), vertex(k + 2), d); }
    /// (u,v) of a patch on the triangle.
    Vec2 on_triangle(double u, double v) const { return u * vertex(0) + v * vertex(1) + (1 - u - v) * vertex(2); }
};

struct Row {
    const char* name;
    double order;
    Patch (*make)(const Cell&);
};
using Kind = BbgForm::Kind;
const Row kRows[] = {
    {"Bilinear", 4, [](const Cell& c) { return make_coons(c.frame()); }},
    {"PartiallyBicubic", 2, [](const Cell& c) { return make_coons(c.frame(), cubic_blend()); }},
    {"CoonsWithASquare", 2, [](const Cell& c) { return make_coons(c.frame(), Function::polynomial({0, 0, 1})); }},
    {"TranslationalBlend", 4, [](const Cell& c) { return make_translational_blend(c.frame()); }},
    {"ControlNet", 4, [](const Cell& c) { return make_control_net(c.control()); }},
    {"Ruled", 2, [](const Cell& c) { return make_ruled(c.along_u(0), c.along_u(1)); }},
    {"Lagrange3", 3, [](const Cell& c) { return c.lagrange(2); }},
    {"Lagrange4", 4, [](const Cell& c) { return c.lagrange(3); }},
    {"HermiteCoons", 8, [](const Cell& c) { return make_coons_hermite(c.hermite()); }},
    {"GregoryCompatible", 8, [](const Cell& c) { return make_coons_hermite(c.hermite(), Twist::gregory); }},
    {"TensorHermite", 4, [](const Cell& c) { return make_tensor_hermite(c.nodes(), c.nodes({c.U}), c.nodes({c.V}), c.nodes({c.U, c.V})); }},
    {"TensorHermiteNoTwist", 2, [](const Cell& c) { return make_tensor_hermite(c.nodes(), c.nodes({c.U}), c.nodes({c.V})); }},
    {"Gordon3x3", 6, [](const Cell& c) { return make_gordon(c.gordon()); }},
    {"GordonHats", 2, [](const Cell& c) { return make_gordon(c.gordon(), GordonBlend::hermite); }},
    {"SideVertexT", 2, [](const Cell& c) { return make_side_vertex(c.edges(), Function::polynomial({0, 1})); }},
    {"SideVertexT2", 3, [](const Cell& c) { return make_side_vertex(c.edges(), Function::polynomial({0, 0, 1})); }},
    {"SideVertexDelta2T3T4", 2, [](const Cell& c) { return make_side_vertex(c.edges(), Function::polynomial({0, 0, 0, 2, -1})); }},
    {"SideVertexDeltaSmooth", 2, [](const Cell& c) { return make_side_vertex(c.edges(), cubic_blend()); }},
    {"ThreeCurves", 2, [](const Cell& c) { return make_three_curves(c.edges()); }},
    {"BbgConvex", 2, [](const Cell& c) { return make_bbg(c.edges(), {Kind::convex}); }},
    {"BbgBoolean", 3, [](const Cell& c) { return make_bbg(c.edges(), {Kind::boolean, 1, 2}); }},
    {"BbgSymmetric", 3, [](const Cell& c) { return make_bbg(c.edges(), {Kind::symmetric}); }},
    {"BbgC1", 4, [](const Cell& c) { return make_bbg_c1(c.edges(), c.cross()); }},
    {"NielsonC1", 4, [](const Cell& c) { return make_nielson_c1(c.edges(), c.cross()); }},
};
std::ostream& operator<<(std::ostream& out, const Row& r) { return out << r.name; }

class Order : public ::testing::TestWithParam<Row> {};

/// Largest error over a few cells of size h, whose places and shapes do not depend on h.
double error(const Row& row, double h) {
    Random r(1);
    double worst = 0;
    for (int n = 0; n < 4; ++n) {
        const double turn = r.number(0, 0.6);
        const Cell cell{{r.number(-1, 1), r.number(-1, 1)},
                        {h * std::cos(turn), h * std::sin(turn)},
                        {-h * std::sin(turn - 0.2), h * std::cos(turn - 0.2)}};
        const Patch patch = row.make(cell);
        for (int i = 0; i <= 12; ++i)
            for (int j = 0; j <= 12; ++j) {
                const double u = i / 12.0, v = j / 12.0;
                if (patch.domain() == Domain::quad) worst = std::max(worst, distance(patch.point(u, v), smooth(cell.at(u, v))));
                else if (i + j <= 12) worst = std::max(worst, distance(patch.point(u, v), smooth(cell.on_triangle(u, v))));
            }
    }
    return worst;
}

TEST_P(Order, IsThatOfTheTable) {
    // Sizes such that the smallest error is far above rounding: the order 8 has 1e-4 h^8 or so.
    const double first = GetParam().order > 5 ? 1 : 0.25;
    const int steps = 4;
    double mean_x = 0, mean_y = 0, xx = 0, xy = 0;
    std::vector<std::pair<double, double>> points;
    for (int k = 0; k < steps; ++k) {
        const double h = first * std::pow(0.5, k), e = error(GetParam(), h);
        ASSERT_GT(e, 1e-13) << "rounding, not approximation, at h = " << h;
        points.emplace_back(std::log2(h), std::log2(e));
        mean_x += points.back().first / steps, mean_y += points.back().second / steps;
    }
    for (const auto& [x, y] : points) xx += (x - mean_x) * (x - mean_x), xy += (x - mean_x) * (y - mean_y);
    RecordProperty("order", std::to_string(xy / xx));
    EXPECT_NEAR(xy / xx, GetParam().order, 0.3);
}

INSTANTIATE_TEST_SUITE_P(Surface, Order, ::testing::ValuesIn(kRows), name_of);

}  // namespace
}  // namespace isoparm::tests
