// Mesh files of other programs: every variant of PLY, OBJ and STL that they write, and whatever a broken file may hold.
#include "io/mesh_reader.h"

#include <gtest/gtest.h>

#include <bit>
#include <cstring>
#include <sstream>

#include "error.h"
#include "io/mesh_files.h"
#include "samples.h"

namespace isoparm::tests {
namespace {

template <class T> void put(std::string& out, T value, bool big = false) {
    char bytes[sizeof value];
    std::memcpy(bytes, &value, sizeof value);
    if (big != (std::endian::native == std::endian::big)) std::reverse(bytes, bytes + sizeof value);
    out.append(bytes, sizeof value);
}

/// A tetrahedron of four triangles.
Mesh tetrahedron() {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.1, 1.0 / 3, 1}};
    MeshPart part;
    part.name = "T";
    part.vertex = {0, 1, 2, 3};
    part.uv.resize(4);
    part.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
    mesh.parts = {part};
    return mesh;
}
std::string written(void (*write)(std::ostream&, const Mesh&, const std::string&)) {
    std::ostringstream out;
    write(out, tetrahedron(), "test");
    return out.str();
}
std::string written_stl() {
    std::ostringstream out;
    write_stl(out, tetrahedron());
    return out.str();
}
void expect_tetrahedron(const MeshFile& file, double rounding = 0) {
    ASSERT_EQ(file.mesh.points.size(), 4u);
    ASSERT_EQ(file.mesh.triangles.size(), 4u);
    double volume = 0;
    for (std::size_t t = 0; t < 4; ++t) {
        const auto [a, b, c] = file.mesh.corners(t);
        volume += dot(a, cross(b, c)) / 6;
    }
    EXPECT_NEAR(volume, 1.0 / 6, rounding + 1e-15);
}
const char* const kCorners = "0 0 0 1 0 0 0 1 0 0.1 0.333333333333333333 1 ";

TEST(MeshReader, WhatIsWrittenIsRead) {
    const MeshFile ply = read_mesh(written(write_ply), "a.PLY");
    EXPECT_EQ(ply.format, "PLY, binary, little-endian");
    EXPECT_EQ(ply.mesh.points, tetrahedron().positions);
    EXPECT_EQ(ply.mesh.triangles[1], (std::array<std::uint32_t, 3>{0, 1, 3}));
    const MeshFile obj = read_mesh(written(write_obj), "a.obj");
    EXPECT_EQ(obj.mesh.points, tetrahedron().positions);
    const MeshFile stl = read_mesh(written_stl(), "a.stl");
    EXPECT_EQ(stl.welded, 8u);  // 12 corners, 4 points
    expect_tetrahedron(stl, 1e-7);
}

