#include "rays/quad_part.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "release.h"

namespace isoparm {
namespace {

using Triangle = std::array<std::uint32_t, 3>;

/// The edge of `a` that `b` has the other way round, as the corners that it begins with in each; -1 where there is none.
std::array<int, 2> shared_edge(const Triangle& a, const Triangle& b) {
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            if (a[i] == b[(j + 1) % 3] && a[(i + 1) % 3] == b[j]) return {i, j};
    return {-1, -1};
}

constexpr std::uint32_t kAlone = ~0u, kSecond = kAlone - 1;

/// Of each triangle its partner, among those that share an edge the next in number that is still free; or kAlone; or kSecond, of one before.
std::vector<std::uint32_t> find_partners(const std::vector<Triangle>& triangles, std::size_t corners) {
    std::vector<std::uint32_t> end(corners + 1, 0), around(3 * triangles.size());  // the triangles around corner c: from end[c - 1] to end[c]
    for (const Triangle& t : triangles)
        for (const auto c : t) ++end[c + 1];
    std::partial_sum(end.begin(), end.end(), end.begin());
    for (std::uint32_t i = 0; i < triangles.size(); ++i)
        for (const auto c : triangles[i]) around[end[c]++] = i;
    std::vector<std::uint32_t> partner(triangles.size(), kAlone);
    for (std::uint32_t i = 0; i < triangles.size(); ++i) {
        if (partner[i] == kSecond) continue;
        for (const auto c : triangles[i])  // each edge at the corner that it begins with, and once more
            for (std::uint32_t k = c > 0 ? end[c - 1] : 0; k < end[c]; ++k)
                if (const auto j = around[k]; j > i && j < partner[i] && partner[j] != kSecond && shared_edge(triangles[i], triangles[j])[0] >= 0) partner[i] = j;
        if (partner[i] != kAlone) partner[partner[i]] = kSecond;
    }
    return partner;
}

std::array<std::uint32_t, 4> quad_of(const Triangle& a, const Triangle& b) {
    const auto [i, j] = shared_edge(a, b);
    return {a[(i + 2) % 3], a[i], b[(j + 2) % 3], a[(i + 1) % 3]};
}

}  // namespace

QuadPart::QuadPart(const Mesh& mesh, MeshPart& part, const Point& centre) : triangles_(part.triangles.size()), vertices_(part.vertex.size(), centre) {
    const std::vector<std::uint32_t> partner = find_partners(part.triangles, part.vertex.size());
    const std::size_t count = triangles_ - static_cast<std::size_t>(std::count(partner.begin(), partner.end(), kSecond));
    quads_.reserve(count), number_.reserve(count);
    for (std::uint32_t i = 0; i < triangles_; ++i) {
        if (partner[i] == kSecond) continue;
        const Triangle& t = part.triangles[i];
        quads_.push_back(partner[i] == kAlone ? std::array{t[0], t[1], t[2], t[2]} : quad_of(t, part.triangles[partner[i]]));
        number_.push_back({i, partner[i] == kAlone ? i : partner[i]});
    }
    for (std::size_t i = 0; i < part.vertex.size(); ++i) vertices_.set(i, mesh.positions[part.vertex[i]]);
    uv_ = std::move(part.uv);
    release(part.triangles), release(part.vertex);
}

}  // namespace isoparm
