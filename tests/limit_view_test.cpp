// The image-space form of `isoparm limit`: what is one surface makes one picture; what is not differs where and as much as it does.
#include "commands/limit_view.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "cages.h"
#include "commands/command.h"
#include "error.h"
#include "io/atomic_file.h"
#include "io/cage_obj.h"
#include "limit.h"
#include "scene/json.h"
#include "subdivision/limit_composite.h"

namespace isoparm::test {
namespace {

std::string cage_path(const std::string& name) { return std::string(ISOPARM_SOURCE_DIR) + "/tests/data/cages/" + name + ".obj"; }
Cage read(const std::string& name) { return read_cage_obj(read_text_file(cage_path(name)), name); }

LimitView view(const Cage& cage, Scheme scheme, int width = 96, int height = 72) {
    return view_limit(LimitSurface(cage, scheme), LimitFaces(cage, scheme), width, height).value();
}

TEST(LimitView, RegularCagesMakeTwoEqualPictures) {
    for (const char* name : {"torus", "creased"}) {
        const LimitView v = view(read(name), Scheme::catmull_clark);
        EXPECT_EQ(v.left_out, 0) << name;
        EXPECT_GT(v.both, 500) << name;
        EXPECT_LT(v.color_max, 1e-5) << name;
        EXPECT_LT(v.normal_max_degrees, 1e-4) << name;
        EXPECT_EQ(v.silhouette_differing, 0) << name;
        EXPECT_EQ(v.silhouette_distance, 0) << name;
        EXPECT_EQ(v.pictures.inside.size(), 96u * 72u) << name;
    }
}

/// One Gregory patch for each sixth of the cube's limit is off it by a tenth of its size: see docs/limit.md.
TEST(LimitView, DifferencesAreSeenInColoursNormalsAndSilhouettes) {
    const LimitView v = view(cube_cage(), Scheme::catmull_clark);
    EXPECT_GT(v.color_rms, 0.02);
    EXPECT_GT(v.color_max, v.color_rms);
    EXPECT_LE(v.color_max, 1);
    EXPECT_GT(v.normal_mean_degrees, 1);
    EXPECT_GT(v.normal_max_degrees, v.normal_mean_degrees);
    EXPECT_GT(v.silhouette_distance, 1);
    EXPECT_EQ(v.silhouette_differing, std::count(v.pictures.inside.begin(), v.pictures.inside.end(), 1) + std::count(v.pictures.inside.begin(), v.pictures.inside.end(), 2));
    EXPECT_EQ(v.both, std::count(v.pictures.inside.begin(), v.pictures.inside.end(), 3));
    // The same in the arrays that become pictures.
    double most = 0;
    for (const float d : v.pictures.degrees) most = std::max(most, std::isnan(d) ? 0 : double(d));
    EXPECT_FLOAT_EQ(float(most), float(v.normal_max_degrees));
    EXPECT_FLOAT_EQ(*std::max_element(v.pictures.color.begin(), v.pictures.color.end()), float(v.color_max));
}

/// The distance of silhouettes is that of the surfaces over the size of a pixel: three times the pixels, three times the distance.
TEST(LimitView, SilhouettesAreFartherInLargerPictures) {
    const LimitView a = view(cube_cage(), Scheme::catmull_clark, 64, 48), b = view(cube_cage(), Scheme::catmull_clark, 192, 144);
    EXPECT_NEAR(b.silhouette_distance / a.silhouette_distance, 3, 1.5);
    EXPECT_NEAR(b.normal_mean_degrees, a.normal_mean_degrees, 0.1 * a.normal_mean_degrees);
}

TEST(LimitComposite, PatchesAreThoseOfTheLimitAtTheirCorners) {
    const Cage cage = prism_cage();
    const LimitComposite c = make_limit_composite(LimitSurface(cage, Scheme::catmull_clark), LimitFaces(cage, Scheme::catmull_clark));
    ASSERT_EQ(c.limit.size(), 15u) << "two pentagons of five, five quads";
    ASSERT_EQ(c.composite.size() + std::size_t(c.left_out), 15u);
    for (std::size_t k = 0; k < c.limit.size(); ++k) {
        EXPECT_EQ(c.limit[k].name, c.composite[k].name);
        for (const double u : {0.0, 1.0})
            for (const double v : {0.0, 1.0}) EXPECT_LT(distance(c.limit[k].patch.point(u, v), c.composite[k].patch.point(u, v)), 1e-12);
    }
}

TEST(LimitView, FacesWithoutTangentsAreLeftOutOfBothPictures) {
    const Cage cage = l_cage();  // a corner inwards: its faces have no patch of the composite
    const LimitComposite c = make_limit_composite(LimitSurface(cage, Scheme::catmull_clark), LimitFaces(cage, Scheme::catmull_clark));
    EXPECT_GT(c.left_out, 0);
    EXPECT_EQ(c.limit.size() + std::size_t(c.left_out), cage.faces.size());
    EXPECT_EQ(view(cage, Scheme::catmull_clark).left_out, c.left_out);
}

TEST(LimitView, CagesThatNoRayMeetsAreNotCalledEqual) {
    Cage cage = cube_cage();
    for (Point& p : cage.positions) p = 1e-30 * p;
    EXPECT_FALSE(view_limit(LimitSurface(cage, Scheme::catmull_clark), LimitFaces(cage, Scheme::catmull_clark), 96, 72));
}

TEST(LimitView, TheCommandTellsAndDrawsIt) {
    const std::string folder = testing::TempDir() + "isoparm_limit_view";
    testing::internal::CaptureStdout();
    EXPECT_EQ(limit_command.run({cage_path("icosahedron"), "--scheme", "loop", "--levels", "1", "--json", "--image", "64x48", "-o", folder}), 0);
    const Json image = Json::parse(testing::internal::GetCapturedStdout(), "out").at("image", "");
    EXPECT_EQ(image.at("width", "").number(), 64);
    EXPECT_EQ(image.at("patches", "").number(), 20);
    EXPECT_GT(image.at("color", "").at("rms", "").number(), 1e-4);
    EXPECT_GT(image.at("normals", "").at("mean_degrees", "").number(), 0.5);
    EXPECT_LT(image.at("silhouette", "").at("distance", "").number(), 3);
    for (const auto& name : limit_view_files()) EXPECT_TRUE(std::filesystem::exists(folder + "/" + name)) << name;
    const Image limit = read_image(folder + "/view-limit.png"), sheet = read_image(folder + "/view-difference.png");
    EXPECT_EQ(limit.width, 64);
    EXPECT_GT(sheet.width, 3 * 64);
    std::filesystem::remove_all(folder);

    testing::internal::CaptureStdout();
    EXPECT_EQ(limit_command.run({cage_path("plane"), "--json"}), 0);
    EXPECT_TRUE(Json::parse(testing::internal::GetCapturedStdout(), "out").at("image", "").is(Json::Kind::null));
    for (const char* size : {"", "640", "8x8", "640x", "0x480", "-1x480", "1e3x480", "640x480x2", "640x1000000000"})
        EXPECT_THROW(limit_command.run({cage_path("plane"), "--image", size}), Error) << size;
}

}  // namespace
}  // namespace isoparm::test
