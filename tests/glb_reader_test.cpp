// Binary glTF of other programs: what the format allows, what is refused by name, and what a broken file may hold.
#include "glb_reader.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <filesystem>

#include "error.h"
#include "expect_program.h"

namespace isoparm::test {
namespace {

template <class T> std::string bytes_of(std::initializer_list<T> values) {
    std::string out;
    for (const T x : values) {
        char bytes[sizeof x];
        std::memcpy(bytes, &x, sizeof x);
        out.append(bytes, sizeof x);
    }
    return out;
}
std::string glb_of(std::string json, std::string binary) {
    json.resize((json.size() + 3) / 4 * 4, ' '), binary.resize((binary.size() + 3) / 4 * 4, '\0');
    const auto word = [](std::size_t x) { return bytes_of<std::uint32_t>({static_cast<std::uint32_t>(x)}); };
    return "glTF" + word(2) + word(28 + json.size() + binary.size()) + word(json.size()) + "JSON" + json + word(binary.size()) + std::string("BIN\0", 4) + binary;
}
/// Five points, then the numbers 0 1 2 3 4 in one, two and four bytes each.
std::string numbers() {
    return bytes_of<float>({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 2, 0.5f}) + bytes_of<std::uint8_t>({0, 1, 2, 3, 4, 0, 0, 0}) + bytes_of<std::uint16_t>({0, 1, 2, 3, 4, 0}) + bytes_of<std::uint32_t>({0, 1, 2, 3, 4});
}
/// A scene of those; `primitive` stands behind the attributes.
std::string scene_of(const std::string& primitive, const std::string& nodes = R"([{"mesh": 0}])", const std::string& more = "") {
    return R"({"asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "nodes": )" + nodes + R"(, "meshes": [{"primitives": [{"attributes": {"POSITION": 0})" + primitive + R"(}]}],
"accessors": [{"bufferView": 0, "componentType": 5126, "count": 5, "type": "VEC3"}, {"bufferView": 1, "componentType": 5121, "count": 5, "type": "SCALAR"},
 {"bufferView": 2, "componentType": 5123, "count": 5, "type": "SCALAR"}, {"bufferView": 3, "componentType": 5125, "count": 5, "type": "SCALAR"}, {"bufferView": 4, "byteOffset": 0, "componentType": 5126, "count": 2, "type": "VEC3"}],
"bufferViews": [{"buffer": 0, "byteLength": 60}, {"buffer": 0, "byteOffset": 60, "byteLength": 5}, {"buffer": 0, "byteOffset": 68, "byteLength": 10}, {"buffer": 0, "byteOffset": 80, "byteLength": 20}, {"buffer": 0, "byteLength": 60, "byteStride": 24}],
"buffers": [{"byteLength": 100}])" + more + "}";
}
MeshFile read(const std::string& json) { return read_glb(glb_of(json, numbers()), "a.glb"); }

using Triangles = std::vector<std::array<std::uint32_t, 3>>;

TEST(GlbReader, StripsFansAndIndicesOfEverySize) {
    EXPECT_EQ(read(scene_of("")).mesh.triangles, (Triangles{{0, 1, 2}})) << "two points are left over";
    for (const char* accessor : {"1", "2", "3"}) {
        const std::string indices = R"(, "indices": )" + std::string(accessor);
        EXPECT_EQ(read(scene_of(indices + R"(, "mode": 4)")).mesh.triangles, (Triangles{{0, 1, 2}}));
        EXPECT_EQ(read(scene_of(indices + R"(, "mode": 5)")).mesh.triangles, (Triangles{{0, 1, 2}, {1, 3, 2}, {2, 3, 4}})) << "the sides of a strip alternate";
        EXPECT_EQ(read(scene_of(indices + R"(, "mode": 6)")).mesh.triangles, (Triangles{{1, 2, 0}, {2, 3, 0}, {3, 4, 0}}));
    }
}
TEST(GlbReader, NodesMoveWhatTheyShow) {
    const auto points = [](const std::string& nodes) { return read(scene_of("", nodes)).mesh.points; };
    EXPECT_EQ(points(R"([{"mesh": 0}])")[4], (Point{0, 2, 0.5}));
    EXPECT_EQ(points(R"([{"mesh": 0, "translation": [1, 2, 3]}])")[4], (Point{1, 4, 3.5}));
    EXPECT_EQ(points(R"([{"mesh": 0, "scale": [2, 3, 4], "translation": [1, 0, 0]}])")[4], (Point{1, 6, 2})) << "first the scale";
    EXPECT_EQ(points(R"([{"mesh": 0, "matrix": [0,1,0,0, -1,0,0,0, 0,0,1,0, 5,6,7,1]}])")[4], (Point{3, 6, 7.5})) << "column by column";
    const double h = std::sqrt(0.5);  // a quarter turn about z takes (0, 2) to (-2, 0), in a node that is moved by (10, 0, 0)
    const auto turned = points(R"([{"children": [1], "translation": [10, 0, 0]}, {"mesh": 0, "rotation": [0, 0, )" + to_text(h) + ", " + to_text(h) + "]}]")[4];
    EXPECT_LE(distance(turned, Point{8, 0, 0.5}), 1e-14);
}
TEST(GlbReader, VerticesOfEqualPlaceBecomeOne) {
    const MeshFile file = read(scene_of(R"(, "indices": 3, "mode": 6)", R"([{"mesh": 0, "children": [1]}, {"mesh": 0}])"));
    EXPECT_EQ(file.mesh.points.size(), 5u);
    EXPECT_EQ(file.welded, 5u);
    EXPECT_EQ(file.mesh.triangles.size(), 6u);
}