TEST(MeshReader, PlyInTextWithOtherElementsAndProperties) {
    const std::string text = std::string("ply\r\nformat ascii 1.0\r\ncomment by hand\r\nobj_info none\r\nelement camera 1\nproperty list uchar int views\nproperty float f\n") +
                             "element vertex 4\nproperty float quality\nproperty double z\nproperty list uint8 int16 marks\nproperty double y\nproperty double x\n" +
                             "element face 4\nproperty uchar red\nproperty list uchar uint vertex_index\nend_header\n" + "2 7 8 0.5\n" +
                             "9 0 0 0 0\n9 0 2 5 6 0 1\n9 0 0 1 0\n9 1 1 3 0.333333333333333333 0.1\n" + "255 3 0 2 1\n255 3 0 1 3\n255 3 1 2 3\n0 3 2 0 3";
    const MeshFile file = read_ply(text, "a.ply");
    EXPECT_EQ(file.format, "PLY, ascii");
    expect_tetrahedron(file);
}
TEST(MeshReader, PlyBigEndianWithFacesFirst) {
    std::string text = "ply\nformat binary_big_endian 1.0\nelement face 1\nproperty list ushort short vertex_indices\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nend_header\n";
    put(text, std::uint16_t{4}, true);
    for (const std::int16_t i : {0, 1, 2, 3}) put(text, i, true);
    for (const float x : {0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 1.f, 1.f, 0.f, 0.f, 1.f, 0.f}) put(text, x, true);
    const MeshFile file = read_ply(text, "a.ply");
    EXPECT_EQ(file.format, "PLY, binary, big-endian");
    EXPECT_EQ(file.polygons, 1u);
    ASSERT_EQ(file.mesh.triangles.size(), 2u);
    EXPECT_EQ(file.mesh.triangles[1], (std::array<std::uint32_t, 3>{0, 2, 3}));
    EXPECT_EQ(file.mesh.points[2], (Point{1, 1, 0}));
}
TEST(MeshReader, ObjWithQuadsNegativeIndicesAndJoinedLines) {
    const MeshFile file = read_obj("# by hand\nmtllib a.mtl\nv 0 0 0\nv 1 0 0 1.0\nv 1 1 0 0.5 0.5 0.5\nv 0 +1e0 0\nvt 0 0\nvn 0 0 1\ng a b\ns off\nf -4/1/1 -3//1 -2/1 \\\n -1 # quad\nv 0 0 1\nf 1 2 -1\r\n", "a.obj");
    EXPECT_EQ(file.polygons, 1u);
    ASSERT_EQ(file.mesh.triangles.size(), 3u);
    EXPECT_EQ(file.mesh.triangles[0], (std::array<std::uint32_t, 3>{0, 1, 2}));
    EXPECT_EQ(file.mesh.triangles[2], (std::array<std::uint32_t, 3>{0, 1, 4}));
}
TEST(MeshReader, AByteOrderMarkIsPassedOver) {
    EXPECT_EQ(read_mesh("\xEF\xBB\xBFv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "a.obj").mesh.triangles.size(), 1u);
}

TEST(MeshReader, StlInTextAndBinaryThatBeginsWithSolid) {
    std::string text = "solid two words\n";
    for (const char* corners : {"0 0 0 0 1 0 1 0 0", "0 0 0 1 0 0 0 0 1"}) {
        std::istringstream in(corners);
        text += "facet normal nan nan nan\n outer loop\n";
        for (std::string x, y, z; in >> x >> y >> z;) text += "  vertex " + x + " " + y + " " + z + "\n";
        text += " endloop\nendfacet\n";
    }
    const MeshFile file = read_stl(text + "endsolid two words\n", "a.stl");
    EXPECT_EQ(file.format, "STL, ascii");
    EXPECT_EQ(file.mesh.triangles.size(), 2u);
    EXPECT_EQ(file.mesh.points.size(), 4u);
    EXPECT_EQ(file.welded, 2u);
    std::string binary = written_stl();
    binary.replace(0, 5, "solid");
    EXPECT_EQ(read_stl(binary, "a.stl").format, "STL, binary");
    EXPECT_THROW(read_stl(binary.substr(0, binary.size() - 1), "a.stl"), Error);
}
TEST(MeshReader, WeldingKeepsTheFirstOfEqualPoints) {
    TriangleMesh mesh{{{1, 2, 3}, {0.0, 0, 0}, {1, 2, 3}, {-0.0, 0, 0}, {5, 5, 5}}, {{2, 3, 4}, {0, 1, 4}}};
    EXPECT_EQ(weld_equal_points(mesh), 2u);
    EXPECT_EQ(mesh.points.size(), 3u);
    EXPECT_EQ(mesh.triangles[0], mesh.triangles[1]);
    EXPECT_EQ(mesh.triangles[0], (std::array<std::uint32_t, 3>{0, 1, 2}));
}

TEST(MeshReader, BadFilesSayWhere) {
    const std::string head = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n";
    const std::string three = "0 0 0\n1 0 0\n0 1 0\n";
    const std::vector<std::array<std::string, 3>> cases = {
        {"a.ply", "", "a.ply:1:1: found the end of the file, expected \"ply\""},
        {"a.ply", "plyx\n", "a.ply:1:1: found 'plyx'"},
        {"a.ply", "ply\nformat utf 1.0\n", "a.ply:2:8: found 'utf', expected ascii"},
        {"a.ply", "ply\nformat ascii 1.0\nelement vertex -1\n", "a.ply:3:16: found '-1'"},
        {"a.ply", "ply\nformat ascii 1.0\nelement vertex 99999999999999999999\n", "a.ply:3:16: found"},
        {"a.ply", "ply\nformat ascii 1.0\nproperty float x\n", "expected an element before it"},
        {"a.ply", "ply\nformat ascii 1.0\nelement vertex 3\nproperty flot x\n", "a.ply:4:10: found 'flot', expected a type"},
        {"a.ply", "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nend_header\n", "found no element vertex with the properties x, y and z"},
        {"a.ply", "ply\nformat ascii 1.0\nelement vertex 1000000000\nproperty float x\nproperty float y\nproperty float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n",
         "1000000000 elements 'vertex' announced and 6 bytes left"},
        {"a.ply", "ply\nformat binary_little_endian 1.0\nelement vertex 1000000000\nproperty float x\nproperty float y\nproperty float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n", "bytes left"},
        {"a.ply", head + three + "3 0 1 3\n", "a.ply:13:7: found the vertex index 3, expected an index from 0, below the number of vertices, 3"},
        {"a.ply", head + three + "3 0 -1 2\n", "the vertex index -1"},
        {"a.ply", head + three + "2 0 1\n", "a face of 2 vertices"},
        {"a.ply", head + three + "3 0 1\n", "found the end of the file, expected a vertex index"},
        {"a.ply", head + three + "200 0 1 2\n", "a list of 200"},
        {"a.ply", head + "0 0 nan\n1 0 0\n0 1 0\n3 0 1 2\n", "a.ply:10:5: found 'nan', expected a coordinate: a finite number"},
        {"a.ply", head + "0 0 1e60\n1 0 0\n0 1 0\n3 0 1 2\n", "at most 1e50"},
        {"a.obj", "v 0 0 0\nv 1 0\n", "a.obj:2:6: found the end of the line, expected a coordinate"},
        {"a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n", "a.obj:4:7: found the vertex index 4, expected 1 to 3, or -1 to -3"},
        {"a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 0\n", "the vertex index 0"},
        {"a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 -4\n", "the vertex index -4"},
        {"a.obj", "v 0 0 0\nv 1 0 0\nf 1 2\n", "a.obj:3:6: found a face of 2 vertices, expected at least 3"},
        {"a.obj", "f 1 2 3\n", "expected vertices before the first face"},
        {"a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3x\n", "a.obj:4:7: found '3x'"},
        {"a.obj", "v inf 0 0\n", "a finite number"},
        {"a.obj", "vertex 0 0 0\n", "a.obj:1:1: found 'vertex', expected a statement of a polygon mesh"},
        {"a.obj", "v 0 0 0\n", "a.obj: found no triangle, expected at least one"},
        {"a.obj", "", "found no triangle"},
        {"a.stl", "", "found 0 bytes"},
        {"a.stl", "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 0 0\nendloop\n", "a.stl:6:1: found 'endloop', expected a coordinate"},
        {"a.stl", "solid x\nfacet normal 0 0 1\nouter lop\n", "a.stl:3:7: found 'lop', expected \"loop\""},
        {"a.stl", "solid x\n", "expected \"facet\" or \"endsolid\""},
        {"a.stl", "solid x\nendsolid x\n", "found no triangle"},
        {"a.stl", written_stl().replace(80, 1, std::string(1, '\2')), "found 2 facets in a file of 284 bytes, expected 184 bytes"},
        {"a.stl", std::string(84, '\377'), "found 4294967295 facets in a file of 84 bytes"},
    };
    for (const auto& [path, text, message] : cases) {
        try {
            read_mesh(text, path);
            ADD_FAILURE() << "read: " << text;
        } catch (const Error& e) {
            EXPECT_EQ(e.kind(), ErrorKind::input) << text;
            EXPECT_NE(std::string(e.what()).find(message), std::string::npos) << "said: " << e.what() << "\nexpected: " << message;
        }
    }
    EXPECT_THROW(read_mesh("", "a.gltf"), Error);
    std::string nan = written_stl();
    const float x = std::numeric_limits<float>::quiet_NaN();
    std::memcpy(nan.data() + 84 + 12 + 4, &x, 4);
    try {
        read_mesh(nan, "a.stl");
        ADD_FAILURE();
    } catch (const Error& e) {
        EXPECT_NE(std::string(e.what()).find("a.stl: byte 100: found nan, expected a coordinate"), std::string::npos) << e.what();
    }
}
TEST(MeshReader, NoPrefixAndNoChangedByteDoesHarm) {
    const std::string ascii = std::string("ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement face 2\nproperty list uchar int vertex_indices\nend_header\n") +
                              kCorners + "3 0 1 2 4 0 1 2 3 ";
    const std::string text_stl = "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid a\n";
    const std::array<std::pair<std::string, std::string>, 5> files = {{{"a.ply", written(write_ply)}, {"a.ply", ascii}, {"a.obj", written(write_obj)}, {"a.stl", written_stl()}, {"a.stl", text_stl}}};
    std::size_t read = 0, refused = 0;
    const auto attempt = [&](const std::string& bytes, const std::string& path) {
        try {
            const MeshFile file = read_mesh(bytes, path);
            for (const auto& t : file.mesh.triangles)
                for (const auto v : t) ASSERT_LT(v, file.mesh.points.size());
            for (const Point& p : file.mesh.points) ASSERT_TRUE(finite(p));
            ++read;
        } catch (const Error& e) {
            ASSERT_EQ(e.kind(), ErrorKind::input);
            ++refused;
        }
    };
    Random random(11);
    for (const auto& [path, bytes] : files) {
        ASSERT_NO_THROW(read_mesh(bytes, path));
        for (std::size_t n = 0; n < bytes.size(); ++n) attempt(bytes.substr(0, n), path);
        for (int k = 0; k < 3000; ++k) {
            std::string changed = bytes;
            for (int i = random.integer(1, 4); i > 0; --i) changed[static_cast<std::size_t>(random.integer(0, static_cast<int>(bytes.size()) - 1))] = static_cast<char>(random.integer(0, 255));
            attempt(changed, path);
        }
    }
    EXPECT_GT(read, 1000u);
    EXPECT_GT(refused, 1000u);
    for (std::size_t n = 0; n < files[0].second.size(); ++n) EXPECT_THROW(read_mesh(files[0].second.substr(0, n), "a.ply"), Error) << n;  // counts and lengths are exact
}

}  // namespace
}  // namespace isoparm::tests
