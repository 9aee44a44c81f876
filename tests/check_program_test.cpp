// isoparm check from the command line: orders, planted gaps, compatibility, promises, exit codes.
#include <gtest/gtest.h>

#include <cmath>

#include "expect_program.h"

namespace isoparm::test {
namespace {

/// The unit square in the plane z = 0, and a second patch beyond x = 1 that begins `gap` above it and rises by `rise`.
std::string two_squares(const std::string& gap, const std::string& rise) {
    return R"({"isoparm": 1, "surfaces": {
        "flat": {"type": "bezier", "points": [[[0,0,0], [0,1,0]], [[1,0,0], [1,1,0]]]},
        "roof": {"type": "bezier", "points": [[[1,0,)" + gap + "], [1,1," + gap + "]], [[2,0,\"" + gap + "+" + rise + "\"], [2,1,\"" + gap + "+" + rise + R"("]]]},
        "both": {"type": "composite", "members": ["flat", "roof"]}}})";
}
struct Checked {
    int code;
    Json::Value json;
};
Checked checked(const std::string& arguments) {
    const Outcome o = run("check " + arguments + " --json");
    EXPECT_EQ(o.err, "") << arguments;
    return {o.code, parsed(o.out)};
}
Checked checked_text(const std::string& scene_text) {
    const TemporaryFolder t;
    write_all(t / "s.json", scene_text);
    return checked(t / "s.json");
}
void expect_holds(const Json::Value& bound, double jump) {
    EXPECT_LE(bound["lower"].asDouble(), jump * (1 + 1e-14));
    EXPECT_GE(bound["upper"].asDouble(), jump * (1 - 1e-14));
    EXPECT_LE(bound["upper"].asDouble() - bound["lower"].asDouble(), 0.011 * jump);
    ASSERT_EQ(bound["at"].size(), 2u);
}

