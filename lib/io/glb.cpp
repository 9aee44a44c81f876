#include "io/glb.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <map>
#include <ostream>

#include "error.h"
#include "isoparm_version.h"
#include "text/json_text.h"

namespace isoparm {
namespace {

using Float3 = std::array<float, 3>;
Float3 to_float(const Point& p) { return {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)}; }

template <class T> void put(std::string& out, T value) {
    char bytes[sizeof value];
    std::memcpy(bytes, &value, sizeof value);
    if constexpr (std::endian::native == std::endian::big) std::reverse(bytes, bytes + sizeof value);
    out.append(bytes, sizeof value);
}

/// The outward normals of the corners of a part.
std::vector<Float3> normals_of(const Mesh& mesh, const MeshPart& part, const Patch& patch) {
    std::vector<Point> facet(part.uv.size());  // sums over the triangles around a corner
    for (const auto& t : part.triangles) {
        const Point &a = mesh.positions[part.vertex[t[0]]], n = cross(mesh.positions[part.vertex[t[1]]] - a, mesh.positions[part.vertex[t[2]]] - a);
        for (const auto c : t) facet[c] += n;
    }
    std::vector<Float3> normals(part.uv.size());
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, normals.size(), 256), [&](const tbb::blocked_range<std::size_t>& range) {
        for (std::size_t i = range.begin(); i < range.end(); ++i) {
            const auto n = unit_normal(patch, patch.jet(part.uv[i].x, part.uv[i].y), part.uv[i].x, part.uv[i].y);
            const double size = length(facet[i]);
            normals[i] = to_float(n ? (part.flipped ? -*n : *n) : size > 0 ? facet[i] / size : Point{0, 0, 1});
        }
    });
    return normals;
}

/// The vertices and indices of one surface.
struct Primitive {
    std::vector<Float3> positions, normals;
    std::vector<std::uint32_t> indices;

    Primitive(const Mesh& mesh, const Composite& surface, const std::vector<std::size_t>& parts) {
        std::map<std::array<std::uint32_t, 6>, std::uint32_t> number;  // by the bits, so that -0 is not 0
        for (const std::size_t m : parts) {
            const MeshPart& part = mesh.parts[m];
            const std::vector<Float3> normal = normals_of(mesh, part, surface[part.member].patch);
            std::vector<std::uint32_t> vertex(part.uv.size(), UINT32_MAX);
            for (const auto& t : part.triangles) {
                const Float3 p[3] = {to_float(mesh.positions[part.vertex[t[0]]]), to_float(mesh.positions[part.vertex[t[1]]]), to_float(mesh.positions[part.vertex[t[2]]])};
                if (p[0] == p[1] || p[1] == p[2] || p[2] == p[0]) continue;
                for (int k = 0; k < 3; ++k) {
                    std::uint32_t& v = vertex[t[k]];
                    if (v == UINT32_MAX) v = number_of(number, p[k], normal[t[k]]);
                    indices.push_back(v);
                }
            }
        }
    }

private:
    std::uint32_t number_of(std::map<std::array<std::uint32_t, 6>, std::uint32_t>& number, const Float3& p, const Float3& n) {
        std::array<std::uint32_t, 6> key;
        for (int k = 0; k < 3; ++k) key[k] = std::bit_cast<std::uint32_t>(p[k]), key[3 + k] = std::bit_cast<std::uint32_t>(n[k]);
        const auto [found, fresh] = number.try_emplace(key, static_cast<std::uint32_t>(positions.size()));
        if (fresh) positions.push_back(p), normals.push_back(n);
        return found->second;
    }
};