TEST(GlbReader, BadFilesAreRefusedWithTheirPlace) {
    const auto refused = [](const std::string& file, const std::string& message) {
        try {
            read_glb(file, "a.glb");
            ADD_FAILURE() << message;
        } catch (const Error& e) {
            EXPECT_EQ(e.kind(), ErrorKind::input);
            EXPECT_NE(std::string(e.what()).find(message), std::string::npos) << e.what();
        }
    };
    const std::string good = scene_of(""), file = glb_of(good, numbers());
    for (std::size_t size = 0; size < file.size(); ++size) EXPECT_THROW(read_glb(file.substr(0, size), "a.glb"), Error) << size;
    refused("{}  " + file.substr(4), "a.glb: byte 0");
    refused(file + "more", "a length of");
    const auto with = [&](const std::string& from, const std::string& to, const std::string& message) {
        std::string text = good;
        ASSERT_NE(text.find(from), std::string::npos) << from;
        refused(glb_of(text.replace(text.find(from), from.size(), to), numbers()), message);
    };
    with("\"2.0\"", "\"1.0\"", "a.glb (JSON):1:23: at $.asset.version: found \"1.0\", expected version 2.0");
    with("\"nodes\": [0]", "\"nodes\": [7]", "an index of nodes, from 0 to 0");
    with("\"nodes\": [0]", "\"nodes\": [0, 0]", "for the second time");
    with("\"nodes\": [0]", "\"nodes\": []", "found no triangle");
    with("\"POSITION\": 0", "\"NORMAL\": 0", "found no key \"POSITION\"");
    with("\"POSITION\": 0", "\"POSITION\": 1", "expected \"VEC3\"");
    with("\"count\": 5", "\"count\": 6", "found 6 elements in 60 bytes");
    with("\"count\": 5", "\"count\": 1e9", "elements in 60 bytes");
    with("\"count\": 5", "\"count\": -1", "$.accessors[0].count: found -1");
    with("\"count\": 5", "\"count\": 0", "no count of elements");
    with("\"count\": 5", "\"count\": 5, \"sparse\": {}", "a sparse accessor");
    with("\"componentType\": 5126", "\"componentType\": 5123", "expected 5126, float32");
    with("\"byteLength\": 60", "\"byteLength\": 1e300", "$.bufferViews[0].byteLength");
    with("\"buffers\": [{", "\"buffers\": [{\"uri\": \"b.bin\", ", "a buffer in another file");
    refused(glb_of(scene_of("", R"([{"children": [0]}])"), numbers()), "for the second time");
    refused(glb_of(scene_of("", R"([{"mesh": 0, "scale": [1e308, 1, 1]}])"), bytes_of<float>({1e10f}) + numbers().substr(4)), "expected a finite number of at most 1e50");
    refused(glb_of(good, bytes_of<float>({NAN}) + numbers().substr(4)), "the coordinate nan of vertex 0");
    refused(glb_of(scene_of(R"(, "indices": 3)"), numbers().substr(0, 80) + bytes_of<std::uint32_t>({0, 1, 5, 0, 0})), "found the index 5 as number 2, expected one below 5");
    refused(glb_of(scene_of(R"(, "indices": 0)"), numbers()), "expected \"SCALAR\"");
    for (const char* name : {"KHR_draco_mesh_compression", "KHR_mesh_quantization", "EXT_anything"})
        refused(glb_of(scene_of("", R"([{"mesh": 0}])", R"(, "extensionsRequired": [")" + std::string(name) + "\"]"), numbers()), "no extension but such as say how surfaces look");
    EXPECT_EQ(read_glb(glb_of(scene_of("", R"([{"mesh": 0}])", R"(, "extensionsRequired": ["KHR_materials_unlit"])"), numbers()), "a.glb").mesh.triangles.empty(), false);
}
/// A file of some kilobytes that shows what it holds a million times.
TEST(GlbReader, WhatIsShownAgainAndAgainHasALimit) {
    std::string nodes = "[{\"children\": [1", list;
    for (int k = 2; k <= 200'001; ++k) nodes += "," + std::to_string(k);
    nodes += "]}";
    for (int k = 1; k <= 200'001; ++k) list += ",{\"mesh\":0}";
    EXPECT_THROW(read(scene_of("", nodes + list + "]")), Error);
}
TEST(GlbReader, VerifyReadsWhatTessellateWrites) {
    const TemporaryFolder t;
    const std::string how = "tessellate " + scene("sphere") + " --quiet --tolerance 2e-2rel -o " + t / "m.";
    ASSERT_EQ(run(how + "stl").code, 0);
    ASSERT_EQ(run(how + "glb").code, 0);
    const auto distance = [&](const char* name) { return parsed(run("verify " + t / name + " --against " + scene("sphere") + " --gap 0.5 --max-triangles 20000 --json --quiet").out); };
    const Json::Value glb = distance("m.glb"), stl = distance("m.stl");
    EXPECT_EQ(glb["triangles"], stl["triangles"]);
    EXPECT_EQ(glb["vertices"], stl["vertices"]);
    EXPECT_EQ(glb["topology"]["boundary_loops"], stl["topology"]["boundary_loops"]);
    EXPECT_EQ(glb["format"].asString(), "glTF, binary");
    ASSERT_EQ(run(how + "glb --certificate " + t / "c.json").code, 0);
    expect("verify " + t / "m.glb --certificate " + t / "c.json --against " + scene("sphere"), 0, "PROVED");
    expect("verify " + t / "m.gltf --against " + scene("sphere"), 64, "expected .ply, .obj, .stl or .glb");
}

}  // namespace
}  // namespace isoparm::test
