#include "scene/suggest.h"

#include <algorithm>
#include <cctype>

namespace isoparm {

std::string quoted(const std::string& text) {
    static constexpr char hex[] = "0123456789abcdef";
    std::string r = "\"";
    for (std::size_t i = 0; i < text.size(); ++i) {
        const auto c = static_cast<unsigned char>(text[i]);
        if (r.size() > 60 && (c & 0xC0) != 0x80) return r + "...\"";
        if (c == '\n') r += "\\n";
        else if (c == '\t') r += "\\t";
        else if (c == '"' || c == '\\') r += '\\', r += text[i];
        else if (c < 0x20 || c == 0x7f) r += std::string("\\x") + hex[c >> 4] + hex[c & 15];
        else r += text[i];
    }
    return r + "\"";
}

std::string listed(const std::vector<std::string>& names) {
    if (names.empty()) return "nothing";
    std::string r;
    for (std::size_t i = 0; i < names.size(); ++i) {
        if (i == 20) return r + ", ... (" + std::to_string(names.size()) + " in all)";
        r += (i ? ", " : "") + names[i];
    }
    return r;
}

namespace {
// Levenshtein distance, where letters that differ in case only cost nothing.
std::size_t edit_distance(const std::string& a, const std::string& b) {
    std::vector<std::size_t> row(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
    for (std::size_t i = 1; i <= a.size(); ++i) {
        std::size_t diagonal = row[0];
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const bool same = std::tolower(static_cast<unsigned char>(a[i - 1])) == std::tolower(static_cast<unsigned char>(b[j - 1]));
            const std::size_t replaced = diagonal + (same ? 0 : 1);
            diagonal = row[j];
            row[j] = std::min({replaced, row[j] + 1, row[j - 1] + 1});
        }
    }
    return row[b.size()];
}
}  // namespace

std::string did_you_mean(const std::string& word, const std::vector<std::string>& names) {
    if (word.size() > 64) return "";
    std::size_t best = std::max<std::size_t>(1, word.size() / 3) + 1;
    const std::string* found = nullptr;
    for (const auto& n : names) {
        const std::size_t d = edit_distance(word, n);
        if (d < best && d < n.size()) best = d, found = &n;
    }
    return found ? "; did you mean " + quoted(*found) + "?" : "";
}

std::string lower_case(std::string text) {
    for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return text;
}

}  // namespace isoparm
