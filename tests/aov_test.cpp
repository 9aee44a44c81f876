// aov_test.cpp -- channels beside the colours say what geometry says.
#include "picture/aov.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <map>

#include "expect_program.h"
#include "image/image.h"
#include "picture/palette.h"
#include "picture/picture.h"

namespace isoparm {
namespace {

using test::expect;
using test::TemporaryFolder;

std::vector<Aov> every_aov() {
    std::vector<Aov> all;
    for (const AovKind& k : all_aovs()) all.push_back(k.aov);
    return all;
}

/// A picture's channels by name.
class Channels {
public:
    explicit Channels(const Picture& p) : p_(p) {
        for (std::size_t i = 0; i < p.layers.channels.size(); ++i) at_[p.layers.channels[i]] = i;
    }
    double operator()(const std::string& name, int x, int y) const {
        return p_.layers.values.at((static_cast<std::size_t>(y) * p_.image.width + x) * at_.size() + at_.at(name));
    }
    Point point(const std::string& name, int x, int y) const { return {(*this)(name + ".X", x, y), (*this)(name + ".Y", x, y), (*this)(name + ".Z", x, y)}; }

private:
    const Picture& p_;
    std::map<std::string, std::size_t> at_;
};

Scene shipped(const std::string& name) { return load_scene(test::source_folder() + "/scenes/" + name + ".json"); }

RenderOptions small(int width, int height, int samples) {
    RenderOptions how;
    how.width = width, how.height = height, how.samples = samples;
    how.aovs = every_aov();
    return how;
}

// scenes/sphere.json: octants of the unit sphere about the origin.
TEST(Aov, OfTheUnitSphere) {
    const Scene scene = shipped("sphere");
    const Picture p = render(scene, small(60, 45, 4));
    const Channels at(p);
    std::vector<const Patch*> all;
    for (const Surface& s : scene.surfaces)
        for (const Member& m : s.patches) all.push_back(&m.patch);
    int patches = 0, others = 0;
    for (int y = 0; y < 45; ++y)
        for (int x = 0; x < 60; ++x) {
            const double number = at("patch.I", x, y);
            if (number < 0) {
                EXPECT_EQ(at("triangle.I", x, y), -1);
                EXPECT_EQ(at("error.V", x, y), 0);
                ++others;
                continue;
            }
            ++patches;
            const Point position = at.point("P", x, y), n = at.point("N", x, y), ng = at.point("Ng", x, y);
            EXPECT_NEAR(length(position), 1, 1e-6);
            EXPECT_NEAR(distance(n, position), 0, 2e-6);  // the front is seen: the normal is the position
            EXPECT_NEAR(length(ng), 1, 1e-6);
            EXPECT_GT(dot(n, ng), 0.98);
            const Patch& patch = *all.at(static_cast<std::size_t>(number));
            EXPECT_NEAR(distance(patch.point(at("uv.U", x, y), at("uv.V", x, y)), position), 0, 2e-6);
            EXPECT_NEAR(at("curvature.gaussian", x, y), 1, 1e-4);
            EXPECT_NEAR(std::fabs(at("curvature.mean", x, y)), 1, 1e-4);
            EXPECT_GT(at("error.V", x, y), 0);
            EXPECT_LE(at("error.V", x, y), p.certified_error * (1 + 1e-6));
            EXPECT_GE(at("triangle.I", x, y), 0);
        }
    EXPECT_GT(patches, 500);
    EXPECT_GT(others, 500);
}

Scene sheets(const std::string& objects, const std::string& more = "") {
    const TemporaryFolder folder;
    const std::string path = folder / "scene.json";
    test::write_all(path, R"({ "isoparm": 1, "surfaces": {
        "unseen": { "type": "bilinear", "points": [[0,0,9],[1,0,9],[0,1,9],[1,1,9]] },
        "low": { "type": "bilinear", "points": [[-2,-2,0],[2,-2,0],[-2,2,0],[2,2,0]] },
        "high": { "type": "bilinear", "points": [[-1,-1,1],[1,-1,1],[-1,1,1],[1,1,1]] } },)" + objects + more +
                              R"( "camera": { "eye": [0,0,10], "target": [0,0,0], "up": [0,1,0], "fov": 40 },
        "image": { "width": 40, "height": 40, "samples": 16, "background": [0.25,0.5,0.75] } })");
    return load_scene(path);
}

