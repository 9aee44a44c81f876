#include "drawing/math_spacing.h"

#include <algorithm>
#include <array>
#include <string_view>

namespace isoparm {
namespace {

constexpr double kThin = 3.0 / 18, kMedium = 4.0 / 18, kThick = 5.0 / 18;

constexpr std::string_view kBinary[] = {"+", "\u2212", "*", "±", "∓", "·", "×", "÷", "∗", "⋆", "•", "⊕", "⊗", "⊖", "∧", "∨", "∪", "∩", "∖"};
constexpr std::string_view kRelation[] = {"=", "<", ">", ":", "≤", "≥", "≠", "≪", "≫", "≈", "∼", "≃", "≅", "≡", "∝", "∈", "∉", "⊂", "⊆", "⊃", "→", "←", "↔", "↦", "⇒", "⇔", "⊥", "∥", "∣"};
constexpr std::string_view kFunction[] = {"∑", "∏", "∫", "sin", "cos", "tan", "exp", "log", "ln", "lim", "max", "min", "det", "dim", "deg", "arctan", "arccos", "arcsin", "cosh", "sinh"};

template <std::size_t n> bool among(const std::string_view (&list)[n], const std::string& text) { return std::find(std::begin(list), std::end(list), text) != std::end(list); }

}  // namespace

MathClass math_class(const std::string& text) {
    if (among(kBinary, text)) return MathClass::binary;
    if (among(kRelation, text)) return MathClass::relation;
    if (among(kFunction, text)) return MathClass::function;
    if (text == "(" || text == "[" || text == "{" || text == "⟨") return MathClass::opening;
    if (text == ")" || text == "]" || text == "}" || text == "⟩" || text == "!" || text == "?") return MathClass::closing;
    if (text == "," || text == ";") return MathClass::punctuation;
    return MathClass::ordinary;
}

MathClass math_class_behind(MathClass before, MathClass now) {
    const bool nothing = before == MathClass::none || before == MathClass::function || before == MathClass::binary || before == MathClass::relation || before == MathClass::opening || before == MathClass::punctuation;
    return now == MathClass::binary && nothing ? MathClass::ordinary : now;
}

bool leaves_alone(MathClass now) { return now == MathClass::none || now == MathClass::relation || now == MathClass::closing || now == MathClass::punctuation; }

double space_between(MathClass before, MathClass now) {
    using enum MathClass;
    if (before == none || before == opening || now == closing || now == punctuation) return before == punctuation ? kThin : 0;
    if (before == punctuation) return kThin;
    if (before == relation || now == relation) return before == now ? 0 : kThick;
    if (before == binary || now == binary) return kMedium;
    if (now == function) return kThin;
    return before == function && now == ordinary ? kThin : 0;
}

double space_of(const std::string& text) {
    double all = 0;
    for (std::size_t at = 0; at < text.size();) {
        if (text[at] == ' ') {
            all += 0.25, ++at;
            continue;
        }
        const std::string character = text.substr(at, 3);
        if (character == "\u2009") all += kThin;
        else if (character == "\u2005") all += kMedium;
        else if (character == "\u2003") all += 1;
        else return 0;
        at += 3;
    }
    return all;
}

}  // namespace isoparm
