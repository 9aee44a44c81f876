// Cages are read as written, and every bad one is refused at its place.
#include "io/cage_obj.h"

#include <gtest/gtest.h>

#include "error.h"

namespace isoparm {
namespace {

const std::string square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n";

std::string refusal(const std::string& text) {
    try {
        read_cage_obj(text, "c.obj");
    } catch (const Error& e) {
        EXPECT_EQ(e.kind(), ErrorKind::input);
        return e.what();
    }
    return "accepted";
}

TEST(CageObj, ReadsVerticesFacesAndTags) {
    const Cage c = read_cage_obj(square +
                                     "v 2 0.5 -1e-3\nf 2 5 3\nt crease 2/1/0 1 2 2.5\nt corner 1/1/0 4 10\n"
                                     "t hole 1/0/0 1\nt interpolateboundary 1/0/0 2\n",
                                 "c.obj");
    ASSERT_EQ(c.positions.size(), 5u);
    EXPECT_EQ(c.positions[4], Point(2, 0.5, -1e-3));
    ASSERT_EQ(c.faces.size(), 2u);
    EXPECT_EQ(c.faces[1], (std::vector<int>{1, 4, 2}));
    EXPECT_EQ(c.face_lines, (std::vector<int>{5, 7}));
    ASSERT_EQ(c.creases.size(), 1u);
    EXPECT_EQ(c.creases[0].a, 1);
    EXPECT_EQ(c.creases[0].b, 2);
    EXPECT_EQ(c.creases[0].sharpness, 2.5);
    ASSERT_EQ(c.corners.size(), 1u);
    EXPECT_EQ(c.corners[0].vertex, 4);
    EXPECT_EQ(c.holes, std::vector<int>{1});
    EXPECT_EQ(c.boundary, Cage::Boundary::edge_only);
}

TEST(CageObj, InterpolatesBoundaryCornersUnlessToldOtherwise) {
    EXPECT_EQ(read_cage_obj(square, "c.obj").boundary, Cage::Boundary::edge_and_corner);
    EXPECT_EQ(read_cage_obj(square + "t interpolateboundary 1/0/0 0\n", "c.obj").boundary, Cage::Boundary::none);
    EXPECT_EQ(read_cage_obj(square + "t interpolateboundary 1/0/0 1\n", "c.obj").boundary, Cage::Boundary::edge_and_corner);
}

TEST(CageObj, PassesOverWhatCarriesNoShape) {
    const Cage c = read_cage_obj(
        "# a comment\r\nmtllib m.mtl\r\no thing\r\ng side\r\ns 1\r\nv 0 0 0 # origin\r\nv +1 0 0 1\r\nv 1 1 0 0.5 0.5 0.5\r\nvt 0 0\r\nvn 0 0 1\r\n"
        "usemtl red\r\nf 1/1/1 2//1 3/1\r\nt facevaryinginterpolateboundary 1/0/0 1\r\n\r\n", "c.obj");
    EXPECT_EQ(c.positions.size(), 3u);
    EXPECT_EQ(c.faces[0], (std::vector<int>{0, 1, 2}));
}

TEST(CageObj, NegativeIndicesCountBackFromTheLastVertexSoFar) {
    const Cage c = read_cage_obj("v 0 0 0\nv 1 0 0\nv 1 1 0\nf -3 -2 -1\nv 0 1 0\nf -4/-1 -2 -1//-1\n", "c.obj");
    EXPECT_EQ(c.faces[0], (std::vector<int>{0, 1, 2}));
    EXPECT_EQ(c.faces[1], (std::vector<int>{0, 2, 3}));
}

TEST(CageObj, ABackslashJoinsLinesButNotInComments) {
    const Cage c = read_cage_obj("# c:\\\nv 0 0 0\nv 1 \\\r\n 0 0\nv 1 1 0\nf 1 \\\n2 \\  \n3\nv 0 1 0 \\", "c.obj");
    EXPECT_EQ(c.positions.size(), 4u);
    EXPECT_EQ(c.faces[0], (std::vector<int>{0, 1, 2}));
    EXPECT_NE(refusal(square + "f 1 \\\n2 9").find("c.obj:7:3: found the vertex index 9"), std::string::npos) << refusal(square + "f 1 \\\n2 9");
}

TEST(CageObj, FacesMayComeBeforeTheirVertices) {
    EXPECT_EQ(read_cage_obj("f 1 2 3\nv 0 0 0\nv 1 0 0\nv 1 1 0\n", "c.obj").faces[0], (std::vector<int>{0, 1, 2}));
}

TEST(CageObj, OneTagMaySharpenSeveralEdges) {
    const Cage c = read_cage_obj(square + "t crease 4/2/0 0 1 1 2 3 4\nt crease 4/1/0 2 3 3 0 5\nt corner 2/1/0 0 1 6\n", "c.obj");
    ASSERT_EQ(c.creases.size(), 4u);
    EXPECT_EQ(c.creases[0].sharpness, 3);
    EXPECT_EQ(c.creases[1].sharpness, 4);
    EXPECT_EQ(c.creases[3].b, 0);
    EXPECT_EQ(c.creases[3].sharpness, 5);
    EXPECT_EQ(c.corners[1].sharpness, 6);
}

struct Bad {
    const char* name;
    std::string text, place, found, expected;
};

TEST(CageObj, RefusesBadCagesAtTheirPlace) {
    const std::vector<Bad> cages = {
        {"empty", "", "c.obj:1:1:", "the end of the file", "v statements"},
        {"no vertices", "# nothing\n\n", "c.obj:2:1:", "without a vertex", "v statements"},
        {"no faces", "v 0 0 0\n", "c.obj:1:1:", "without a face", "f statements"},
        {"unknown statement", square + "cstype bezier\n", "c.obj:6:1:", "'cstype'", "OBJ statement"},
        {"two coordinates", "v 0 0\n", "c.obj:1:6:", "the end of the line", "a coordinate"},
        {"five numbers", "v 0 0 0 1 2\n", "c.obj:1:9:", "'1'", "nothing after"},
        {"word for a number", "v 0 zero 0\n", "c.obj:1:5:", "'zero'", "a finite number"},
        {"number with a tail", "v 0 1x 0\n", "c.obj:1:5:", "'1x'", "a finite number"},
        {"nan", "v 0 nan 0\n", "c.obj:1:5:", "'nan'", "a finite number"},
        {"infinity", "v 0 0 inf\n", "c.obj:1:7:", "'inf'", "a finite number"},
        {"overflow", "v 0 0 1e999\n", "c.obj:1:7:", "'1e999'", "1e100"},
        {"huge", "v 0 0 1e200\n", "c.obj:1:7:", "'1e200'", "1e100"},
        {"weight", "v 0 0 0 2\n", "c.obj:1:9:", "'2'", "weight 1"},
        {"face of two", square + "f 1 2\n", "c.obj:6:6:", "2 vertices", "at least 3"},
        {"face of none", square + "f\n", "c.obj:6:2:", "0 vertices", "at least 3"},
        {"index 0", square + "f 0 1 2\n", "c.obj:6:3:", "index 0", "1 or more"},
        {"index too large", square + "f 1 2 9\nf 3 2 1\n", "c.obj:6:7:", "index 9", "1 to 4"},
        {"index too far back", square + "f -5 2 3\n", "c.obj:6:3:", "index -5", "-1 to -4"},
        {"index overflow", square + "f 99999999999 2 3\n", "c.obj:6:3:", "'99999999999'", "v/vt/vn"},
        {"fractional index", square + "f 1.5 2 3\n", "c.obj:6:3:", "'1.5'", "v/vt/vn"},
        {"too many slashes", square + "f 1/1/1/1 2 3\n", "c.obj:6:3:", "'1/1/1/1'", "v/vt/vn"},
        {"trailing slash", square + "f 1/ 2 3\n", "c.obj:6:3:", "'1/'", "v/vt/vn"},
        {"degenerate face", square + "f 1 2 2 3\n", "c.obj:6:7:", "vertex 2 a second time", "all different"},
        {"tag without name", square + "t\n", "c.obj:6:2:", "the end of the line", "name of a tag"},
        {"unknown tag", square + "t vertexedit 1/1/0 0 1\n", "c.obj:6:3:", "'vertexedit'", "crease, corner"},
        {"counts missing", square + "t crease\n", "c.obj:6:9:", "the end of the line", "2/1/0"},
        {"counts malformed", square + "t crease 2/1 0 1 2\n", "c.obj:6:10:", "'2/1'", "2/1/0"},
        {"counts disagree", square + "t crease 2/1/0 0 1\n", "c.obj:6:10:", "before 2 values", "add up"},
        {"counts negative", square + "t crease -1/1/2 0 1\n", "c.obj:6:10:", "'-1/1/2'", "add up"},
        {"odd crease", square + "t crease 3/1/0 0 1 2 5\n", "c.obj:6:3:", "3 vertices", "pairs"},
        {"crease off the edges", square + "t crease 2/1/0 0 2 5\n", "c.obj:6:16:", "from vertex 0 to 2", "an edge of a face"},
        {"crease vertex out of range", square + "t crease 2/1/0 0 7 5\n", "c.obj:6:18:", "vertex 7", "0 to 3"},
        {"negative tag index", square + "t crease 2/1/0 0 -1 5\n", "c.obj:6:18:", "-1", "counted from 0"},
        {"negative sharpness", square + "t crease 2/1/0 0 1 -5\n", "c.obj:6:20:", "-5", "0 or more"},
        {"sharpnesses", square + "t crease 4/3/0 0 1 1 2 5 5 5\n", "c.obj:6:3:", "3 sharpnesses", "one for each"},
        {"corner out of range", square + "t corner 1/1/0 4 5\n", "c.obj:6:16:", "vertex 4", "0 to 3"},
        {"hole out of range", square + "t hole 1/0/0 1\n", "c.obj:6:14:", "face 1", "0 to 0"},
        {"boundary rule", square + "t interpolateboundary 1/0/0 3\n", "c.obj:6:29:", "found 3", "0 (none)"},
        {"boundary rule missing", square + "t interpolateboundary 0/0/0\n", "c.obj:6:28:", "the end of the line", "0, 1 or 2"},
        {"brackets", std::string(1 << 20, '['), "c.obj:1:1:", "'[[[[", "OBJ statement"},
        {"zeros", std::string(100, '\0'), "c.obj:1:1:", "'????", "OBJ statement"},
        {"truncated", "v 0 0 0\nv 1", "c.obj:2:4:", "the end of the line", "a coordinate"},
    };
    for (const Bad& bad : cages) {
        const std::string message = refusal(bad.text);
        EXPECT_EQ(message.rfind(bad.place, 0), 0u) << bad.name << ": " << message;
        EXPECT_NE(message.find(bad.found), message.npos) << bad.name << ": " << message;
        EXPECT_NE(message.find("expected"), message.npos) << bad.name << ": " << message;
        EXPECT_NE(message.find(bad.expected), message.npos) << bad.name << ": " << message;
        EXPECT_LT(message.size(), 300u) << bad.name;
    }
}

}  // namespace
}  // namespace isoparm
