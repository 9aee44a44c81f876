// The real program on scenes that are wrong: exit 65, and file:line:column, what was found, what was expected.
// The first line of every file in bad_scenes/ holds the place and the message.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>

#include "run_program.h"

namespace isoparm::test {
namespace {

std::string folder() { return source_folder() + "/tests/bad_scenes"; }

std::vector<std::string> bad_scenes() {
    std::vector<std::string> names;
    for (const auto& f : std::filesystem::directory_iterator(folder()))
        if (f.path().extension() == ".json") names.push_back(f.path().stem().string());
    std::sort(names.begin(), names.end());
    return names;
}

class BadScene : public testing::TestWithParam<std::string> {};

TEST_P(BadScene, IsRefusedWithItsPlace) {
    const std::string file = GetParam() + ".json", text = read_all(folder() + "/" + file);
    const std::string prefix = "// expect ";
    ASSERT_EQ(text.rfind(prefix, 0), 0u);
    const std::string expected = text.substr(prefix.size(), text.find('\n') - prefix.size());
    const Outcome o = run("info " + file, folder());
    EXPECT_EQ(o.code, 65);
    EXPECT_EQ(o.out, "");
    EXPECT_EQ(o.err.rfind("isoparm: " + file + ":" + expected, 0), 0u) << "got      " << o.err << "expected isoparm: " << file << ":" << expected;
    EXPECT_EQ(std::count(o.err.begin(), o.err.end(), '\n'), 1) << "one line, no control characters of the input";
}
INSTANTIATE_TEST_SUITE_P(All, BadScene, testing::ValuesIn(bad_scenes()), [](const auto& info) { return info.param; });

TEST(BadScenes, AreManyAndSayWhatWasFoundAndExpected) {
    const auto names = bad_scenes();
    EXPECT_GE(names.size(), 45u);
    for (const auto& name : names) {
        const std::string text = read_all(folder() + "/" + name + ".json"), line = text.substr(0, text.find('\n'));
        EXPECT_NE(line.find("found "), std::string::npos) << name;
        EXPECT_NE(line.find("expected "), std::string::npos) << name;
    }
}

// Files too big to keep: written, tried, removed.
void expect_refused(const std::string& text, const std::string& message) {
    const TemporaryFolder t;
    write_all(t / "scene.json", text);
    const Outcome o = run("info scene.json", t.path());
    EXPECT_EQ(o.code, 65) << o.err;
    EXPECT_NE(o.err.find("scene.json:1:"), std::string::npos) << o.err;
    EXPECT_NE(o.err.find(message), std::string::npos) << o.err;
}
std::string repeated(const std::string& text, int count) {
    std::string r;
    r.reserve(text.size() * static_cast<std::size_t>(count));
    for (int k = 0; k < count; ++k) r += text;
    return r;
}

TEST(BadScenes, TenMegabytesOfBracketsAreRefused) {
    expect_refused(repeated("[", 10'000'000), "expected a JSON object");
    expect_refused("{\"isoparm\":" + repeated("[", 10'000'000), "nested deeper than 100 levels");
    expect_refused(repeated("{\"a\":", 2'000'000), "nested deeper than 100 levels");
    expect_refused("{\"isoparm\":[" + repeated("[],", 3'000'000) + "0]}", "more than 2000000 values");
}
TEST(BadScenes, AFileBeyondTheLimitIsRefused) { expect_refused(repeated(" ", 65 << 20), "more than 64 MiB"); }
TEST(BadScenes, ALongExpressionIsRefused) {
    expect_refused("{\"isoparm\":1,\"parameters\":{\"p\":\"" + repeated("(", 100'000) + "\"}}", "expected at most 4096");
    expect_refused("{\"isoparm\":1,\"parameters\":{\"p\":\"" + repeated("(", 4000) + "\"}}", "nested deeper than 200 levels");
}
TEST(BadScenes, ALongChainIsRefused) {
    std::string text = "{\"isoparm\":1,\"curves\":{";
    for (int k = 20'000; k > 0; --k) text += "\"c" + std::to_string(k) + "\":{\"type\":\"reverse\",\"curve\":\"c" + std::to_string(k - 1) + "\"},";
    expect_refused(text + "\"c0\":{\"type\":\"line\",\"points\":[[0,0,0],[1,0,0]]}}}", "chain of more than 100 definitions");
}
TEST(BadScenes, AnImportedFileMustBeARegularOne) {
    const TemporaryFolder t;
    std::filesystem::create_directory(t / "folder.bv");
    ASSERT_EQ(::mkfifo((t / "pipe.bv").c_str(), 0600), 0);
    for (const std::string name : {"folder", "pipe"}) {
        write_all(t / "scene.json", "{\"isoparm\":1,\"surfaces\":{\"S\":{\"type\":\"file\",\"path\":\"" + name + ".bv\"}}}");
        const Outcome o = run("info scene.json", t.path());
        EXPECT_EQ(o.code, 65);
        EXPECT_NE(o.err.find("scene.json:1:52: at $.surfaces.S.path: found a " + name), std::string::npos) << o.err;
    }
}
TEST(BadScenes, ImportedFilesLieBelowTheScene) {
    const TemporaryFolder t;
    std::filesystem::create_directories(t / "scene/below");
    const std::string teapot = read_all(test::source_folder() + "/tests/fuzz/corpus/teapot_part.bv");
    write_all(t / "outside.bv", teapot), write_all(t / "scene/below/a.bv", teapot);
    std::filesystem::create_symlink("../outside.bv", t / "scene/link.bv");
    const auto told = [&](const std::string& name) {
        write_all(t / "scene/s.json", "{\"isoparm\":1,\"surfaces\":{\"S\":{\"type\":\"file\",\"path\":\"" + name + "\"}}}");
        return run("info s.json", t / "scene").err;
    };
    for (const std::string& name : {std::string("../outside.bv"), t / "outside.bv", std::string("below/../../outside.bv"), std::string("link.bv")})
        EXPECT_NE(told(name).find("s.json:1:52: at $.surfaces.S.path: found \"" + name + "\", expected a file in the scene's folder or below it"), std::string::npos) << told(name);
    for (const std::string name : {"below/a.bv", "./below/../below/a.bv"}) EXPECT_EQ(told(name).find("expected a file in the scene's folder"), std::string::npos) << told(name);
}
TEST(BadScenes, AMissingSceneIsAnInputOutputError) {
    const Outcome o = run("info nothing.json");
    EXPECT_EQ(o.code, 4);
    EXPECT_NE(o.err.find("nothing.json: cannot be read: No such file"), std::string::npos) << o.err;
}

}  // namespace
}  // namespace isoparm::test
