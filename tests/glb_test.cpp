// Binary glTF: what the specification asks of the file, and that its triangles are those of the other formats.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <set>

#include "expect_program.h"

namespace isoparm::test {
namespace {

/// A reader that believes nothing: every rule of glTF 2.0 that this kind of file could break.
struct Glb {
    Json::Value json;
    std::string bytes;  // the binary chunk

    explicit Glb(const std::string& file) {
        const auto word = [&](std::size_t at) {
            std::uint32_t x = 0;
            EXPECT_LE(at + 4, file.size());
            if (at + 4 <= file.size()) std::memcpy(&x, file.data() + at, 4);
            return x;
        };
        EXPECT_EQ(file.substr(0, 4), "glTF");
        EXPECT_EQ(word(4), 2u);
        EXPECT_EQ(word(8), file.size());
        EXPECT_EQ(word(12) % 4, 0u);
        EXPECT_EQ(file.substr(16, 4), "JSON");
        json = parsed(file.substr(20, word(12)));
        const std::size_t binary = 20 + word(12);
        EXPECT_EQ(word(binary) % 4, 0u);
        EXPECT_EQ(file.substr(binary + 4, 4), std::string("BIN\0", 4));
        EXPECT_EQ(binary + 8 + word(binary), file.size());
        bytes = file.substr(binary + 8);
        EXPECT_EQ(json["asset"]["version"].asString(), "2.0");
        EXPECT_EQ(json["buffers"].size(), 1u);
        EXPECT_EQ(json["buffers"][0]["byteLength"].asUInt(), bytes.size());
        EXPECT_EQ(json["scenes"][0]["nodes"].size(), json["nodes"].size());
    }

