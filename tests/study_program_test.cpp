// isoparm study from the command line: its files, going on after it was killed, and what it refuses.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <set>

#include "drawing/plot.h"
#include "drawing/text_cairo.h"
#include "image/image.h"
#include "provenance.h"
#include "run_program.h"
#include "scene/json.h"
#include "sha256.h"
#include "study/study_table.h"

namespace isoparm {
namespace {

namespace fs = std::filesystem;
using test::read_all, test::write_all;

std::string scene() { return test::source_folder() + "/scenes/coons.json"; }
std::string arguments(const std::string& folder) {
    return "study '" + scene() + "' -o '" + folder + "' --methods uniform,fast --tolerances 3e-2rel,1e-2rel,3e-3rel --size 120x90";
}

std::size_t count(const std::string& text, const std::string& part) {
    std::size_t n = 0;
    for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
    return n;
}
std::vector<std::string> lines(const std::string& text) {
    std::vector<std::string> all;
    for (std::size_t from = 0; from < text.size();) {
        const auto to = std::min(text.find("\r\n", from), text.size());
        all.push_back(text.substr(from, to - from));
        from = to + 2;
    }
    return all;
}

/// Every tag is closed in its turn, attributes are quoted, and & begins an entity: enough to be XML.
void expect_well_formed(const std::string& xml) {
    std::vector<std::string> open;
    for (std::size_t i = 0; i < xml.size(); ++i) {
        if (xml[i] == '&') {
            const auto end = xml.find(';', i);
            ASSERT_TRUE(end != std::string::npos && end - i < 10) << xml.substr(i, 20);
        }
        if (xml[i] != '<') continue;
        const auto end = xml.find('>', i);
        ASSERT_NE(end, std::string::npos);
        const std::string tag = xml.substr(i + 1, end - i - 1);
        ASSERT_EQ(count(tag, "\"") % 2, 0u) << tag;
        if (tag[0] == '/') {
            ASSERT_FALSE(open.empty());
            EXPECT_EQ(open.back(), tag.substr(1));
            open.pop_back();
        } else if (tag[0] != '?' && tag[0] != '!' && tag.back() != '/') {
            open.push_back(tag.substr(0, tag.find_first_of(" \n")));
        }
        i = end;
    }
    EXPECT_TRUE(open.empty());
}

TEST(StudyProgram, WritesATableDiagramsPicturesAndOnePage) {
    const test::TemporaryFolder t;
    const std::string folder = t / "out";
    const auto result = test::run(arguments(folder));
    ASSERT_EQ(result.code, 0) << result.err;
    EXPECT_EQ(result.out, "");

    const auto csv = lines(read_all(folder + "/study.csv"));
    ASSERT_EQ(csv.size(), 7u);
    EXPECT_EQ(csv[0].rfind("method,tolerance,triangles,vertices,certified_error,certified_parametric,sampled_error,n_opt,ratio,seconds_"
                           "processor,seconds_wall,",
                           0),
              0u)
        << csv[0];
    EXPECT_EQ(csv[1].rfind("uniform,", 0), 0u);
    EXPECT_EQ(csv[6].rfind("fast,", 0), 0u);

    const Json json = Json::parse(read_all(folder + "/study.json"), "study.json");
    EXPECT_EQ(json.at("provenance", "").at("scene sha256", "").string(), sha256(read_all(scene())));
    EXPECT_EQ(json.at("provenance", "").at("program", "").string(), "isoparm " + program_version());
    EXPECT_TRUE(json.at("provenance", "").find("date"));
    const Json runs = json.at("runs", "");
    ASSERT_EQ(runs.size(), 6u);
    for (const Json& r : runs.children()) {
        EXPECT_EQ(r.at("status", "").string(), "reached");
        EXPECT_LE(r.at("certified_error", "").number(), r.at("tolerance", "").number());
        EXPECT_LE(r.at("sampled_error", "").number(), r.at("certified_error", "").number());
        EXPECT_NEAR(r.at("ratio", "").number(), r.at("triangles", "").number() / r.at("n_opt", "").number(), 1e-9);
        EXPECT_EQ(r.size(), study_columns().size());
    }
    const Json order = json.at("methods", "")[1].at("order", "").at("certified", "");
    EXPECT_EQ(order.at("points", "").number(), 3);
    EXPECT_GT(order.at("order", "").number(), 1.5);

    for (const std::string name :
         {"triangles-certified", "triangles-sampled", "triangles-tolerance", "time-triangles", "ratio-tolerance"}) {
        SCOPED_TRACE(name);
        expect_well_formed(read_all(folder + "/" + name + ".svg"));
        EXPECT_EQ(read_all(folder + "/" + name + ".pdf").rfind("%PDF-", 0), 0u);
    }
    for (const std::string name : {"uniform-certified", "uniform-sampled", "fast-certified", "fast-sampled"})
        EXPECT_EQ(read_all(folder + "/heat/" + name + ".png").substr(1, 3), "PNG") << name;

    const std::string page = read_all(folder + "/index.html");
    EXPECT_EQ(count(page, "<svg"), 5u);
    EXPECT_EQ(count(page, "src=\"data:image/png;base64,"), 4u);
    for (const std::string outside : {"src=\"http", "href=\"http", "url(http", "@import", "<script", "<link", "src=\"//"})
        EXPECT_EQ(count(page, outside), 0u) << outside;
    for (const StudyColumn& c : study_columns())
        EXPECT_NE(page.find(std::string("<code>") + c.name + "</code>"), std::string::npos) << c.name;
    EXPECT_NE(page.find("prefers-color-scheme: dark"), std::string::npos);
    EXPECT_EQ(page.find(folder), std::string::npos) << "a path of this machine";
}

/// What a run said that it made: "fast at ..." and the like, one a line.
std::size_t made(const test::Outcome& result) { return count(result.err, "x optimum"); }

TEST(StudyProgram, GoesOnWhereItWasAndMakesDamagedRunsAgain) {
    const test::TemporaryFolder t;
    const std::string folder = t / "out";
    const auto first = test::run(arguments(folder));
    ASSERT_EQ(first.code, 0) << first.err;
    EXPECT_EQ(made(first), 6u);
    const std::string csv = read_all(folder + "/study.csv");

    const auto again = test::run(arguments(folder));
    EXPECT_EQ(made(again), 0u) << again.err;
    EXPECT_NE(again.err.find("6 of 6 runs were there already"), std::string::npos) << again.err;
    EXPECT_EQ(read_all(folder + "/study.csv"), csv);

    std::vector<fs::path> files;
    for (const auto& f : fs::directory_iterator(folder + "/runs"))
        if (f.path().filename().string().rfind("fast", 0) == 0) files.push_back(f.path());
    std::sort(files.begin(), files.end());
    ASSERT_EQ(files.size(), 3u);
    fs::remove(files[0]);
    const auto one = test::run(arguments(folder));
    EXPECT_EQ(made(one), 1u) << one.err;
    EXPECT_NE(one.err.find("5 of 6 runs were there already"), std::string::npos) << one.err;

    write_all(files[1].string(), read_all(files[1].string()).substr(0, 100));
    const auto damaged = test::run(arguments(folder));
    EXPECT_EQ(made(damaged), 1u) << damaged.err;
    EXPECT_NE(damaged.err.find("the file is damaged, its run is made again"), std::string::npos) << damaged.err;

    std::string text = read_all(files[1].string());
    char& digit = text[text.find("\"triangles\": ") + 13];
    digit = digit == '9' ? '8' : char(digit + 1);
    write_all(files[1].string(), text);
    const auto changed = test::run(arguments(folder));
    EXPECT_EQ(made(changed), 1u) << changed.err;
    EXPECT_NE(changed.err.find("found other contents than were written; the file is damaged"), std::string::npos) << changed.err;

    write_all(folder + "/heat/fast-sampled.png", "no picture");
    const auto picture = test::run(arguments(folder));
    EXPECT_EQ(made(picture), 1u) << picture.err;
    EXPECT_NE(picture.err.find("fast-sampled.png: missing, changed, or of another size"), std::string::npos) << picture.err;

    const auto larger = test::run(arguments(folder) + " --size 160x120");
    EXPECT_EQ(made(larger), 2u) << larger.err;

    write_all(folder + "/runs/mine.json", "mine");
    write_all(folder + "/notes.txt", "mine");
    const auto other = test::run(arguments(folder) + " --max-triangles 1000");
    EXPECT_EQ(count(other.err, "other options or another version"), 6u) << other.err;
    EXPECT_EQ(count(other.err, "was not reached"), count(read_all(folder + "/study.csv"), "not reached,")) << other.err;
    EXPECT_EQ(read_all(folder + "/runs/mine.json") + read_all(folder + "/notes.txt"), "minemine");
}

TEST(StudyProgram, WhatIsNotReachedIsRecordedAndTheStudyGoesOn) {
    const test::TemporaryFolder t;
    const auto result =
        test::run("study '" + scene() + "' -o " + t / "out" +
                  " --methods uniform,quadtree,fast --tolerances 1e-2,1e-7 --max-triangles 5000 --reproducible --size 120x90");
    ASSERT_EQ(result.code, 0) << result.err;
    const Json json = Json::parse(read_all(t / "out/study.json"), "study.json");
    EXPECT_FALSE(json.at("provenance", "").find("date"));
    int reached = 0;
    for (const Json& r : json.at("runs", "").children()) {
        if (r.at("status", "").string() == "reached") {
            ++reached;
            continue;
        }
        EXPECT_EQ(r.at("tolerance", "").number(), 1e-7);
        EXPECT_TRUE(r.at("triangles", "").is(Json::Kind::null));
        EXPECT_NE(r.at("reason", "").string().find("5000"), std::string::npos) << r.at("reason", "").string();
    }
    EXPECT_EQ(reached, 3);
    expect_well_formed(read_all(t / "out/triangles-certified.svg"));
}

TEST(StudyProgram, RefusesWhatItCannotDo) {
    const test::TemporaryFolder t;
    const auto expect = [&](const std::string& more, int code, const std::string& message) {
        const auto result = test::run("study '" + scene() + "' " + more);
        EXPECT_EQ(result.code, code) << more << "\n" << result.err;
        EXPECT_NE(result.err.find(message), std::string::npos) << more << "\n" << result.err;
    };
    expect("", 64, "-o is missing");
    expect("-o " + t / "a --methods fasst", 64, "did you mean \"fast\"?");
    expect("-o " + t / "a --tolerances 1e-2,,1e-3", 64, "--tolerances: found \"\" in the list");
    expect("-o " + t / "a --tolerances 1px", 64, "a tolerance in pixels needs a picture");
    expect("-o " + t / "a --tolerances -1", 64, "--tolerances: found \"-1\"");
    expect("-o " + t / "a --max-triangles 0", 64, "--max-triangles");
    expect("-o " + t / "a --size 3", 64, "--size: found \"3\"");
    EXPECT_FALSE(fs::exists(t / "a"));
    write_all(t / "file", "");
    expect("-o " + t / "file", 4, "file");
    expect("-o " + t / "file/under", 4, "cannot make this folder");
    fs::create_directory(t / "taken");
    write_all(t / "taken/index.html", "mine");
    expect("-o " + t / "taken", 4, "not of a study");
    EXPECT_EQ(read_all(t / "taken/index.html"), "mine");
    fs::create_directory(t / "drawn");
    write_all(t / "drawn/ratio-tolerance.pdf", "mine");
    expect("-o " + t / "drawn", 4, "ratio-tolerance.pdf: found a file that is not of a study");
    EXPECT_EQ(read_all(t / "drawn/ratio-tolerance.pdf"), "mine");
}

TEST(StudyProgram, RefusesAFolderThatItMayNotWriteTo) {
    if (geteuid() == 0) GTEST_SKIP() << "root may write anywhere";
    const test::TemporaryFolder t;
    fs::create_directory(t / "locked");
    fs::permissions(t / "locked", fs::perms::owner_read | fs::perms::owner_exec);
    const auto result = test::run("study '" + scene() + "' -o " + t / "locked");
    EXPECT_EQ(result.code, 4);
    EXPECT_NE(result.err.find("locked"), std::string::npos) << result.err;
}

TEST(StudyProgram, ThePageShowsItsFiguresInABrowser) {
    std::string browser;
    for (const std::string name : {"chromium", "chromium-browser", "google-chrome"})
        if (browser.empty() && std::system(("command -v " + name + " >/dev/null 2>&1").c_str()) == 0) browser = name;
    if (browser.empty()) GTEST_SKIP() << "there is no chromium";
    const test::TemporaryFolder t;
    ASSERT_EQ(
        test::run("study '" + scene() + "' -o " + t / "out" + " --methods fast --tolerances 3e-2rel,1e-2rel --quiet --size 400x300").code,
        0);
    const std::string command =
        "timeout 60 " + browser +
        " --headless --no-sandbox --disable-gpu --host-resolver-rules='MAP * ~NOTFOUND' --window-size=1200,4000 --dump-dom 'file://" +
        t / "out/index.html" + "' >" + t / "dom.html" + " 2>/dev/null && timeout 60 " + browser +
        " --headless --no-sandbox --disable-gpu --hide-scrollbars --window-size=1200,3000 --screenshot=" + t / "page.png" + " 'file://" +
        t / "out/index.html' >/dev/null 2>&1";
    if (std::system(("export HOME=" + t.path() + "; " + command).c_str()) != 0) GTEST_SKIP() << browser << " does not run here";
    const std::string dom = read_all(t / "dom.html");
    EXPECT_EQ(count(dom, "<svg"), 5u);
    EXPECT_EQ(count(dom, "<img"), 2u);
    const Image page = read_image(t / "page.png");
    EXPECT_EQ(page.width, 1200);
    std::set<std::array<float, 3>> colors;
    for (int y = 0; y < page.height; y += 3)
        for (int x = 0; x < page.width; x += 3) colors.insert({page.at(x, y)[0], page.at(x, y)[1], page.at(x, y)[2]});
    EXPECT_GT(colors.size(), 500u) << "the heat maps are not there";
}

// ---- the parts that draw and digest

TEST(Sha256, OfTheStandardsExamples) {
    EXPECT_EQ(sha256(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
    EXPECT_EQ(sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
    EXPECT_EQ(sha256("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
              "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
}

TEST(Plot, TicksAreRoundAndInside) {
    EXPECT_EQ(log_ticks(0.5, 2000), (std::vector<double>{1, 10, 100, 1000}));
    EXPECT_EQ(log_ticks(1.7, 12), (std::vector<double>{2, 5, 10}));
}

TEST(Plot, TheSameDrawingGivesTheSameBytesAndStaysOnItsPaper) {
    Plot plot{"Title", "abscissa", "$N / N_{opt}$", {}};
    PlotSeries s = plot_style(3);
    s.name = "a & b <c>";
    s.points = {{1e-5, 3}, {1e-3, 5000}, {0.2, 17}};
    plot.series = {s};
    const Drawing drawing = draw_plot(plot, 400, 300);
    for (const auto format : {VectorFormat::svg, VectorFormat::pdf})
        EXPECT_TRUE(vector_file(drawing, 400, 300, format, "t") == vector_file(drawing, 400, 300, format, "t"));
    EXPECT_EQ(vector_file(drawing, 400, 300, VectorFormat::pdf, "t").find("CreationDate"), std::string::npos);
    for (const DrawingItem& item : drawing)
        if (const auto* text = std::get_if<Text>(&item.shape)) {
            const TextBox box = text_box(text->text, text->size);
            const double right = text->at.x + (text->turned ? box.bottom : box.right),
                         top = text->at.y - (text->turned ? box.advance : -box.top);
            EXPECT_TRUE(text->at.x >= 0 && right <= 400 && top >= 0 && text->at.y <= 300) << text->at.x << " " << text->at.y;
        }
    EXPECT_FALSE(draw_plot({"empty", "x", "y", {}}, 400, 300).empty());
}

}  // namespace
}  // namespace isoparm
