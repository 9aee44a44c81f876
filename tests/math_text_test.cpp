// math_text_test.cpp -- space between the signs of formulas, and roots.
#include "drawing/math_text.h"

#include <gtest/gtest.h>

#include "drawing/text_cairo.h"

namespace isoparm {
namespace {

// The TeXbook, chapter 18: 5/18 em around relations, 4/18 around binary signs, 3/18 behind commas; none in scripts.
TEST(MathText, SignsHaveTheSpaceThatTexGivesThem) {
    const double thin = 3.0 / 18, medium = 4.0 / 18, thick = 5.0 / 18;
    const auto space = [](const std::string& text) {
        double all = 0;
        for (const TextRun& r : parse_math_text(text)) all += r.before;
        return all;
    };
    for (const auto& [text, expected] : {std::pair<std::string, double>{"a=b", 2 * thick}, {"a+b", 2 * medium}, {"a-b", 2 * medium}, {"r(u,v)", thin}, {"a \\to b", 2 * (thick - thin)}, {"a\\le b", 2 * thick - thin},
                                         {"P_{i-1}", 0}, {"x^{a=b}", 0}, {"-1", 0}, {"x=-1", 2 * thick}, {"(-1)", 0}, {"a+", 0}, {"(a+)", 0}, {"2\\sin\\theta", 2 * thin}, {"\\sin(x)", 0}, {"$a=$ and $=b$", 2 * thick},
                                         {"a=\\text{const}", 2 * thick}, {"\\sqrt{a+b}=c", 2 * medium + 2 * thick}, {"x_i=y_j^2+1", 2 * thick + 2 * medium}, {"a = b", 2 * (thick - thin)}})
        EXPECT_NEAR(space(text), expected, 1e-12) << text;
    EXPECT_EQ(space("one, two = three"), 0) << "prose";
    // And it is there on the picture: as wide as the letters by themselves and the space.
    const auto wide = [](const std::string& text) { return text_box(parse_math_text(text), 100).advance; };
    EXPECT_NEAR(wide("1=2"), wide("1") + wide("{=}") + wide("2") + 200 * thick, 1e-6);
}
TEST(MathText, RootsHaveABarOverAllThatTheyAreOf) {
    for (const auto& [text, tex] : {std::pair<std::string, std::string>{"\\sqrt{2}", "$\\sqrt{2}$"}, {"1+\\sqrt{x_1^2+y^{2}}-a", "$1+\\sqrt{x_{1}^{2}+y^{2}}-a$"}, {"\\sqrt{1+\\sqrt{x}}^2", "$\\sqrt{1+\\sqrt{x}}^{2}$"}, {"e^{\\sqrt{x}}", "$e^{\\sqrt{x}}$"}, {"2\\sqrt[3]{x}-\\sqrt[n_1]{y^2}", "$2\\sqrt[3]{x}-\\sqrt[n_{1}]{y^{2}}$"}, {"\\sqrt[]{x}", "$\\sqrt{x}$"}, {"\\sqrt[\\text{ab}c]{x}", "$\\sqrt[\\operatorname{ab}c]{x}$"},
                                                                      {"\\sqrt[{a]b}]{y}", "$\\sqrt[{a]b}]{y}$"}, {"\\sqrt[\\sqrt[3]{2}]{x}", "$\\sqrt[{\\sqrt[3]{2}}]{x}$"}})
        EXPECT_EQ(tex_of(parse_math_text(text)), tex) << text;
    for (const std::string inside : {"2", "x^2+1", "\\hat{X}", "H_i^{(3)}"}) {
        const MathText text = parse_math_text("\\sqrt{" + inside + "}");
        EXPECT_EQ(text.at(0).covers, text.size() - 1) << inside;
        const PlacedText placed = placed_text(text, 100);
        ASSERT_EQ(placed.bars.size(), 1u) << inside;
        const TextBox bar = placed.bars[0], all = text_box(text, 100), own = text_box(parse_math_text(inside), 100);
        EXPECT_LE(bar.left, placed.runs.at(1).x + 2) << inside;
        EXPECT_GE(bar.right, placed.runs.at(1).x + own.right) << inside;
        EXPECT_LT(bar.bottom, own.top) << inside << ": above all";
        EXPECT_GT(bar.bottom, bar.top + 2);
        EXPECT_GE(bar.top, all.top - 1e-9);
        EXPECT_EQ(bar.right, all.right);
        // It is painted, without gaps or holes where it overlaps with the sign.
        const Coverage c = coverage(Text{{50, 200}, 100, text}, 0, 500, 300);
        const int row = static_cast<int>(200 + 0.5 * (bar.top + bar.bottom)) - c.y0;
        for (int x = static_cast<int>(50 + bar.left + 1); x < 50 + bar.right - 1; ++x) EXPECT_GT(c.part.at(static_cast<std::size_t>(row * c.width + x - c.x0)), 128) << inside << ' ' << x;
    }
    const PlacedText nested = placed_text(parse_math_text("\\sqrt{1+\\sqrt{x}}"), 100);
    ASSERT_EQ(nested.bars.size(), 2u);
    EXPECT_LT(nested.bars[1].bottom, nested.bars[0].top) << "the outer one is above the inner";
    EXPECT_GT(nested.runs.at(0).scale, 1);
}

}  // namespace
}  // namespace isoparm
