// Degenerate geometry at every entry: points that coincide, curves without length, patches without area, edges that are points, scales from
// 1e-300 to 1e150. Each command gives an answer without NaN, or refuses with the place and the reason; nothing but an exit code of the list.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "expect_program.h"
#include "io/mesh_reader.h"

namespace isoparm {
namespace {

namespace fs = std::filesystem;
using test::Outcome, test::parsed, test::read_all, test::run, test::write_all;

struct Case {
    const char* name;
    std::string curves, surface;
    bool sized;  // between 1e-70 and 1e70: tessellates
};

std::string at(double s, const char* points) {  // "1 0 0; 0 1 0", times s
    std::istringstream in(points);
    std::ostringstream out;
    out.precision(17);
    out << "[[";
    for (std::string word; in >> word;) {
        const bool last = word.back() == ';';
        out << std::stod(word) * s << (last ? "], [" : in.peek() == EOF ? "]]" : ", ");
    }
    return out.str();
}
std::string line(double s, const char* points) { return R"({"type": "line", "points": )" + at(s, points) + "}"; }
std::string coons(double s, const char* c0, const char* c1, const char* d0, const char* d1) {
    return R"("c0": )" + line(s, c0) + R"(, "c1": )" + line(s, c1) + R"(, "d0": )" + line(s, d0) + R"(, "d1": )" + line(s, d1);
}
constexpr const char* kCoons = R"({"type": "coons", "c0": "c0", "c1": "c1", "d0": "d0", "d1": "d1"})";
std::string square(double s) { return coons(s, "0 0 0; 1 0 0", "0 1 0; 1 1 1", "0 0 0; 0 1 0", "1 0 0; 1 1 1"); }
std::string flat(const char* points) { return R"({"type": "triangle", "points": )" + at(1, points) + "}"; }

std::vector<Case> cases() {
    return {{"huge", square(1e150), kCoons, false},
            {"large", square(1e40), kCoons, true},
            {"small", square(1e-60), kCoons, true},
            {"tiny", square(1e-300), kCoons, false},
            {"subnormal", square(1e-310), kCoons, false},
            {"point", coons(0, "0 0 0; 1 0 0", "0 1 0; 1 1 1", "0 0 0; 0 1 0", "1 0 0; 1 1 1"), kCoons, false},
            {"collapsed_edge", coons(1, "0 0 0; 0 0 0", "0 1 0; 1 1 0", "0 0 0; 0 1 0", "0 0 0; 1 1 0"), kCoons, true},
            {"two_collapsed_edges", coons(1, "0 0 0; 0 0 0", "1 1 0; 1 1 0", "0 0 0; 1 1 0", "0 0 0; 1 1 0"), kCoons, true},
            {"no_area", coons(1, "0 0 0; 1 0 0", "0 0 0; 1 0 0", "0 0 0; 0 0 0", "1 0 0; 1 0 0"), kCoons, true},
            {"folded", coons(1, "0 0 0; 1 0 0", "1 1 0; 0 1 0", "0 0 0; 1 1 0", "1 0 0; 0 1 0"), kCoons, true},
            {"triangle_of_a_point", "", flat("2 0 0; 2 0 0; 2 0 0"), false},
            {"triangle_of_a_line", "", flat("0 0 0; 1 0 0; 2 0 0"), true},
            {"cone_at_its_apex", R"("c": )" + line(1, "0 0 0; 1 0 0"), R"({"type": "cone", "curve": "c", "apex": [0, 0, 0]})", true},
            {"ruled_by_points", R"("a": )" + line(1, "0 0 0; 0 0 0") + R"(, "b": )" + line(1, "0 0 0; 0 0 0"), R"({"type": "ruled", "c0": "a", "c1": "b"})", false},
            {"tangents_of_zero", R"("a": {"type": "hermite", "points": [[0,0,0],[0,0,0]], "tangents": [[0,0,0],[0,0,0]]}, "b": )" + line(1, "0 0 0; 1 0 0"), R"({"type": "ruled", "c0": "a", "c1": "b"})", true},
            {"weights_apart", "", R"({"type": "bezier", "points": [[[0,0,0],[0,1,0]],[[1,0,0],[1,1,0]]], "weights": [[1e-3,1],[1,1e3]]})", true}};
}

bool finite(const std::string& path) {
    for (const Point& p : read_mesh(read_all(path), path).mesh.points)
        for (const double x : {p.x, p.y, p.z})
            if (!std::isfinite(x)) return false;
    return true;
}
/// Words of C for what is not finite; "null" is what there is instead.
bool has_nan(const std::string& text) {
    for (const char* word : {"nan", "NaN", "inf,", "inf]", "inf}", "-inf", "Infinity"})
        if (text.find(word) != std::string::npos) return true;
    return false;
}

class Degenerate : public testing::TestWithParam<Case> {};
TEST_P(Degenerate, IsAnsweredOrRefusedWithItsPlace) {
    const Case& c = GetParam();
    const test::TemporaryFolder t;
    write_all(t / "s.json", R"({"isoparm": 1, "curves": {)" + c.curves + R"(}, "surfaces": {"s": )" + c.surface + R"(}, "objects": [{"surface": "s"}], "tessellation": {"tolerance": {"relative": 0.01}}})");
    const auto answered = [&](const std::string& arguments, bool may) {
        const Outcome o = run(arguments, t.path());
        EXPECT_FALSE(has_nan(o.out)) << arguments << "\n" << o.out;
        if (may) {
            EXPECT_TRUE(o.code == 0 || o.code == 1) << arguments << ": " << o.code << "\n" << o.err << o.out;
        } else {
            EXPECT_EQ(o.code, 65) << arguments << "\n" << o.out;
            EXPECT_NE(o.err.find("s.json"), std::string::npos) << o.err;
            EXPECT_NE(o.err.find("size"), std::string::npos) << o.err;
        }
    };
    answered("info s.json", true);
    answered("eval s.json --surface s --at 0.5,0.25 --at 0,0 --json", true);
    answered("eval s.json --surface s --at 0.5,0.25 --at 0,0", true);
    answered("check s.json --json", c.sized);
    for (const char* name : {"m.ply", "m.obj"}) {
        answered("tessellate s.json --quiet --report - -o " + std::string(name), c.sized);
        EXPECT_EQ(fs::exists(t / name), c.sized);
        EXPECT_TRUE(!c.sized || finite(t / name)) << name;
    }
}
INSTANTIATE_TEST_SUITE_P(Geometry, Degenerate, testing::ValuesIn(cases()), [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace isoparm
