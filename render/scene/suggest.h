// suggest.h -- words for messages: quoted text, lists of names, and what a misspelt name may have meant.
#pragma once
#include <string>
#include <vector>

namespace isoparm {
/// In double quotes, control characters escaped, shortened to 60 characters.
std::string quoted(const std::string& text);
/// "a, b, c"; "nothing" when empty; shortened after 20.
std::string listed(const std::vector<std::string>& names);
/// "; did you mean \"points\"?" when a name is close, otherwise "".
std::string did_you_mean(const std::string& word, const std::vector<std::string>& names);
/// Of the letters of ASCII.
std::string lower_case(std::string text);

}  // namespace isoparm
