#include "subdivision/limit_vertices.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

namespace isoparm {
namespace {

class Fans {
public:
    Fans(const Cage& cage, Scheme scheme) : cage_(cage), size_(scheme == Scheme::loop ? 3 : 4), sharp_(cage.positions.size(), false), first_(cage.positions.size(), -1) {
        for (int f = 0; f < static_cast<int>(cage.faces.size()); ++f) {
            const auto& c = cage.faces[f];
            for (std::size_t k = 0; k < c.size(); ++k) halves_[{c[k], c[(k + 1) % c.size()]}] = {f, static_cast<int>(k)}, first_[c[k]] = f;
        }
        for (const auto& c : cage.creases)
            if (c.sharpness > 0) sharp_[c.a] = sharp_[c.b] = true;
        for (const auto& c : cage.corners)
            if (c.sharpness > 0) sharp_[c.vertex] = true;
    }

    bool hole(int face) const { return std::find(cage_.holes.begin(), cage_.holes.end(), face) != cage_.holes.end(); }

    /// The faces around a vertex; none where it is not smooth, or not inside.
    std::vector<LimitSector> around(int v) const {
        if (sharp_[v] || first_[v] < 0) return {};
        std::vector<LimitSector> sectors;
        for (int f = first_[v];;) {
            const auto& c = cage_.faces[f];
            const int n = static_cast<int>(c.size()), k = static_cast<int>(std::find(c.begin(), c.end(), v) - c.begin());
            if (hole(f)) return {};
            sectors.push_back(n == size_ ? LimitSector{f, patch_name(f), k, 0} : LimitSector{f, patch_name(f, k), 0, 1});
            const auto across = halves_.find({v, c[(k + n - 1) % n]});
            if (across == halves_.end()) return {};
            f = across->second.face;
            if (f == first_[v]) return sectors;
        }
    }
    /// The quads that a face of another size is cut into. Sides of a quad at the centre: from the middle of the edge before its corner on, to that of the edge after it.
    std::vector<LimitSector> centre(int face) const {
        std::vector<LimitSector> sectors;
        const int n = static_cast<int>(cage_.faces[face].size());
        for (int k = 0; k < n; ++k) sectors.push_back({face, patch_name(face, k), 2, 1});
        return sectors;
    }

private:
    struct Half {
        int face, corner;
    };
    const Cage& cage_;
    int size_;
    std::vector<bool> sharp_;
    std::vector<int> first_;  // a face of each vertex
    std::map<std::pair<int, int>, Half> halves_;
};

}  // namespace

std::string patch_name(int face, int corner) {
    std::string name("#");
    name.append(std::to_string(face));
    if (corner >= 0) name.append(".").append(std::to_string(corner));
    return name;
}

Eigenvalues eigenvalues(Scheme scheme, int valence) {
    const double n = valence, turn = 2 * std::numbers::pi / n;
    if (scheme == Scheme::loop) {
        const auto of_frequency = [&](int k) { return 0.375 + 0.25 * std::cos(k * turn); };
        const double lambda = of_frequency(1);  // 1/8: of the second ring
        return {lambda, std::max({0.125, lambda * lambda, valence > 3 ? of_frequency(2) : 0})};
    }
    const auto of_frequency = [&](int k) { return (5 + std::cos(k * turn) + std::cos(k * turn / 2) * std::sqrt(18 + 2 * std::cos(k * turn))) / 16; };
    const double cup = (3 * n - 7 + std::sqrt(5 * n * n - 30 * n + 49)) / (8 * n);  // of frequency 0
    return {of_frequency(1), std::max(cup, valence > 3 ? of_frequency(2) : 0)};
}

std::vector<ExtraordinaryVertex> extraordinary_vertices(const Cage& cage, Scheme scheme) {
    if (scheme == Scheme::bilinear) return {};
    const int regular = scheme == Scheme::loop ? 6 : 4;
    const Fans fans(cage, scheme);
    std::vector<ExtraordinaryVertex> all;
    const auto add = [&](const std::string& name, std::vector<LimitSector> sectors) {
        const int n = static_cast<int>(sectors.size());
        if (n >= 3 && n != regular) all.push_back({name, n, std::move(sectors)});
    };
    for (std::size_t v = 0; v < cage.positions.size(); ++v) add("vertex " + std::to_string(v), fans.around(static_cast<int>(v)));
    for (std::size_t f = 0; f < cage.faces.size(); ++f)
        if (scheme == Scheme::catmull_clark && cage.faces[f].size() != 4 && !fans.hole(static_cast<int>(f)))
            add("centre of face " + std::to_string(f), fans.centre(static_cast<int>(f)));
    return all;
}

}  // namespace isoparm