TEST(CheckProgram, PlantedJumpsComeBack) {
    for (const char* h : {"1e-3", "1e-5", "1e-7"}) {
        const double jump = std::strtod(h, nullptr);
        const Checked gap = checked_text(two_squares(h, "0"));
        EXPECT_EQ(gap.code, 2);
        ASSERT_EQ(gap.json["edges"].size(), 1u);
        const Json::Value e = gap.json["edges"][0];
        EXPECT_EQ(e["a"]["surface"].asString() + " " + e["a"]["edge"].asString(), "flat d1");
        EXPECT_EQ(e["b"]["surface"].asString() + " " + e["b"]["edge"].asString(), "roof d0");
        EXPECT_EQ(e["order"].asString(), "not joined");
        expect_holds(e["c0"], jump);
        EXPECT_EQ(gap.json["failed"].size(), 1u);

        const Checked bent = checked_text(two_squares("0", h));
        EXPECT_EQ(bent.code, 0);
        ASSERT_EQ(bent.json["edges"].size(), 1u);
        const Json::Value f = bent.json["edges"][0];
        EXPECT_EQ(f["order"].asString(), "C0");
        EXPECT_LE(f["c0"]["upper"].asDouble(), 1e-13);
        expect_holds(f["c1"], jump);
        expect_holds(f["g1_degrees"], std::atan(jump) * 180 / M_PI);
        EXPECT_EQ(f["c1"]["at"][0].asDouble(), 1);
    }
    const Checked flat = checked_text(two_squares("0", "0"));
    EXPECT_EQ(flat.code, 0);
    EXPECT_EQ(flat.json["edges"][0]["order"].asString(), "C2");
    EXPECT_EQ(flat.json["edges"][0]["geometric"].asString(), "G2");
}
TEST(CheckProgram, TheToleranceDecides) {
    const TemporaryFolder t;
    write_all(t / "s.json", two_squares("1e-5", "0"));
    EXPECT_EQ(checked(t / "s.json" + " --tolerance 2e-5").code, 0);
    EXPECT_EQ(checked(t / "s.json" + " --tolerance 1e-3rel").json["edges"][0]["order"].asString(), "C2");
    EXPECT_EQ(checked(t / "s.json" + " --capture 1e-6").json["edges"].size(), 0u);  // too far apart to be meant to meet
    EXPECT_EQ(checked(t / "s.json" + " --capture 0").code, 0);
    write_all(t / "bent.json", two_squares("0", "1e-3"));
    EXPECT_EQ(checked(t / "bent.json" + " --angle 0.1").json["edges"][0]["order"].asString(), "G2");  // both are flat
}
TEST(CheckProgram, TheTeapotIsG1OrBetterAcrossItsEdges) {
    const Checked c = checked(scene("teapot"));
    EXPECT_EQ(c.code, 0);
    ASSERT_EQ(c.json["edges"].size(), 52u);
    EXPECT_EQ(c.json["open"].size(), 16u);
    EXPECT_EQ(c.json["poles"].size(), 8u);
    std::size_t g1_alone = 0;
    for (const Json::Value& e : c.json["edges"]) {
        EXPECT_TRUE(e["order"] == "G1" || e["order"] == "C1") << e;
        g1_alone += e["order"] == "G1";
        EXPECT_LE(e["g1_degrees"]["upper"].asDouble(), 1e-6);
    }
    EXPECT_EQ(g1_alone, 6u);  // rim to body, and halves of the spout: their speeds differ
    EXPECT_EQ(run("check " + scene("teapot") + " --threads 1").out, run("check " + scene("teapot") + " --threads 3").out);
}
// Two parts of a cylinder, one above the other: a bound of G1 that falls in stairs.
TEST(CheckProgram, TheBudgetDecidesWhatFallsInStairs) {
    const TemporaryFolder t;
    write_all(t / "s.json", R"x({"isoparm": 1, "curves": {"p": {"type": "formula", "xyz": ["cos(3*t)", "sin(3*t)", "0"], "domain": [0, 1]},
        "q": {"type": "transform", "curve": "p", "translate": [0, 0, 1]}, "r": {"type": "transform", "curve": "p", "translate": [0, 0, 3]}},
        "surfaces": {"A": {"type": "ruled", "c0": "p", "c1": "q"}, "B": {"type": "ruled", "c0": "q", "c1": "r"}, "X": {"type": "composite", "members": ["A", "B"]}}})x");
    const Json::Value few = checked(t / "s.json --halvings 10").json["edges"][0], all = checked(t / "s.json").json["edges"][0];
    EXPECT_NE(few["geometric"].asString(), "G2");
    EXPECT_EQ(all["geometric"].asString(), "G2");
    EXPECT_LT(all["g1_degrees"]["upper"].asDouble(), 1e-6);
    EXPECT_GT(few["g1_degrees"]["upper"].asDouble(), 1e-6);
}
TEST(CheckProgram, DataAndTheirRemedies) {
    const Checked coons = checked(scene("coons"));
    EXPECT_EQ(coons.code, 0);
    EXPECT_TRUE(coons.json["surfaces"][0]["compatible"].asBool());
    ASSERT_EQ(coons.json["surfaces"][0]["conditions"].size(), 8u);  // four corners, four curves
    for (const Json::Value& k : coons.json["surfaces"][0]["conditions"]) EXPECT_LE(k["gap"].asDouble(), 1e-12) << k;

    const Checked twists = checked(scene("s004_incompatible_twists"));
    EXPECT_EQ(twists.code, 0);
    EXPECT_FALSE(twists.json["surfaces"][0]["compatible"].asBool());
    std::size_t remedied = 0;
    for (const Json::Value& k : twists.json["surfaces"][0]["conditions"])
        if (!k["holds"].asBool()) {
            EXPECT_EQ(k["remedy"].asString(), "average");
            EXPECT_NEAR(k["gap"].asDouble(), 20, 1e-9);
            ++remedied;
        }
    EXPECT_EQ(remedied, 4u);

    const Checked network = checked(scene("s003_coons_network"));
    EXPECT_EQ(network.code, 0);
    EXPECT_EQ(network.json["lines"].size(), 6u);
    for (const Json::Value& l : network.json["lines"]) EXPECT_EQ(l["order"].asString(), "C1");
    EXPECT_EQ(network.json["edges"].size(), 0u);
}
TEST(CheckProgram, FarFromTheOriginRoundingIsNamed) {
    const TemporaryFolder t;
    const auto scene_at = [](const std::string& x) {
        return R"({"isoparm": 1, "surfaces": {"S": {"type": "transform", "translate": [)" + x + R"(, 0, 0], "surface": {"type": "composite", "members": [
          {"type": "bezier", "points": [[[0,0,0],[0,1,0.3]],[[1,0,0.1],[1,1,0.7]]]}, {"type": "bezier", "points": [[[1,0,0.1],[1,1,0.7]],[[2,0,0],[2,1,0.1]]]}]}}}})";
    };
    write_all(t / "near.json", scene_at("0")), write_all(t / "far.json", scene_at("1e9"));
    EXPECT_EQ(checked(t / "near.json").code, 0);
    expect("check " + t / "far.json", 1, "move the surfaces to the origin, or give a larger --tolerance");
    expect("check " + t / "far.json --tolerance 1e-3", 0, "");
}
TEST(CheckProgram, ErrorsSayWhatIsWrong) {
    const TemporaryFolder t;
    write_all(t / "apart.json", R"({"isoparm": 1, "surfaces": {"S": {"type": "coons",
        "c0": {"type": "line", "points": [[0,0,0], [1,0,0]]}, "c1": {"type": "line", "points": [[0,1,0], [1,1,0]]},
        "d0": {"type": "line", "points": [[0,0,0], [0,1,0]]}, "d1": {"type": "line", "points": [[1,0,0.01], [1,1,0]]}}}})");
    expect("check " + t / "apart.json", 65, "found a gap of 0.01");
    expect("check " + scene("coons") + " --tolerance 1px", 64, "needs a picture");
    expect("check " + scene("coons") + " --tolerance 0", 64, "");
    expect("check " + scene("coons") + " --angle 0", 64, "expected degrees above 0");
    expect("check " + scene("coons") + " --capture x", 64, "");
    expect("check " + scene("coons") + " --surface T", 64, "expected one of");
    expect("check", 64, "expected one scene");
    expect("check " + t / "missing.json", 4, "missing.json");
}

}  // namespace
}  // namespace isoparm::test
