// isoparm verify from the command line: meshes of this and other programs, limits, exit codes.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "expect_program.h"

namespace isoparm::test {
namespace {

const char* const kOctahedron = "v 1 0 0\nv -1 0 0\nv 0 1 0\nv 0 -1 0\nv 0 0 1\nv 0 0 -1\nf 1 3 5\nf 3 2 5\nf 2 4 5\nf 4 1 5\nf 3 1 6\nf 2 3 6\nf 4 2 6\nf 1 4 6\n";

TEST(VerifyProgram, OwnMeshesInEveryFormatKeepTheirTolerance) {
    const TemporaryFolder t;
    for (const char* ending : {"ply", "obj", "stl"}) {
        const std::string mesh = t / (std::string("m.") + ending);
        ASSERT_EQ(run("tessellate " + scene("sphere") + " --quiet --tolerance 1e-2rel -o " + mesh + " --report " + t / "r.json").code, 0);
        const Json::Value report = parsed(read_all(t / "r.json"));
        const Outcome o = run("verify " + mesh + " --against " + scene("sphere") + " --tolerance 1e-2rel --watertight --manifold --json");
        ASSERT_EQ(o.code, 0) << o.out << o.err;
        EXPECT_EQ(o.err, "");
        const Json::Value v = parsed(o.out);
        EXPECT_EQ(v["triangles"].asInt(), report["triangles"].asInt());
        EXPECT_EQ(v["vertices"].asInt(), report["vertices"].asInt());
        EXPECT_EQ(v["welded"].asInt() > 0, std::string(ending) == "stl");
        EXPECT_LE(v["distance"]["lower"].asDouble(), report["certified_error"].asDouble());
        EXPECT_LE(v["distance"]["upper"].asDouble(), report["tolerance"].asDouble());
        EXPECT_GE(v["distance"]["lower"].asDouble(), 0.94 * v["distance"]["upper"].asDouble());
        EXPECT_EQ(v["topology"]["boundary_loops"].asInt(), 0);
        EXPECT_LT(v["sampled_normals"]["against"].asInt(), v["triangles"].asInt() / 20);  // thin triangles beside a pole may be folded
        ASSERT_EQ(v["limits"].size(), 3u);
        for (const auto& limit : v["limits"]) EXPECT_TRUE(limit["holds"].asBool()) << limit["what"];
    }
}
TEST(VerifyProgram, TolerancesInPixelsAreThoseOfTheScenesPicture) {
    const TemporaryFolder t;
    const auto tolerance = [&](const std::string& text) {
        write_all(t / "s.json", R"({"isoparm": 1, "surfaces": {"s": {"type": "bezier", "points": [[[0,0,0], [0,1,1]], [[1,0,0], [1,1,-1]]]}}, "objects": [{"surface": "s"}], )" + text + "}");
        const Outcome o = run("tessellate " + t / "s.json" + " --quiet -o " + t / "m.ply --report -");
        EXPECT_EQ(o.code, 0) << o.err;
        expect("verify " + t / "m.ply" + " --against " + t / "s.json" + " --tolerance 0.5px", 0, "holds");
        return parsed(o.out)["tolerance"].asDouble();
    };
    const std::string half = R"("tessellation": {"tolerance": {"pixels": 0.5}})";
    // 4 scene units high in 400 pixels, whatever the size of the surface and where it is in the picture.
    EXPECT_NEAR(tolerance(R"("camera": {"eye": [0,0,9], "target": [0,0,0], "up": [0,1,0], "orthographic": 4}, "image": {"width": 300, "height": 400}, )" + half), 0.005, 1e-12);
    // The nearest corner is 8 away from the eye, and away from the axis pixels are finer by the secant of the angle there.
    const double tan = std::tan(20 * 3.14159265358979 / 180), axis = 0.5 * 2 * 8 * tan / 400;
    EXPECT_NEAR(tolerance(R"("camera": {"eye": [0,0,9], "target": [0,0,0], "up": [0,1,0], "fov": 40}, "image": {"width": 400, "height": 400}, )" + half), axis / std::sqrt(1 + 2 * tan * tan), 1e-9);
}
TEST(VerifyProgram, TheBorderOfASurfaceIsNoHole) {
    const TemporaryFolder t;
    ASSERT_EQ(run("tessellate " + scene("coons") + " --quiet --tolerance 3e-3rel -o " + t / "m.obj").code, 0);
    expect("verify " + t / "m.obj" + " --against " + scene("coons") + " --watertight", 0, "Limit watertight: holds");
    std::string text = read_all(t / "m.obj");
    const std::size_t face = text.find("\nf ", text.size() / 4 * 3);  // one in the middle
    text.erase(face, text.find('\n', face + 1) - face);
    write_all(t / "hole.obj", text);
    expect("verify " + t / "hole.obj" + " --against " + scene("coons") + " --watertight", 2, "Limit watertight: EXCEEDED, 1 holes");
}
TEST(VerifyProgram, WhatIsWrongElsewhereHidesNoHole) {
    const TemporaryFolder t;
    ASSERT_EQ(run("tessellate " + scene("coons") + " --quiet --tolerance 3e-3rel -o " + t / "m.obj").code, 0);
    std::string text = read_all(t / "m.obj");
    const std::size_t face = text.find("\nf ", text.size() / 4 * 3);
    text.erase(face, text.find('\n', face + 1) - face);
    const std::string end = "f -1 -2 -3\n";
    for (const std::string stray : {"v 0 0 9\nv 0.01 0 9\nv 0 0.01 9\n", "v 900 0 0\nv 900 1 0\nv 900 0 1\n"}) {
        write_all(t / "stray.obj", text + stray + end);
        expect("verify " + t / "stray.obj" + " --against " + scene("coons") + " --watertight", 2, "Limit watertight: EXCEEDED, 2 holes");
    }
}
TEST(VerifyProgram, ChordsOfAFlatBorderAreNoHoles) {
    const TemporaryFolder t;
    write_all(t / "disc.json", R"json({"isoparm": 1, "curves": {"c": {"type": "formula", "xyz": ["cos(t)", "sin(t)", "0"], "domain": [0, "2*pi"]}},
        "surfaces": {"disc": {"type": "cone", "curve": "c", "apex": [0,0,0]}}})json");
    std::string mesh = "v 0 0 0\n";  // a hexagon: far from the circle, and in the plane of the disc
    for (int k = 0; k < 6; ++k) mesh += "v " + std::to_string(std::cos(k * 3.14159265358979 / 3)) + " " + std::to_string(std::sin(k * 3.14159265358979 / 3)) + " 0\n";
    for (int k = 0; k < 6; ++k) mesh += "f 1 " + std::to_string(2 + k) + " " + std::to_string(2 + (k + 1) % 6) + "\n";
    write_all(t / "hexagon.obj", mesh);
    expect("verify " + t / "hexagon.obj" + " --against " + t / "disc.json" + " --surface disc --watertight --junctions 1e-4", 0, "Limit watertight: holds");
}
TEST(VerifyProgram, LimitsAndExitCodes) {
    const TemporaryFolder t;
    expect("verify /dev/zero --against " + scene("sphere"), 64, "expected .ply, .obj, .stl or .glb");
    std::filesystem::create_symlink("/dev/zero", t / "zero.ply");
    expect("verify " + t / "zero.ply" + " --against " + scene("sphere"), 4, "found a device or pipe, expected a file");
    const std::string against = " --against " + scene("sphere");
    write_all(t / "o.obj", kOctahedron);  // 1 - 1/sqrt 3 = 0.42265 away
    expect("verify " + t / "o.obj" + against, 0, "Distance, proved");
    expect("verify " + t / "o.obj" + against + " --tolerance 0.4235", 0, "Limit tolerance 0.4235: holds");
    expect("verify " + t / "o.obj" + against + " --tolerance 0.4218", 2, "EXCEEDED, between 0.42");
    expect("verify " + t / "o.obj" + against + " --tolerance 0.42265 --max-triangles 2000", 2, "NOT DECIDED");
    expect("verify " + t / "o.obj" + against + " --tolerance 0.2rel", 0, "holds");  // of the diagonal, 2 sqrt 3
    expect("verify " + t / "o.obj" + against + " --gap 0.001 --max-triangles 500", 0, "note: the interval is proved, but wider than 0.001");
    expect("verify " + t / "o.obj" + against + " --surface octant", 0, "1 patch");
    expect("verify " + t / "o.obj" + against + " --set s=1 --json", 0, "\"distance\"");
    write_all(t / "open.obj", std::string(kOctahedron, std::string(kOctahedron).rfind('f')));
    expect("verify " + t / "open.obj" + against + " --watertight", 2, "1 holes");
    write_all(t / "flip.obj", std::string(kOctahedron, std::string(kOctahedron).rfind('f')) + "f 4 1 6\n");
    expect("verify " + t / "flip.obj" + against + " --manifold", 2, "3 inconsistent edges");
    expect("verify " + t / "flip.obj" + against + " --watertight", 0, "holds");
    write_all(t / "twins.obj", std::string(kOctahedron) + "v 1 0 0\n");
    expect("verify " + t / "twins.obj" + against, 0, "1 unused, 1 with the coordinates of another (--weld makes them one)");
    expect("verify " + t / "twins.obj" + against + " --weld", 0, "1 vertices with equal coordinates became one");
}
TEST(VerifyProgram, ErrorsSayWhatIsWrong) {
    const TemporaryFolder t;
    const std::string against = " --against " + scene("sphere");
    write_all(t / "o.obj", kOctahedron);
    write_all(t / "bad.obj", "v 0 0 0\nf 1 2 3\n");
    write_all(t / "short.ply", "ply\nformat binary_little_endian 1.0\nelement vertex 4000000\nproperty double x\nproperty double y\nproperty double z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n");
    expect("verify" + against, 64, "expected one mesh");
    expect("verify " + t / "o.obj", 64, "--against is missing");
    expect("verify " + t / "o.obj" + against + " --gap 0", 64, "--gap: found 0");
    expect("verify " + t / "o.obj" + against + " --tolerance 1px", 2, "EXCEEDED");
    expect("verify " + t / "o.obj" + against + " --surface x", 64, "expected one of");
    expect("verify " + t / "o.xyz.obj" + against, 4, "No such file");
    expect("verify " + source_folder() + "/README.md" + against, 64, "expected .ply, .obj, .stl or .glb");
    expect("verify " + t / "none.obj" + against, 4, "No such file");
    expect("verify " + t / "bad.obj" + against, 65, "bad.obj:2:5: found the vertex index 2, expected 1 to 1");
    expect("verify " + t / "short.ply" + against, 65, "0 bytes left");
    expect("verify " + t / "o.obj --against " + t / "none.json", 4, "No such file");
    expect("verify " + t / "o.obj --against " + t / "bad.obj", 65, "bad.obj:1:1");
}
TEST(VerifyProgram, TheAnswerDoesNotDependOnThreads) {
    const TemporaryFolder t;
    ASSERT_EQ(run("tessellate " + scene("coons") + " --quiet --tolerance 3e-3rel -o " + t / "m.ply").code, 0);
    const std::string verify = "verify " + t / "m.ply" + " --against " + scene("coons") + " --json --gap 0.1 --threads ";
    const std::string one = run(verify + "1").out;
    EXPECT_EQ(run(verify + "2").out, one);
    EXPECT_EQ(run(verify + "5").out, one);
}

}  // namespace
}  // namespace isoparm::test
