// Networks: the doctor finds the exact repair of every order and direction, and says where curves meet that miss their nodes.
#include <gtest/gtest.h>

#include <algorithm>

#include "curve_doctor.h"
#include "curves/bezier.h"
#include "curves/line.h"
#include "curves/modify.h"
#include "patches/network.h"
#include "samples.h"

namespace isoparm::tests {
namespace {

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

/// u_curves and v_curves of a polynomial surface at the nodes.
CurveNetwork random_network(Random& random, const std::vector<double>& u_nodes, const std::vector<double>& v_nodes) {
    const auto p = random_net(random, 4, 4);
    const auto b = [](const std::vector<Point>& q, double t) { return make_bezier(q)(t); };
    const double u1 = u_nodes.back(), v1 = v_nodes.back();
    CurveNetwork n{{}, {}, u_nodes, v_nodes};
    for (double v : v_nodes) {
        std::vector<Point> q;
        for (int i = 0; i < 4; ++i) q.push_back(b(p[i], v / v1));
        n.u_curves.push_back(reparametrized(make_bezier(q), 0, u1));
    }
    for (double u : u_nodes) {
        std::vector<Point> q;
        for (int j = 0; j < 4; ++j) q.push_back(b({p[0][j], p[1][j], p[2][j], p[3][j]}, u / u1));
        n.v_curves.push_back(reparametrized(make_bezier(q), 0, v1));
    }
    return n;
}
CurveNetwork repaired(const CurveNetwork& given, const NetworkRepair& r) {
    CurveNetwork n = given;
    n.u_curves = r.u(r.swapped ? given.v_curves : given.u_curves);
    n.v_curves = r.v(r.swapped ? given.u_curves : given.v_curves);
    return n;
}
void shuffle(Random& random, std::vector<Curve>& curves) {
    for (std::size_t k = curves.size(); k > 1; --k) std::swap(curves[k - 1], curves[random.integer(0, int(k) - 1)]);
    for (Curve& c : curves)
        if (random.integer(0, 1)) c = reversed(c);
}
TEST(CurveDoctor, RepairsNetworksInAnyOrderAndDirection) {
    Random random(7);
    int repairs = 0;
    for (int k = 0; k < 60; ++k) {
        const bool even = k % 2;
        const CurveNetwork right = even ? random_network(random, {0, 1, 2, 3}, {0, 1, 2}) : random_network(random, {0, 0.3, 0.5, 1}, {0, 0.2, 0.7, 0.9, 1});
        ASSERT_TRUE(diagnose_network(right).fits);
        CurveNetwork given = right;
        shuffle(random, given.u_curves);
        shuffle(random, given.v_curves);
        if (k % 3 == 0) std::swap(given.u_curves, given.v_curves);
        const auto d = diagnose_network(given);
        if (d.fits) continue;
        ASSERT_TRUE(d.repair) << d.misfit;
        ++repairs;
        EXPECT_EQ(d.repair->swapped, k % 3 == 0);
        const CurveNetwork fixed = repaired(given, *d.repair);
        EXPECT_TRUE(diagnose_network(fixed).fits) << d.changes;
        if (!even) continue;
        EXPECT_NO_THROW(make_network({fixed.v_curves, fixed.u_curves}));
    }
    EXPECT_GE(repairs, 55);
}
TEST(CurveDoctor, ChangesNoMoreOfANetworkThanIsNeeded) {
    Random random(8);
    CurveNetwork n = random_network(random, {0, 1, 2, 3}, {0, 1, 2});
    n.u_curves[1] = reversed(n.u_curves[1]);
    EXPECT_EQ(diagnose_network(n).changes, "u_curves[1] reversed");
    std::swap(n.v_curves[1], n.v_curves[2]);
    const auto d = diagnose_network(n);
    EXPECT_EQ(d.changes, "u_curves[1] reversed, v_curves[1] from v_curves[2], v_curves[2] from v_curves[1]");
    EXPECT_TRUE(contains(d.misfit, "of 12 crossings are open")) << d.misfit;
}
TEST(CurveDoctor, TakesTheCheapestRepairOfANetwork) {
    Random random(12);
    const auto cost = [](const Repair& r) {
        int n = 0;
        for (std::size_t k = 0; k < r.order.size(); ++k) n += (r.order[k] != int(k)) + r.reversed[k];
        return n;
    };
    const auto all = [](int n) {
        std::vector<Repair> list;
        Repair r{{}, std::vector<bool>(n)};
        for (int k = 0; k < n; ++k) r.order.push_back(k);
        do
            for (int mask = 0; mask < 1 << n; ++mask) {
                for (int k = 0; k < n; ++k) r.reversed[k] = mask >> k & 1;
                list.push_back(r);
            }
        while (std::next_permutation(r.order.begin(), r.order.end()));
        return list;
    };
    const auto u_repairs = all(3), v_repairs = all(2);
    for (int round = 0; round < 12; ++round) {
        CurveNetwork given = random_network(random, {0, 1}, {0, 1, 2});
        shuffle(random, given.u_curves);
        shuffle(random, given.v_curves);
        int least = 1000;
        for (const Repair& u : u_repairs)
            for (const Repair& v : v_repairs) {
                const CurveNetwork tried = repaired(given, {false, u, v});
                bool fits = true;
                for (int i = 0; i < 2; ++i)
                    for (int j = 0; j < 3; ++j) fits = fits && distance(tried.u_curves[j](i), tried.v_curves[i](j)) < 1e-9;
                if (fits) least = std::min(least, cost(u) + cost(v));
            }
        const auto d = diagnose_network(given);
        EXPECT_EQ(d.repair ? cost(d.repair->u) + cost(d.repair->v) : 0, least);
    }
}
TEST(CurveDoctor, RepairsANetworkWithAPole) {
    // Rays and arcs of a disc: the first v-curve is its centre.
    CurveNetwork n{{}, {}, {0, 0.5, 1}, {0, 1, 2}};
    std::vector<Point> rim{{1, 0, 0}, {0.7, 0.7, 0.1}, {0, 1, 0}};
    for (const Point& p : rim) n.u_curves.push_back(make_line({0, 0, 0}, p));
    for (double u : n.u_nodes) n.v_curves.push_back(reparametrized(make_bezier({u * rim[0], u * (2.0 * rim[1] - 0.5 * (rim[0] + rim[2])), u * rim[2]}), 0, 2));
    ASSERT_TRUE(diagnose_network(n).fits);
    std::swap(n.u_curves[0], n.u_curves[1]);
    n.v_curves[2] = reversed(n.v_curves[2]);
    const auto d = diagnose_network(n);
    ASSERT_TRUE(d.repair) << d.misfit;
    EXPECT_TRUE(diagnose_network(repaired(n, *d.repair)).fits);
}
TEST(CurveDoctor, SaysWhereCurvesOfANetworkReallyMeet) {
    Random random(9);
    CurveNetwork n = random_network(random, {0, 0.5, 1}, {0, 1});
    n.u_nodes[1] = 0.4;
    const auto d = diagnose_network(n);
    EXPECT_FALSE(d.repair);
    EXPECT_TRUE(contains(d.misfit, "u_curves[0] meets v_curves[1] (distance ")) << d.misfit;
    EXPECT_TRUE(contains(d.misfit, ", sampled) at u = 0.5, v = 0, but the node is u = 0.4, v = 0: reparametrise it or move the node")) << d.misfit;
}
TEST(CurveDoctor, LeavesANetworkWithAGapAlone) {
    Random random(10);
    CurveNetwork n = random_network(random, {0, 1, 2}, {0, 1, 2});
    n.v_curves[1] = transformed(n.v_curves[1], Transform::translate({0, 0, 1e-3}));
    n.u_curves[0] = reversed(n.u_curves[0]);
    const auto d = diagnose_network(n);
    EXPECT_FALSE(d.repair);
    EXPECT_TRUE(contains(d.misfit, "with u_curves[0] reversed they come near")) << d.misfit;
    EXPECT_TRUE(contains(d.misfit, "staying 0.001 apart")) << d.misfit;
    EXPECT_TRUE(contains(d.misfit, "do not meet (sampled): they come no nearer than ")) << d.misfit;
}
TEST(CurveDoctor, SaysThatANetworkIsTooBigToSearch) {
    CurveNetwork n;
    const int m = 400;
    for (int k = 0; k <= m; ++k) {
        const double t = double(k) / m;
        n.u_nodes.push_back(t), n.v_nodes.push_back(t);
        n.u_curves.push_back(make_line({0, t, 0}, {1, t, t}));
        n.v_curves.push_back(make_line({t, 0, 0}, {t, 1, t}));
    }
    ASSERT_TRUE(diagnose_network(n).fits);
    std::swap(n.u_curves[0], n.u_curves[1]);
    const auto d = diagnose_network(n);
    EXPECT_FALSE(d.repair);
    EXPECT_TRUE(contains(d.misfit, "802 of 160801 crossings are open")) << d.misfit;
    EXPECT_TRUE(contains(d.misfit, "there are too many curves to try every order and direction")) << d.misfit;
    EXPECT_TRUE(contains(d.misfit, "and 799 more")) << d.misfit;
}

}  // namespace
}  // namespace isoparm::tests
