// math_spacing.h -- the space between the signs of a formula, as TeX has it (Knuth, The TeXbook, 1984, chapter 18).
#pragma once
#include <string>

namespace isoparm {

/// Letters and digits; sums and functions; signs such as +; such as =; brackets; commas. `none`: where a formula begins.
enum class MathClass { none, ordinary, function, binary, relation, opening, closing, punctuation };
/// Of a character, or of an upright word ("sin").
MathClass math_class(const std::string& text);
/// A binary sign that has nothing to join on its left ("-1", "= -1") is an ordinary one.
MathClass math_class_behind(MathClass before, MathClass now);
/// Is a binary sign before such a one left without something to join?
bool leaves_alone(MathClass now);
/// In ems.
double space_between(MathClass before, MathClass now);
/// That of a text which is nothing but space; 0 of others.
double space_of(const std::string& text);

}  // namespace isoparm
