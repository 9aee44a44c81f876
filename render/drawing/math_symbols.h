// math_symbols.h -- what TeX's names stand for in labels, as characters, and back.
#pragma once
#include <optional>
#include <string>
#include <vector>

namespace isoparm {

/// All bytes (UTF-8) of the character that begins at `at`.
std::string character_at(const std::string& text, std::size_t at);

/// A character that is set slanted, as variables are, or upright; or an upright word ("sin").
struct MathSymbol {
    std::string text;
    bool italic = false;
};
/// Of a name without its backslash.
std::optional<MathSymbol> math_symbol(const std::string& name);
/// The combining character of \hat, \vec ...; "" of other names.
std::string math_accent(const std::string& name);
/// An upper-case letter in the alphabet of \mathbb or \mathcal; "" of other characters.
std::string math_letter(const std::string& alphabet, char letter);
/// All names, for advice.
std::vector<std::string> math_names();

/// "\alpha " of "α", "\mathbb{R}" of "ℝ"; "" of characters that mathematics has no name for.
std::string tex_of_symbol(const std::string& character);
/// "\hat" of a combining circumflex; "" of characters that are no accents.
std::string tex_of_accent(const std::string& character);

}  // namespace isoparm
