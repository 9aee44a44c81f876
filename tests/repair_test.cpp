// "repair": true in scenes: the curves are put right, it is said once, and nothing else changes.
#include "scene/repair.h"

#include <gtest/gtest.h>

#include "curves/bspline.h"
#include "curves/line.h"
#include "curves/modify.h"
#include "run_program.h"
#include "samples.h"

namespace isoparm::test {
namespace {

using tests::Random;

// A square with d1 drawn downwards, and a net of lines in the wrong order.
const std::string kCurves = R"("curves": {
    "s": { "type": "line", "points": [[0,0,0], [1,0,0]] }, "n": { "type": "line", "points": [[0,1,0], [1,1,1]] },
    "w": { "type": "line", "points": [[0,0,0], [0,1,0]] }, "e": { "type": "line", "points": [[1,1,1], [1,0,0]] },
    "diagonal": { "type": "line", "points": [[1,0,0], [0,1,0]] } },)";
std::string scene_of(const std::string& surface) { return "{ \"isoparm\": 1, " + kCurves + " \"surfaces\": { \"S\": " + surface + " } }"; }
const std::string kCoons = R"({ "type": "coons", "c0": "s", "c1": "n", "d0": "w", "d1": "e", "repair": true })";
const std::string kNote = ": at $.surfaces.S: curves repaired: d1 reversed\n";

TEST(Repair, IsSaidOnceByEveryCommand) {
    const TemporaryFolder t;
    write_all(t / "scene.json", scene_of(kCoons));
    for (const char* command : {"info scene.json", "eval scene.json --at 0.5,0.5", "tessellate scene.json -o m.ply", "render scene.json -o p.png --size 8x6 --samples 1"}) {
        const Outcome o = run(command, t.path());
        EXPECT_EQ(o.code, 0) << o.err;
        EXPECT_EQ(o.err.rfind("isoparm: note: scene.json:", 0), 0u) << o.err;
        const auto at = o.err.find(kNote);
        ASSERT_NE(at, std::string::npos) << o.err;
        EXPECT_EQ(o.err.find("note:", at), std::string::npos) << o.err;
        EXPECT_EQ(run(std::string(command) + " --quiet", t.path()).err, "");
    }
    EXPECT_NE(run("info scene.json", t.path()).out.find("\nnotes\n  scene.json:"), std::string::npos);
    const Json notes = Json::parse(run("info --json scene.json", t.path()).out, "info").at("notes", "the notes");
    ASSERT_EQ(notes.size(), 1u);
    EXPECT_NE((notes[0].string() + "\n").find(kNote), std::string::npos);
}
TEST(Repair, GivesTheSurfaceOfTheRightCurves) {
    const TemporaryFolder t;
    write_all(t / "a.json", scene_of(kCoons));
    write_all(t / "b.json", scene_of(R"({ "type": "coons", "c0": "s", "c1": "n", "d0": "w", "d1": { "type": "reverse", "curve": "e" } })"));
    const Outcome a = run("eval a.json --surface S --at 0.3,0.8 --json", t.path()), b = run("eval b.json --surface S --at 0.3,0.8 --json", t.path());
    EXPECT_EQ(a.code, 0) << a.err;
    EXPECT_EQ(a.out, b.out);
    EXPECT_EQ(b.err, "");
}
TEST(Repair, WorksForEveryTypeOfCurves) {
    const std::string line = R"({ "type": "line", "points": )";
    const std::string zero_u = line + "[[1,0,0], [1,0,1]] }", along_v = line + "[[0,1,0], [0,1,1]] }";
    const std::vector<std::array<std::string, 2>> cases{
        // One change, with v upside down, instead of three.
        {R"({ "type": "network", "a": ["w", "e"], "b": ["n", "s"], "repair": true })", "curves repaired: a[0] reversed\n"},
        {R"({ "type": "coons_triangle", "method": "side_vertex", "edges": ["w", "s", "diagonal"], "repair": true })", "curves repaired: E1 reversed"},
        {R"({ "type": "coons_hermite", "repair": true, "f": ["w", )" + zero_u + ", " + zero_u + R"(, "e"], "g": ["s", )" + along_v + ", " + along_v + R"(, "n"] })",
         "curves repaired: f[3] reversed"},
    };
    for (const auto& [surface, note] : cases) {
        const TemporaryFolder t;
        write_all(t / "scene.json", scene_of(surface));
        const Outcome o = run("info scene.json", t.path());
        EXPECT_EQ(o.code, 0) << o.err;
        EXPECT_NE(o.err.find(note), std::string::npos) << o.err;
    }
}
TEST(Repair, LeavesCurvesThatFitAlone) {
    const TemporaryFolder t;
    write_all(t / "scene.json", scene_of(R"({ "type": "coons", "c0": "s", "c1": "n", "d0": "w", "d1": { "type": "reverse", "curve": "e" }, "repair": true })"));
    const Outcome o = run("info --json scene.json", t.path());
    EXPECT_EQ(o.code, 0);
    EXPECT_EQ(o.err, "");
    EXPECT_NE(o.out.find("\"notes\": []"), std::string::npos) << o.out;
}

