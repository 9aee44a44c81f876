// film_program_test.cpp -- films and their frames as the program makes them: cameras that go round, what is kept of runs that were killed, ffmpeg.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "image/image.h"
#include "run_program.h"

namespace isoparm::test {
namespace {

/// Two balls, one red beside the z axis and one blue on it, farther up; `camera` and `image` complete it.
std::string scene_text(const std::string& camera, const std::string& image = R"("width": 40, "height": 30, "samples": 4, "background": "white")") {
    return R"({ "isoparm": 1, "objects": [{ "point": [1, 0, 0], "radius": 0.3, "color": [1, 0, 0] }, { "point": [0, 0, 0.7], "radius": 0.2, "color": [0, 0, 1] }],
        "camera": )" + camera + R"(, "image": {)" + image + "}}";
}
constexpr const char* kFixed = R"({ "eye": [0, -5, 0], "target": [0, 0, 0], "fov": 40 })";

/// The largest difference of two pictures of one size.
float difference(const std::string& a, const std::string& b) {
    const Image x = read_image(a), y = read_image(b);
    EXPECT_EQ(x.pixels.size(), y.pixels.size());
    float most = 0;
    for (std::size_t i = 0; i < std::min(x.pixels.size(), y.pixels.size()); ++i) most = std::max(most, std::fabs(x.pixels[i] - y.pixels[i]));
    return most;
}
/// Runs the program in a folder, sends it a signal as soon as a file is there, and waits for its end. What it says is in "said".
int signalled(const std::string& folder, const std::string& arguments, const std::string& signal, const std::string& file) {
    const std::string script = "cd '" + folder + "'; '" + program() + "' " + arguments + " >said 2>&1 </dev/null & p=$!; n=0; while [ ! -e " + file +
                               " ] && kill -0 $p && [ $n -lt 6000 ]; do sleep 0.01; n=$((n+1)); done 2>/dev/null; kill -" + signal + " $p 2>/dev/null; wait $p 2>/dev/null";
    const int status = std::system(script.c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}
bool has_ffmpeg() { return std::system("ffmpeg -version >/dev/null 2>&1") == 0; }

TEST(FilmProgram, TheTurntableTakesTheEyeRoundItsTarget) {
    const TemporaryFolder t;
    write_all(t / "s.json", scene_text(kFixed));
    ASSERT_EQ(run("render s.json -o f%d.png --frames 4 --turntable 360", t.path()).code, 0);
    const char* eyes[] = {"[0, -5, 0]", "[5, 0, 0]", "[0, 5, 0]", "[-5, 0, 0]"};  // counter-clockwise from above, and not back at the first
    for (int k = 0; k < 4; ++k) {
        write_all(t / "one.json", scene_text(std::string(R"({ "eye": )") + eyes[k] + R"(, "target": [0, 0, 0], "fov": 40 })"));
        ASSERT_EQ(run("render one.json -o one.png", t.path()).code, 0);
        EXPECT_LT(difference(t / "one.png", t / ("f" + std::to_string(k) + ".png")), 0.02f) << k;
    }
    EXPECT_GT(difference(t / "f0.png", t / "f1.png"), 0.5f);
    // A swing that is no whole turn ends where it says.
    ASSERT_EQ(run("render s.json -o g%d.png --frames 3 --turntable=-180", t.path()).code, 0);
    EXPECT_LT(difference(t / "g1.png", t / "f3.png"), 0.02f);
    EXPECT_LT(difference(t / "g2.png", t / "f2.png"), 0.02f);
}

TEST(FilmProgram, CamerasThatFitHaveEverythingInThePictureAllTheWayAtOneScale) {
    const TemporaryFolder t;
    for (const std::string camera : {R"({ "fit": true })", R"({ "eye": [0, -5, 2], "orthographic": true })", R"({ "eye": [4, -5, 2], "target": [1, 0, 0], "fit": true, "up": [0, 1, 0] })"}) {
        write_all(t / "s.json", scene_text(camera, R"("width": 80, "height": 60, "samples": 4, "background": "white")"));
        ASSERT_EQ(run("render s.json -o f%d.png --frames 7 --turntable 360", t.path()).code, 0);
        double least = 1e9, most = 0;
        for (int k = 0; k < 7; ++k) {
            const Image image = read_image(t / ("f" + std::to_string(k) + ".png"));
            double blue = 0;
            for (int y = 0; y < image.height; ++y)
                for (int x = 0; x < image.width; ++x) {
                    const float* p = &image.pixels[4 * (static_cast<std::size_t>(y) * image.width + x)];
                    if (x == 0 || y == 0 || x == image.width - 1 || y == image.height - 1) EXPECT_GT(std::min({p[0], p[1], p[2]}), 0.98f) << camera << " frame " << k << ": cut off at " << x << ", " << y;
                    blue += std::max(0.0f, p[2] - p[0]);
                }
            least = std::min(least, blue), most = std::max(most, blue);
        }
        EXPECT_GT(least, 1) << camera;
        if (camera.find("orthographic") != std::string::npos) EXPECT_LT(most, 1.25 * least) << camera;
    }
}

TEST(FilmProgram, PanelsTurnEachWithItsOwnCamera) {
    const TemporaryFolder t;
    const auto text = [](const std::string& first, const std::string& second) {
        return R"({ "isoparm": 1, "panels": [{ "objects": [{ "point": [1, 0, 0], "radius": 0.3 }, { "point": [0, 0, 0.5], "radius": 0.2 }] },
            { "objects": [{ "point": [1, 0, 0], "radius": 0.3 }], "camera": )" + second + R"( }], "marks": false, "camera": )" + first + R"(, "image": { "width": 64, "height": 24, "samples": 4 } })";
    };
    write_all(t / "s.json", text(R"({ "eye": [0, -5, 0], "target": [0, 0, 0] })", R"({ "eye": [0, 0, 6], "target": [0, 0, 0], "up": [0, 1, 0] })"));
    write_all(t / "one.json", text(R"({ "eye": [5, 0, 0], "target": [0, 0, 0] })", R"({ "eye": [6, 0, 0], "target": [0, 0, 0], "up": [0, 1, 0] })"));
    ASSERT_EQ(run("render s.json -o f%d.png --frames 2 --turntable 90", t.path()).code, 0);
    ASSERT_EQ(run("render one.json -o one.png", t.path()).code, 0);
    EXPECT_LT(difference(t / "one.png", t / "f1.png"), 0.02f);
    EXPECT_GT(difference(t / "f0.png", t / "f1.png"), 0.5f);
}

