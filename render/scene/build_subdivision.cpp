// build_subdivision.cpp -- limit surfaces of subdivision cages, from an OBJ file or given in the scene.
#include <algorithm>
#include <cmath>
#include <set>

#include "io/cage_obj.h"
#include "scene/registry.h"
#include "scene/suggest.h"
#include "subdivision.h"

namespace isoparm {
namespace {

constexpr double kInfinitelySharp = 10;
constexpr double kLargest = 1e100;  // as in files: squares and products of lengths stay finite
constexpr std::size_t kMostCorners = 500;  // of a face, as make_subdivision() has it

Cage read_cage(const Json& j, SceneBuilder& scene) {
    scene.values().text(j, "the name of an .obj file, relative to the scene, or a cage");
    const IncludedFile file = scene.included(j, "an OBJ cage");
    try {
        return read_cage_obj(file.text, file.path);
    } catch (const Error& e) {
        j.fail("found a file that cannot be used, expected an OBJ cage: " + std::string(e.what()));
    }
}

/// [numbers ..., sharpness]; infinitely sharp when that is left out.
double sharpness(const std::vector<Json>& list, std::size_t at, const SceneValues& values) {
    return list.size() > at ? values.in_range(list[at], 0, kInfinitelySharp, "a sharpness from 0 to 10, which is infinite") : kInfinitelySharp;
}

Cage inline_cage(const Json& j, const SceneValues& values) {
    Cage cage;
    for (const Json& v : values.list(j.at("vertices", "the vertices [x, y, z] of the cage"), 3, 0, "points [x, y, z]")) {
        const Point p = cage.positions.emplace_back(values.point(v));
        if (std::max({std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)}) > kLargest) v.fail("found a vertex with a coordinate above 1e100 in size, expected at most that");
    }
    const int last = static_cast<int>(cage.positions.size()) - 1;
    const auto vertex = [&](const Json& v) { return values.integer(v, 0, last, "a vertex"); };
    std::set<std::pair<int, int>> edges;
    for (const Json& f : values.list(j.at("faces", "the faces of the cage, lists of vertices counted from 0"), 1, 0, "faces")) {
        std::vector<int> corners;
        for (const Json& v : values.list(f, 3, kMostCorners, "vertices")) {
            if (const int i = vertex(v); std::find(corners.begin(), corners.end(), i) == corners.end()) corners.push_back(i);
            else v.fail("found the vertex " + std::to_string(i) + " a second time in a face, expected vertices that are all different");
        }
        for (std::size_t k = 0; k < corners.size(); ++k) edges.insert(std::minmax(corners[k], corners[(k + 1) % corners.size()]));
        cage.faces.push_back(corners);
    }
    if (const auto creases = j.find("creases"))
        for (const Json& c : values.list(*creases, 0, 0, "creases [vertex, vertex, sharpness]")) {
            const auto list = values.list(c, 2, 3, "elements: the ends of an edge and its sharpness");
            const int a = vertex(list[0]), b = vertex(list[1]);
            if (!edges.contains(std::minmax(a, b))) c.fail("found a crease from vertex " + std::to_string(a) + " to " + std::to_string(b) + ", expected the ends of an edge of a face");
            cage.creases.push_back({a, b, sharpness(list, 2, values)});
        }
    if (const auto corners = j.find("corners"))
        for (const Json& c : values.list(*corners, 0, 0, "corners [vertex, sharpness]")) {
            const auto list = values.list(c, 1, 2, "elements: a vertex and its sharpness");
            const int v = vertex(list[0]);
            cage.corners.push_back({v, sharpness(list, 1, values)});
        }
    return cage;
}

/// The cage's vertices and edges, to draw.
ControlNet net_of(const Cage& cage) {
    ControlNet net;
    net.points = cage.positions;
    for (std::size_t v = 0; v < net.points.size(); ++v) net.indices.push_back(std::to_string(v));
    std::set<std::pair<int, int>> edges;
    for (const auto& f : cage.faces)
        for (std::size_t k = 0; k < f.size(); ++k) edges.insert(std::minmax(f[k], f[(k + 1) % f.size()]));
    for (const auto& [a, b] : edges) net.rods.push_back({a, b});
    return net;
}

}  // namespace

BuiltSurface build_subdivision(const Json& j, SceneBuilder& scene) {
    static const std::vector<std::string> inline_keys{"vertices", "faces", "creases", "corners"};
    const auto file = j.find("cage");
    if (file && !file->is(Json::Kind::object))
        for (const auto& key : inline_keys)
            if (const auto extra = j.find(key)) extra->fail_at_key("found " + quoted(key) + " beside a cage in a file, expected one or the other");
    if (file && file->is(Json::Kind::object)) file->allow_keys(inline_keys);
    if (!file && !j.find("vertices")) j.at("cage", "the cage, an .obj file or {\"vertices\", \"faces\", \"creases\", \"corners\"}, or these keys here");
    Cage cage = !file ? inline_cage(j, scene.values()) : file->is(Json::Kind::object) ? inline_cage(*file, scene.values()) : read_cage(*file, scene);
    const auto scheme_key = j.find("scheme");
    const auto scheme = scheme_key ? static_cast<Scheme>(scene.values().word(*scheme_key, {"catmull-clark", "loop", "bilinear"})) : Scheme::catmull_clark;
    if (const auto boundary = j.find("boundary"))
        cage.boundary = scene.values().word(*boundary, {"edge_and_corner", "edge_only"}) == 0 ? Cage::Boundary::edge_and_corner : Cage::Boundary::edge_only;
    SubdivisionSurface s = make_subdivision(cage, scheme);
    BuiltSurface built(std::move(s.patches), net_of(cage));
    built.detail = std::to_string(s.regular) + " regular and " + std::to_string(s.irregular) + " irregular faces" +
                   (s.without_limit > 0 ? ", " + std::to_string(s.without_limit) + " without a limit" : "");
    return built;
}

}  // namespace isoparm
