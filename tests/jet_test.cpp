// jet_test.cpp -- a formula run on jets gives its own derivatives: against differences, over intervals, packs and
// polynomials, for every operation.
#include "scalar/jet.h"

#include <gtest/gtest.h>

#include <functional>

#include "function.h"
#include "samples.h"
#include "scalar/cone.h"
#include "scalar/elementary.h"

namespace isoparm {
namespace {

using tests::Random;

/// One operation as a formula in (u,v) for every scalar; u in [0.2,1.2], v in [0.3,1.3] keep all of them smooth.
struct Formula {
    const char* name;
    std::function<JetUV<double, 3>(JetU<double, 3>, JetV<double, 3>)> number;
    std::function<JetUV<Interval, 3>(JetU<Interval, 3>, JetV<Interval, 3>)> interval;
    std::function<JetUV<Pack, 3>(JetU<Pack, 3>, JetV<Pack, 3>)> pack;
};
template <class F> Formula formula(const char* name, F f) { return {name, f, f, f}; }

const std::vector<Formula>& formulas() {
    static const std::vector<Formula> list{
        formula("sum", [](auto u, auto v) { return u + v + 2.0 * u - 0.5; }),
        formula("difference", [](auto u, auto v) { return (3.0 - u) - v * 2.0; }),
        formula("product", [](auto u, auto v) { return (u * v) * (u + v) * u; }),
        formula("quotient", [](auto u, auto v) { return (1.0 + u * u) / (v + u * v); }),
        formula("quotient_mixed", [](auto u, auto v) { return v / u + (2.0 / v) * u; }),
        formula("square", [](auto u, auto v) { return square(u - v) * square(v); }),
        formula("sine", [](auto u, auto v) { return sin(u * v + u); }),
        formula("cosine", [](auto u, auto v) { return cos(u * v - v) * u; }),
        formula("exponential", [](auto u, auto v) { return exp(u * v * 0.5 - v); }),
        formula("logarithm", [](auto u, auto v) { return log(u + v * v); }),
        formula("root", [](auto u, auto v) { return sqrt(u * u + v); }),
        formula("power", [](auto u, auto v) { return pow(u * v + u, 1.7) + pow(v + u, -0.3) + pow(u + v, 0.1); }),
        formula("integer_power",
                [](auto u, auto v) { return power(u + v, 5) + power(u * v, 3) + power(u + v, -2) + power(u * v, 0); }),
        formula("choice",
                [](auto u, auto v) {
                    const auto x = u * v;
                    return absolute(x - 5.0) + smaller(x, x + 1.0) + larger(x, x - 1.0);
                }),
        formula("cone_square",
                [](auto u, auto v) {
                    return cone([](const auto& r) { return square(r); }, [](const auto& t) { return sin(t) + t * t; },
                                u, v);
                }),
        formula("cone_linear",
                [](auto u, auto v) {
                    return cone([](const auto& r) { return r; }, [](const auto& t) { return exp(t) * t; }, u, v);
                }),
        formula("cone_quartic",
                [](auto u, auto v) {
                    return cone([](const auto& r) { return square(r) * r * (2.0 - r); },
                                [](const auto& t) { return t * (1.0 - t); }, u, v);
                }),
    };
    return list;
}

class JetLaw : public ::testing::TestWithParam<Formula> {
protected:
    static JetUV<double, 3> at(double u, double v) {
        return GetParam().number(variable_u<double, 3>(u), variable_v<double, 3>(v));
    }
};

TEST_P(JetLaw, CoefficientsAreTheDerivatives) {
    Random r(1);
    const double h = 1e-5;
    for (int n = 0; n < 30; ++n) {
        const double u = r.number(0.25, 1.15), v = r.number(0.35, 1.25);
        const auto x = at(u, v), u0 = at(u - h, v), u1 = at(u + h, v), v0 = at(u, v - h), v1 = at(u, v + h);
        for (int i = 0; i <= 2; ++i)
            for (int j = 0; i + j <= 2; ++j) {
                const double du = (u1.coefficient(i, j) - u0.coefficient(i, j)) / (2 * h * (i + 1)),
                             dv = (v1.coefficient(i, j) - v0.coefficient(i, j)) / (2 * h * (j + 1));
                EXPECT_NEAR(du, x.coefficient(i + 1, j), 1e-6 * (1 + std::abs(du))) << i << j;
                EXPECT_NEAR(dv, x.coefficient(i, j + 1), 1e-6 * (1 + std::abs(dv))) << i << j;
            }
    }
}

TEST_P(JetLaw, IntervalsHoldAllNumbers) {
    Random r(2);
    for (int n = 0; n < 200; ++n) {
        const double w = std::pow(10, -r.number(0.1, 16));
        const Interval u(r.number(0.2, 0.4), r.number(0.2, 0.4) + w), v(r.number(0.3, 0.5), r.number(0.3, 0.5) + w);
        const Interval bu(std::min(u.lo, u.hi), std::max(u.lo, u.hi)), bv(std::min(v.lo, v.hi), std::max(v.lo, v.hi));
        const auto box = GetParam().interval(variable_u<Interval, 3>(bu), variable_v<Interval, 3>(bv));
        for (int s = 0; s < 10; ++s) {
            const auto x =
                at(std::clamp(r.number(bu.lo, bu.hi), bu.lo, bu.hi), std::clamp(r.number(bv.lo, bv.hi), bv.lo, bv.hi));
            for (int k = 0; k < x.size; ++k) {
                const double slack = 1e-12 * (1 + std::abs(x.c[k]));
                EXPECT_TRUE(x.c[k] >= box.c[k].lo - slack && x.c[k] <= box.c[k].hi + slack)
                    << x.c[k] << " not in [" << box.c[k].lo << ", " << box.c[k].hi << "], coefficient " << k;
            }
        }
    }
}

TEST_P(JetLaw, IntervalsOfAPointAreTight) {
    Random r(3);
    for (int n = 0; n < 50; ++n) {
        const double u = r.number(0.2, 1.2), v = r.number(0.3, 1.3);
        const auto box =
            GetParam().interval(variable_u<Interval, 3>(Interval(u)), variable_v<Interval, 3>(Interval(v)));
        const auto x = at(u, v);
        for (int k = 0; k < x.size; ++k) EXPECT_LE(box.c[k].hi - box.c[k].lo, 1e-9 * (1 + std::abs(x.c[k]))) << k;
    }
}

TEST_P(JetLaw, PacksEqualNumbersBitForBit) {
    Random r(4);
    for (int n = 0; n < 50; ++n) {
        Pack u, v;
        for (int i = 0; i < Pack::lanes; ++i) u.set(i, r.number(0.2, 1.2)), v.set(i, r.number(0.3, 1.3));
        const auto p = GetParam().pack(variable_u<Pack, 3>(u), variable_v<Pack, 3>(v));
        for (int i = 0; i < Pack::lanes; ++i) {
            const auto x = at(u[i], v[i]);
            for (int k = 0; k < x.size; ++k) EXPECT_EQ(p.c[k][i], x.c[k]) << k;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Operation, JetLaw, ::testing::ValuesIn(formulas()),
                         [](const auto& info) { return std::string(info.param.name); });

TEST(Jet, SparseJetsAreDenseJetsWithoutTheirZeros) {
    const auto u = variable_u<double, 3>(0.3);
    const auto v = variable_v<double, 3>(0.7);
    static_assert(decltype(u)::size == 4 && decltype(u * v)::size == 10 && decltype(v)::size == 4);
    const JetUV<double, 3> du(u), dv(v);
    const auto sparse = (u * u + 1.0) * (v - 2.0) / (1.0 + v * v),
               dense = (du * du + 1.0) * (dv - 2.0) / (1.0 + dv * dv);
    for (int k = 0; k < dense.size; ++k) EXPECT_DOUBLE_EQ(sparse.c[k], dense.c[k]);
    EXPECT_EQ(u.coefficient(0, 1), 0);
}

TEST(Jet, ConeAtItsApexAnswersWhatExists) {
    const auto H = [](const auto& r) { return square(r); };
    const auto g = [](const auto& t) { return 1.0 + t * t * t; };
    const auto x = cone(H, g, variable_u<double, 2>(0.0), variable_v<double, 2>(0.0));
    EXPECT_EQ(x.c[0], 0);
    EXPECT_EQ(x.coefficient(1, 0), 0);
    EXPECT_EQ(x.coefficient(0, 1), 0);
    for (int k = 3; k < 6; ++k) EXPECT_TRUE(std::isnan(x.c[k])) << "second derivatives depend on the direction";
    // but a quadratic form has them all: r^2 tau (1 - tau) = u v
    const auto uv = cone(
        H, [](const auto& t) { return t * (1.0 - t); }, variable_u<double, 2>(0.0), variable_v<double, 2>(0.0));
    EXPECT_EQ(uv.coefficient(2, 0), 0);
    EXPECT_EQ(uv.coefficient(1, 1), 1);
    EXPECT_EQ(uv.coefficient(0, 2), 0);
}

TEST(Jet, ConeBoundsHoldUpToItsApex) {
    Random r(6);
    const auto H = [](const auto& x) { return square(x) * (3.0 - 2.0 * x); };
    const auto g = [](const auto& t) { return sin(t * 2.0) + t; };
    for (int n = 0; n < 500; ++n) {
        const double a = n % 3 ? 0 : r.number(0, 0.1), b = n % 2 ? 0 : r.number(0, 0.1),
                     wa = std::pow(10, -r.number(0.3, 12)), wb = std::pow(10, -r.number(0.3, 12));
        const auto box = cone(H, g, variable_u<Interval, 3>({a, a + wa}), variable_v<Interval, 3>({b, b + wb}));
        for (int k = 0; k < 6; ++k) EXPECT_TRUE(box.c[k].bounded());
        for (int s = 0; s < 10; ++s) {
            const double u = r.number(a, a + wa), v = r.number(b, b + wb);
            const auto x = cone(H, g, variable_u<double, 3>(u), variable_v<double, 3>(v));
            for (int k = 0; k < x.size; ++k) {
                const double slack = 1e-13 * (1 + std::abs(x.c[k]));
                EXPECT_TRUE(x.c[k] >= box.c[k].lo - slack && x.c[k] <= box.c[k].hi + slack) << "coefficient " << k;
            }
        }
    }
}

TEST(Polynomials, AreTheFormulaThatMadeThem) {
    Random r(7);
    const auto f = [](const auto& u, const auto& v) {
        return power(u - 0.5, 3) * v + square(u * v) - 2.0 * u + power(v, 4) * (u + 1.0) - 0.25;
    };
    for (int n = 0; n < 50; ++n) {
        const double a = r.number(-1, 1), b = r.number(-1, 1), h = std::pow(10, -r.number(0, 6));
        const Interval u(a, a + 1), v(b, b + 2);
        const Polynomial p = f(Polynomial::variable_u(u), Polynomial::variable_v(v));
        ASSERT_TRUE(p.exists());
        EXPECT_EQ(p.degree_u(), 3);
        EXPECT_EQ(p.degree_v(), 4);
        const double x = r.number(a, a + 1 - h), y = r.number(b, b + 2 - h);
        JetUV<Interval, 2> centre;
        JetUV<Interval, 3> over;
        p.jets<3>(mid(u), mid(v), {x, x + h}, {y, y + h}, &centre, &over);
        const double s = r.number(x, x + h), t = r.number(y, y + h);
        const auto exact = f(JetUV<double, 3>(variable_u<double, 3>(s)), JetUV<double, 3>(variable_v<double, 3>(t)));
        const auto middle = f(JetUV<double, 3>(variable_u<double, 3>(mid(Interval(x, x + h)))),
                              JetUV<double, 3>(variable_v<double, 3>(mid(Interval(y, y + h)))));
        for (int k = 0; k < exact.size; ++k) {
            const double slack = 1e-12 * (10 + std::abs(exact.c[k]));
            EXPECT_TRUE(exact.c[k] >= over.c[k].lo - slack && exact.c[k] <= over.c[k].hi + slack) << k;
            EXPECT_NEAR(k < centre.size ? mid(centre.c[k]) : middle.c[k], middle.c[k], slack) << k;
        }
        EXPECT_LE(p.range().lo, exact.c[0]);
        EXPECT_GE(p.range().hi, exact.c[0]);
    }
}

TEST(Polynomials, WhatIsNoneDoesNotExist) {
    const auto u = Polynomial::variable_u({0, 1}), v = Polynomial::variable_v({0, 1});
    for (const auto& p : {u / v, u / (v + 1.0), Polynomial::nothing() + u, u * Polynomial::nothing(),
                          -Polynomial::nothing(), square(u / v), u - Polynomial::nothing(), u / Polynomial::nothing(),
                          Polynomial::nothing() / Polynomial(2), power(u, -1), power(u, 65)})
        EXPECT_FALSE(p.exists());
    EXPECT_TRUE((u / Polynomial(3.0)).exists());
    EXPECT_TRUE(power(u, 64).exists());
}

TEST(Functions, TaylorCoefficientsOfPolynomials) {
    Random r(8);
    const Function f = Function::polynomial({1, -2, 0.5, 3, -1});
    for (int n = 0; n < 50; ++n) {
        const double t = r.number(-2, 2), w = std::pow(10, -r.number(0, 12));
        const double expected[] = {1 - 2 * t + 0.5 * t * t + 3 * t * t * t - t * t * t * t,
                                   -2 + t + 9 * t * t - 4 * t * t * t, 0.5 + 9 * t - 6 * t * t, 3 - 4 * t};
        double out[4];
        f.taylor(t, 3, out);
        Interval box[4];
        f.taylor(Interval(t - w * r.number(), t + w * r.number()), 3, box);
        Pack lanes[4];
        f.taylor(Pack(t), 3, lanes);
        for (int k = 0; k < 4; ++k) {
            EXPECT_NEAR(out[k], expected[k], 1e-13 * 50);
            EXPECT_TRUE(box[k].lo - 1e-12 <= expected[k] && expected[k] <= box[k].hi + 1e-12);
            EXPECT_EQ(lanes[k][3], out[k]);
        }
    }
    double constant[4];
    Function::polynomial({7}).taylor(0.5, 3, constant);
    EXPECT_TRUE(constant[0] == 7 && constant[1] == 0 && constant[3] == 0);
}

}  // namespace
}  // namespace isoparm
