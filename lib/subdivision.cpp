#include "subdivision.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <map>
#include <optional>

#include "error.h"
#include "patches/bezier_triangle.h"
#include "patches/tensor_bezier.h"
#include "subdivision/subdivision_cell.h"
#include "subdivision/subdivision_face.h"

namespace isoparm {
namespace {

constexpr double kCore = 1e-11;               // of the cage's diagonal
constexpr std::size_t kMostFaces = 500;       // around a vertex, and vertices of a face: work grows with its square

/// Who meets whom in a cage.
class Neighbours {
public:
    explicit Neighbours(const Cage& cage) : cage_(cage), faces_(cage.positions.size()), sharpness_(cage.positions.size(), 0) {
        for (int f = 0; f < static_cast<int>(cage.faces.size()); ++f) {
            const auto& c = cage.faces[f];
            if (c.size() > kMostFaces)
                throw_input(face_name(cage, f) + ": found " + std::to_string(c.size()) + " vertices, expected at most " + std::to_string(kMostFaces) + "; split the face");
            for (std::size_t k = 0; k < c.size(); ++k) {
                faces_[c[k]].push_back(f);
                const int a = c[k], b = c[(k + 1) % c.size()];
                Edge& edge = edges_[std::minmax(a, b)];
                const auto name = [&] { return face_name(cage, f) + ": the edge from vertex " + std::to_string(a) + " to " + std::to_string(b); };
                if (++edge.faces > 2) throw_input(name() + " is not manifold: found a third face there, expected at most two; split the cage along it");
                if (edge.faces == 2 && edge.from == a)
                    throw_input(name() + ": found another face that runs along it the same way, expected all faces to turn the same way; reverse one of the two");
                edge.from = a;
            }
        }
        for (const auto& c : cage.creases) {
            const auto found = edges_.find(std::minmax(c.a, c.b));
            if (found == edges_.end()) throw_input("a crease from vertex " + std::to_string(c.a) + " to " + std::to_string(c.b) + ": expected the ends of an edge of a face");
            found->second.sharpness = limited(c.sharpness);
        }
        for (const auto& c : cage.corners) sharpness_[c.vertex] = limited(c.sharpness);
        for (auto& [ends, edge] : edges_)
            if (edge.faces == 1) edge.sharpness = kInfiniteSharpness;
        for (std::size_t v = 0; v < faces_.size(); ++v) check_vertex(static_cast<int>(v));
        if (cage.boundary != Cage::Boundary::edge_only)
            for (std::size_t v = 0; v < faces_.size(); ++v)
                if (faces_[v].size() == 1) sharpness_[v] = kInfiniteSharpness;
    }

    bool at_boundary(int face) const {
        const auto& c = cage_.faces[face];
        return std::any_of(c.begin(), c.end(), [&](int v) {
            return std::any_of(faces_[v].begin(), faces_[v].end(), [&](int f) {
                const auto& d = cage_.faces[f];
                const std::size_t n = d.size(), k = std::find(d.begin(), d.end(), v) - d.begin();
                return edges_.at(std::minmax(v, d[(k + 1) % n])).faces == 1 || edges_.at(std::minmax(v, d[(k + n - 1) % n])).faces == 1;
            });
        });
    }

    Ring<Interval> ring(int face) const {
        std::vector<int> list{face};
        for (const int v : cage_.faces[face]) list.insert(list.end(), faces_[v].begin(), faces_[v].end());
        std::sort(list.begin() + 1, list.end());
        list.erase(std::unique(list.begin() + 1, list.end()), list.end());
        list.erase(std::find(list.begin() + 1, list.end(), face));
        Ring<Interval> r;
        std::map<int, int> number;
        for (const int f : list) {
            r.faces.emplace_back();
            for (const int v : cage_.faces[f]) {
                const auto [at, fresh] = number.try_emplace(v, static_cast<int>(r.points.size()));
                r.faces.back().push_back(at->second);
                if (!fresh) continue;
                const Point& p = cage_.positions[v];
                r.points.push_back({Interval(p.x), Interval(p.y), Interval(p.z)});
                r.sharpness.push_back(sharpness_[v]);
            }
        }
        for (const int f : list) {
            const auto& c = cage_.faces[f];
            for (std::size_t k = 0; k < c.size(); ++k) {
                const int a = c[k], b = c[(k + 1) % c.size()];
                if (const float s = edges_.at(std::minmax(a, b)).sharpness; s > 0) r.creases.push_back({number[a], number[b], s});
            }
        }
        return r;
    }

private:
    struct Edge {
        int faces = 0, from = -1;  // its first vertex in the last of them
        float sharpness = 0;
    };
    static float limited(double s) { return static_cast<float>(std::min(s, double(kInfiniteSharpness))); }