/// The JSON chunk and the binary one, side by side.
class Glb {
public:
    void add(const GlbSurface& s, const Primitive& p) {
        const std::string comma = count_ ? ",\n" : "\n", n = std::to_string(count_), a = std::to_string(3 * count_), b = std::to_string(3 * count_ + 1), c = std::to_string(3 * count_ + 2);
        nodes_ += comma + "{\"name\": " + json_text(s.name) + ", \"mesh\": " + n + "}";
        roots_ += count_ ? ", " : "";
        roots_ += n;
        meshes_ += comma + "{\"name\": " + json_text(s.name) + ", \"primitives\": [{\"attributes\": {\"POSITION\": " + a + ", \"NORMAL\": " + b + "}, \"indices\": " + c + ", \"material\": " + n + ", \"mode\": 4}]}";
        const auto channel = [](double x) { return to_text(std::clamp(x, 0.0, 1.0)); };
        materials_ += comma + "{\"name\": " + json_text(s.name) + ", \"pbrMetallicRoughness\": {\"baseColorFactor\": [" + channel(s.color.x) + ", " + channel(s.color.y) + ", " + channel(s.color.z) + ", " +
                      channel(s.opacity) + "], \"metallicFactor\": 0, \"roughnessFactor\": 0.6}, \"alphaMode\": " + (s.opacity < 1 ? "\"BLEND\"" : "\"OPAQUE\"") + ", \"doubleSided\": true}";
        Float3 low = p.positions[0], high = low;
        for (const Float3& x : p.positions)
            for (int k = 0; k < 3; ++k) low[k] = std::min(low[k], x[k]), high[k] = std::max(high[k], x[k]);
        accessor(12 * p.positions.size(), 34962, 5126, p.positions.size(), "VEC3", ", \"min\": " + list(low) + ", \"max\": " + list(high));
        for (const Float3& x : p.positions) add_floats(x);
        accessor(12 * p.normals.size(), 34962, 5126, p.normals.size(), "VEC3", "");
        for (const Float3& x : p.normals) add_floats(x);
        accessor(4 * p.indices.size(), 34963, 5125, p.indices.size(), "SCALAR", "");
        for (const std::uint32_t i : p.indices) put(data_, i);
        ++count_;
    }

    void write(std::ostream& out) const {
        std::string json = "{\"asset\": {\"version\": \"2.0\", \"generator\": \"isoparm " ISOPARM_VERSION "\"},\n\"scene\": 0, \"scenes\": [{\"nodes\": [" + roots_ + "]}],\n\"nodes\": [" + nodes_ + "],\n\"meshes\": [" + meshes_ +
                           "],\n\"materials\": [" + materials_ + "],\n\"accessors\": [" + accessors_ + "],\n\"bufferViews\": [" + views_ + "],\n\"buffers\": [{\"byteLength\": " + std::to_string(data_.size()) + "}]}";
        json.resize((json.size() + 3) / 4 * 4, ' ');
        const std::size_t size = 12 + 8 + json.size() + 8 + data_.size();
        if (size > 0xFFFFFFFFu) throw Error(ErrorKind::io, "binary glTF cannot hold more than 4 GiB; write PLY");
        std::string head;
        for (const std::size_t x : {std::size_t{0x46546C67}, std::size_t{2}, size, json.size(), std::size_t{0x4E4F534A}}) put(head, static_cast<std::uint32_t>(x));
        out << head << json;
        head.clear();
        for (const std::size_t x : {data_.size(), std::size_t{0x004E4942}}) put(head, static_cast<std::uint32_t>(x));
        out << head << data_;  // all numbers have four bytes
    }

private:
    void accessor(std::size_t bytes, int target, int component, std::size_t count, const char* type, const std::string& more) {
        const std::string view = std::to_string(view_count_), comma = view_count_++ ? ",\n" : "\n";
        views_ += comma + "{\"buffer\": 0, \"byteOffset\": " + std::to_string(data_.size()) + ", \"byteLength\": " + std::to_string(bytes) + ", \"target\": " + std::to_string(target) + "}";
        accessors_ += comma + "{\"bufferView\": " + view + ", \"componentType\": " + std::to_string(component) + ", \"count\": " + std::to_string(count) + ", \"type\": \"" + type + "\"" + more + "}";
    }
    void add_floats(const Float3& x) {
        for (const float f : x) put(data_, f);
    }
    static std::string list(const Float3& x) { return json_text(Point{x[0], x[1], x[2]}); }

    std::string nodes_, roots_, meshes_, materials_, accessors_, views_, data_;
    std::size_t count_ = 0, view_count_ = 0;
};

}  // namespace

void write_glb(std::ostream& out, const Mesh& mesh, const Composite& surface, const std::vector<GlbSurface>& surfaces) {
    Glb file;
    for (const GlbSurface& s : surfaces)
        if (const Primitive p(mesh, surface, s.parts); !p.indices.empty()) file.add(s, p);
    file.write(out);
}

}  // namespace isoparm
