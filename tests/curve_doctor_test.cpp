// The doctor finds the exact repair of every order and direction, and says what is the matter where there is none.
#include "curve_doctor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "curves/bezier.h"
#include "curves/closest_approach.h"
#include "curves/line.h"
#include "curves/modify.h"
#include "error.h"
#include "patches/side_vertex.h"
#include "samples.h"

namespace isoparm::tests {
namespace {

/// Every order and direction of n curves: what a user can paste.
template <class F> void for_all_pastes(int n, F f) {
    std::vector<int> order(n);
    std::iota(order.begin(), order.end(), 0);
    do {
        for (int mask = 0; mask < 1 << n; ++mask) f(order, mask);
    } while (std::next_permutation(order.begin(), order.end()));
}
std::vector<Curve> pasted(const std::vector<Curve>& right, const std::vector<int>& order, int mask) {
    std::vector<Curve> r;
    for (std::size_t k = 0; k < order.size(); ++k) r.push_back(mask >> k & 1 ? reversed(right[order[k]]) : right[order[k]]);
    return r;
}
CoonsCurves frame_of(const std::vector<Curve>& c) { return {c[0], c[1], c[2], c[3]}; }
std::array<Curve, 3> triangle_of(const std::vector<Curve>& c) { return {c[0], c[1], c[2]}; }
bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }
int changes_of(const Repair& r) {
    int n = 0;
    for (std::size_t k = 0; k < r.order.size(); ++k) n += (r.order[k] != int(k)) + r.reversed[k];
    return n;
}
Curve line(const Point& a, const Point& b) { return make_line(a, b); }

TEST(ClosestApproach, FindsWhereCurvesCross) {
    Random r(11);
    for (int k = 0; k < 200; ++k) {
        const Curve a = random_cubic(r, r.point(), r.point());
        const double s = r.number(), t = r.number();
        const Curve b0 = random_cubic(r, r.point(), r.point());
        const Curve b = transformed(b0, Transform::translate(a(s) - b0(t)));
        const Approach x = closest_approach(a, b);
        EXPECT_LT(x.distance, 1e-12) << k;
        EXPECT_EQ(x.distance, distance(a(x.s), b(x.t)));
    }
}
TEST(ClosestApproach, OfParallelAndSkewLinesIsTheirDistance) {
    EXPECT_NEAR(closest_approach(line({0, 0, 0}, {1, 0, 0}), line({0, 2, 0}, {1, 2, 0})).distance, 2, 1e-15);
    const Approach x = closest_approach(line({-1, 0, 0}, {3, 0, 0}), line({0, -1, 5}, {0, 1, 5}));
    EXPECT_NEAR(x.distance, 5, 1e-14);
    EXPECT_NEAR(x.s, 0.25, 1e-12);
    EXPECT_NEAR(x.t, 0.5, 1e-12);
    EXPECT_NEAR(closest_approach(line({0, 0, 0}, {1, 0, 0}), line({3, 0, 0}, {2, 0, 0})).distance, 1, 1e-15);  // end to end
}

TEST(CurveDoctor, RepairsEveryAssignmentOfAFrame) {
    for (const Point& offset : {Point{}, Point{1e4, -2e4, 5e3}}) {
        Random random(1, offset);
        const Frame f = random_frame(random);
        const std::vector<Curve> right{f.c0, f.c1, f.d0, f.d1};
        int as_given = 0, tried = 0, fewest = 0;
        for_all_pastes(4, [&](const std::vector<int>& order, int mask) {
            const auto given = pasted(right, order, mask);
            const auto d = diagnose_frame(frame_of(given));
            ++tried;
            bool fits = true;
            try {
                make_coons(frame_of(given));
            } catch (const IncompatibleError&) {
                fits = false;
            }
            ASSERT_EQ(d.fits, fits);
            if (fits) {
                ++as_given;
                EXPECT_FALSE(d.repair);
                EXPECT_EQ(d.misfit + d.changes, "");
                return;
            }
            ASSERT_TRUE(d.repair);
            EXPECT_NO_THROW(make_coons(frame_of((*d.repair)(given))));
            EXPECT_FALSE(d.changes.empty());
            EXPECT_FALSE(contains(d.changes, "other way")) << d.changes;
            fewest = std::max(fewest, changes_of(*d.repair));
            if (tried % 16) return;
            int cheaper = 0;  // no cheaper assignment closes
            for_all_pastes(4, [&](const std::vector<int>& o, int m) {
                Repair r{o, {}};
                for (int k = 0; k < 4; ++k) r.reversed.push_back(m >> k & 1);
                if (changes_of(r) < changes_of(*d.repair) && diagnose_frame(frame_of(r(given))).fits) ++cheaper;
            });
            EXPECT_EQ(cheaper, 0);
        });
        EXPECT_EQ(tried, 384);
        EXPECT_EQ(as_given, 8);  // the symmetries of the square
        EXPECT_LE(fewest, 4);
    }
}
TEST(CurveDoctor, SaysTheObviousRepair) {
    const Curve c0 = line({0, 0, 0}, {1, 0, 0}), c1 = line({0, 1, 0}, {1, 1, 1}), d0 = line({0, 0, 0}, {0, 1, 0}), d1 = line({1, 0, 0}, {1, 1, 1});
    EXPECT_EQ(diagnose_frame({c0, c1, d0, reversed(d1)}).changes, "d1 reversed");
    EXPECT_EQ(diagnose_frame({c0, d0, c1, d1}).changes, "c1 from d0, d0 from c1");
    const auto d = diagnose_frame({c0, c1, reversed(d0), d1});
    EXPECT_EQ(d.misfit, "c0(0) and d0(0) are 1 apart, c1(0) and d0(1) are 1 apart");
}
TEST(CurveDoctor, LeavesAFrameWithAGapAlone) {
    const Point x{0.3, 0, 0};
    const Curve c0 = line({0, 0, 0}, {1, 0, 0}), c1 = line({0, 1, 0}, {1, 1, 0}), d0 = line({0, 0, 0}, {0, 1, 0}), d1 = line({1, 0, 0}, Point{1, 1, 0} + x);
    for (bool turn : {false, true}) {
        const auto d = diagnose_frame({c0, turn ? reversed(c1) : c1, d0, d1});
        EXPECT_FALSE(d.fits);
        EXPECT_FALSE(d.repair);
        EXPECT_TRUE(contains(d.misfit, turn ? "at best (c1 reversed) c1(0) and d1(1) stay 0.3 apart" : "at best (as given) c1(1) and d1(1) stay 0.3 apart")) << d.misfit;
        EXPECT_TRUE(contains(d.misfit, turn ? "the end nearest to c1(0) is d1(1), 0.3 away" : "the end nearest to c1(1) is d1(1), 0.3 away")) << d.misfit;
    }
}
TEST(CurveDoctor, KeepsToTheToleranceOfTheSurface) {
    Random random(5);
    for (double gap : {0.2e-9, 5e-9}) {
        const Frame f = random_frame(random);
        const double size = 1;  // of the order of the frame's
        const Curve moved = transformed(f.c1, Transform::translate({gap * size, 0, 0}));
        const auto d = diagnose_frame({f.c0, reversed(moved), f.d0, f.d1});
        EXPECT_EQ(d.repair.has_value(), gap < 1e-9) << d.misfit;
        EXPECT_EQ(d.changes, gap < 1e-9 ? "c1 reversed" : "");
    }
}
TEST(CurveDoctor, SeesCurvesThatRunBeyondTheirCorner) {
    const auto d = diagnose_frame({line({0, 0, 0}, {2, 0, 0}), line({0, 1, 0}, {1, 1, 0}), line({0, 0, 0}, {0, 1, 0}), line({1, -1, 0}, {1, 1, 0})});
    EXPECT_FALSE(d.repair);
    EXPECT_TRUE(contains(d.misfit, "c0 and d1 cross (sampled): cut c0 at its parameter 0.5 and d1 at its parameter 0.5")) << d.misfit;
}
TEST(CurveDoctor, SaysWhenMoreThanOneSurfaceFits) {
    // Three curves from A to B and one from A to A's place: any of the three can be opposite to the fourth.
    const Point a{0, 0, 0}, b{1, 0, 0};
    const auto arc = [&](const Point& m) { return make_bezier({a, m, b}); };
    const Curve loop = make_bezier({a, {0, 1, 0}, {0, 0, 1}, a}), other = make_bezier({b, {2, 1, 0}, {2, 0, 1}, b});
    const auto d = diagnose_frame({loop, arc({0.5, 1, 0}), arc({0.5, 0, 1}), other});
    ASSERT_TRUE(d.repair);
    EXPECT_TRUE(contains(d.changes, "span other surfaces") || contains(d.changes, "spans another surface")) << d.changes;
}

TEST(CurveDoctor, RepairsEveryAssignmentOfATriangle) {
    Random random(2);
    const auto e = random_triangle(random);
    const std::vector<Curve> right{e[0], e[1], e[2]};
    const Function H = Function::polynomial({0, 0, 1});
    int as_given = 0, tried = 0;
    for_all_pastes(3, [&](const std::vector<int>& order, int mask) {
        const auto given = pasted(right, order, mask);
        const auto d = diagnose_triangle(triangle_of(given));
        ++tried;
        if (d.fits) {
            ++as_given;
            EXPECT_NO_THROW(make_side_vertex(triangle_of(given), H));
            return;
        }
        EXPECT_THROW(make_side_vertex(triangle_of(given), H), IncompatibleError);
        ASSERT_TRUE(d.repair);
        EXPECT_NO_THROW(make_side_vertex(triangle_of((*d.repair)(given)), H));
        EXPECT_LE(changes_of(*d.repair), 2) << d.changes;  // two curves exchanged make up for three reversed
    });
    EXPECT_EQ(tried, 48);
    EXPECT_EQ(as_given, 6);  // the symmetries of the triangle
}
TEST(CurveDoctor, LeavesAnOpenTriangleAlone) {
    const auto d = diagnose_triangle({line({0, 1, 0}, {0, 0, 0}), line({0, 0, 0}, {1, 0, 0}), line({1, 0, 0}, {0, 2, 0})});
    EXPECT_FALSE(d.repair);
    EXPECT_TRUE(contains(d.misfit, "E3(1) and E1(0) stay 1 apart")) << d.misfit;
}
TEST(CurveDoctor, RepairsACommonStart) {
    Random random(3);
    const Point a = random.point();
    const Curve c = random_cubic(random, a, random.point()), d = random_cubic(random, a, random.point());
    EXPECT_TRUE(diagnose_common_start(c, d).fits);
    EXPECT_EQ(diagnose_common_start(reversed(c), d).changes, "c reversed");
    EXPECT_EQ(diagnose_common_start(c, reversed(d)).changes, "d reversed");
    EXPECT_EQ(diagnose_common_start(reversed(c), reversed(d)).changes, "c reversed, d reversed");
    EXPECT_FALSE(diagnose_common_start(c, random_cubic(random, random.point(), random.point())).repair);
}

// ---- with cross derivatives -----------------------------------------------------------------------------------------
HermiteData hermite_data(Random& random) {
    const auto p = random_net(random, 4, 4);
    const auto column = [&](int j, int from, double scale) {
        std::vector<Point> q;
        for (int i = 0; i < 4; ++i) q.push_back(from < 0 ? p[i][j] : scale * (p[i][j] - p[i][from]));
        return make_bezier(q);
    };
    const auto row = [&](int i, int from, double scale) {
        std::vector<Point> q;
        for (int j = 0; j < 4; ++j) q.push_back(from < 0 ? p[i][j] : scale * (p[i][j] - p[from][j]));
        return make_bezier(q);
    };
    return {{row(0, -1, 0), row(1, 0, 3), row(3, 2, 3), row(3, -1, 0)}, {column(0, -1, 0), column(1, 0, 3), column(3, 2, 3), column(3, -1, 0)}};
}
TEST(CurveDoctor, RepairsHermiteData) {
    Random random(4);
    const HermiteData right = hermite_data(random);
    ASSERT_TRUE(diagnose_hermite(right, Twist::compatible).fits);
    int tried = 0;
    for_all_pastes(4, [&](const std::vector<int>& order, int mask) {
        if (++tried % 5) return;
        // Sides in any order and direction, some cross derivatives negated or turned alone.
        HermiteRepair harm{{order, {}}, {}, {}};
        for (int k = 0; k < 4; ++k) {
            harm.sides.reversed.push_back(mask >> k & 1);
            harm.cross_reversed.push_back(random.integer(0, 3) ? bool(mask >> k & 1) : !(mask >> k & 1));
            harm.negated.push_back(random.integer(0, 1));
        }
        const HermiteData given = harm(right);
        const auto d = diagnose_hermite(given, Twist::compatible);
        if (d.fits) return;
        ASSERT_TRUE(d.repair) << d.misfit;
        EXPECT_NO_THROW(make_coons_hermite((*d.repair)(given))) << d.changes;
    });
    HermiteData given = right;
    given.g[0] = reversed(given.g[0]), given.g[1] = reversed(given.g[1]);
    EXPECT_EQ(diagnose_hermite(given, Twist::compatible).changes, "g[0] reversed, g[1] reversed");
    given = right;
    given.f[2] = linear_combination({-1}, {given.f[2]});
    EXPECT_EQ(diagnose_hermite(given, Twist::average).changes, "f[2] negated");
}
TEST(CurveDoctor, LeavesHermiteDataOfAnotherSpeedAlone) {
    Random random(6);
    HermiteData given = hermite_data(random);
    given.f[1] = linear_combination({0.5}, {given.f[1]});
    const auto d = diagnose_hermite(given, Twist::gregory);
    EXPECT_FALSE(d.fits);
    EXPECT_FALSE(d.repair);
    EXPECT_TRUE(contains(d.misfit, "f[1] and the derivative of g[0] at (0,0) differ by ")) << d.misfit;
    EXPECT_TRUE(contains(d.misfit, "(0.5 times it: reparametrise the one or scale the other)")) << d.misfit;
}

}  // namespace
}  // namespace isoparm::tests