TEST(Aov, AreThoseOfTheNearestThingWhateverItsOpacity) {
    const Picture p = render(sheets(R"("objects": [ { "surface": "low", "color": [0.5,0.25,0.125] }, { "surface": "high", "opacity": 0.3, "color": [0.125,0.25,0.5] },
                                                   { "point": [0,0,2], "radius": 0.25 } ],)"), small(40, 40, 16));
    const Channels at(p);
    EXPECT_EQ(at("patch.I", 20, 20), -1);  // the ball: nearest, and no patch
    EXPECT_NEAR(at("Z", 20, 20), 7.75, 0.03);
    EXPECT_EQ(at("patch.I", 15, 20), 2);
    EXPECT_NEAR(at("Z", 15, 20), 9, 1e-5);  // along the axis, off the axis too
    EXPECT_NEAR(at("albedo.R", 15, 20), linear_from_srgb(0.125), 1e-6);
    EXPECT_EQ(at("patch.I", 9, 9), 1);
    EXPECT_NEAR(at("Z", 9, 9), 10, 1e-5);
    EXPECT_NEAR(at("albedo.R", 9, 9), linear_from_srgb(0.5), 1e-6);
    EXPECT_EQ(at("curvature.gaussian", 9, 9), 0);
    EXPECT_EQ(at("patch.I", 0, 0), -1);
    EXPECT_EQ(at("Z", 0, 0), 1e10f);
    EXPECT_EQ(at("variance.G", 0, 0), 0);
    // A pixel whose samples fall on the ball's edge and on what is behind varies more than one inside.
    double most = 0;
    for (int x = 15; x < 25; ++x) most = std::max(most, at("variance.G", x, 20));
    EXPECT_GT(most, 4 * at("variance.G", 20, 20));
}

TEST(Aov, PatchesKeepTheirNumbersInPanels) {
    const Picture p = render(sheets("", R"("panels": [ { "objects": [ { "surface": "high" } ] }, { "objects": [ { "surface": "low" } ] } ],)"), small(80, 40, 1));
    const Channels at(p);
    EXPECT_EQ(at("patch.I", 20, 20), 2);
    EXPECT_EQ(at("patch.I", 60, 20), 1);
    EXPECT_EQ(at("patch.I", 0, 0), -1);
    EXPECT_EQ(at("variance.R", 20, 20), 0);
}

TEST(AovThreads, AreTheSameForEveryNumberAndInCrops) {
    const Scene scene = shipped("coons");
    const RenderOptions how = small(48, 36, 4);
    std::vector<float> first;
    for (const int threads : {1, 2, 7}) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        const auto values = render(scene, how).layers.values;
        if (first.empty()) first = values;
        EXPECT_EQ(values, first) << threads;
    }
    for (const float x : first) ASSERT_TRUE(std::isfinite(x));
    RenderOptions cropped = how;
    cropped.crop = {13, 9, 40, 30};
    const Picture part = render(scene, cropped);
    const std::size_t channels = part.layers.channels.size();
    for (int y = 9; y < 30; ++y)
        for (std::size_t i = 0; i < 27 * channels; ++i)
            ASSERT_EQ(part.layers.values[(y - 9) * 27 * channels + i], first[(y * 48 + 13) * channels + i]);
}

TEST(Aov, LieBesideTheSameColoursInTheFile) {
    const TemporaryFolder folder;
    const std::string how = "render " + test::scene("coons") + " --size 48x36 --samples 2 --quiet -o '";
    EXPECT_EQ(test::run(how + folder / "with.exr" + "' --aov all").code, 0);
    EXPECT_EQ(test::run(how + folder / "some.exr" + "' --aov=Z,uv").code, 0);
    EXPECT_EQ(test::run(how + folder / "without.exr'").code, 0);
    EXPECT_EQ(read_image(folder / "with.exr").pixels, read_image(folder / "without.exr").pixels);
    const std::string with = test::read_all(folder / "with.exr"), some = test::read_all(folder / "some.exr");
    for (const std::string& name : channels_of(every_aov())) EXPECT_NE(with.find(name + '\0'), std::string::npos) << name;
    EXPECT_NE(some.find(std::string("uv.V") + '\0'), std::string::npos);
    EXPECT_EQ(some.find("albedo"), std::string::npos);
    EXPECT_NE(with.find("isoparm:patches"), std::string::npos);
}

TEST(Aov, BadRequestsSayWhatIsPossible) {
    const std::string how = "render " + test::scene("coons") + " -o /tmp/never-written-by-isoparm";
    expect(how + ".png --aov all", 64, "expected a file with the extension .exr");
    expect(how + ".exr --aov N,albdo", 64, "did you mean \"albedo\"?");
    expect(how + ".exr --aov N,", 64, "found \"\", expected all, or some of N, Ng, P, uv");
    EXPECT_FALSE(std::filesystem::exists("/tmp/never-written-by-isoparm.exr"));
}

}  // namespace
}  // namespace isoparm