TEST(FilmProgram, KilledRunsGoOnWithTheFirstFrameThatIsMissing) {
    const TemporaryFolder t, other;
    write_all(t / "s.json", scene_text(kFixed, R"("width": 60, "height": 40, "samples": 256)"));
    write_all(other / "s.json", read_all(t / "s.json"));
    const std::string arguments = "render s.json -o f%03d.png --frames 8 --turntable 100";
    ASSERT_EQ(run(arguments, other.path()).code, 0);
    const int status = signalled(t.path(), arguments + " --resume part", "KILL", "f002.png");
    EXPECT_TRUE(status == 137 || status == 0) << status;  // 0: it was faster than the signal
    if (status == 0) GTEST_SKIP() << "the program was faster than the signal";
    ASSERT_TRUE(std::filesystem::exists(t / "part/frames"));
    ASSERT_TRUE(std::filesystem::exists(t / "f001.png"));
    const auto made = std::filesystem::last_write_time(t / "f000.png");
    write_all(t / "f001.png", "damaged");
    write_all(t / "part/isoparm.tmp-0123", "what a run leaves that is killed while it names a file");
    const Outcome wrong = run(arguments + " --resume part --samples 8", t.path());
    EXPECT_EQ(wrong.code, 65);
    EXPECT_NE(wrong.err.find("part: found frames of another scene"), std::string::npos) << wrong.err;
    const Outcome again = run(arguments + " --resume part", t.path());
    ASSERT_EQ(again.code, 0) << again.err;
    EXPECT_EQ(again.err.find("f000.png"), std::string::npos) << again.err;
    EXPECT_NE(again.err.find("f001.png"), std::string::npos) << again.err;
    EXPECT_EQ(std::filesystem::last_write_time(t / "f000.png"), made);
    EXPECT_FALSE(std::filesystem::exists(t / "part"));
    for (int k = 0; k < 8; ++k) EXPECT_EQ(read_all(t / ("f00" + std::to_string(k) + ".png")), read_all(other / ("f00" + std::to_string(k) + ".png"))) << k;

    std::filesystem::create_directory(t / "mine");
    write_all(t / "mine/letter.txt", "dear");
    const Outcome full = run(arguments + " --resume mine", t.path());
    EXPECT_EQ(full.code, 65) << full.err;
    EXPECT_EQ(read_all(t / "mine/letter.txt"), "dear");
}