// ---- the data of every type -----------------------------------------------------------------------------------------
TEST(Repair, CarriesWhatIsGivenAlongTheEdgesOfATriangle) {
    Random random(1);
    const auto e = tests::random_triangle(random);
    std::array<Curve, 3> along{tests::random_cubic(random, {}, {1, 2, 3}), tests::random_cubic(random, {}, {1, 0, 3}), tests::random_cubic(random, {}, {1, 2, 0})};
    const auto c = cure(TriangleCurves{{reversed(e[1]), e[0], e[2]}, {reversed(along[1]), along[0], along[2]}});
    ASSERT_TRUE(c.data);
    // Whatever the order is now, an edge has kept its own data, in its own direction.
    for (int k = 0; k < 3; ++k) {
        int owners = 0;
        for (int i = 0; i < 3; ++i)
            for (bool back : {false, true}) {
                const Curve edge = back ? reversed(e[i]) : e[i], data = back ? reversed(along[i]) : along[i];
                if (distance(c.data->edges[k](0.3), edge(0.3)) > 1e-12) continue;
                ++owners;
                EXPECT_LT(distance(c.data->along[k](0.3), data(0.3)), 1e-12);
            }
        EXPECT_EQ(owners, 1);
        EXPECT_LT(distance(c.data->edges[k](1), c.data->edges[(k + 1) % 3](0)), 1e-12);
    }
}
TEST(Repair, OfACommonStart) {
    const CommonStart given{make_line({1, 0, 0}, {0, 0, 0}), make_line({0, 0, 0}, {0, 1, 0})};
    const auto c = cure(given);
    ASSERT_TRUE(c.data);
    EXPECT_EQ(c.data->c(0), c.data->d(0));
    EXPECT_EQ(c.changes, "c reversed");
}
TEST(Repair, OfControlPolygonsMirrorsTheKnots) {
    const SplineCurve c{2, {0, 0, 0, 0.25, 1, 1, 1}, {{0, 0, 0}, {1, 0, 1}, {2, 0, 1}, {3, 0, 0}}};
    SplineCurve back = c;
    back.knots = {0, 0, 0, 0.75, 1, 1, 1};
    std::reverse(back.points.begin(), back.points.end());
    for (auto* s : {&back})
        for (auto& p : s->points) p = p + Point{0, 1, 0};
    const SplineCurve d0{1, {0, 0, 1, 1}, {{0, 0, 0}, {0, 1, 0}}}, d1{1, {0, 0, 1, 1}, {{3, 0, 0}, {3, 1, 0}}};
    const auto cured = cure(ControlFrame{c, back, d0, d1});
    ASSERT_TRUE(cured.data);
    EXPECT_EQ(cured.changes, "c1 reversed");
    EXPECT_EQ(cured.data->c1.knots, c.knots);
    for (std::size_t k = 0; k < 4; ++k) EXPECT_EQ(cured.data->c1.points[k], (c.points[k] + Point{0, 1, 0}));
}
TEST(Repair, OfAGordonNetworkWithItsFamiliesExchanged) {
    const auto across = [](double v) { return make_line({0, v, 0}, {1, v, v}); };  // of the surface (u, v, u v)
    const auto up = [](double u) { return make_line({u, 0, 0}, {u, 1, u}); };
    const GordonNetwork right{{across(0), across(0.3), across(1)}, {0, 0.3, 1}, {up(0), up(1)}, {0, 1}};
    EXPECT_TRUE(cure(right).fits);
    const auto c = cure(GordonNetwork{right.v_curves, right.v_nodes, {right.u_curves[2], right.u_curves[1], reversed(right.u_curves[0])}, right.u_nodes});
    ASSERT_TRUE(c.data) << c.misfit;
    EXPECT_NE(c.misfit.find("2 curves u_curves stand for 3 nodes"), std::string::npos) << c.misfit;
    EXPECT_NE(c.changes.find("u_curves[0] from v_curves["), std::string::npos) << c.changes;
    EXPECT_TRUE(cure(*c.data).fits);
}

}  // namespace
}  // namespace isoparm::test
