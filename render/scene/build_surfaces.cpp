// build_surfaces.cpp -- surfaces that a scene file gives by their points.
#include <algorithm>

#include "curves/piecewise_bezier.h"
#include "patches/bezier_triangle.h"
#include "patches/tensor_bezier.h"
#include "patches/tensor_hermite.h"
#include "scene/registry.h"

namespace isoparm {

namespace {
/// "01", or "0,10" where an index of two digits makes that ambiguous.
std::string indices(std::initializer_list<int> all, int largest) {
    std::string text;
    for (const int i : all) text += (largest > 9 && !text.empty() ? "," : "") + std::to_string(i);
    return text;
}
}  // namespace

ControlNet net_of(const Grid<Point>& grid) {
    ControlNet net;
    const int rows = static_cast<int>(grid.size()), columns = static_cast<int>(grid.front().size());
    for (int i = 0; i < rows; ++i) {
        for (int j = 0; j < columns; ++j) {
            net.points.push_back(grid[i][j]);
            net.indices.push_back(indices({i, j}, std::max(rows, columns) - 1));
            if (j > 0) net.rods.push_back({i * columns + j - 1, i * columns + j});
            if (i > 0) net.rods.push_back({(i - 1) * columns + j, i * columns + j});
        }
    }
    return net;
}

namespace {
constexpr std::size_t kMost = max_degree + 1;

/// Rows of degree+1, degree, ... 1 points, from the edge w = 0 towards C.
ControlNet net_of(int degree, const std::vector<Point>& points) {
    ControlNet net{points, {}, {}};
    for (int k = 0; k <= degree; ++k)
        for (int j = 0; j <= degree - k; ++j) net.indices.push_back(indices({degree - k - j, j, k}, degree));
    int start = 0;
    for (int row = 0; row < degree; ++row) {
        const int length = degree + 1 - row, above = start + length;
        for (int k = 0; k + 1 < length; ++k) {
            net.rods.push_back({start + k, start + k + 1});
            net.rods.push_back({start + k, above + k});
            net.rods.push_back({start + k + 1, above + k});
        }
        start = above;
    }
    return net;
}

BuiltSurface with_degree(BuiltSurface s, const std::string& degree, bool rational) {
    s.detail = "degree " + degree + (rational ? ", rational" : "");
    return s;
}
std::string by(std::size_t p, std::size_t q) { return std::to_string(p) + " x " + std::to_string(q); }

Json points_of(const Json& j) { return j.at("points", "the points of the surface"); }
Grid<double> weights_of(const Json& j, const SceneValues& values, const Grid<Point>& points) {
    const auto weights = j.find("weights");
    return weights ? values.weight_grid(*weights, points) : Grid<double>{};
}
/// All in one list, or in rows of n + 1, n, ..., 1.
template <class T, class Read> std::vector<T> rows_of(const Json& j, int n, const Read& read) {
    const bool rows = j.is(Json::Kind::array) && static_cast<int>(j.size()) == n + 1 && j[0].is(Json::Kind::array) && static_cast<int>(j[0].size()) == n + 1 &&
                      (std::is_same_v<T, double> || j[0][0].is(Json::Kind::array));
    if (!rows) return read(j, static_cast<std::size_t>((n + 1) * (n + 2) / 2));
    std::vector<T> all;
    for (int k = 0; k <= n; ++k)
        for (const T& x : read(j[static_cast<std::size_t>(k)], static_cast<std::size_t>(n + 1 - k))) all.push_back(x);
    return all;
}
}  // namespace

BuiltSurface build_bezier_patch(const Json& j, SceneBuilder& scene) {
    const auto p = scene.values().grid(points_of(j), 2, 2, kMost);
    const auto w = weights_of(j, scene.values(), p);
    return with_degree({make_bezier_patch(p, w), net_of(p)}, by(p.size() - 1, p.front().size() - 1), !w.empty());
}

BuiltSurface build_bspline_patch(const Json& j, SceneBuilder& scene) {
    const SceneValues& values = scene.values();
    const auto degrees = values.list(j.at("degree", "the degrees [p, q]"), 2, 2, "degrees [p, q]");
    const int p = values.integer(degrees[0], 1, max_degree, "the degree in u"), q = values.integer(degrees[1], 1, max_degree, "the degree in v");
    const auto points = values.grid(points_of(j), static_cast<std::size_t>(p) + 1, static_cast<std::size_t>(q) + 1, 0);
    const auto knots = values.list(j.at("knots", "the knots [[in u], [in v]]"), 2, 2, "knot vectors [[in u], [in v]]");
    const auto knots_u = values.knots(knots[0], p, points.size()), knots_v = values.knots(knots[1], q, points.front().size());
    const auto w = weights_of(j, values, points);
    return with_degree({make_bspline_patch(p, q, knots_u, knots_v, points, w), net_of(points)}, by(p, q), !w.empty());
}

BuiltSurface build_hermite_patch(const Json& j, SceneBuilder& scene) {
    const auto grid = [&](const Json& g) { return scene.values().grid(g, 2, 2, 1000); };
    const auto points = grid(points_of(j)), du = grid(j.at("du", "the derivatives x_u at the points")), dv = grid(j.at("dv", "the derivatives x_v at the points"));
    const auto duv = j.find("duv");
    return make_tensor_hermite(points, du, dv, duv ? grid(*duv) : Grid<Point>{});
}

// Four points P00, P10, P01, P11 (P_ij at u = i, v = j; pbrt's order), or a grid [[P00, P01], [P10, P11]].
BuiltSurface build_bilinear(const Json& j, SceneBuilder& scene) {
    const Json points = points_of(j);
    Grid<Point> grid;
    if (points.is(Json::Kind::array) && points.size() == 2) {
        grid = scene.values().grid(points, 2, 2, 2);
    } else {
        const auto p = scene.values().points(points, 4, 4);
        grid = {{p[0], p[2]}, {p[1], p[3]}};
    }
    return {make_bezier_patch(grid), net_of(grid)};
}

BuiltSurface build_triangle(const Json& j, SceneBuilder& scene) {
    const auto p = scene.values().points(points_of(j), 3, 3);
    return {make_bezier_triangle(1, p), net_of(1, p)};
}

BuiltSurface build_bezier_triangle(const Json& j, SceneBuilder& scene) {
    const SceneValues& values = scene.values();
    const int n = values.integer(j.at("degree", "the degree"), 1, max_degree, "the degree");
    const auto p = rows_of<Point>(points_of(j), n, [&](const Json& row, std::size_t count) { return values.points(row, count, count); });
    const auto w = j.find("weights");
    const auto weights = w ? rows_of<double>(*w, n, [&](const Json& row, std::size_t count) { return values.weights(row, count); }) : std::vector<double>{};
    return with_degree({make_bezier_triangle(n, p, weights), net_of(n, p)}, std::to_string(n), w != nullptr);
}

}  // namespace isoparm
