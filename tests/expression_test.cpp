#include "scene/expression.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "scalar/elementary.h"

namespace isoparm {
namespace {

double value(const std::string& text, const std::map<std::string, double>& names = {}) { return Expression::parse(text, names, false).value(); }
Expression formula(const std::string& text) { return Expression::parse(text, {{"p", 0.75}}, true); }

TEST(Expression, FollowsTheUsualPrecedence) {
    EXPECT_EQ(value("1 + 2*3"), 7);
    EXPECT_EQ(value("-2^2"), -4);
    EXPECT_EQ(value("(-2)^2"), 4);
    EXPECT_EQ(value("2^3^2"), 512);
    EXPECT_EQ(value("2^-1"), 0.5);
    EXPECT_EQ(value("7 - 2 - 1"), 4);
    EXPECT_EQ(value("12/3/2"), 2);
    EXPECT_EQ(value("2*-3"), -6);
    EXPECT_EQ(value("--3"), 3);
    EXPECT_EQ(value("1e-3 + .5"), 0.501);
}
TEST(Expression, KnowsFunctionsConstantsAndParameters) {
    EXPECT_EQ(value("sqrt(2)/2"), std::sqrt(2.0) / 2);
    EXPECT_EQ(value("sin(pi/6)"), std::sin(std::numbers::pi / 6));
    EXPECT_EQ(value("exp(1) - e"), 0);
    EXPECT_EQ(value("max(1, 5, 3) + min(4, 2) + abs(-1)"), 8);
    EXPECT_EQ(value("pow(2, 0.5)"), std::sqrt(2.0));
    EXPECT_EQ(value("if(a > 1, 10, 20)", {{"a", 2}}), 10);
    EXPECT_EQ(value("1 - 2*te", {{"te", 0.4}}), 1 - 2 * 0.4);
}
TEST(Expression, ErrorsNameThePlaceTheFoundAndTheExpected) {
    const auto fails = [](const std::string& text, std::size_t offset, const std::string& message) {
        try {
            Expression::parse(text, {{"height", 1}}, true);
            ADD_FAILURE() << text;
        } catch (const ExpressionError& e) {
            EXPECT_EQ(e.offset, offset) << text << ": " << e.what();
            EXPECT_NE(std::string(e.what()).find(message), std::string::npos) << text << ": " << e.what();
        }
    };
    fails("", 0, "the end of the expression");
    fails("2t", 1, "a product is written with *");
    fails("2(t)", 1, "a product is written with *");
    fails("2**3", 1, "a power is written with ^");
    fails("1 + ", 4, "expected a number, a name");
    fails("sin t", 4, "expected \"(\" after sin");
    fails("pow(2)", 5, "another argument of pow");
    fails("sin(1, 2)", 5, "expected \")\"");
    fails("if(t, 1, 2)", 4, "expected a comparison");
    fails("heigth", 0, "did you mean \"height\"?");
    fails("1 $ 2", 2, "found \"$\"");
    fails("t < 1", 2, "found \"<\"");
    fails("1/0", 0, "not finite");
    EXPECT_THROW(value("t"), ExpressionError);
}

// The derivative coefficients against the difference quotient of the next lower one.
TEST(Formula, JetsAgreeWithDifferences) {
    for (const char* text : {"t^2", "2*t^3 - t^4", "3*t^2 - 2*t^3", "sin(3*t)*cos(t)", "exp(-t^2)", "sqrt(1 + t)", "pow(1 + t, 1.7)", "(1 + t)^t", "2^t", "1/(1 + t^2)", "abs(t - 2)",
                             "min(t, 3 + t^2)", "max(t^3, t - 5)", "if(t < 2, t^2, 0)", "t^-2"}) {
        const Function f = make_formula(formula(text));
        for (const double t : {0.2, 0.5, 0.9}) {
            double at[4], before[4], after[4];
            const double h = 1e-5;
            f.taylor(t, 3, at);
            f.taylor(t - h, 3, before);
            f.taylor(t + h, 3, after);
            for (int k = 0; k < 3; ++k) EXPECT_NEAR(at[k + 1] * (k + 1), (after[k] - before[k]) / (2 * h), 2e-7 * (1 + std::fabs(at[k + 1]))) << text << " at " << t << " order " << k + 1;
        }
    }
}
TEST(Formula, PacksEqualNumbersBitForBit) {
    for (const char* text : {"t^2", "sin(3*t)*cos(t) + exp(t)", "pow(t, 1.5)", "if(t < 0.5, t, sqrt(t))", "abs(t - 0.4)", "t^t"}) {
        const Function f = make_formula(formula(text));
        Pack t, packed[4];
        for (int i = 0; i < Pack::lanes; ++i) t.set(i, (i + 0.5) / Pack::lanes);
        f.taylor(t, 3, packed);
        for (int i = 0; i < Pack::lanes; ++i) {
            double one[4];
            f.taylor(t[i], 3, one);
            for (int k = 0; k <= 3; ++k) EXPECT_EQ(packed[k][i], one[k]) << text;
        }
    }
}
TEST(Formula, IntervalsEncloseNumbers) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> pick(-3, 3);
    for (const char* text : {"t^2", "t^3 - t", "sin(t)", "cos(5*t)", "exp(t)", "sqrt(abs(t))", "pow(abs(t) + 0.1, 0.3)", "1/(2 + sin(t))", "min(t, t^2)", "max(1 - t, t)", "if(t < 0.3, t, 0.6 - t)", "2^t"}) {
        const Function f = make_formula(formula(text));
        for (int round = 0; round < 500; ++round) {
            double a = pick(random), b = a + std::exp(2 * pick(random)) * 0.05;
            Interval box[4];
            f.taylor(Interval(a, b), 3, box);
            for (int k = 0; k <= 20; ++k) {
                const double t = std::clamp(a + (b - a) * k / 20, a, b);
                double one[4];
                f.taylor(t, 3, one);
                for (int d = 0; d <= 3; ++d) {
                    if (!std::isfinite(one[d])) continue;
                    ASSERT_TRUE(box[d].lo <= one[d] && one[d] <= box[d].hi) << text << " [" << a << ", " << b << "] at " << t << " order " << d << ": " << one[d];
                }
            }
        }
    }
}
TEST(Formula, SineAndCosineFindTheirExtrema) {
    EXPECT_EQ(sin(Interval(1, 2)).hi, 1);
    EXPECT_LT(sin(Interval(1, 1.5)).hi, 1);
    EXPECT_EQ(sin(Interval(4, 5)).lo, -1);
    EXPECT_EQ(cos(Interval(-0.1, 0.1)).hi, 1);
    EXPECT_EQ(cos(Interval(3, 3.3)).lo, -1);
    EXPECT_EQ(cos(Interval(-100, 100)).lo, -1);
    EXPECT_GT(sin(Interval(1, 2)).lo, 0.84);
    EXPECT_LE(exp(Interval(-800, -799)).lo, 0);
    EXPECT_GT(exp(Interval(-800, -799)).hi, 0);
    EXPECT_FALSE(exp(Interval(0, 800)).bounded());
}
TEST(Formula, PolynomialsAreRecognised) {
    const Interval box(0.25, 0.5);
    for (const char* text : {"t^2", "2*t^3 - t^4", "(1 - t)^2*(1 + t/2)", "p*t"}) EXPECT_TRUE(make_formula(formula(text))(Polynomial::variable_u(box)).exists()) << text;
    for (const char* text : {"1/t", "sin(t)", "abs(t)", "t^0.5", "t^-1", "if(t < 1, t, 0)"}) EXPECT_FALSE(make_formula(formula(text))(Polynomial::variable_u(box)).exists()) << text;
    EXPECT_EQ(make_formula(formula("3*t^2 - 2*t^3"))(1.0), 1);
}
TEST(Formula, AChoiceThatJumpsHasNoBoundAcrossItsSwitch) {
    Interval out[3];
    make_formula(formula("if(t < 0.5, 0, 1)")).taylor(Interval(0.4, 0.6), 2, out);
    EXPECT_EQ(out[0].lo, 0);
    EXPECT_EQ(out[0].hi, 1);
    EXPECT_FALSE(out[1].bounded());
    make_formula(formula("if(t < 0.5, t, 1 - t)")).taylor(Interval(0.4, 0.6), 2, out);
    EXPECT_NEAR(out[1].lo, -1, 1e-15);
    EXPECT_NEAR(out[1].hi, 1, 1e-15);
    EXPECT_FALSE(out[2].bounded());
    make_formula(formula("if(t < 0.5, t, 1 - t)")).taylor(Interval(0.4, 0.5), 2, out);
    EXPECT_NEAR(out[1].lo, 1, 1e-15);
    EXPECT_TRUE(out[2].bounded());
}

/// At t a formula over [0,1] has this value and slope 1, as number, in packs and in its enclosure.
void expect_slope_one(const char* text, double t, double value) {
    const Function f = make_formula(formula(text), 0, 1);
    double number[3];
    Interval point[3];
    Pack pack[3];
    f.taylor(t, 2, number);
    f.taylor(Interval(t), 2, point);
    f.taylor(Pack(t), 2, pack);
    EXPECT_EQ(number[0], value) << text;
    EXPECT_EQ(number[1], 1) << text;
    EXPECT_EQ(pack[1][3], 1) << text;
    EXPECT_TRUE(point[1].contains(1)) << text << ": [" << point[1].lo << ", " << point[1].hi << "]";
}
TEST(Formula, AtAKinkAnswersWithThePieceToItsRight) {
    for (const char* text : {"if(t<=0,0,t)", "if(t>0,t,0)", "if(0<t,t,0)", "if(0>=t,0,t)", "max(0,t)", "max(t,0)", "-min(0,-t)", "(t+abs(t))/2", "(t+abs(-t))/2"})
        expect_slope_one(text, 0, 0);
}
TEST(Formula, AtTheEndOfItsDomainAnswersWithThePieceToItsLeft) {
    for (const char* text : {"if(t<1,t,1)", "if(t>=1,1,t)", "min(t,1)", "min(1,t)", "1-abs(t-1)", "1-abs(1-t)"}) expect_slope_one(text, 1, 1);
}
TEST(Formula, OverADomainMustBeFiniteAndMustNotJump) {
    for (const char* text : {"t/(2*t-1)", "if(t<0.5,0,1)", "if(t<=0,0,1)", "if(t<1,0,1)", "sqrt(0.5-t)"}) EXPECT_THROW(make_formula(formula(text), 0, 1), Error) << text;
    EXPECT_NO_THROW(make_formula(formula("t/(2*t-1)"), 2, 3));
}

TEST(FormulaCurve, KnowsItsBreaksAndRefusesPolesAndJumps) {
    const auto curve = [](const std::string& y) { return make_formula_curve({formula("cos(t)"), formula(y), formula("0")}, 0, 2); };
    EXPECT_TRUE(curve("t^2").breaks().empty());
    const auto breaks = curve("if(t < 0.3, t, 0.6 - t)").breaks();
    ASSERT_EQ(breaks.size(), 1u);
    EXPECT_EQ(breaks[0].t, 0.3);
    EXPECT_EQ(breaks[0].continuity, 0);
    EXPECT_THROW(curve("1/(t - 1)"), Error);
    EXPECT_THROW(curve("sqrt(1 - t)"), Error);
    EXPECT_THROW(curve("if(t < 0.3, 0, 1)"), Error);
    const Point d = curve("t^2").derivative(1.5);
    EXPECT_EQ(d.x, -std::sin(1.5));
    EXPECT_EQ(d.y, 3);
}

}  // namespace
}  // namespace isoparm