TEST(FilmProgram, AnInterruptedFilmEndsWithoutAFile) {
    if (!has_ffmpeg()) GTEST_SKIP() << "no ffmpeg";
    const TemporaryFolder t;
    write_all(t / "s.json", scene_text(kFixed, R"("width": 200, "height": 150, "samples": 1024, "background": "white")"));
    EXPECT_EQ(signalled(t.path(), "render s.json -o f.mp4 --frames 500 --turntable 360 --resume part", "TERM", "part/00000.png"), 143);
    EXPECT_NE(read_all(t / "said").find("the same command goes on with them (part)"), std::string::npos) << read_all(t / "said");
    EXPECT_FALSE(std::filesystem::exists(t / "f.mp4"));
}

TEST(FilmProgram, FfmpegMakesFilmsThatDoNotDependOnThreads) {
    if (!has_ffmpeg()) GTEST_SKIP() << "no ffmpeg";
    const TemporaryFolder t;
    write_all(t / "s.json", scene_text(kFixed));
    for (const std::string kind : {"mp4", "webm", "gif"}) {
        const std::string name = "f." + kind;
        const Outcome o = run("render s.json -o " + name + " --frames 6 --turntable 360 --fps 10 --size 41x30 --threads 1", t.path());
        ASSERT_EQ(o.code, 0) << o.err;
        EXPECT_NE(o.err.find(name + ": 6 frames, 0.6 s"), std::string::npos) << o.err;
        const std::string first = read_all(t / name);
        ASSERT_EQ(run("render s.json -o " + name + " --frames 6 --turntable 360 --fps 10 --size 41x30 --threads 3 --resume part", t.path()).code, 0);
        EXPECT_EQ(read_all(t / name), first) << kind;
        EXPECT_EQ(t.files(), 2u) << "the scene and the film";
        // Its frames are the pictures, but for what the format loses.
        ASSERT_EQ(run("render s.json -o f%d.png --frames 6 --turntable 360 --size " + std::string(kind == "gif" ? "41x30" : "41x30 --crop 0,0,40,30"), t.path()).code, 0);
        ASSERT_EQ(std::system(("cd '" + t.path() + "' && ffmpeg -v error -i " + name + " -vf scale=in_color_matrix=bt709:out_range=pc g%d.png </dev/null").c_str()), 0);
        for (int k = 0; k < 6; ++k) {
            const Image a = read_image(t / ("f" + std::to_string(k) + ".png")), b = read_image(t / ("g" + std::to_string(k + 1) + ".png"));
            ASSERT_EQ(a.width, b.width);
            ASSERT_EQ(a.height, b.height);
            double sum = 0;
            for (std::size_t i = 0; i < a.pixels.size(); ++i) sum += std::fabs(a.pixels[i] - b.pixels[i]);
            EXPECT_LT(sum / static_cast<double>(a.pixels.size()), 0.02) << kind << " " << k;
        }
        EXPECT_FALSE(std::filesystem::exists(t / "g7.png"));
        for (const auto& f : std::filesystem::directory_iterator(t.path()))
            if (f.path().filename() != "s.json") std::filesystem::remove(f.path());
    }
}

TEST(FilmProgram, WhatCannotBeIsToldBeforeAnythingIsDrawn) {
    const TemporaryFolder t;
    write_all(t / "s.json", scene_text(kFixed));
    write_all(t / "clear.json", scene_text(kFixed, R"("width": 40, "height": 30, "background": "transparent")"));
    const auto refused = [&](int code, const std::string& arguments, const std::string& message, const std::string& before = "") {
        const Outcome o = run("render " + arguments, t.path(), before);
        EXPECT_EQ(o.code, code) << o.err;
        EXPECT_NE(o.err.find(message), std::string::npos) << o.err;
        EXPECT_EQ(t.files(), 2u);
    };
    refused(4, "s.json -o f.mp4 --frames 3 --turntable 90", "found no ffmpeg", "env PATH=/nowhere");
    refused(4, "s.json -o no/f.mp4 --frames 3 --turntable 90", "no/f.mp4: cannot be written");
    refused(64, "clear.json -o f.mp4 --frames 3 --turntable 90", "holds nothing transparent");
    refused(64, "s.json -o f.mp4", "expected --frames N too");
    refused(64, "s.json -o f.mp4 --frames 3", "--animate is missing, or --turntable");
    refused(64, "s.json -o f%d.png --turntable 90", "--frames is missing");
    refused(64, "s.json -o f%d.png --frames 3 --turntable 1e6", "expected degrees");
    refused(64, "s.json -o f%d.png --frames 3 --turntable 90 --fps 10", "--fps: found \"f%d.png\"");
    refused(64, "s.json -o f.gif --frames 3 --turntable 90 --fps 0", "expected 0.1 to 240");
    refused(64, "s.json -o f.png --fps 9", "expected --frames N");
}

}  // namespace
}  // namespace isoparm::test
