#include "io/bv.h"

#include <gtest/gtest.h>

#include "error.h"
#include "run_program.h"

namespace isoparm {
namespace {

const std::string kSquare = "5\n1 1\n0 0 0\n0 1 0\n1 0 0\n1 1 2\n";

TEST(Bv, ControlPointsHaveVFastest) {
    const Composite c = read_bv(kSquare, "a/square.bv");
    ASSERT_EQ(c.size(), 1u);
    EXPECT_EQ(c[0].name, "square#0");
    EXPECT_EQ(c[0].patch.point(0, 1), Point(0, 1, 0));
    EXPECT_EQ(c[0].patch.point(1, 0), Point(1, 0, 0));
    EXPECT_EQ(c[0].patch.point(0.5, 0.5), Point(0.5, 0.5, 0.5));
}
TEST(Bv, GroupsNameTheirPatches) {
    const Composite c = read_bv("Group 3 lid\n" + kSquare + kSquare + "Group 0 body\n" + kSquare + "Group 3 lid\n" + kSquare, "x.bv");
    ASSERT_EQ(c.size(), 4u);
    EXPECT_EQ(c[1].name, "lid#1");
    EXPECT_EQ(c[2].name, "body#0");
    EXPECT_EQ(c[3].name, "lid#2");
}
TEST(Bv, EveryKindIsRead) {
    const Composite c = read_bv("4 1  0 0 0  0 1 0  1 0 0  1 1 0\n"
                                "8 1 2  0 0 0 2  0 1 0 1  0 4 0 2   1 0 0 1  1 1 0 1  1 2 0 1\n"
                                "3 2  0 0 0  1 0 0  2 0 0   0 1 0  1 1 0   0 2 5\n", "k.bv");
    ASSERT_EQ(c.size(), 3u);
    EXPECT_EQ(c[1].patch.point(0, 1), Point(0, 2, 0));  // wy 4 by w 2
    EXPECT_EQ(c[2].patch.domain(), Domain::triangle);
    EXPECT_EQ(c[2].patch.point(1, 0), Point(0, 0, 0));
    EXPECT_EQ(c[2].patch.point(0, 1), Point(2, 0, 0));
    EXPECT_EQ(c[2].patch.point(0, 0), Point(0, 2, 5));
}
TEST(Bv, ErrorsNameThePlace) {
    const auto fails = [](const std::string& text, const std::string& message) {
        try {
            read_bv(text, "bad.bv");
            ADD_FAILURE() << text;
        } catch (const Error& e) {
            EXPECT_EQ(e.kind(), ErrorKind::input);
            EXPECT_NE(std::string(e.what()).find(message), std::string::npos) << e.what();
        }
    };
    fails("", "bad.bv:1:1: found the end of the file, expected at least one patch");
    fails("5\n1 1\n0 0 0\n0 abc 0\n", "bad.bv:4:3: found 'abc', expected the y of control point 1 of patch 0");
    fails(kSquare + "5 1\n", "bad.bv:8:1: found the end of the file, expected the degree in v of patch 1");
    fails("5\n1 1\n0 0 0\n0 1", "bad.bv:4:4: found the end of the file, expected the z of control point 1");
    fails("5 0 1", "bad.bv:1:3: found '0', expected the degree in u of patch 0");
    fails("5 1 1000000", "found '1000000'");
    fails("8 1 1 0 0 0 0", "bad.bv:1:13: found '0', expected a positive weight");
    fails("5 1 1 nan", "found 'nan'");
    fails("5 1 1 1e999", "found '1e999'");
    fails("6", "kind 6, trimmed patches, is not supported");
    fails("1 4 1", "a polyhedron has no curved surface");
    fails("Group lid", "expected the colour of the group");
    fails("Group 0", "expected the name of the group");
    fails("teapot", "found 'teapot', expected the kind of a patch");
    fails(std::string("5 1 1 \0 1", 9), "found '?'");
}
// What was cut off anywhere is either a smaller file or an error.
TEST(Bv, EveryPrefixIsReadOrRefused) {
    const std::string text = "Group 1 a\n" + kSquare + "8 1 1  0 0 0 1  0 1 0 1  1 0 0 1  1 1 0 1\n";
    for (std::size_t n = 0; n < text.size(); ++n) {
        try {
            EXPECT_LE(read_bv(text.substr(0, n), "p.bv").size(), 2u);
        } catch (const Error& e) {
            EXPECT_EQ(e.kind(), ErrorKind::input);
        }
    }
}
// The box of the teapot's control points, z up: handle to the left, spout to the right.
TEST(Bv, TheTeapotHas32Patches) {
    const std::string path = test::source_folder() + "/scenes/teapot.bv";
    const Composite c = read_bv(test::read_all(path), path);
    ASSERT_EQ(c.size(), 32u);
    Point low(9, 9, 9), high(-9, -9, -9);
    for (const Member& m : c)
        for (const double u : {0.0, 0.25, 0.5, 0.75, 1.0})
            for (const double v : {0.0, 0.25, 0.5, 0.75, 1.0}) {
                const Point p = m.patch.point(u, v);
                for (int i = 0; i < 3; ++i) low[i] = std::min(low[i], p[i]), high[i] = std::max(high[i], p[i]);
            }
    EXPECT_NEAR(low.x, -3, 0.03);
    EXPECT_NEAR(high.x, 3.43, 0.03);
    EXPECT_NEAR(low.y, -2, 0.01);
    EXPECT_NEAR(high.y, 2, 0.01);
    EXPECT_EQ(low.z, 0);
    EXPECT_NEAR(high.z, 3.15, 0.01);
}

}  // namespace
}  // namespace isoparm
