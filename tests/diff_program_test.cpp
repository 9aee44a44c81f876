// isoparm diff from the command line: exit codes, reports, folders, and the page in a browser.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <limits>

#include "expect_program.h"
#include "image/image.h"
#include "image/image_layers.h"

namespace isoparm {
namespace {

namespace fs = std::filesystem;
using test::expect, test::parsed, test::read_all, test::run, test::write_all;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

/// Colours, normals, and the patches that they are of: left 3, right 4.
ImageLayer picture() {
    ImageLayer l = make_layer("", 40, 30, {"R", "G", "B", "N.Y", "patch.I", "uv.U", "uv.V"}, {"half", "half", "half", "half", "uint32", "float", "float"});
    for (int y = 0; y < 30; ++y)
        for (int x = 0; x < 40; ++x) {
            l.at(x, y, "R") = 0.5f, l.at(x, y, "G") = static_cast<float>(x) / 64, l.at(x, y, "B") = static_cast<float>(y) / 64, l.at(x, y, "N.Y") = 0.25f;
            l.at(x, y, "patch.I") = x < 20 ? 3.0f : 4.0f, l.at(x, y, "uv.U") = static_cast<float>(x % 20) / 20, l.at(x, y, "uv.V") = static_cast<float>(y) / 30;
        }
    return l;
}
ImageLayer bytes(float red, float green, float blue) {
    ImageLayer l = make_layer("", 40, 30, {"R", "G", "B"}, {"uint8", "uint8", "uint8"});
    l.space = "sRGB";
    for (std::size_t i = 0; i < l.values.size(); i += 3) l.values[i] = red, l.values[i + 1] = green, l.values[i + 2] = blue;
    return l;
}

class DiffProgram : public testing::Test {
protected:
    void SetUp() override {
        ImageLayer l = picture();
        write_layers(t / "a.exr", {l});
        for (int x = 4; x < 16; ++x) l.at(x, 7, "N.Y") += 0.0078125f;
        l.at(10, 7, "N.Y") += 0.0234375f;
        write_layers(t / "b.exr", {l});
    }
    test::Outcome diff(const std::string& arguments) const { return run("diff " + arguments, t.path()); }
    const test::TemporaryFolder t;
};

TEST_F(DiffProgram, ExitCodesFollowTheLimits) {
    EXPECT_EQ(diff("a.exr a.exr").code, 0);
    EXPECT_EQ(diff("a.exr b.exr").code, 2);
    EXPECT_EQ(diff("-fail 0.1 a.exr b.exr").code, 1) << "the warning is at 1e-6";
    EXPECT_EQ(diff("--fail 0.1 --warn 0.1 a.exr b.exr").code, 0);
    EXPECT_EQ(diff("-failpercent 1 -warnpercent 1 a.exr b.exr").code, 0) << "12 of 1200 pixels";
    EXPECT_EQ(diff("-failpercent 0.99 a.exr b.exr").code, 2);
    EXPECT_EQ(diff("-failpercent 1 -warnpercent 1 -hardfail 0.02 a.exr b.exr").code, 2);
    EXPECT_EQ(diff("-fail 1 -warn 1 -hardwarn 0.02 a.exr b.exr").code, 1);
    EXPECT_EQ(diff("--channel N.Y=0.1 a.exr b.exr").code, 0);
    EXPECT_EQ(diff("-fail 1 --channel 'N.*=0.03' a.exr b.exr").code, 2);
    EXPECT_EQ(diff("--fail-rms 1e-9 -fail 1 -warn 1 a.exr b.exr").code, 2);
    const auto quiet = diff("-q -a a.exr b.exr");
    EXPECT_EQ(quiet.out + quiet.err, "");
    EXPECT_EQ(quiet.code, 2);
}

TEST_F(DiffProgram, FailuresAreToldByPatchAndPlace) {
    const auto text = diff("-fail 0.004 a.exr b.exr").out;
    EXPECT_NE(text.find("N.Y: 12 px > 0.004, worst 0.03125 at (10,7), patch 3, uv (0.5,0.2333)"), std::string::npos) << text;
    EXPECT_NE(text.find("FAIL: 12 of 1200 pixels (1 %) differ by more than 0.004"), std::string::npos) << text;
    const auto json = parsed(diff("--json -fail 0.004 a.exr b.exr").out);
    EXPECT_EQ(json["result"].asString(), "fail");
    EXPECT_EQ(json["failing_pixels"].asInt(), 12);
    EXPECT_EQ(json["max"].asDouble(), 0.03125);
    EXPECT_EQ(json["worst"]["x"].asInt(), 10);
    EXPECT_EQ(json["worst"]["y"].asInt(), 7);
    EXPECT_EQ(json["worst"]["channel"].asString(), "N.Y");
    EXPECT_EQ(json["worst"]["a"].asDouble(), 0.25);
    EXPECT_EQ(json["worst"]["b"].asDouble(), 0.28125);
    EXPECT_EQ(json["flip"].asDouble(), 0) << "the colours are equal";
    EXPECT_EQ(json["parts"][0]["patches"][0]["patch"].asInt(), 3);
    EXPECT_EQ(json["parts"][0]["channels"].size(), 7u);
    const auto same = parsed(diff("--json a.exr a.exr").out);
    EXPECT_EQ(same["result"].asString(), "pass");
    for (const char* key : {"psnr", "worst"}) EXPECT_TRUE(same.isMember(key) && same[key].isNull()) << key;
    EXPECT_EQ(same["mean"].asDouble() + same["rms"].asDouble() + same["max"].asDouble() + same["flip"].asDouble(), 0);
}

TEST_F(DiffProgram, WhatIsNotFiniteNeverPasses) {
    ImageLayer l = picture();
    l.at(3, 3, "R") = kNan;
    write_layers(t / "n.exr", {l});
    EXPECT_EQ(diff("a.exr n.exr -fail 9 -warn 9 -failpercent 100 -warnpercent 100").code, 2);
    EXPECT_EQ(diff("n.exr n.exr").code, 2);
    EXPECT_EQ(diff("n.exr n.exr --allow-nonfinite").code, 0);
    const auto outcome = diff("--json a.exr n.exr");
    EXPECT_EQ(outcome.out.find("nan"), std::string::npos) << outcome.out;
    const auto json = parsed(outcome.out);
    EXPECT_EQ(json["worst"]["b"].asString(), "NaN");
    EXPECT_TRUE(json["flip"].isNull());
    EXPECT_EQ(json["nonfinite_pixels"].asInt(), 1);
}

TEST_F(DiffProgram, WhatIsNotComparableSaysWhy) {
    write_layers(t / "a.png", {bytes(0.2f, 0.4f, 0.6f)});
    ImageLayer l = picture();
    l.part.channels[3] = "N.Z";
    write_layers(t / "c.exr", {l});
    const auto outcome = diff("a.exr c.exr");
    EXPECT_EQ(outcome.code, 3);
    EXPECT_NE(outcome.out.find("channels missing: N.Y"), std::string::npos) << outcome.out;
    EXPECT_EQ(diff("a.exr a.png").code, 3);
    EXPECT_EQ(diff("--mismatch-fails a.exr c.exr").code, 2);
    const auto json = parsed(diff("--json a.exr c.exr").out);
    EXPECT_EQ(json["result"].asString(), "not_comparable");
    EXPECT_TRUE(json.isMember("mean") && json["mean"].isNull());
}

TEST_F(DiffProgram, RefusesWhatItCannotDo) {
    const auto refuses = [&](const std::string& arguments, int code, const std::string& message) {
        const auto o = diff(arguments);
        EXPECT_EQ(o.code, code) << arguments << "\n" << o.err;
        EXPECT_NE(o.err.find(message), std::string::npos) << arguments << "\n" << o.err;
    };
    write_all(t / "text.exr", "this is no image");
    refuses("a.exr", 64, "expected a reference and a new image");
    refuses("a.exr none.exr", 4, "none.exr: there is no such file");
    refuses("a.exr text.exr", 4, "text.exr: the file does not begin like one of format openexr");
    refuses("-fail -1 a.exr b.exr", 64, "-fail: found -1");
    refuses("-failpercent 101 a.exr b.exr", 64, "from 0 to 100");
    refuses("--channel N.X=1 a.exr b.exr", 64, "did you mean \"N.Y\"?");
    refuses("-p a.exr b.exr", 64, "use --fail-flip");
    refuses("-o a.exr a.exr b.exr", 64, "which is the file of REF too");
    refuses("-o d.xyz a.exr b.exr", 64, "expected the extension of an image format");
    refuses("-o no/d.exr a.exr b.exr", 4, "there is no folder no");
    refuses("--max-pixels 1000 a.exr b.exr", 4, "found 1200 pixels in the header");
    refuses(". a.exr", 64, "two images or two folders");
    refuses("/dev/zero a.exr", 4, "/dev/zero");
}

TEST_F(DiffProgram, WritesTheDifference) {
    EXPECT_EQ(diff("-q -abs -scale 2 -o d.exr b.exr a.exr").code, 2);
    EXPECT_EQ(diff("-q -od -o none.exr a.exr a.exr").code, 0);
    EXPECT_FALSE(fs::exists(t / "none.exr"));
    ImageLayer l = picture();
    l.values.assign(l.values.size(), 0);
    for (int x = 4; x < 16; ++x) l.at(x, 7, "N.Y") = 0.015625f;
    l.at(10, 7, "N.Y") = 0.0625f;
    l.part.types.assign(7, "float");
    write_layers(t / "expected.exr", {l});
    const auto same = diff("expected.exr d.exr");
    EXPECT_EQ(same.code, 0) << same.out << same.err;
    EXPECT_EQ(fs::exists(t / "d.exr.tmp"), false);
}

TEST_F(DiffProgram, OnlyTheMaskCounts) {
    ImageLayer mask = bytes(1, 1, 1);
    write_layers(t / "all.png", {mask});
    for (int x = 0; x < 40; ++x) mask.at(x, 7, "R") = 0;
    write_layers(t / "mask.png", {mask});
    EXPECT_EQ(diff("--mask all.png a.exr b.exr").code, 2);
    EXPECT_EQ(diff("--mask mask.png a.exr b.exr").code, 0);
    write_layers(t / "small.png", {make_layer("", 8, 8, {"R", "G", "B"}, {"uint8", "uint8", "uint8"})});
    EXPECT_EQ(diff("--mask small.png a.exr b.exr").code, 64);
}

TEST_F(DiffProgram, FoldersArePairedByName) {
    fs::create_directories(t / "refs/deep");
    fs::create_directories(t / "news/deep");
    const auto write = [&](const std::string& name, float red) { write_layers(t / name, {bytes(red, 0, 0)}); };
    write("refs/same.png", 0.2f), write("news/same.png", 0.2f);
    write("refs/deep/other.png", 0.2f), write("news/deep/other.png", 0.4f);
    write("refs/either.png", 0.2f), write("refs/either.alt1.png", 0.6f), write("news/either.png", 0.6f);
    write("refs/gone.png", 0.2f), write("news/new.png", 0.2f);
    const auto outcome = diff("--json --junit j.xml refs news");
    EXPECT_EQ(outcome.code, 2) << outcome.err;
    const auto json = parsed(outcome.out);
    EXPECT_EQ(json["result"].asString(), "fail");
    std::map<std::string, std::string> results;
    for (const auto& p : json["pairs"]) results[fs::path(p["new"].asString()).filename()] = p["result"].asString();
    EXPECT_EQ(results, (std::map<std::string, std::string>{{"same.png", "pass"}, {"other.png", "fail"}, {"either.png", "pass"}, {"gone.png", "fail"}, {"new.png", "fail"}}));
    const std::string junit = read_all(t / "j.xml");
    EXPECT_NE(junit.find("tests=\"5\" failures=\"3\" errors=\"0\""), std::string::npos) << junit;
    EXPECT_NE(junit.find("message=\"FAIL: the new image is missing\""), std::string::npos) << junit;

    const std::string before = read_all(t / "refs/same.png");
    ImageLayer odd = picture();
    odd.at(0, 0, "R") = kNan;
    write_layers(t / "news/odd.exr", {odd});
    write_all(t / "news/bad.png", "damaged");
    EXPECT_EQ(diff("--update refs news").code, 4) << "a damaged image becomes no reference";
    EXPECT_FALSE(fs::exists(t / "refs/bad.png"));
    EXPECT_FALSE(fs::exists(t / "refs/odd.exr")) << "nor one with NaN";
    EXPECT_EQ(read_all(t / "refs/deep/other.png"), read_all(t / "news/deep/other.png"));
    EXPECT_EQ(read_all(t / "refs/new.png"), read_all(t / "news/new.png"));
    EXPECT_EQ(read_all(t / "refs/same.png"), before);
    for (const char* name : {"refs/gone.png", "news/odd.exr", "news/bad.png"}) fs::remove(t / name);
    EXPECT_EQ(diff("refs news").code, 0);
}

TEST_F(DiffProgram, ManyRunsNeverHang) {
    for (int k = 0; k < 8; ++k) {
        const auto outcome = diff("-q --max-seconds 5 a.exr a.exr");
        ASSERT_EQ(outcome.code, 0) << "run " << k << ": " << outcome.err;
    }
}

TEST_F(DiffProgram, LinkedFoldersAreComparedAndLoopsEnd) {
    fs::create_directories(t / "refs");
    fs::create_directories(t / "news");
    fs::create_directories(t / "far");
    fs::copy_file(t / "a.exr", t / "refs/a.exr"), fs::copy_file(t / "a.exr", t / "news/a.exr");
    fs::copy_file(t / "b.exr", t / "far/x.exr");
    fs::create_directory_symlink("../far", t / "news/linked");
    fs::create_directory_symlink(".", t / "news/loop");
    const auto outcome = diff("refs news");
    EXPECT_EQ(outcome.code, 2) << outcome.out;
    EXPECT_NE(outcome.out.find("news/linked/x.exr"), std::string::npos) << outcome.out;
    EXPECT_NE(outcome.out.find("2 images: 1 pass, 1 missing"), std::string::npos) << outcome.out;
    fs::remove(t / "news/linked");
    write_all(t / "news/w.webp", "RIFF");
    const auto unread = diff("refs news");
    EXPECT_EQ(unread.code, 0) << unread.out << unread.err;
    EXPECT_NE(unread.err.find("1 images are of formats that are not read, and were not compared: news/w.webp"), std::string::npos) << unread.err;
}

TEST_F(DiffProgram, UpdateKeepsFormatsAndAlternatives) {
    write_layers(t / "a.png", {bytes(0.2f, 0.4f, 0.6f)});
    const std::string before = read_all(t / "a.png");
    const auto other = diff("--update a.png a.exr");
    EXPECT_EQ(other.code, 64) << other.err;
    EXPECT_NE(other.err.find("expected files of one format; nothing was written"), std::string::npos) << other.err;
    EXPECT_EQ(read_all(t / "a.png"), before);
    EXPECT_EQ(diff("--update none.webp a.exr").code, 64);
    EXPECT_FALSE(fs::exists(t / "none.webp"));

    fs::create_directories(t / "news");
    fs::copy_file(t / "a.png", t / "news/pic.altitude.png");
    EXPECT_EQ(diff("news news").code, 0) << "pic.png does not exist: pic.altitude.png is no other reference for it";
    EXPECT_EQ(diff("--update made/refs news").code, 0) << "a missing folder of references is made";
    EXPECT_EQ(read_all(t / "made/refs/pic.altitude.png"), before);

    write_layers(t / "made/refs/pic.png", {bytes(1, 1, 1)});
    fs::copy_file(t / "a.png", t / "news/pic.png");
    EXPECT_EQ(diff("made/refs made/refs").code, 0);
    write_layers(t / "news/pic.altitude.png", {bytes(0, 0, 0)});
    EXPECT_EQ(diff("--update made/refs news").code, 2);
    EXPECT_EQ(read_all(t / "made/refs/pic.altitude.png"), before) << "an alternative is never written";
    EXPECT_EQ(read_all(t / "made/refs/pic.png"), before);
}

TEST_F(DiffProgram, NamesArePrintedAsTextOnly) {
    const std::string name = "x\x1b[2J\xff.exr";
    fs::copy_file(t / "a.exr", t / name);
    const std::string quoted_name = "'" + name + "'";
    for (const std::string how : {"", "--json ", "--junit - ", "--html - "}) {
        const auto outcome = diff(how + quoted_name + " b.exr");
        EXPECT_EQ(outcome.code, 2) << outcome.err;
        EXPECT_EQ(outcome.out.find('\x1b'), std::string::npos) << how;
        EXPECT_EQ(outcome.out.find('\xff'), std::string::npos) << how;
    }
    EXPECT_NE(diff(quoted_name + " b.exr").out.find("x\\x1b[2J\xef\xbf\xbd.exr and b.exr"), std::string::npos);
    EXPECT_EQ(parsed(diff("--json " + quoted_name + " b.exr").out)["reference"].asString(), "x\x1b[2J\xef\xbf\xbd.exr");
}

TEST_F(DiffProgram, OneReportGoesToStandardOutput) {
    const auto outcome = diff("--junit - a.exr b.exr");
    EXPECT_EQ(outcome.out.rfind("<?xml", 0), 0u) << outcome.out;
    EXPECT_FALSE(fs::exists(t / "-"));
    EXPECT_EQ(diff("--junit - --json a.exr b.exr").code, 64);
    EXPECT_EQ(diff("--junit - --html - a.exr b.exr").code, 64);
}

TEST_F(DiffProgram, TheSelftestFindsEveryChange) {
    const auto outcome = diff("--selftest -q");
    EXPECT_EQ(outcome.code, 0) << outcome.out;
    EXPECT_EQ(outcome.out, "73 changes, 0 missed\n");
}

// ---- the page ---------------------------------------------------------------------------------------------------------

std::string browser() {
    for (const std::string name : {"chromium", "chromium-browser", "google-chrome"})
        if (std::system(("command -v " + name + " >/dev/null 2>&1").c_str()) == 0) return name;
    return "";
}

TEST_F(DiffProgram, ThePageWorksInABrowser) {
    if (browser().empty()) GTEST_SKIP() << "there is no chromium";
    write_layers(t / "red.png", {bytes(1, 0, 0)});
    ImageLayer blue = bytes(0, 0, 1);
    for (int x = 0; x < 40; ++x)
        for (int y = 0; y < 10; ++y) blue.at(x, y, "R") = 1, blue.at(x, y, "B") = 0;  // the upper third is equal
    write_layers(t / "blue.png", {blue});
    ASSERT_EQ(diff("-q --html page.html red.png blue.png").code, 2);
    const std::string page = read_all(t / "page.html");
    for (const std::string outside : {"src=\"http", "href=\"http", "url(http", "@import", "<link", "src=\"//"}) EXPECT_EQ(page.find(outside), std::string::npos) << outside;

    const auto visit = [&](const std::string& state, const std::string& what) {
        const std::string command = "export HOME='" + t.path() + "'; timeout 60 " + browser() + " --headless --no-sandbox --disable-gpu --hide-scrollbars --enable-logging=stderr --host-resolver-rules='MAP * ~NOTFOUND' --window-size=900,900 " + what +
                                    " 'file://" + t / "page.html#" + state + "' >'" + t / "dom" + "' 2>'" + t / "log" + "'";
        return std::system(command.c_str()) == 0;
    };
    /// The attributes of the figure of that name, and of the stage.
    const auto tag = [&](const std::string& begin) {
        const std::string dom = read_all(t / "dom");
        const auto at = dom.find(begin);
        return at == std::string::npos ? "" : dom.substr(at, dom.find('>', at) - at);
    };
    if (!visit("", "--dump-dom")) GTEST_SKIP() << "the browser does not run here";
    const auto shown = [&](const std::string& name) { return tag("<figure data-image=\"" + name + "\"").find("hidden") == std::string::npos; };
    EXPECT_TRUE(shown("a") && shown("b") && !shown("heat") && !shown("flip")) << "side by side";
    EXPECT_EQ(read_all(t / "log").find("CONSOLE"), std::string::npos) << read_all(t / "log");

    ASSERT_TRUE(visit("mode=flicker", "--virtual-time-budget=700 --dump-dom"));
    EXPECT_NE(tag("<div class=\"stage\"").find("data-shown=\"b\""), std::string::npos) << "it begins with a, and turns after half a second";
    EXPECT_TRUE(!shown("a") && shown("b"));

    ASSERT_TRUE(visit("mode=heat", "--dump-dom"));
    EXPECT_TRUE(!shown("a") && !shown("b") && shown("heat"));
    EXPECT_EQ(read_all(t / "log").find("CONSOLE"), std::string::npos) << read_all(t / "log");

    ASSERT_TRUE(visit("mode=wipe&at=25", "--screenshot='" + t / "wipe.png" + "'"));
    EXPECT_EQ(read_all(t / "log").find("CONSOLE"), std::string::npos) << read_all(t / "log");
    // The stage is 860 pixels wide and begins at x = 20: left of a quarter of it the reference is seen, right of it the new image.
    const Image shot = read_image(t / "wipe.png");
    int red = 0, blue_pixels = 0, wrong = 0;
    for (int y = 0; y < shot.height; ++y)
        for (int x = 30; x < 870; ++x) {
            const float* p = shot.at(x, y);
            const bool is_red = p[0] > 0.9f && p[1] < 0.02f && p[2] < 0.02f, is_blue = p[2] > 0.9f && p[0] < 0.02f && p[1] < 0.02f;
            red += is_red && x < 230, blue_pixels += is_blue && x > 240, wrong += is_blue && x < 230;
        }
    EXPECT_GT(red, 10000);
    EXPECT_GT(blue_pixels, 10000);
    EXPECT_EQ(wrong, 0);
}

}  // namespace
}  // namespace isoparm
