// cages.h -- subdivision cages for tests, one for each kind of vertex, edge and face.
#pragma once
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "cage.h"

namespace isoparm::test {

inline Cage cube_cage() {
    Cage c;
    for (int k = 0; k < 8; ++k) c.positions.emplace_back(k & 1 ? 1 : -1, k & 2 ? 1 : -1, (k & 4 ? 1 : -1) + 0.2 * (k == 5) - 0.1 * (k == 2));
    c.faces = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    return c;
}

/// n quads around vertex 0 and a ring of quads about them (triangles for Loop: two rings of triangles), open.
inline Cage fan_cage(int n, bool triangles = false) {
    Cage c;
    const double pi = 3.141592653589793;
    c.positions.emplace_back(0.1, -0.1, 0.6);
    const int m = triangles ? n : 2 * n;
    for (int ring = 1; ring <= 2; ++ring)
        for (int k = 0; k < m; ++k) c.positions.emplace_back(ring * std::cos(2 * pi * k / m), ring * std::sin(2 * pi * k / m), 0.3 * ((k * 7 + ring * 3) % 4) / ring);
    const auto inner = [&](int k) { return 1 + k % m; };
    const auto outer = [&](int k) { return 1 + m + k % m; };
    for (int k = 0; k < n; ++k) c.faces.push_back(triangles ? std::vector<int>{0, inner(k), inner(k + 1)} : std::vector<int>{0, inner(2 * k), inner(2 * k + 1), inner(2 * k + 2)});
    for (int k = 0; k < m; ++k) {
        if (triangles) c.faces.push_back({inner(k), outer(k), outer(k + 1)}), c.faces.push_back({inner(k), outer(k + 1), inner(k + 1)});
        else c.faces.push_back({inner(k), outer(k), outer(k + 1), inner(k + 1)});
    }
    return c;
}

/// Three squares of 2 x 2 quads: a boundary with a corner inwards.
inline Cage l_cage() {
    Cage c;
    std::vector<std::vector<int>> number(5, std::vector<int>(5, -1));
    for (int i = 0; i < 5; ++i)
        for (int j = 0; j < 5; ++j)
            if (i <= 2 || j <= 2) number[i][j] = static_cast<int>(c.positions.size()), c.positions.emplace_back(i, j, 0.25 * ((3 * i + 5 * j + i * j) % 4));
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j)
            if (i < 2 || j < 2) c.faces.push_back({number[i][j], number[i + 1][j], number[i + 1][j + 1], number[i][j + 1]});
    return c;
}

/// A prism over a pentagon: faces of 5 and 4 vertices, all irregular.
inline Cage prism_cage() {
    Cage c;
    for (int level = 0; level < 2; ++level)
        for (int k = 0; k < 5; ++k) c.positions.emplace_back(std::cos(1.2566 * k), std::sin(1.2566 * k), level + 0.1 * k * level);
    c.faces = {{4, 3, 2, 1, 0}, {5, 6, 7, 8, 9}};
    for (int k = 0; k < 5; ++k) c.faces.push_back({k, (k + 1) % 5, (k + 1) % 5 + 5, k + 5});
    return c;
}

inline Cage octahedron_cage() {
    Cage c;
    c.positions = {{1, 0, 0}, {0, 1.2, 0}, {-1, 0, 0.1}, {0, -1, 0}, {0, 0, 1}, {0.2, 0, -1}};
    for (int k = 0; k < 4; ++k) c.faces.push_back({k, (k + 1) % 4, 4}), c.faces.push_back({(k + 1) % 4, k, 5});
    return c;
}

/// Regular triangles in 4 x 4 sheared squares, open.
inline Cage triangle_grid_cage() {
    Cage c;
    for (int j = 0; j <= 4; ++j)
        for (int i = 0; i <= 4; ++i) c.positions.emplace_back(i + 0.5 * j, j, 0.3 * ((i * 7 + j * 5 + i * j) % 4));
    for (int j = 0; j < 4; ++j)
        for (int i = 0; i < 4; ++i) {
            const int k = 5 * j + i;
            c.faces.push_back({k, k + 1, k + 5}), c.faces.push_back({k + 1, k + 6, k + 5});
        }
    return c;
}

inline Cage creased(Cage c, std::vector<Cage::Crease> creases, std::vector<Cage::Corner> corners = {}) {
    c.creases = std::move(creases), c.corners = std::move(corners);
    return c;
}

struct NamedCage {
    std::string name;
    Cage cage;
    Scheme scheme = Scheme::catmull_clark;
};
inline std::vector<NamedCage> all_cages() {
    Cage round = l_cage();
    round.boundary = Cage::Boundary::edge_only;
    Cage open = fan_cage(5);
    open.boundary = Cage::Boundary::none;
    const Cage cube = cube_cage();
    const std::vector<Cage::Crease> top{{4, 5, 10}, {5, 7, 10}, {7, 6, 10}, {6, 4, 10}};
    std::vector<NamedCage> all{{"cube", cube}, {"L", l_cage()}, {"L, rounded corners", round}, {"fan without its boundary", open}, {"prism", prism_cage()},
                               {"sharp ring", creased(cube, top)},
                               {"semi-sharp", creased(cube, {{4, 5, 2.5}, {5, 7, 1.25}, {7, 6, 0.5}, {6, 4, 3}, {0, 1, 0.75}})},
                               {"corners", creased(cube, {{0, 1, 10}, {0, 2, 10}, {0, 4, 10}}, {{7, 10}, {5, 1.5}})},
                               {"L, creased", creased(l_cage(), {{6, 7, 10}, {7, 8, 10}, {8, 9, 10}, {12, 13, 1.5}})},
                               {"octahedron", octahedron_cage(), Scheme::loop},
                               {"triangles", triangle_grid_cage(), Scheme::loop},
                               {"triangles, creased", creased(triangle_grid_cage(), {{11, 12, 10}, {12, 13, 10}, {10, 11, 10}, {13, 14, 10}, {6, 7, 1.25}}, {{18, 10}}), Scheme::loop},
                               {"prism, bilinear", prism_cage(), Scheme::bilinear}};
    for (const int n : {2, 3, 5, 6, 8}) all.push_back({"fan of " + std::to_string(n), fan_cage(n)});
    for (const int n : {3, 5, 8}) all.push_back({"triangles around " + std::to_string(n), fan_cage(n, true), Scheme::loop});
    return all;
}

}  // namespace isoparm::test
