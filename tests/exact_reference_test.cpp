// exact_reference_test.cpp -- exact rays against a reference that shares nothing with them: roots of two Bernstein polynomials in long double, by halving.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "bezier_cells.h"
#include "expect_program.h"
#include "scene.h"
#include "traced_scene.h"

namespace isoparm {
namespace {

using Number = long double;

/// Coefficients of two polynomials f_1, f_2 and of the numerator and denominator of the distance, (p + 1) x (q + 1) of each.
struct Net {
    int p, q;
    std::vector<std::array<Number, 4>> c;  // at i (q + 1) + j
};

/// A ray and a cell: both f vanish where they meet.
Net net_of(const BezierCell& cell, const Ray& ray, const Point& n1, const Point& n2) {
    Net net{cell.degree_u, cell.degree_v, {}};
    const auto scalar = [](const Point& n, const Point& x) { return Number(n.x) * x.x + Number(n.y) * x.y + Number(n.z) * x.z; };
    for (std::size_t k = 0; k < cell.poles.size(); ++k) {
        const Number w = cell.weights.empty() ? 1 : cell.weights[k];
        const auto off = [&](const Point& n) { return w * (scalar(n, cell.poles[k]) - scalar(n, ray.origin)); };
        net.c.push_back({off(n1), off(n2), off(ray.direction), w});
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
void roots(const Net& net, Number u0, Number v0, Number h, Number k, Number size, Met& met) {
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
        roots(parts[0], u0, v0, along_u ? h / 2 : h, along_u ? k : k / 2, size, met);
        return roots(parts[1], along_u ? u0 + h / 2 : u0, along_u ? v0 : v0 + k / 2, along_u ? h / 2 : h, along_u ? k : k / 2, size, met);
    }
    // It is met if f is much as a linear map with an inverse; otherwise that is doubtful, as it is beside a border.
    if (!(std::fabs(det) > 1e-3L * across)) met.doubtful = true;
    const Number near_u = 1e-9L * size * s[3] * std::hypot(b1, b2) / std::max(std::fabs(det), Number(1e-300L)) * h, near_v = 1e-9L * size * s[3] * std::hypot(a1, a2) / std::max(std::fabs(det), Number(1e-300L)) * k;
    if (u0 < near_u || u0 + h > 1 - near_u || v0 < near_v || v0 + k > 1 - near_v) met.doubtful = true;
    if (s[2] >= 0) met.distances.push_back(s[2] / s[3]);
}

Point normal_to(const Point& d, const Point& other) { return normalized(cross(d, other)); }

struct Compared {
    int rays = 0, hits = 0, doubtful = 0, wrong = 0;
};
Compared compare(const std::string& name, int packets, unsigned seed) {
    Scene scene = load_scene(test::source_folder() + "/scenes/" + name + ".json");
    std::erase_if(scene.objects, [](const SceneObject& o) { return o.kind != SceneObject::Kind::surface; });
    for (SceneObject& o : scene.objects) o.boundary = false, o.isolines = {}, o.opacity = 1;
    const TracedScene traced = build_traced_scene(scene, 1e-2, {}, true);
    const Bounds box = bounding_box(scene);
    const double size = box.diagonal();
    std::vector<BezierCell> cells;
    std::vector<const Patch*> patches;
    for (const SceneObject& o : scene.objects)
        for (const Member& m : scene.find_surface(o.name)->patches) {
            patches.push_back(&m.patch);
            const auto more = bezier_cells(m.patch);
            cells.insert(cells.end(), more.begin(), more.end());
        }
    std::mt19937_64 random(seed);
    const auto number = [&](double low, double high) { return std::uniform_real_distribution<>(low, high)(random); };
    /// Beside a border of the patch that was hit: it counts as met a little beyond.
    const auto at_border = [](const Patch& patch, const Hit& hit) {
        const Rect r = patch.rect();
        const double u = 1e-7 * (r.u1 - r.u0), v = 1e-7 * (r.v1 - r.v0);
        return hit.u < r.u0 + u || hit.u > r.u1 - u || hit.v < r.v0 + v || hit.v > r.v1 - v;
    };
    Compared result;
    for (int packet = 0; packet < packets; ++packet) {
        Ray rays[EmbreeScene::packet];
        Hit hits[EmbreeScene::packet];
        for (Ray& r : rays) {
            const Patch& patch = *patches[static_cast<std::size_t>(number(0, double(patches.size()) - 1e-9))];
            const PointFrame f = patch.frame(number(0, 1), number(0, 1));
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
            for (const BezierCell& cell : cells) roots(net_of(cell, r, n1, n2), 0, 0, 1, 1, size, met);
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

TEST(ExactReference, RaysMeetWhatHalvingFinds) {
    for (const char* name : {"coons", "teapot", "sphere"}) {
        const Compared c = compare(name, name == std::string("coons") ? 300 : 100, 21);
        EXPECT_EQ(c.wrong, 0) << name;
        EXPECT_GT(c.hits, c.rays / 2) << name;
        EXPECT_LT(c.doubtful, c.rays / 4) << name;
    }
}

}  // namespace
}  // namespace isoparm
