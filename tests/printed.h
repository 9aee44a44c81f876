// printed.h -- a scene rendered for print in a folder of its own. Header only, test code.
#pragma once
#include "drawing_tests.h"
#include "expect_program.h"

namespace isoparm::test {

inline constexpr const char* kBall = R"({ "isoparm": 1, "title": "A & <B>", "surfaces": { "s": { "type": "bilinear", "points": [[[-1,-1,0],[-1,1,0]],[[1,-1,0],[1,1,0]]] } },
  "objects": [ { "surface": "s", "color": "white", "opacity": 0.2, "isolines": { "u": 3, "v": 3, "width": "0.5pt" }, "outline": { "width": "1pt", "color": "#ff0000" } },
               { "point": [0.4, -0.3, 0.7], "radius": 0.05, "color": "black", "label": { "text": "P_{00}", "side": "right", "size": "9pt" } } ],
  "camera": { "eye": [3,-4,2.5], "target": [0,0,0] }, "image": { "width": 240, "height": 180, "samples": 4 } })";

/// Renders into the folder of the scene.
struct Printed {
    TemporaryFolder folder;
    explicit Printed(const std::string& scene = kBall) { write_all(folder / "scene.json", scene); }
    std::string file(const std::string& name, const std::string& options = "") const {
        const Outcome r = test::run("render scene.json --threads 1 --quiet -o " + name + " " + options, folder.path());
        EXPECT_EQ(r.code, 0) << r.err;
        return read_all(folder / name);
    }
    Outcome refused(const std::string& arguments) const { return test::run("render scene.json " + arguments, folder.path()); }
};

}  // namespace isoparm::test