    /// The faces around a vertex must be one fan: reached from the first across shared edges.
    void check_vertex(int v) const {
        const auto& list = faces_[v];
        if (list.size() > kMostFaces)
            throw_input("vertex " + std::to_string(v) + ": found " + std::to_string(list.size()) + " faces around it, expected at most " + std::to_string(kMostFaces));
        std::map<int, std::vector<int>> at;  // faces at the other ends of the edges of v
        for (const int f : list) {
            const auto& c = cage_.faces[f];
            const std::size_t n = c.size(), k = std::find(c.begin(), c.end(), v) - c.begin();
            at[c[(k + 1) % n]].push_back(f), at[c[(k + n - 1) % n]].push_back(f);
        }
        std::map<int, bool> seen;
        std::vector<int> todo;
        if (!list.empty()) todo.push_back(list[0]), seen[list[0]] = true;
        while (!todo.empty()) {
            const int f = todo.back();
            todo.pop_back();
            const auto& c = cage_.faces[f];
            const std::size_t n = c.size(), k = std::find(c.begin(), c.end(), v) - c.begin();
            for (const int end : {c[(k + 1) % n], c[(k + n - 1) % n]})
                for (const int g : at[end])
                    if (!std::exchange(seen[g], true)) todo.push_back(g);
        }
        if (seen.size() < list.size())
            throw_input("vertex " + std::to_string(v) + " is not manifold: found faces that meet there in this vertex only (" + face_name(cage_, list[0]) +
                        " is one), expected one fan; give each fan a vertex of its own");
    }

    const Cage& cage_;
    std::vector<std::vector<int>> faces_;  // around each vertex
    std::vector<float> sharpness_;
    std::map<std::pair<int, int>, Edge> edges_;
};

Point corner(const Ring<Interval>& ring, int k) {
    const auto& p = ring.points[ring.faces[0][k]];
    return {mid(p.x), mid(p.y), mid(p.z)};
}

/// The patches of one face.
std::vector<Patch> patches_of(const Ring<Interval>& ring, Scheme scheme, FaceLimits& limits, bool& regular) {
    const Subdivider<Interval> s(ring, scheme);
    const int n = static_cast<int>(ring.faces[0].size());
    std::vector<Patch> result;
    regular = scheme == Scheme::bilinear && n == 4;
    if (n != (scheme == Scheme::loop ? 3 : 4)) {
        bool any;
        for (int k = 0; k < n; ++k) result.push_back(patches_of(s.child(k), scheme, limits, any)[0]);
    } else if (scheme == Scheme::bilinear) {
        result.push_back(make_bezier_patch({{corner(ring, 0), corner(ring, 3)}, {corner(ring, 1), corner(ring, 2)}}));
    } else if (const auto control = s.regular()) {
        regular = true;
        const std::vector<Point> p = bezier_points(*control, scheme);
        if (scheme == Scheme::loop) {
            result.push_back(make_bezier_triangle(4, p));
        } else {
            Grid<Point> grid(4);
            for (int i = 0; i < 4; ++i) grid[i].assign(p.begin() + 4 * i, p.begin() + 4 * i + 4);
            result.push_back(make_bezier_patch(grid));
        }
    } else {
        result.push_back(make_subdivision_face(ring, scheme, limits));
    }
    return result;
}

}  // namespace

SubdivisionSurface make_subdivision(const Cage& cage, Scheme scheme, std::size_t most_pieces) {
    check_cage(cage, scheme);
    const Neighbours neighbours(cage);
    const std::size_t faces = cage.faces.size();
    std::vector<char> hole(faces, 0), regular(faces, 0);
    for (const int f : cage.holes) hole[f] = 1;
    if (cage.boundary == Cage::Boundary::none)
        for (std::size_t f = 0; f < faces; ++f) hole[f] |= neighbours.at_boundary(static_cast<int>(f));
    FaceLimits limits;
    limits.core = kCore * diagonal(cage), limits.most_pieces = most_pieces;
    std::vector<std::vector<Patch>> patches(faces);
    tbb::parallel_for(std::size_t(0), faces, [&](std::size_t f) {
        if (hole[f]) return;
        bool one = false;
        patches[f] = patches_of(neighbours.ring(static_cast<int>(f)), scheme, limits, one);
        regular[f] = one;
    });
    SubdivisionSurface result;
    for (std::size_t f = 0; f < faces; ++f) {
        const std::string name = "#" + std::to_string(f);
        for (std::size_t k = 0; k < patches[f].size(); ++k) result.patches.push_back({patches[f].size() == 1 ? name : name + "." + std::to_string(k), patches[f][k]});
        (hole[f] ? result.without_limit : regular[f] ? result.regular : result.irregular) += 1;
    }
    if (result.patches.empty()) throw_input("every face of the cage is a hole, or left out at a boundary: there is no limit surface");
    return result;
}

}  // namespace isoparm
