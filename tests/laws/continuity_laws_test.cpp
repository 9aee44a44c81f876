// continuity_laws_test.cpp -- the models that jumps are bounded by hold what they model: for all operations, and every type of patch.
#include <gtest/gtest.h>

#include "joints/edge_side.h"
#include <functional>

#include "curves/modify.h"
#include "promises.h"
#include "samples.h"

namespace isoparm::tests {
namespace {

struct Known {  // a model, and the function that it encloses
    TaylorModel model;
    std::function<double(double)> f;
};

TEST(TaylorModelLaws, EveryOperationEnclosesItsFunction) {
    Random random(7);
    for (int round = 0; round < 300; ++round) {
        std::vector<Known> known;
        for (int k = 0; k < 2; ++k) {
            const double a = random.number(-2, 2), b = random.number(-2, 2);
            known.push_back({TaylorModel::linear(a, b), [a, b](double d) { return a + b * d; }});
        }
        known.push_back({TaylorModel(Interval(0.5, 0.75)), [](double) { return 0.6; }});
        known[2].model.widen(Interval(-0.125, 0.25));
        for (int step = 0; step < 8; ++step) {
            const Known x = known[std::size_t(random.integer(0, int(known.size()) - 1))], y = known[std::size_t(random.integer(0, int(known.size()) - 1))];
            switch (random.integer(0, 4)) {
                case 0: known.push_back({x.model + y.model, [x, y](double d) { return x.f(d) + y.f(d); }}); break;
                case 1: known.push_back({x.model - y.model, [x, y](double d) { return x.f(d) - y.f(d); }}); break;
                case 2: known.push_back({x.model * y.model, [x, y](double d) { return x.f(d) * y.f(d); }}); break;
                case 3: known.push_back({x.model / y.model, [x, y](double d) { return x.f(d) / y.f(d); }}); break;
                default: known.push_back({sqrt(x.model), [x](double d) { return std::sqrt(x.f(d)); }});
            }
            const Known& z = known.back();
            if (!z.model.bounded()) {
                known.pop_back();
                continue;
            }
            const Interval range = z.model.range();
            for (int k = 0; k <= 20; ++k) {
                const double d = k / 10.0 - 1, value = z.f(d), slack = 1e-9 * (1 + std::fabs(value));
                ASSERT_TRUE(std::isfinite(value)) << "a bounded model of something that is not, round " << round;
                ASSERT_GE(value, range.lo - slack);
                ASSERT_LE(value, range.hi + slack);
                ASSERT_GE(value, z.model.at(d).lo - slack);
                ASSERT_LE(value, z.model.at(d).hi + slack);
            }
        }
    }
}
TEST(TaylorModelLaws, QuotientsAndRootsAreSharpOnShortPieces) {
    const TaylorModel x = TaylorModel::linear(2, 0.25);
    EXPECT_LT(mag((TaylorModel(1.0) / x).rest()), 1e-13);
    EXPECT_LT(mag(sqrt(x).rest()), 1e-13);
    const TaylorModel part = (x * x * x).restricted(0.5, 0.5);  // d in [0,1]
    EXPECT_NEAR(part.range().lo, 8, 1e-2);
    EXPECT_NEAR(part.at(1).lo, 2.25 * 2.25 * 2.25, 1e-12);
}
TEST(TaylorModelLaws, WhatHasNoBoundSaysSo) {
    const TaylorModel x = TaylorModel::linear(0.5, 1);
    EXPECT_FALSE((TaylorModel(1.0) / x).bounded());
    EXPECT_FALSE(sqrt(x).bounded());
    EXPECT_FALSE(((TaylorModel(1.0) / x) * TaylorModel(0.0)).bounded());
    EXPECT_FALSE(TaylorModel(Interval::all()).bounded());
}

class EdgeLaws : public ::testing::TestWithParam<PatchType> {};

TEST_P(EdgeLaws, ModelsOfAnEdgeHoldTheJetsOnIt) {
    Random random(11);
    const PatchSample sample = GetParam().make(random);
    const Patch& patch = sample.patch;
    for (int edge = 0; edge < patch.edges(); ++edge) {
        std::vector<double> cuts{0};
        for (const double b : patch.edge_breaks(edge)) cuts.push_back(b);
        cuts.push_back(1);
        const std::size_t cell = std::size_t(random.integer(0, int(cuts.size()) - 2));
        const ParameterLine line = edge_line(patch, edge, cuts[cell], cuts[cell + 1]);
        const EdgeSide side(patch, line, line.cross);
        for (const double half : {0.5, 0.1, 1e-3, 0.0}) {
            const double middle = random.number(half, 1 - half);
            const EdgeSide::Jet models = side.jet(middle, half);
            for (int k = 0; k < 9; ++k) {
                const double d = random.number(-0.99, 0.99), s = middle + half * d;
                const Vec2 along{line.to.x - line.from.x, line.to.y - line.from.y}, &across = line.cross;
                Vec2 p = side.at(s);
                if (patch.domain() == Domain::triangle && edge == 2) p.y = 1 - p.x;
                const PointJet x = patch.jet(p.x, p.y);
                for (int axis = 0; axis < 3; ++axis) {
                    const auto c = [&](int i, int j) { return x[axis].coefficient(i, j); };
                    const auto second = [&](const Vec2& a, const Vec2& b) { return 2 * c(2, 0) * a.x * b.x + c(1, 1) * (a.x * b.y + a.y * b.x) + 2 * c(0, 2) * a.y * b.y; };
                    const double expected[] = {c(0, 0), c(1, 0) * along.x + c(0, 1) * along.y, c(1, 0) * across.x + c(0, 1) * across.y, second(along, along) / 2, second(along, across), second(across, across) / 2};
                    for (int n = 0; n < 6; ++n) {
                        const Interval at = models[axis].c[n].at(d);
                        if (!std::isfinite(expected[n])) continue;
                        const double slack = 1e-7 * (1 + std::fabs(expected[n]));
                        ASSERT_GE(expected[n], at.lo - slack) << "edge " << edge << ", coefficient " << n << ", half " << half << ", s " << s;
                        ASSERT_LE(expected[n], at.hi + slack) << "edge " << edge << ", coefficient " << n << ", half " << half << ", s " << s;
                        if (half > 0) continue;
                        ASSERT_LT(at.hi - at.lo, slack) << "edge " << edge << ", coefficient " << n << ", s " << s;
                    }
                }
            }
        }
    }
}
TEST_P(EdgeLaws, ResidualsOfTheBoundaryAreBoundedAndNoticed) {
    Random random(12);
    const PatchSample sample = GetParam().make(random);
    const double h = 1e-2, near = 1e-4;
    if (sample.boundary.empty()) return;
    const std::size_t k = std::size_t(random.integer(0, int(sample.boundary.size()) - 1));  // one edge: some types take a second for each
    if (std::find(sample.free.begin(), sample.free.end(), int(k)) == sample.free.end()) {
        const Promise kept{"boundary", edge_line(sample.patch, int(k), 0, 1), sample.boundary[k], 0, 0};
        EXPECT_LE(bound_residual(sample.patch, kept, near).upper, near) << k;
        Promise broken = kept;
        broken.curve = transformed(kept.curve, Transform::translate({0, h, 0}));
        const JumpBound b = bound_residual(sample.patch, broken, near);
        EXPECT_LE(b.lower, h + 1e-9) << k;
        EXPECT_GE(b.lower, 0.9 * h) << k;
        EXPECT_GE(b.upper, h - 1e-9) << k;
    }
}
INSTANTIATE_TEST_SUITE_P(Patches, EdgeLaws, ::testing::ValuesIn(patch_types()), [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace isoparm::tests