    template <class T> std::vector<T> read(const Json::Value& accessor, unsigned component, unsigned target, std::size_t numbers) const {
        const Json::Value& a = json["accessors"][accessor.asInt()];
        const Json::Value& view = json["bufferViews"][a["bufferView"].asInt()];
        const std::size_t count = a["count"].asUInt(), offset = view["byteOffset"].asUInt(), length = view["byteLength"].asUInt();
        EXPECT_EQ(a["componentType"].asUInt(), component);
        EXPECT_EQ(a["type"].asString(), numbers == 3 ? "VEC3" : "SCALAR");
        EXPECT_EQ(view["target"].asUInt(), target);
        EXPECT_EQ(offset % 4, 0u);
        EXPECT_EQ(length, count * sizeof(T));
        EXPECT_GT(count, 0u);
        std::vector<T> out(count);
        EXPECT_LE(offset + length, bytes.size());
        if (offset + length <= bytes.size() && length == count * sizeof(T)) std::memcpy(static_cast<void*>(out.data()), bytes.data() + offset, length);
        return out;
    }
};

using Float3 = std::array<float, 3>;
struct Piece {
    std::string name;
    std::vector<Float3> positions, normals;
    std::vector<std::uint32_t> indices;
};

std::vector<Piece> pieces_of(const Glb& glb) {
    std::vector<Piece> all;
    for (const auto& node : glb.json["nodes"]) {
        const Json::Value& mesh = glb.json["meshes"][node["mesh"].asInt()];
        EXPECT_EQ(mesh["primitives"].size(), 1u);
        const Json::Value& p = mesh["primitives"][0];
        Piece piece{node["name"].asString(), glb.read<Float3>(p["attributes"]["POSITION"], 5126, 34962, 3), glb.read<Float3>(p["attributes"]["NORMAL"], 5126, 34962, 3), glb.read<std::uint32_t>(p["indices"], 5125, 34963, 1)};
        EXPECT_EQ(p["mode"].asInt(), 4);
        EXPECT_EQ(piece.positions.size(), piece.normals.size());
        EXPECT_EQ(piece.indices.size() % 3, 0u);
        for (const auto i : piece.indices) EXPECT_LT(i, piece.positions.size());
        for (const Float3& n : piece.normals) EXPECT_NEAR(std::hypot(n[0], n[1], n[2]), 1, 1e-6);
        const Json::Value& accessor = glb.json["accessors"][p["attributes"]["POSITION"].asInt()];
        for (int axis = 0; axis < 3; ++axis) {
            const auto [low, high] = std::minmax_element(piece.positions.begin(), piece.positions.end(), [&](const Float3& a, const Float3& b) { return a[axis] < b[axis]; });
            EXPECT_EQ(float(accessor["min"][axis].asDouble()), (*low)[axis]);
            EXPECT_EQ(float(accessor["max"][axis].asDouble()), (*high)[axis]);
        }
        all.push_back(piece);
    }
    return all;
}

using Triangle = std::array<Float3, 3>;
void add(std::multiset<Triangle>& all, Triangle t) {
    std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());  // keeps the side
    all.insert(t);
}

TEST(Glb, HoldsTheTrianglesOfTheOtherFormats) {
    const TemporaryFolder t;
    for (const char* name : {"sphere", "s004_gregory"}) {
        const std::string how = "tessellate " + scene(name) + " --quiet --tolerance 5e-3rel -o " + t / "m.";
        ASSERT_EQ(run(how + "stl").code, 0);
        ASSERT_EQ(run(how + "glb --report " + t / "r.json").code, 0);
        const std::vector<Piece> pieces = pieces_of(Glb(read_all(t / "m.glb")));
        std::multiset<Triangle> found, expected;
        std::size_t vertices = 0;
        for (const Piece& p : pieces) {
            vertices += p.positions.size();
            for (std::size_t i = 0; i < p.indices.size(); i += 3) add(found, {p.positions[p.indices[i]], p.positions[p.indices[i + 1]], p.positions[p.indices[i + 2]]});
        }
        const std::string stl = read_all(t / "m.stl");
        for (std::size_t at = 84; at + 50 <= stl.size(); at += 50) {
            Triangle x;
            std::memcpy(static_cast<void*>(x.data()), stl.data() + at + 12, 36);
            add(expected, x);
        }
        EXPECT_EQ(found, expected) << name;
        const Json::Value report = parsed(read_all(t / "r.json"));
        EXPECT_EQ(found.size(), report["triangles"].asUInt());
        EXPECT_LT(vertices, 1.3 * report["vertices"].asUInt());  // shared but where patches or poles have several normals
        EXPECT_GT(report["format_rounding"].asDouble(), 0);
        EXPECT_LT(report["format_rounding"].asDouble(), 1e-6);
        EXPECT_LE(report["certified_error"].asDouble(), report["tolerance"].asDouble());
    }
}

TEST(Glb, NormalsAreThoseOfTheSurfaceOnTheSideOfTheTriangles) {
    const TemporaryFolder t;
    ASSERT_EQ(run("tessellate " + scene("sphere") + " --quiet --tolerance 5e-3rel -o " + t / "m.glb").code, 0);
    double side = 0;  // all normals point away from the centre, or all to it
    for (const Piece& p : pieces_of(Glb(read_all(t / "m.glb"))))
        for (std::size_t i = 0; i < p.positions.size(); ++i) {
            const Float3 &x = p.positions[i], &n = p.normals[i];
            const double d = (double(x[0]) * n[0] + double(x[1]) * n[1] + double(x[2]) * n[2]) / std::hypot(x[0], x[1], x[2]);
            if (side == 0) side = d > 0 ? 1 : -1;
            EXPECT_GT(side * d, 0.999999);
        }
    for (const Piece& p : pieces_of(Glb(read_all(t / "m.glb"))))
        for (std::size_t i = 0; i < p.indices.size(); i += 3) {
            const Float3 &a = p.positions[p.indices[i]], &b = p.positions[p.indices[i + 1]], &c = p.positions[p.indices[i + 2]], &n = p.normals[p.indices[i]];
            double e[3], f[3];
            for (int k = 0; k < 3; ++k) e[k] = double(b[k]) - a[k], f[k] = double(c[k]) - a[k];
            const double area[3] = {e[1] * f[2] - e[2] * f[1], e[2] * f[0] - e[0] * f[2], e[0] * f[1] - e[1] * f[0]};
            EXPECT_GT(area[0] * n[0] + area[1] * n[1] + area[2] * n[2], 0);
        }
}

TEST(Glb, SurfacesHaveTheirNamesAndColours) {
    const TemporaryFolder t;
    write_all(t / "two.json", R"({"isoparm": 1,
        "surfaces": {"flat \"one\"": {"type": "bezier", "points": [[[0,0,0],[0,1,0]],[[1,0,0],[1,1,0]]]}, "B": {"type": "bezier", "points": [[[0,0,1],[0,1,1]],[[1,0,1],[1,1,2]]]}},
        "objects": [{"surface": "B", "color": [1, 0, 0.5], "opacity": 0.5}, {"surface": "flat \"one\""}]})");
    const Outcome o = run("tessellate " + t / "two.json" + " --quiet --tolerance 1e-3 --certificate " + t / "c.json -o " + t / "m.glb");
    ASSERT_EQ(o.code, 0) << o.err;
    const Glb glb(read_all(t / "m.glb"));
    ASSERT_EQ(pieces_of(glb).size(), 2u);
    for (const auto& node : glb.json["nodes"]) {
        const Json::Value& material = glb.json["materials"][glb.json["meshes"][node["mesh"].asInt()]["primitives"][0]["material"].asInt()];
        EXPECT_EQ(material["name"], node["name"]);
        const Json::Value& color = material["pbrMetallicRoughness"]["baseColorFactor"];
        ASSERT_EQ(color.size(), 4u);
        if (node["name"].asString() != "B") continue;
        EXPECT_EQ(color[0].asDouble(), 1);
        EXPECT_EQ(color[1].asDouble(), 0);
        EXPECT_NEAR(color[2].asDouble(), 0.2140, 1e-4);  // sRGB 0.5, linear
        EXPECT_EQ(color[3].asDouble(), 0.5);
        EXPECT_EQ(material["alphaMode"].asString(), "BLEND");
    }
    expect("verify --certificate " + t / "c.json" + " --against " + t / "two.json", 0, "PROVED");
    expect("tessellate " + scene("coons") + " -o " + t / "x.glb --tolerance 1e-8", 2, "cannot be kept in .glb");
    expect("tessellate " + scene("coons") + " -o " + t / "x.gltf", 64, ".stl or .glb");
}

}  // namespace
}  // namespace isoparm::test
