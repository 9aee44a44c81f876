#include <algorithm>
#include <cstring>

#include "error.h"
#include "io/mesh_scanner.h"

namespace isoparm {
namespace {

constexpr std::size_t kHeader = 84, kFacet = 50;

void add_facet(MeshFile& file, const std::array<Point, 3>& corners) {
    const auto n = static_cast<std::uint32_t>(file.mesh.points.size());
    file.mesh.points.insert(file.mesh.points.end(), corners.begin(), corners.end());
    file.mesh.triangles.push_back({n, n + 1, n + 2});
}

void read_binary(const std::string& bytes, const std::string& path, std::size_t facets, MeshFile& file) {
    file.format = "STL, binary";
    ByteScanner in(bytes, kHeader, path, false);
    file.mesh.points.reserve(3 * facets);
    file.mesh.triangles.reserve(facets);
    for (std::size_t k = 0; k < facets; ++k) {
        in.skip(12, "a normal");
        std::array<Point, 3> corners;
        for (Point& p : corners)
            for (int axis = 0; axis < 3; ++axis) p[axis] = in.coordinate(in.number<float>("a coordinate"));
        in.skip(2, "the attributes of a facet");
        add_facet(file, corners);
    }
}

/// facet normal x y z outer loop vertex x y z (three times) endloop endfacet, between solid NAME and endsolid NAME.
void read_text(const std::string& bytes, const std::string& path, MeshFile& file) {
    file.format = "STL, ascii";
    TextScanner in(bytes, path);
    const auto expect = [&](const char* word) {
        const std::string_view found = in.word();
        const std::string wanted = std::string("\"") + word + "\"";
        if (found != word) in.fail_word(found, wanted.c_str());
    };
    expect("solid");
    in.next_line();
    for (;;) {
        const std::string_view word = in.word();
        if (word == "facet") {
            expect("normal");
            for (int k = 0; k < 3; ++k) in.word();  // no use is made of it, and some programs write NaN
            expect("outer"), expect("loop");
            std::array<Point, 3> corners;
            for (Point& p : corners) {
                expect("vertex");
                for (int axis = 0; axis < 3; ++axis) p[axis] = in.number(in.word(), "a coordinate");
            }
            expect("endloop"), expect("endfacet");
            if (file.mesh.triangles.size() == kMostElements / 3) in.fail("one more facet", "at most " + std::to_string(kMostElements / 3));
            add_facet(file, corners);
        } else if (word == "endsolid") {
            in.next_line();
            if (const std::string_view next = in.word(); next.empty()) return;
            else if (next != "solid") in.fail_word(next, "\"solid\" or the end of the file");
            in.next_line();
        } else {
            in.fail_word(word, "\"facet\" or \"endsolid\"");
        }
    }
}

}  // namespace

MeshFile read_stl(const std::string& bytes, const std::string& path) {
    MeshFile file;
    std::uint32_t facets = 0;
    if (bytes.size() >= kHeader) facets = ByteScanner(bytes, kHeader - 4, path, false).number<std::uint32_t>("the number of facets");
    const std::size_t size = kHeader + kFacet * std::size_t{facets};
    // Binary files may begin with "solid" too: only the length tells. A few bytes behind the facets are passed over.
    const bool solid = bytes.rfind("solid", 0) == 0;
    if (bytes.size() >= kHeader && (bytes.size() == size || (!solid && bytes.size() > size && bytes.size() < size + kFacet))) read_binary(bytes, path, facets, file);
    else if (solid) read_text(bytes, path, file);
    else if (bytes.size() < kHeader) throw_input(path + ": found " + std::to_string(bytes.size()) + " bytes, expected \"solid\" or the 84 bytes that a binary STL file begins with");
    else throw_input(path + ": byte 80: found " + std::to_string(facets) + " facets in a file of " + std::to_string(bytes.size()) + " bytes, expected " + std::to_string(size) + " bytes for them");
    file.welded = weld_equal_points(file.mesh);
    return file;
}

}  // namespace isoparm
