// math_text.h -- short texts as a paper prints them: "P_{00}", "c_0", "\alpha_i^2", "Triangle $T_1$".
//
// Between two $ is mathematics: letters slanted, digits and signs upright, _ and ^ with one character or {several},
// names like \alpha, accents like \hat; \frac{a}{b} stands in one line, as a/b; around relations, binary signs and behind commas is TeX's space. A text without $ is mathematics as a whole when it has _, ^ or \, or no word of two letters.
#pragma once
#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

namespace isoparm {

/// Letters of one kind in a row. Lengths are in ems of the whole text.
struct TextRun {
    std::string text;  // UTF-8
    bool italic = false, bold = false;
    double scale = 1;  // of the letters
    double rise = 0;   // of their base line
    /// Where it begins: behind everything before; or, for the first run of a superscript that stands over a subscript,
    /// where that subscript began.
    enum class Begins { behind, subscript, over_subscript } begins = Begins::behind;
    bool prose = false;  // no mathematics
    double before = 0;   // space before it, beside what is written
    std::size_t covers = 0;  // of a radical sign: so many runs behind it are under its bar
    std::size_t index = 0;   // likewise: so many runs before it are its index
};
using MathText = std::vector<TextRun>;

struct MathTextError : std::runtime_error {
    MathTextError(std::size_t at, const std::string& what) : std::runtime_error(what), offset(at) {}
    std::size_t offset;  // byte
};

/// `prose`: text without $ is never mathematics. Throws MathTextError: "found ..., expected ...".
MathText parse_math_text(const std::string& text, bool prose = false);

/// A number as an axis shows it: at most `digits` behind the point, a true minus sign.
MathText number_text(double x, int digits);

/// The same in TeX: prose as text, everything else between two $.
std::string tex_of(const MathText& text);

}  // namespace isoparm
