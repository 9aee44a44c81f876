// exact_pieces_test.cpp -- what pieces say of a surface and its derivatives is what intervals of its formula say, up to the proved errors.
#include "rays/exact_pieces.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "expect_program.h"
#include "rays/exact_patch.h"
#include "scene/scene.h"

namespace isoparm {
namespace {

struct Compared {
    int places = 0, none = 0, wrong = 0, parts = 0, wrong_parts = 0;
};
/// At random places of the leaves of a surface; errors, and what is left of enclosed ranges about their middles, times `part`.
Compared compare(const std::string& scene_name, const std::string& surface, double part) {
    const Scene scene = load_scene(test::source_folder() + "/scenes/" + scene_name + ".json");
    const double size = bounding_box(scene).diagonal();
    const Patch& patch = scene.find_surface(surface)->patches[0].patch;
    const ExactPatch exact(patch, size);
    const ExactPieces pieces(patch, size, exact.leaves());
    std::mt19937_64 random(3);
    const auto number = [&](double low, double high) { return std::uniform_real_distribution<>(low, high)(random); };
    Compared result;
    for (int k = 0; k < 2000; ++k) {
        const auto leaf = static_cast<std::size_t>(number(0, double(exact.leaves()) - 1e-9));
        const LeafMap& map = exact.map(leaf);
        const double u = number(map.box.u.lo, map.box.u.hi), v = number(map.box.v.lo, map.box.v.hi);
        if (patch.domain() == Domain::triangle && u + v > 1 - 1e-12) continue;
        ++result.places;
        const auto exact_jets = patch.enclose({Interval(u), Interval(v)}).centre;
        // Of an eighth of the leaf about that place.
        const auto about = [&](const Interval& t, double x) { return Interval(std::max(t.lo, x - rad(t) / 8), std::min(t.hi, x + rad(t) / 8)); };
        const Box box{about(map.box.u, u), about(map.box.v, v)};
        if (const auto e = pieces.enclose(leaf, map.box, box)) {
            ++result.parts;
            for (int axis = 0; axis < 3; ++axis)
                for (int c = 0; c < 6; ++c) {
                    const Interval& over = e->over[axis].c[c];
                    const Interval& at = exact_jets[axis].c[c];
                    result.wrong_parts += std::fabs(mid(at) - mid(over)) > part * rad(over) + rad(at);
                }
        }
        const ExactPiece* piece = pieces.at(leaf, map.box, exact.cell(leaf), u, v);
        if (!piece) {
            ++result.none;
            continue;
        }
        EXPECT_LE(piece->error.position, ExactPieces::wanted * size);
        double x[9], *rows[9];
        for (int i = 0; i < 9; ++i) rows[i] = x + i;
        piece->frames(1, &u, &v, rows);
        const double error[] = {piece->error.position, piece->error.du, piece->error.dv};
        for (int c = 0; c < 3; ++c)
            for (int axis = 0; axis < 3; ++axis) {
                const Interval& at = exact_jets[axis].c[c];
                result.wrong += std::fabs(x[3 * c + axis] - mid(at)) > part * error[c] + rad(at);
            }
    }
    return result;
}

TEST(ExactPieces, AreWithinTheirErrors) {
    for (const auto& [scene, surface] : {std::pair{"side_vertex", "shell"}, {"s004_gregory", "square"}}) {
        const Compared c = compare(scene, surface, 1);
        EXPECT_GT(c.places, 900) << scene;
        EXPECT_LT(c.none, c.places / 20) << scene;
        EXPECT_GT(c.parts, c.places / 2) << scene;
        EXPECT_EQ(c.wrong, 0) << scene;
        EXPECT_EQ(c.wrong_parts, 0) << scene;
    }
}

// Errors and ranges that were much smaller would be found out.
TEST(ExactPieces, SmallerErrorsAreDenied) {
    for (const auto& [scene, surface] : {std::pair{"side_vertex", "shell"}, {"s004_gregory", "square"}}) {
        const Compared c = compare(scene, surface, 1e-3);
        EXPECT_GT(c.wrong, 0) << scene;
        EXPECT_GT(c.wrong_parts, 0) << scene;
    }
}

}  // namespace
}  // namespace isoparm
