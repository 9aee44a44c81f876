// patch_laws_test.cpp -- what every surface type must satisfy at points. New types: one row in samples_*.cpp.
#include <gtest/gtest.h>

#include "error.h"
#include "patches/tensor_bezier.h"
#include "patches/transformed.h"
#include "samples.h"

namespace isoparm::tests {
namespace {

constexpr int kInstances = 4;

class PatchLaw : public ::testing::TestWithParam<PatchType> {
protected:
    template <class F> void each(F law) const {
        for (int seed = 1; seed <= kInstances; ++seed) {
            SCOPED_TRACE("seed " + std::to_string(seed));
            Random random(seed);
            const PatchSample sample = GetParam().make(random);
            law(sample, random);
        }
    }
};

bool near(const std::vector<double>& breaks, double t, double h) {
    return std::any_of(breaks.begin(), breaks.end(), [&](double b) { return std::abs(t - b) <= 2 * h; });
}
Point coefficient(const PointJet& x, int i, int j) {
    return {x.x.coefficient(i, j), x.y.coefficient(i, j), x.z.coefficient(i, j)};
}

TEST_P(PatchLaw, InterpolatesItsBoundary) {
    each([](const PatchSample& s, Random& r) {
        const double size = size_of_sample(s.patch);
        for (std::size_t k = 0; k < s.boundary.size(); ++k) {
            if (std::count(s.free.begin(), s.free.end(), int(k))) continue;
            const Curve& c = s.boundary[k];
            for (int n = 0; n <= 20; ++n) {
                const double t = n < 2 ? n : r.number();
                const Vec2 p = s.patch.edge_point(int(k), t);
                EXPECT_LE(distance(s.patch.point(p.x, p.y), c(c.begin() + t * (c.end() - c.begin()))), 2e-14 * size)
                    << s.patch.edge_name(int(k)) << " at " << t;
            }
        }
    });
}

TEST_P(PatchLaw, JetsAgreeWithCentralDifferences) {
    each([](const PatchSample& s, Random& r) {
        const Patch& patch = s.patch;
        const Rect rect = patch.rect();
        const double size = size_of_sample(patch), hu = 1e-5 * (rect.u1 - rect.u0), hv = 1e-5 * (rect.v1 - rect.v0);
        for (int n = 0; n < 20; ++n) {
            const Vec2 p = random_parameter(r, patch, 0.02);
            if (near(patch.breaks_u(), p.x, hu) || near(patch.breaks_v(), p.y, hv)) continue;
            const PointJet at = patch.jet(p.x, p.y), u0 = patch.jet(p.x - hu, p.y), u1 = patch.jet(p.x + hu, p.y),
                           v0 = patch.jet(p.x, p.y - hv), v1 = patch.jet(p.x, p.y + hv);
            EXPECT_LE(distance(patch.point(p.x, p.y), coefficient(at, 0, 0)), 1e-14 * size);
            for (int i = 0; i <= 1; ++i)
                for (int j = 0; i + j <= 1; ++j) {
                    const double scale =
                        1e-6 * (size + length(coefficient(at, i + 1, j)) + length(coefficient(at, i, j + 1))) /
                        std::min(hu, hv) * 1e-5 * 10;
                    const Point du = (coefficient(u1, i, j) - coefficient(u0, i, j)) / (2 * hu * (i + 1)),
                                dv = (coefficient(v1, i, j) - coefficient(v0, i, j)) / (2 * hv * (j + 1));
                    EXPECT_LE(distance(du, coefficient(at, i + 1, j)), scale)
                        << "d/du of (" << i << "," << j << ") at " << p.x << ", " << p.y;
                    EXPECT_LE(distance(dv, coefficient(at, i, j + 1)), scale)
                        << "d/dv of (" << i << "," << j << ") at " << p.x << ", " << p.y;
                }
        }
    });
}

TEST_P(PatchLaw, PacksEqualScalarsBitForBit) {
    each([](const PatchSample& s, Random& r) {
        const Patch& patch = s.patch;
        for (double spread : {0.01, 1.0})
            for (std::size_t count : {1, 7, 8, 31, 64}) {
                std::vector<double> u(count), v(count);
                const Vec2 middle = random_parameter(r, patch);
                for (std::size_t i = 0; i < count; ++i) {
                    const Vec2 p = random_parameter(r, patch);
                    u[i] = middle.x + spread * (p.x - middle.x), v[i] = middle.y + spread * (p.y - middle.y);
                    if (i % 5 == 4) {  // on an edge, and at its ends: the singular places
                        const Vec2 e = patch.edge_point(int(i) % patch.edges(), i % 3 ? double(i % 2) : r.number());
                        u[i] = e.x, v[i] = e.y;
                    }
                }
                std::vector<Point> out(count);
                patch.points(count, u.data(), v.data(), out.data());
                for (std::size_t i = 0; i < count; ++i)
                    EXPECT_TRUE(out[i] == patch.point(u[i], v[i])) << u[i] << ", " << v[i];
            }
    });
}

TEST_P(PatchLaw, MovesWithItsData) {
    const Point offset{1000, -700, 400};
    double worst = 0;
    for (int seed = 1; seed <= kInstances; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        Random here(seed), there(seed, offset), r(seed);
        const Patch a = GetParam().make(here).patch, b = GetParam().make(there).patch;
        for (int n = 0; n < 30; ++n) {
            const Vec2 p = random_parameter(r, a);
            worst = std::max(worst, distance(a.point(p.x, p.y) + offset, b.point(p.x, p.y)) / length(offset));
        }
    }
    if (GetParam().moves_with_its_data) {
        EXPECT_LE(worst, 1e-12);
    } else {
        EXPECT_GE(worst, 1e-2) << "a form that the theory says is not affine invariant seems to be";
    }
}

TEST_P(PatchLaw, VerticesHaveTangentPlanesExactlyWhenPromised) {
    each([this](const PatchSample& s, Random&) {
        if (s.patch.domain() == Domain::quad) return;
        for (const Vec2 at : {Vec2{1, 0}, Vec2{0, 1}, Vec2{0, 0}}) {
            const SurfacePoint p = evaluate(s.patch, at.x, at.y);
            EXPECT_TRUE(finite(p.position));
            EXPECT_EQ(p.du && p.dv && p.normal, GetParam().smooth_vertices);
        }
    });
}

TEST_P(PatchLaw, EvaluationIsFiniteEverywhereAndRefusesTheRest) {
    each([](const PatchSample& s, Random& r) {
        const Rect rect = s.patch.rect();
        for (int n = 0; n < 50; ++n) {
            Vec2 p = random_parameter(r, s.patch);
            if (n % 2) p = s.patch.edge_point(n % s.patch.edges(), n % 5 ? r.number() : n % 3 / 2.0);
            const SurfacePoint e = evaluate(s.patch, p.x, p.y);
            EXPECT_TRUE(finite(e.position));
            for (const auto& d : {e.du, e.dv, e.duu, e.duv, e.dvv, e.normal}) EXPECT_TRUE(!d || finite(*d));
            EXPECT_NEAR(length(e.normal.value_or(Point{0, 0, 1})), 1, 1e-15);
            EXPECT_TRUE(std::isfinite(e.gaussian.value_or(0)) && std::isfinite(e.mean.value_or(0)));
        }
        EXPECT_THROW(evaluate(s.patch, rect.u0 - 1e-3, rect.v0), Error);
        EXPECT_THROW(evaluate(s.patch, rect.u1, rect.v1 + 1e-3), Error);
        EXPECT_THROW(evaluate(s.patch, NAN, rect.v0), Error);
    });
}

TEST_P(PatchLaw, TransformedMovesPointsNormalsAndCurvature) {
    const Transform map =
        Transform::translate({1, 2, 3}) * Transform::rotate({1, 2, 2}, 77) * Transform::mirror({1, 0, 1}, 0.5);
    each([&](const PatchSample& s, Random& r) {
        const Patch moved = transformed(s.patch, map);
        const double size = size_of_sample(s.patch) + 4;
        for (int n = 0; n < 10; ++n) {
            const Vec2 p = random_parameter(r, s.patch, 0.01);
            const SurfacePoint a = evaluate(s.patch, p.x, p.y), b = evaluate(moved, p.x, p.y);
            EXPECT_LE(distance(map.point(a.position), b.position), 1e-14 * size);
            EXPECT_LE(distance(map.vector(*a.du), *b.du), 1e-14 * (size + length(*a.du)));
            // An odd number of mirrors turns S_u x S_v, and with it the sign of the mean curvature.
            EXPECT_LE(length(map.vector(*a.normal) + *b.normal), 1e-10);
            EXPECT_NEAR(*a.gaussian, *b.gaussian, 1e-9 * (1 + std::abs(*a.gaussian)));
            EXPECT_NEAR(*a.mean, -*b.mean, 1e-9 * (1 + std::abs(*a.mean)));
        }
    });
}

// Close to a pole, with knots of very different lengths, and at sizes whose squares barely fit.
TEST(Normals, RegularPointsHaveThemWhateverTheParametersScale) {
    const Point o{};
    const Patch pole = make_bezier_patch({{o, o, o, o}, {o, o, o, o}, {{1, 0, 0}, {1, 1, 0}, {.5, 1.5, 0}, {0, 2, 0}}, {{2, 0, -1}, {2, 2, -1}, {1, 2.5, -1}, {0, 3, -1}}});
    const SurfacePoint near = evaluate(pole, 1e-4, 0.5);
    ASSERT_TRUE(near.normal);
    EXPECT_NEAR(near.normal->z, 1, 1e-3);
    const Patch skewed = make_bspline_patch(1, 1, {0, 0, 1e7, 1e7}, {0, 0, 1e-7, 1e-7}, {{{0, 0, 0}, {0, 1, 0}}, {{1, 0, 0}, {1, 1, 1}}});
    for (const Vec2 at : {Vec2{1, 0}, Vec2{5e6, 5e-8}}) {
        ASSERT_TRUE(evaluate(skewed, at.x, at.y).normal);
        EXPECT_GT(evaluate(skewed, at.x, at.y).normal->z, 0.5);
    }
    for (const double size : {1e-60, 1e60}) {
        const SurfacePoint s = evaluate(make_bezier_patch({{o, {0, size, 0}}, {{size, 0, 0}, {size, size, 0}}}), 0.3, 0.6);
        ASSERT_TRUE(s.normal);
        EXPECT_LE(distance(*s.normal, {0, 0, 1}), 1e-15);
    }
}

INSTANTIATE_TEST_SUITE_P(Type, PatchLaw, ::testing::ValuesIn(patch_types()), name_of);

}  // namespace
}  // namespace isoparm::tests
