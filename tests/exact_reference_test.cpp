// exact_reference_test.cpp -- exact rays against a reference that shares nothing with them: roots of two Bernstein polynomials in long double, by halving.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "curves/bezier_cells.h"
#include "expect_program.h"
#include "rays/traced_scene.h"
#include "scene/scene.h"

namespace isoparm {
namespace {

using Number = long double;

/// Bernstein coefficients of coordinates and their denominator, (p + 1) x (q + 1) of each, over the unit square or its half u + v <= 1.
struct Cell {
    int p, q;
    bool triangle;
    std::vector<std::array<Number, 4>> c;  // at i (q + 1) + j
    Number largest_weight = 1;
};

std::vector<Cell> tensor_cells(const Patch& patch) {
    std::vector<Cell> cells;
    for (const BezierCell& from : bezier_cells(patch)) {
        Cell cell{from.degree_u, from.degree_v, false, {}};
        for (std::size_t k = 0; k < from.poles.size(); ++k) {
            const Number w = from.weights.empty() ? 1 : from.weights[k];
            const Point& x = from.poles[k];
            cell.c.push_back({w * x.x, w * x.y, w * x.z, w});
        }
        cells.push_back(std::move(cell));
    }
    return cells;
}

/// A quotient of polynomials about the middle of the triangle's square, as Bernstein polynomials.
Cell triangle_cell(const Patch& patch) {
    const auto form = patch.exact_cell(0, 0);
    if (form.size() != 4) throw std::logic_error("no quotient");
    Cell cell{0, 0, true, {}};
    for (const Polynomial& x : form) cell.p = std::max(cell.p, x.degree_u()), cell.q = std::max(cell.q, x.degree_v());
    cell.c.assign(static_cast<std::size_t>((cell.p + 1) * (cell.q + 1)), {});
    // Bernstein coefficients of a polynomial are its blossom at k ones and n - k zeros, where x = 1/2 and -1/2.
    const auto blossom = [](int n, int i, int ones) {  // of x^i: the mean of all products of i of the n arguments
        std::vector<Number> e(static_cast<std::size_t>(i) + 1, 0);
        e[0] = 1;
        for (int k = 0; k < n; ++k)
            for (int j = i; j > 0; --j) e[static_cast<std::size_t>(j)] += e[static_cast<std::size_t>(j) - 1] * (k < ones ? 0.5L : -0.5L);
        Number ways = 1;
        for (int k = 0; k < i; ++k) ways = ways * (n - k) / (k + 1);
        return e[static_cast<std::size_t>(i)] / ways;
    };
    cell.largest_weight = 0;
    for (int k = 0; k <= cell.p; ++k)
        for (int l = 0; l <= cell.q; ++l) {
            auto& c = cell.c[static_cast<std::size_t>(k * (cell.q + 1) + l)];
            for (std::size_t axis = 0; axis < 4; ++axis)
                for (int i = 0; i <= form[axis].degree_u(); ++i)
                    for (int j = 0; j <= form[axis].degree_v(); ++j) c[axis] += Number(mid(form[axis].coefficient(i, j))) * blossom(cell.p, i, k) * blossom(cell.q, j, l);
            cell.largest_weight = std::max(cell.largest_weight, std::fabs(c[3]));
        }
    return cell;
}

/// Coefficients of two polynomials f_1, f_2 and of the numerator and denominator of the distance, (p + 1) x (q + 1) of each.
struct Net {
    int p, q;
    std::vector<std::array<Number, 4>> c;  // at i (q + 1) + j
};

/// A ray and a cell: both f vanish where they meet.
Net net_of(const Cell& cell, const Ray& ray, const Point& n1, const Point& n2) {
    Net net{cell.p, cell.q, {}};
    for (const auto& x : cell.c) {
        const auto off = [&](const Point& n) { return n.x * (x[0] - x[3] * ray.origin.x) + n.y * (x[1] - x[3] * ray.origin.y) + n.z * (x[2] - x[3] * ray.origin.z); };
        net.c.push_back({off(n1), off(n2), off(ray.direction), x[3]});
    }
    return net;
}

/// The halves of a net along u or v, by de Casteljau's algorithm.
std::array<Net, 2> halves(const Net& net, bool along_u) {
    std::array<Net, 2> to{net, net};
    const int n = along_u ? net.p : net.q, lines = along_u ? net.q + 1 : net.p + 1, step = along_u ? net.q + 1 : 1, next = along_u ? 1 : net.q + 1;
    for (int line = 0; line < lines; ++line)
        for (int k = 0; k < 4; ++k) {
            std::vector<Number> b;
            for (int i = 0; i <= n; ++i) b.push_back(net.c[line * next + i * step][k]);
            for (int level = 0; level <= n; ++level) {
                to[0].c[line * next + level * step][k] = b[0];
                to[1].c[line * next + (n - level) * step][k] = b[n - level];
                for (int i = 0; i + level < n; ++i) b[i] = (b[i] + b[i + 1]) / 2;
            }
        }
    return to;
}

struct Met {
    std::vector<Number> distances;
    bool doubtful = false;  // tangent, or so near to the border of a cell that it may be met or missed
    int parts = 0;          // looked at
};

/// All roots in a net, which is the part [u0, u0 + h] x [v0, v0 + k] of a cell. `size`: of the scene.
void roots(const Cell& cell, const Net& net, Number u0, Number v0, Number h, Number k, Number size, Met& met) {
    if (cell.triangle && u0 + v0 > 1 + 1e-9L) return;
    constexpr int kMostParts = 3000;  // more look at a fold
    if (met.doubtful || ++met.parts > kMostParts) return void(met.doubtful = true);
    const auto corner = [&](int i, int j) { return net.c[static_cast<std::size_t>(i * (net.q + 1) + j)]; };
    const auto s = corner(0, 0), a = corner(net.p, 0), b = corner(0, net.q), c = corner(net.p, net.q);
    const Number a1 = (a[0] - s[0] + c[0] - b[0]) / 2, a2 = (a[1] - s[1] + c[1] - b[1]) / 2, b1 = (b[0] - s[0] + c[0] - a[0]) / 2, b2 = (b[1] - s[1] + c[1] - a[1]) / 2;
    const Number det = a1 * b2 - a2 * b1, across = std::hypot(a1, a2) * std::hypot(b1, b2), rounding = 1e-15L * size * s[3];  // of poles and planes in double
    // No root where one of f_1, f_2, and of the sums of them that are nearly u and v, has no change of sign.
    const Number sums[4][2] = {{1, 0}, {0, 1}, {b2, -b1}, {-a2, a1}};
    Number extent = 0;
    for (int i = 0; i < 4; ++i) {
        Number low = INFINITY, high = -INFINITY;
        for (const auto& x : net.c) low = std::min(low, sums[i][0] * x[0] + sums[i][1] * x[1]), high = std::max(high, sums[i][0] * x[0] + sums[i][1] * x[1]);
        const Number slack = rounding * (std::fabs(sums[i][0]) + std::fabs(sums[i][1]));
        if (low > slack || high < -slack) return;
        if (i < 2) extent = std::max(extent, high - low);
    }
    if (extent > 1e-11L * size * s[3] && h > 1e-12L) {
        const bool along_u = h >= k;
        const auto parts = halves(net, along_u);
        roots(cell, parts[0], u0, v0, along_u ? h / 2 : h, along_u ? k : k / 2, size, met);
        return roots(cell, parts[1], along_u ? u0 + h / 2 : u0, along_u ? v0 : v0 + k / 2, along_u ? h / 2 : h, along_u ? k : k / 2, size, met);
    }
    // It is met if f is much as a linear map with an inverse; otherwise that is doubtful, as it is beside a border.
    if (!(std::fabs(det) > 1e-3L * across)) met.doubtful = true;
    const Number near_u = 1e-9L * size * s[3] * std::hypot(b1, b2) / std::max(std::fabs(det), Number(1e-300L)) * h, near_v = 1e-9L * size * s[3] * std::hypot(a1, a2) / std::max(std::fabs(det), Number(1e-300L)) * k;
    if (u0 < near_u || u0 + h > 1 - near_u || v0 < near_v || v0 + k > 1 - near_v) met.doubtful = true;
    if (cell.triangle && (u0 + v0 + h + k > 1 - near_u - near_v || s[3] < 1e-3L * cell.largest_weight)) met.doubtful = true;  // beside its vertices the denominator vanishes
    if (s[2] >= 0) met.distances.push_back(s[2] / s[3]);
}

Point normal_to(const Point& d, const Point& other) { return normalized(cross(d, other)); }

/// A scene's surfaces, opaque and without lines.
Scene bare_surfaces(const std::string& name) {
    Scene scene = load_scene(test::source_folder() + "/scenes/" + name + ".json");
    std::erase_if(scene.objects, [](const SceneObject& o) { return o.kind != SceneObject::Kind::surface; });
    for (SceneObject& o : scene.objects) o.boundary = false, o.isolines = {}, o.opacity = 1;
    return scene;
}

struct Compared {
    int rays = 0, hits = 0, doubtful = 0, wrong = 0;
};
Compared compare(const std::string& name, int packets, unsigned seed) {
    const Scene scene = bare_surfaces(name);
    const TracedScene traced = build_traced_scene(scene, 1e-2, {}, true);
    const Bounds box = bounding_box(scene);
    const double size = box.diagonal();
    std::vector<Cell> cells;
    std::vector<const Patch*> patches;
    for (const SceneObject& o : scene.objects)
        for (const Member& m : scene.find_surface(o.name)->patches) {
            patches.push_back(&m.patch);
            const auto more = m.patch.domain() == Domain::triangle ? std::vector<Cell>{triangle_cell(m.patch)} : tensor_cells(m.patch);
            cells.insert(cells.end(), more.begin(), more.end());
        }
    std::mt19937_64 random(seed);
    const auto number = [&](double low, double high) { return std::uniform_real_distribution<>(low, high)(random); };
    /// Beside a border of the patch that was hit: it counts as met a little beyond.
    const auto at_border = [](const Patch& patch, const Hit& hit) {
        const Rect r = patch.rect();
        const double u = 1e-7 * (r.u1 - r.u0), v = 1e-7 * (r.v1 - r.v0);
        return hit.u < r.u0 + u || hit.u > r.u1 - u || hit.v < r.v0 + v || hit.v > r.v1 - v || (patch.domain() == Domain::triangle && hit.u + hit.v > 1 - u);
    };
    Compared result;
    for (int packet = 0; packet < packets; ++packet) {
        Ray rays[EmbreeScene::packet];
        Hit hits[EmbreeScene::packet];
        for (Ray& r : rays) {
            const Patch& patch = *patches[static_cast<std::size_t>(number(0, double(patches.size()) - 1e-9))];
            double u = number(0, 1), v = number(0, 1);
            if (patch.domain() == Domain::triangle && u + v > 1) u = 1 - u, v = 1 - v;
            const PointFrame f = patch.frame(u, v);
            const Point at{f.x.c[0], f.y.c[0], f.z.c[0]}, n = cross(Point{f.x.c[1], f.y.c[1], f.z.c[1]}, Point{f.x.c[2], f.y.c[2], f.z.c[2]});
            Point d{number(-1, 1), number(-1, 1), number(-1, 1)};
            if (number(0, 1) < 0.4 && length(n) > 0) d = d - (1 - std::pow(10, number(-5, -1))) * (dot(d, n) / dot(n, n)) * n;  // grazing
            r.direction = normalized(d);
            r.origin = at - number(0.1, 1.5) * size * r.direction;
        }
        traced.embree->intersect(rays, EmbreeScene::packet, hits);
        for (int i = 0; i < EmbreeScene::packet; ++i) {
            const Ray& r = rays[i];
            const Point n1 = normal_to(r.direction, std::fabs(r.direction.x) < 0.6 ? Point{1, 0, 0} : Point{0, 1, 0}), n2 = normal_to(r.direction, n1);
            Met met;
            for (const Cell& cell : cells) roots(cell, net_of(cell, r, n1, n2), 0, 0, 1, 1, size, met);
            ++result.rays;
            // The reference knows distances to 1e-11 sizes over the sine of the ray's angle, 1e-3 at least.
            const bool good = hits[i].found() ? !met.distances.empty() && std::fabs(static_cast<double>(*std::min_element(met.distances.begin(), met.distances.end())) - hits[i].distance) <= 3e-8 * size + hits[i].error
                                              : met.distances.empty();
            const bool unproved = hits[i].found() && !(hits[i].error < 1e-8 * size);  // taken as a hit, and counted as undecided
            if (met.doubtful || unproved || (!good && hits[i].found() && at_border(*traced.things[hits[i].geometry].patch, hits[i]))) {
                ++result.doubtful;
                continue;
            }
            result.hits += !met.distances.empty();
            result.wrong += !good;
            if (!good) ADD_FAILURE() << name << ", packet " << packet << ", ray " << i << ": found " << hits[i].distance << " (" << hits[i].error << "), the reference " << met.distances.size() << " places";
        }
    }
    return result;
}

/// Of a hit, how much farther its S(u,v), in intervals, surely is from the ray than `part` of the proved error: positive where that is wrong.
double beyond(const Patch& patch, const Ray& ray, const Hit& hit, double part) {
    const Vec3<Interval> s = patch.enclose_point(hit.u, hit.v);
    const Point to = Point{mid(s.x), mid(s.y), mid(s.z)} - ray.origin;
    return length(cross(to, ray.direction)) - rounding::length_up(rad(s.x), rad(s.y), rad(s.z)) - 1e-15 * length(to) - part * hit.error;
}

// Where surfaces are no polynomials, of hits is told by other ones that are near them: what is proved of those holds for the surface.
TEST(ExactReference, SurfacesAreAsNearToRaysAsIsProved) {
    for (const char* name : {"side_vertex", "s004_side_vertex", "s004_gregory"}) {
        const Scene scene = bare_surfaces(name);
        const TracedScene traced = build_traced_scene(scene, 1e-2, {}, true);
        const Bounds box = bounding_box(scene);
        const double size = box.diagonal();
        std::mt19937_64 random(5);
        const auto number = [&](double low, double high) { return std::uniform_real_distribution<>(low, high)(random); };
        int hits = 0, proved = 0, wrong = 0, vain = 0;
        for (int packet = 0; packet < 400; ++packet) {
            Ray rays[EmbreeScene::packet];
            Hit found[EmbreeScene::packet];
            const Point to{number(box.low.x, box.high.x), number(box.low.y, box.high.y), number(box.low.z, box.high.z)};
            const Point d = normalized(Point{number(-1, 1), number(-1, 1), number(-1, 1)});
            for (Ray& r : rays) {
                r.direction = normalized(d + 0.02 * Point{number(-1, 1), number(-1, 1), number(-1, 1)});
                r.origin = to - size * r.direction;
            }
            traced.embree->intersect(rays, EmbreeScene::packet, found);
            for (int i = 0; i < EmbreeScene::packet; ++i) {
                if (!found[i].found()) continue;
                ++hits, proved += found[i].error < 1.1e-11 * size;
                const Patch& patch = *traced.things[found[i].geometry].patch;
                wrong += beyond(patch, rays[i], found[i], 1) > 0;
                vain += beyond(patch, rays[i], found[i], 0) > 0;
            }
        }
        EXPECT_GT(hits, 1000) << name;
        EXPECT_GT(proved, hits * 9 / 10) << name;
        EXPECT_EQ(wrong, 0) << name;
        EXPECT_GT(vain, 0) << name << ": errors of nothing would do";
    }
}

TEST(ExactReference, RaysMeetWhatHalvingFinds) {
    for (const char* name : {"coons", "teapot", "sphere", "side_vertex"}) {
        const Compared c = compare(name, name == std::string("coons") || name == std::string("side_vertex") ? 300 : 100, 21);
        EXPECT_EQ(c.wrong, 0) << name;
        EXPECT_GT(c.hits, c.rays / 2) << name;
        EXPECT_LT(c.doubtful, c.rays / 4) << name;
    }
}

}  // namespace
}  // namespace isoparm
