#include "cage.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "error.h"

namespace isoparm {
namespace {
constexpr std::size_t max_face_size = 65535;  // OpenSubdiv's VALENCE_LIMIT

/// Two triangles on the same three vertices, and no other one at one of these. The faces are those of a cage for Loop's scheme.
void refuse_valence_two(const Cage& cage) {
    std::vector<int> count(cage.positions.size(), 0);
    for (const auto& f : cage.faces)
        for (const int v : f) ++count[v];
    std::map<std::array<int, 3>, std::size_t> seen;
    for (std::size_t k = 0; k < cage.faces.size(); ++k) {
        std::array<int, 3> f{cage.faces[k][0], cage.faces[k][1], cage.faces[k][2]};
        std::sort(f.begin(), f.end());
        const auto [first, fresh] = seen.try_emplace(f, k);
        if (fresh) continue;
        for (const int v : f)
            if (count[v] == 2)
                throw_input("vertex " + std::to_string(v) + ": found two edges, between " + face_name(cage, first->second) + " and " + face_name(cage, k) +
                            " on the same three vertices, expected three edges or more at a vertex inside; split one of these triangles");
    }
}
}  // namespace

double diagonal(const Cage& cage) {
    Point low = cage.positions[cage.faces[0][0]], high = low;
    for (const auto& f : cage.faces)
        for (const int v : f) {
            const Point& p = cage.positions[v];
            for (int axis = 0; axis < 3; ++axis) low[axis] = std::min(low[axis], p[axis]), high[axis] = std::max(high[axis], p[axis]);
        }
    return std::hypot(high.x - low.x, high.y - low.y, high.z - low.z);
}
double reach(const Cage& cage) {
    double far = 0;
    for (const auto& f : cage.faces)
        for (const int v : f) far = std::max(far, std::hypot(cage.positions[v].x, cage.positions[v].y, cage.positions[v].z));
    return far;
}

std::string face_name(const Cage& cage, std::size_t face) {
    const std::string name = "face " + std::to_string(face);
    return face < cage.face_lines.size() ? name + " (line " + std::to_string(cage.face_lines[face]) + ")" : name;
}

void check_cage(const Cage& cage, Scheme scheme) {
    const int vertices = static_cast<int>(cage.positions.size()), faces = static_cast<int>(cage.faces.size());
    const auto in_range = [](int i, int count, const std::string& what) {
        if (i < 0 || i >= count) throw_input(what + ": found index " + std::to_string(i) + ", expected 0 to " + std::to_string(count - 1));
    };
    if (faces == 0) throw_input("a cage without faces has no limit surface");
    for (std::size_t k = 0; k < cage.faces.size(); ++k) {
        std::vector<int> f = cage.faces[k];
        const std::string name = face_name(cage, k);
        for (const int i : f) in_range(i, vertices, name);
        if (f.size() < 3 || f.size() > max_face_size)
            throw_input(name + ": found " + std::to_string(f.size()) + " vertices, expected 3 to " + std::to_string(max_face_size));
        if (scheme == Scheme::loop && f.size() != 3)
            throw_input(name + ": found " + std::to_string(f.size()) + " vertices, expected 3: Loop's scheme is of triangles only");
        std::sort(f.begin(), f.end());
        if (std::adjacent_find(f.begin(), f.end()) != f.end()) throw_input(name + " is degenerate: found a vertex twice, expected different vertices");
    }
    if (scheme == Scheme::loop) refuse_valence_two(cage);
    for (const Point& p : cage.positions)
        if (!finite(p)) throw_input("a vertex of the cage is not finite");
    const auto not_negative = [](double s) {
        if (!(s >= 0)) throw_input("a sharpness: found " + to_text(s) + ", expected 0 or more");
    };
    for (const auto& c : cage.creases) {
        not_negative(c.sharpness);
        in_range(c.a, vertices, "a crease");
        in_range(c.b, vertices, "a crease");
    }
    for (const auto& c : cage.corners) {
        not_negative(c.sharpness);
        in_range(c.vertex, vertices, "a corner");
    }
    for (const int f : cage.holes) in_range(f, faces, "a hole");
}

}  // namespace isoparm
