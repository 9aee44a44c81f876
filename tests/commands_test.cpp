// The real program from its command line: results, exit codes, files.
#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <sstream>

#include "expect_program.h"

namespace isoparm::test {
namespace {

TEST(Commands, HelpAndVersion) {
    expect("--help", 0, "tessellate");
    expect("help eval", 0, "usage: isoparm eval");
    expect("--version", 0, "isoparm ");
    expect("", 64, "usage: isoparm COMMAND");
    for (const char* c : {"info", "eval", "tessellate", "verify", "check", "render", "figures", "limit"}) expect(std::string(c) + " --help", 0, "usage: isoparm " + std::string(c));
}
TEST(Commands, UsageErrorsSuggest) {
    expect("rendr x", 64, "did you mean \"render\"?");
    expect("info " + scene("coons") + " --jsn", 64, "did you mean \"--json\"?");
    expect("info", 64, "expected one scene");
    expect("info a b", 64, "expected one scene");
    expect("info " + scene("coons") + " --set", 64, "needs a value");
    expect("info " + scene("coons") + " --set x", 64, "expected PARAMETER=NUMBER");
    expect("info " + scene("coons") + " --set x=1", 64, "has no such parameter");
    expect("info --threads 0 " + scene("coons"), 64, "expected a whole number from 1");
    expect("info --json=yes " + scene("coons"), 64, "takes no value");
    expect("eval " + scene("coons"), 64, "--at is missing");
    expect("eval " + scene("coons") + " --at 1", 64, "expected u,v");
    expect("eval " + scene("coons") + " --surface T --at 0,0", 64, "expected one of: S");
    expect("eval " + scene("teapot") + " --at 0,0", 64, "which has 32 patches");
    expect("eval " + scene("coons") + " --at 0,2", 65, "expected a point of the domain of S: 0 <= u <= 1");
    expect("eval " + scene("side_vertex") + " --at 0.6,0.6", 65, "u + v <= 1");
    expect("tessellate " + scene("coons"), 64, "-o is missing");
    expect("tessellate " + scene("coons") + " -o x.ply --quality best", 64, "expected one of: fast, optimal");
    expect("tessellate " + scene("coons") + " -o x.ply --vertices free --normals 5", 64, "--vertices surface");
    expect("tessellate " + scene("coons") + " -o x.ply --tolerance 0", 64, "expected a positive number");
    expect("tessellate " + scene("coons") + " -o x.ply --measure angular", 64, "expected one of: geometric, parametric");
    expect("render " + scene("coons") + " -o x.png --size 10", 64, "expected WIDTHxHEIGHT");
    expect("figures nothing -o /tmp", 64, "expected one of: cone");
}
TEST(Commands, OptimalMeshesHaveFewerTrianglesAndSaySo) {
    const TemporaryFolder folder;
    const auto report = [&](const std::string& quality) {
        const Outcome o = run("tessellate " + scene("coons") + " --tolerance 1e-2rel --quiet --report - -o '" + folder / "mesh.ply" + "' " + quality);
        EXPECT_EQ(o.code, 0) << o.err;
        return parsed(o.out);
    };
    const Json::Value fast = report(""), optimal = report("--quality optimal");
    EXPECT_EQ(fast["quality"].asString(), "fast");
    EXPECT_EQ(optimal["quality"].asString(), "optimal");
    EXPECT_LT(optimal["triangles"].asInt(), fast["triangles"].asInt());
    EXPECT_LE(optimal["certified_error"].asDouble(), optimal["tolerance"].asDouble());
}
TEST(Commands, InfoTellsWhatIsThere) {
    expect("info " + scene("sphere"), 0, "octant: bezier, degree 2 x 2, rational");
    const Json::Value v = parsed(run("info --json --set=a=2 " + scene("s004_gregory")).out);
    EXPECT_EQ(v["parameters"]["a"].asDouble(), 2);
    EXPECT_EQ(v["curves"].size(), 8u);
    EXPECT_EQ(v["surfaces"][0]["type"].asString(), "coons_hermite");
}
TEST(Commands, EvalAnswersInJson) {
    const Outcome o = run("eval " + scene("sphere") + " --surface octant --at 0.3,0.7 --at 0,0.5 --json");
    ASSERT_EQ(o.code, 0) << o.err;
    const Json::Value v = parsed(o.out);
    EXPECT_EQ(v["surface"].asString(), "octant");
    ASSERT_EQ(v["points"].size(), 2u);
    const Json::Value &p = v["points"][0], &pole = v["points"][1];
    EXPECT_EQ(p["at"][1].asDouble(), 0.7);
    double norm = 0;
    for (int i = 0; i < 3; ++i) norm += p["S"][i].asDouble() * p["S"][i].asDouble();
    EXPECT_NEAR(norm, 1, 1e-15);
    EXPECT_NEAR(p["gaussian"].asDouble(), 1, 1e-13);
    for (const char* key : {"Su", "Sv", "Suu", "Suv", "Svv", "n"}) EXPECT_EQ(p[key].size(), 3u) << key;
    EXPECT_NEAR(pole["n"][2].asDouble(), 1, 1e-15);
    EXPECT_TRUE(pole["gaussian"].isNull());
    EXPECT_TRUE(parsed(run("eval " + scene("s004_gregory") + " --surface square --at 0,0 --json").out)["points"][0]["Suv"].isNull());
    expect("eval " + scene("sphere") + " --surface sphere/south/octant --at 0,0", 0, "S         0 0 -1");
    expect("eval --at -0.5,0 -- " + scene("coons"), 65, "found -0.5,0");
}
TEST(Commands, TessellateWritesMeshAndReport) {
    const TemporaryFolder t;
    for (const char* name : {"sphere", "coons"}) {
        const Outcome o = run("tessellate " + scene(name) + " -o " + t / "m.ply" + " --tolerance 1e-3rel --report " + t / "r.json");
        ASSERT_EQ(o.code, 0) << o.err;
        EXPECT_EQ(o.out, "");
        EXPECT_NE(o.err.find("certified error"), std::string::npos);
        const Json::Value r = parsed(read_all(t / "r.json"));
        EXPECT_LE(r["certified_error"].asDouble(), r["tolerance"].asDouble());
        EXPECT_LE(r["sampled_error"].asDouble(), r["certified_error"].asDouble());
        EXPECT_EQ(r["t_junctions"].asInt(), 0);
        EXPECT_EQ(r["non_manifold_edges"].asInt(), 0);
        EXPECT_EQ(r["boundary_loops"].asInt(), std::string(name) == "sphere" ? 0 : 1);
        EXPECT_EQ(r["measure"].asString(), "geometric");
        ASSERT_EQ(r["surfaces"].size(), 1u);
        EXPECT_EQ(r["surfaces"][0]["triangles"].asUInt64(), r["triangles"].asUInt64());
        EXPECT_GT(r["surfaces"][0]["optimal_triangles"].asDouble(), 0);
        const std::string mesh = read_all(t / "m.ply");
        EXPECT_NE(mesh.find("element vertex " + std::to_string(r["vertices"].asUInt64()) + "\n"), std::string::npos);
    }
    EXPECT_EQ(t.files(), 2u);
}
TEST(Commands, TheMeshDoesNotDependOnThreads) {
    const TemporaryFolder t;
    ASSERT_EQ(run("tessellate " + scene("teapot") + " --quiet --tolerance 1e-3rel --threads 1 -o " + t / "one.ply").code, 0);
    const Outcome o = run("tessellate " + scene("teapot") + " --quiet --tolerance 1e-3rel --threads 7 -o " + t / "seven.ply");
    ASSERT_EQ(o.code, 0);
    EXPECT_EQ(o.err, "");
    EXPECT_TRUE(read_all(t / "one.ply") == read_all(t / "seven.ply"));
}
TEST(Commands, ABudgetEndsWithWhatWasReached) {
    const TemporaryFolder t;
    write_all(t / "m.ply", "old");
    const Outcome o = run("tessellate " + scene("sphere") + " -o " + t / "m.ply" + " --tolerance 1e-6 --max-triangles 1000");
    EXPECT_EQ(o.code, 2) << o.err;
    EXPECT_NE(o.err.find("triangles"), std::string::npos) << o.err;
    EXPECT_EQ(read_all(t / "m.ply"), "old");
}
TEST(Commands, OutputThatCannotBeWrittenIsAnInputOutputError) {
    const TemporaryFolder t;
    expect("tessellate " + scene("coons") + " --tolerance 1e-2 -o " + t / "no/folder/m.ply", 4, "No such file or directory");
    std::filesystem::create_directory(t / "d.ply");
    expect("tessellate " + scene("coons") + " --tolerance 1e-2 -o " + t / "d.ply", 4, "Is a directory");
    if (std::filesystem::exists("/dev/full")) {
        const int status = std::system(("'" + program() + "' info " + scene("coons") + " >/dev/full 2>'" + t / "err" + "'").c_str());
        EXPECT_EQ(WEXITSTATUS(status), 4);
        EXPECT_NE(read_all(t / "err").find("standard output: writing failed"), std::string::npos);
    }
}
TEST(Commands, AnOutputNeverReplacesTheSceneOrAnotherOutput) {
    const TemporaryFolder t;
    const std::string text = read_all(source_folder() + "/scenes/coons.json");
    write_all(t / "self.ply", text);
    std::filesystem::create_symlink("self.ply", t / "link.png");
    std::filesystem::create_hard_link(t / "self.ply", t / "hard.ply");
    const auto refused = [&](const std::string& arguments) {
        const Outcome o = run(arguments, t.path());
        EXPECT_EQ(o.code, 64) << arguments << o.err;
        EXPECT_NE(o.err.find(", expected another one"), std::string::npos) << o.err;
    };
    refused("tessellate self.ply -o self.ply");
    refused("tessellate self.ply -o ./hard.ply");
    refused("tessellate self.ply -o b.ply --report b.ply");
    refused("tessellate self.ply -o b.ply --report '" + t / "../" + std::filesystem::path(t.path()).filename().string() + "/b.ply'");
    refused("tessellate self.ply -o b.ply --report self.ply");
    refused("render self.ply -o link.png");
    EXPECT_EQ(t.files(), 3u);
    EXPECT_EQ(read_all(t / "self.ply"), text);
}
/// -o DIR, files that the scene includes, images of the folders compared.
TEST(Commands, AnOutputNeverReplacesWhatIsReadBesides) {
    namespace fs = std::filesystem;
    const TemporaryFolder t;
    const std::string cage = read_all(source_folder() + "/tests/data/cages/cube.obj");
    const std::string included = R"({"isoparm": 1, "surfaces": {"S": {"type": "subdivision", "cage": "v12.obj"}}})";
    for (const char* name : {"limit.json", "v12.obj", "v12.png", "limit.png"}) write_all(t / name, cage);
    write_all(t / "s.json", included);
    for (const char* folder : {"spline", "net", "ref", "new"}) fs::create_directory(t / folder);
    for (const char* name : {"spline/limit.json", "net/cage-0.obj"}) fs::copy_file(source_folder() + "/scenes/coons.json", t / name);
    for (const char* name : {"ref/b.png", "ref/c.gif", "new/a.png", "new/b.png"}) write_all(t / name, "image");
    const auto refused = [&](const std::string& arguments, const std::string& file) {
        const std::string before = read_all(t / file);
        const Outcome o = run(arguments, t.path());
        EXPECT_EQ(o.code, 64) << arguments << o.err;
        EXPECT_NE(o.err.find(", expected another one"), std::string::npos) << arguments << o.err;
        EXPECT_EQ(read_all(t / file), before) << arguments;
    };
    refused("limit limit.json -o .", "limit.json");
    refused("limit limit.png -o .", "limit.png");
    refused("limit --scene spline/limit.json --surface S -o spline", "spline/limit.json");
    refused("limit --scene net/cage-0.obj --surface S -o net", "net/cage-0.obj");
    refused("tessellate s.json --tolerance 0.1 -o v12.obj", "v12.obj");
    refused("tessellate s.json --tolerance 0.1 -o v12.ply --report v12.obj", "v12.obj");
    write_all(t / "s.json", included.substr(0, included.find(".obj")) + ".png" + included.substr(included.find(".obj") + 4));
    refused("render s.json --size 8x8 -o v12.png", "v12.png");
    for (const std::string image : {"ref/b.png", "new/a.png", "new/b.png", "ref/c.gif", "ref/a.png"})
        for (const char* report : {"--html ", "--junit "}) refused("diff ref new " + (report + image), image);
    EXPECT_FALSE(fs::exists(t / "ref/a.png"));
}
TEST(Commands, FoldersAreCheckedBeforeTheWork) {
    const TemporaryFolder t;
    const std::string hopeless = "tessellate " + scene("coons") + " --tolerance 1e-9 --max-triangles 10";
    expect(hopeless + " -o " + t / "no/m.ply", 4, "No such file or directory");
    expect(hopeless + " -o " + t / "m.ply --report " + t / "no/r.json", 4, "No such file or directory");
    expect("render " + scene("coons") + " -o " + t / "no/p.png", 4, "there is no folder");
    EXPECT_EQ(t.files(), 0u);
}
TEST(Commands, TheReportGoesToStandardOutput) {
    const TemporaryFolder t;
    const Outcome o = run("tessellate " + scene("coons") + " --tolerance 1e-2 --report - -o " + t / "m.ply");
    ASSERT_EQ(o.code, 0) << o.err;
    EXPECT_GT(parsed(o.out)["triangles"].asInt(), 0);
    EXPECT_EQ(t.files(), 1u);
}
TEST(Commands, RoundingToFloatIsPartOfTheCertifiedErrorOfStl) {
    const TemporaryFolder t;
    const auto report = [&](const std::string& name) { return parsed(run("tessellate " + scene("sphere") + " --tolerance 1e-3 --report - -o " + t / name).out); };
    const Json::Value ply = report("m.ply"), stl = report("m.stl");
    EXPECT_EQ(ply["format_rounding"].asDouble(), 0);
    EXPECT_GT(stl["format_rounding"].asDouble(), 1e-8);
    EXPECT_TRUE(ply["normal_deviation"].isNumeric());
    EXPECT_TRUE(stl["normal_deviation"].isNull()) << "the triangles in the file are not those whose normals were bounded";
    EXPECT_LT(stl["format_rounding"].asDouble(), 0x1p-24 * 1.8);
    EXPECT_LE(stl["certified_error"].asDouble(), 1e-3);
    EXPECT_EQ(stl["tolerance"].asDouble(), 1e-3);
    expect("tessellate " + scene("sphere") + " --tolerance 1e-7 -o " + t / "fine.stl", 2, "write .ply or .obj");
    EXPECT_EQ(t.files(), 2u);
}
TEST(Commands, ScenesThatCannotBeMeshedAreRefusedWithTheirPlace) {
    const TemporaryFolder t;
    const auto refused = [&](const std::string& text, const std::string& message, const std::string& command = "tessellate s.json -o m.ply") {
        write_all(t / "s.json", text);
        const Outcome o = run(command, t.path());
        EXPECT_EQ(o.code, 65) << o.err;
        EXPECT_EQ(o.err.rfind("isoparm: s.json:" + message, 0), 0u) << o.err;
    };
    const auto square = [](const std::string& x) { return "{\"isoparm\":1,\n\"surfaces\":{\"S\":{\"type\":\"bilinear\",\"points\":[[0,0,0],[" + x + ",0,0],[0," + x + ",0],[" + x + "," + x + ",0]]}}"; };
    refused("{\"isoparm\":1, \"objects\":[]}", "1:25: at $.objects: found no surface that is drawn, expected one");
    refused("{\"isoparm\":1}", "1:1: at $: found no surface that is drawn, expected one");
    refused(square("0") + "}", "1:1: at $: found surfaces of size 0, expected");
    for (const std::string command : {"tessellate s.json -o m.ply", "render s.json -o p.png"})
        refused(square("1e300") + ",\n\"objects\":[{\"surface\":\"S\"}]}", "3:11: at $.objects: found surfaces of size inf, from (0, 0, 0) to (1e+300, 1e+300, 0), expected", command);
}
TEST(Commands, FramesAreThePicturesOfTheirParameters) {
    const TemporaryFolder t;
    write_all(t / "s.json", R"({ "isoparm": 1, "parameters": { "h": { "value": 0, "min": -1, "max": 1 }, "k": 0 },
        "objects": [{ "point": ["h", "k", 0], "radius": 0.2 }], "camera": { "eye": [0,-5,0], "target": [0,0,0] }, "image": { "width": 24, "height": 16, "samples": 4 } })");
    const Outcome o = run("render s.json -o f%03d.png --frames 3 --animate h --animate k=0.5:0", t.path());
    ASSERT_EQ(o.code, 0) << o.err;
    EXPECT_EQ(t.files(), 4u);
    const std::vector<std::string> sets{"-1,0.5", "0,0.25", "1,0"};
    for (int k = 0; k < 3; ++k) {
        const std::string at = sets[k], comma = at.substr(0, at.find(','));
        ASSERT_EQ(run("render s.json -o one.png --set h=" + comma + " --set k=" + at.substr(comma.size() + 1), t.path()).code, 0);
        EXPECT_EQ(read_all(t / "one.png"), read_all(t / ("f00" + std::to_string(k) + ".png"))) << k;
    }
    const auto refused = [&](const std::string& arguments, const std::string& message) {
        const Outcome bad = run("render s.json " + arguments, t.path());
        EXPECT_EQ(bad.code, 64) << bad.err;
        EXPECT_NE(bad.err.find(message), std::string::npos) << bad.err;
    };
    refused("-o f.png --frames 3 --animate h", "expected a name with one %d");
    refused("-o f%s.png --frames 3 --animate h", "expected a name with one %d");
    refused("-o f%d%d.png --frames 3 --animate h", "expected a name with one %d");
    refused("-o f%d.png --frames 1 --animate h", "whole number from 2");
    refused("-o f%d.png --frames 3", "--animate is missing");
    refused("-o f%d.png --animate h", "--frames is missing");
    refused("-o f%d.png --frames 3 --animate k", "no min and max");
    refused("-o f%d.png --frames 3 --animate x=0:1", "no such parameter");
    refused("-o f%d.png --frames 3 --animate h=0", "expected PARAMETER or PARAMETER=FROM:TO");
    refused("-o f%d.png --frames 3 --animate h=0:2", "expected values from -1 to 1");
    refused("-o f%d.png --frames 3 --animate h --animate h", "given twice");
}
// What other programs read: the chunk oFFs of PNG, data and display window of OpenEXR.
TEST(Commands, CropsSayWhereTheyLie) {
    const TemporaryFolder t;
    for (const std::string kind : {"png", "exr"}) {
        const std::string whole = t / ("whole." + kind), part = t / ("part." + kind), again = t / ("again." + kind);
        for (const auto& [file, crop] : {std::pair(whole, ""), {part, " --crop 10,20,43,41"}, {again, " --crop 0,0,60,45"}})
            ASSERT_EQ(run("render " + scene("coons") + " --size 60x45 --samples 1 --tolerance 0.1 -o '" + file + "'" + crop).code, 0);
        const std::string bytes = read_all(part), other = read_all(whole);
        EXPECT_NE(bytes.find("10,20,43,41"), std::string::npos);
        EXPECT_NE(bytes.find("60x45"), std::string::npos);
        if (kind == "png") {
            EXPECT_NE(bytes.find(std::string("\0\0\0\x09oFFs\0\0\0\x0a\0\0\0\x14\0", 17)), std::string::npos);
            EXPECT_EQ(other.find("oFFs"), std::string::npos);
            EXPECT_EQ(read_all(again).find("oFFs"), std::string::npos) << "at the corner there is nothing to say";
        } else {
            const auto box = [](const std::string& file, const std::string& name) {  // least x, y, largest x, y
                std::array<int, 4> b{};
                const auto at = file.find(name + std::string("\0box2i\0\x10\0\0\0", 11));
                if (at != std::string::npos) std::memcpy(b.data(), file.data() + at + name.size() + 11, sizeof b);
                return b;
            };
            EXPECT_EQ(box(bytes, "dataWindow"), (std::array{10, 20, 42, 40}));
            EXPECT_EQ(box(bytes, "displayWindow"), (std::array{0, 0, 59, 44}));
            EXPECT_EQ(box(other, "dataWindow"), (std::array{0, 0, 59, 44}));
        }
        EXPECT_EQ(run("diff '" + part + "' '" + part + "'").code, 0) << "and they are read";
        EXPECT_EQ(run("diff '" + whole + "' '" + part + "'").code, 3);
    }
    ASSERT_EQ(run("render " + scene("coons") + " --size 60x45 --samples 1 --tolerance 0.1 --aov Z -o '" + (t / "z.exr") + "' --crop 10,20,43,41").code, 0) << "with further channels too";
    EXPECT_NE(read_all(t / "z.exr").find(std::string("dataWindow\0box2i\0\x10\0\0\0\x0a\0\0\0\x14\0\0\0", 29)), std::string::npos);
}
TEST(Commands, ScenesWithNothingToDrawAreToldOf) {
    const TemporaryFolder t;
    write_all(t / "empty.json", "{ \"isoparm\": 1 }");
    write_all(t / "point.json", R"({ "isoparm": 1, "objects": [ { "point": [0,0,0] } ] })");
    const Outcome empty = run("render empty.json --size 8x8 -o e.png", t.path()), point = run("render point.json --size 60x45 --samples 1 -o p.png", t.path());
    EXPECT_EQ(empty.code, 0);
    EXPECT_NE(empty.err.find("note: e.png: there is nothing to draw in \"empty.json\""), std::string::npos) << empty.err;
    EXPECT_EQ(point.err.find("note"), std::string::npos) << point.err;
    for (const char* background : {"white", "transparent"})
        for (const char* output : {"a.png", "a.pdf"}) {
            write_all(t / "away.json", R"({ "isoparm": 1, "objects": [ { "point": [0,0,0], "label": "P" } ], "camera": { "eye": [0,0,5], "target": [0,0,9], "up": [0,1,0] }, "image": { "background": ")" + std::string(background) + R"(" } })");
            const Outcome away = run("render away.json --size 8x8 --samples 1 -o " + std::string(output), t.path());
            EXPECT_EQ(away.code, 0);
            EXPECT_NE(away.err.find("shows the background and nothing else"), std::string::npos) << away.err;
        }
    EXPECT_EQ(run("render away.json --size 8x8 --samples 1 --crop 0,0,4,4 -o a.png", t.path()).err.find("note"), std::string::npos) << "a part may be empty";
    EXPECT_EQ(run("render away.json --size 8x8 --samples 1 --quiet -o a.png", t.path()).err, "");
}
TEST(Commands, ScenesTooSmallForSinglePrecisionAreRefused) {
    const TemporaryFolder t;
    const auto render = [&](const std::string& z, const std::string& more) {
        write_all(t / "s.json", R"({"isoparm": 1, "surfaces": {"s": {"type": "bilinear", "points": [[0,0,0],[)" + z + ",0,0],[0," + z + ",0],[" + z + "," + z + R"(,0]]}}, "objects": [{"surface": "s", "boundary": false}]})");
        return run("render s.json --size 16x12 --samples 1 -o s.png" + more, t.path());
    };
    EXPECT_EQ(render("1e-8", "").code, 0);
    EXPECT_EQ(render("1e-12", " --exact").code, 0);
    const Outcome small = render("1e-12", "");
    EXPECT_EQ(small.code, 65);
    EXPECT_NE(small.err.find("s.json: found a scene 1.414"), std::string::npos) << small.err;
    EXPECT_NE(small.err.find("choose a smaller unit of length, or --exact"), std::string::npos) << small.err;
}
TEST(Commands, WithoutFontsLabelsAreAnErrorAndPicturesAreNot) {
    const TemporaryFolder t;
    write_all(t / "fonts.conf", "<?xml version=\"1.0\"?><fontconfig></fontconfig>");
    ::setenv("FONTCONFIG_FILE", (t / "fonts.conf").c_str(), 1);
    const auto render = [&](const std::string& label) {
        write_all(t / "s.json", "{ \"isoparm\": 1, \"objects\": [{ \"point\": [0,0,0], \"label\": \"" + label + "\" }], \"image\": { \"width\": 16, \"height\": 16, \"samples\": 1 } }");
        return run("render s.json -o p.png", t.path());
    };
    const Outcome with = render("P_0"), without = render("");
    ::unsetenv("FONTCONFIG_FILE");
    EXPECT_EQ(without.code, 0) << without.err;
    EXPECT_EQ(with.code, 4) << with.err;
    EXPECT_NE(with.err.find("no font was found"), std::string::npos) << with.err;
}
TEST(Commands, LimitNamesTheCageThatItRefuses) {
    const TemporaryFolder t;
    write_all(t / "q.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n");
    expect("limit --scheme loop " + t / "q.obj", 65, "q.obj: face 0 (line 5): found 4 vertices, expected 3");
}
TEST(Commands, FiguresRendersEverySceneAndAContactSheet) {
    const TemporaryFolder t;
    write_all(t / "good.json", read_all(source_folder() + "/scenes/coons.json"));
    write_all(t / "bad.json", "{");
    ::setenv("ISOPARM_SCENES", t.path().c_str(), 1);
    const Outcome both = run("figures -o " + t / "both" + " --size 32x24 --samples 1 --tolerance 1e-2rel");
    const Outcome one = run("figures good -o " + t / "one" + " --size 32x24 --samples 1 --tolerance 1e-2rel");
    ::unsetenv("ISOPARM_SCENES");
    EXPECT_EQ(both.code, 65) << "the code of the one that failed";
    EXPECT_NE(both.err.find("bad.json:1:"), std::string::npos) << both.err;
    EXPECT_EQ(one.code, 0) << one.err;
    for (const char* f : {"both/good.png", "both/contact_sheet.png", "one/good.png", "one/contact_sheet.png"}) EXPECT_GT(read_all(t / f).size(), 60u) << f;
    EXPECT_FALSE(std::filesystem::exists(t / "both/bad.png"));
}

}  // namespace
}  // namespace isoparm::test
