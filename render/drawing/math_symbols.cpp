#include "drawing/math_symbols.h"

#include <map>
#include <utility>

namespace isoparm {
namespace {

const std::map<std::string, MathSymbol>& symbols() {
    static const std::map<std::string, MathSymbol> all{
        {"alpha", {"α", true}}, {"beta", {"β", true}}, {"gamma", {"γ", true}}, {"delta", {"δ", true}}, {"epsilon", {"ε", true}},
        {"zeta", {"ζ", true}}, {"eta", {"η", true}}, {"theta", {"θ", true}}, {"iota", {"ι", true}}, {"kappa", {"κ", true}}, {"lambda", {"λ", true}},
        {"mu", {"μ", true}}, {"nu", {"ν", true}}, {"xi", {"ξ", true}}, {"pi", {"π", true}}, {"rho", {"ρ", true}}, {"sigma", {"σ", true}},
        {"tau", {"τ", true}}, {"upsilon", {"υ", true}}, {"phi", {"φ", true}}, {"chi", {"χ", true}}, {"psi", {"ψ", true}}, {"omega", {"ω", true}},
        {"Gamma", {"Γ", false}}, {"Delta", {"Δ", false}}, {"Theta", {"Θ", false}}, {"Lambda", {"Λ", false}}, {"Xi", {"Ξ", false}},
        {"Pi", {"Π", false}}, {"Sigma", {"Σ", false}}, {"Phi", {"Φ", false}}, {"Psi", {"Ψ", false}}, {"Omega", {"Ω", false}}, {"cdot", {"·", false}},
        {"times", {"×", false}}, {"le", {"≤", false}}, {"ge", {"≥", false}}, {"ne", {"≠", false}}, {"pm", {"±", false}}, {"infty", {"∞", false}},
        {"partial", {"∂", false}}, {"oplus", {"⊕", false}}, {"to", {"→", false}}, {"prime", {"′", false}}, {"circ", {"°", false}},
        {"ldots", {"…", false}}, {"sin", {"sin", false}}, {"cos", {"cos", false}}, {"exp", {"exp", false}}, {"sum", {"∑", false}},
        {"in", {"∈", false}}, {"quad", {"\u2003", false}}, {"varepsilon", {"ε", true}}, {"vartheta", {"ϑ", true}}, {"varphi", {"φ", true}},
        {"varrho", {"ϱ", true}}, {"varsigma", {"ς", true}}, {"ell", {"ℓ", true}}, {"hbar", {"ℏ", false}}, {"Upsilon", {"Υ", false}},
        {"leq", {"≤", false}}, {"geq", {"≥", false}}, {"neq", {"≠", false}}, {"ll", {"≪", false}}, {"gg", {"≫", false}}, {"approx", {"≈", false}},
        {"sim", {"∼", false}}, {"simeq", {"≃", false}}, {"cong", {"≅", false}}, {"equiv", {"≡", false}}, {"propto", {"∝", false}},
        {"mp", {"∓", false}}, {"otimes", {"⊗", false}}, {"ominus", {"⊖", false}}, {"wedge", {"∧", false}}, {"vee", {"∨", false}},
        {"cup", {"∪", false}}, {"cap", {"∩", false}}, {"subset", {"⊂", false}}, {"subseteq", {"⊆", false}}, {"supset", {"⊃", false}},
        {"setminus", {"∖", false}}, {"notin", {"∉", false}}, {"emptyset", {"∅", false}}, {"nabla", {"∇", false}}, {"forall", {"∀", false}},
        {"exists", {"∃", false}}, {"mapsto", {"↦", false}}, {"rightarrow", {"→", false}}, {"leftarrow", {"←", false}},
        {"leftrightarrow", {"↔", false}}, {"Rightarrow", {"⇒", false}}, {"Leftrightarrow", {"⇔", false}}, {"perp", {"⊥", false}},
        {"parallel", {"∥", false}}, {"mid", {"∣", false}}, {"angle", {"∠", false}}, {"langle", {"⟨", false}}, {"rangle", {"⟩", false}},
        {"ast", {"∗", false}}, {"star", {"⋆", false}}, {"bullet", {"•", false}}, {"div", {"÷", false}}, {"cdots", {"⋯", false}},
        {"dots", {"…", false}}, {"int", {"∫", false}}, {"prod", {"∏", false}}, {"surd", {"√", false}}, {"deg", {"deg", false}},
        {"det", {"det", false}}, {"dim", {"dim", false}}, {"tan", {"tan", false}}, {"log", {"log", false}}, {"ln", {"ln", false}},
        {"lim", {"lim", false}}, {"max", {"max", false}}, {"min", {"min", false}}, {"arctan", {"arctan", false}}, {"arccos", {"arccos", false}},
        {"arcsin", {"arcsin", false}}, {"cosh", {"cosh", false}}, {"sinh", {"sinh", false}}, {"qquad", {"\u2003\u2003", false}}};
    return all;
}

constexpr std::pair<const char*, const char*> kAccents[] = {{"hat", "\u0302"}, {"bar", "\u0304"}, {"tilde", "\u0303"}, {"vec", "\u20d7"}, {"dot", "\u0307"}, {"ddot", "\u0308"}, {"overline", "\u0305"}, {"underline", "\u0332"}};

/// Those that Unicode had before the rest of the alphabet.
const std::map<char, const char*>& early_letters(const std::string& alphabet) {
    static const std::map<char, const char*> bb{{'C', "ℂ"}, {'H', "ℍ"}, {'N', "ℕ"}, {'P', "ℙ"}, {'Q', "ℚ"}, {'R', "ℝ"}, {'Z', "ℤ"}};
    static const std::map<char, const char*> cal{{'B', "ℬ"}, {'E', "ℰ"}, {'F', "ℱ"}, {'H', "ℋ"}, {'I', "ℐ"}, {'L', "ℒ"}, {'M', "ℳ"}, {'R', "ℛ"}};
    return alphabet == "mathbb" ? bb : cal;
}

std::string utf8(unsigned code) {
    return {static_cast<char>(0xf0 | code >> 18), static_cast<char>(0x80 | (code >> 12 & 0x3f)), static_cast<char>(0x80 | (code >> 6 & 0x3f)), static_cast<char>(0x80 | (code & 0x3f))};
}

}  // namespace

std::optional<MathSymbol> math_symbol(const std::string& name) {
    const auto known = symbols().find(name);
    return known == symbols().end() ? std::nullopt : std::optional(known->second);
}

std::string math_accent(const std::string& name) {
    for (const auto& [known, character] : kAccents)
        if (name == known) return character;
    return "";
}

std::string math_letter(const std::string& alphabet, char letter) {
    if (letter < 'A' || letter > 'Z') return "";
    const auto& early = early_letters(alphabet);
    const auto known = early.find(letter);
    return known != early.end() ? known->second : utf8((alphabet == "mathbb" ? 0x1d538u : 0x1d49cu) + static_cast<unsigned>(letter - 'A'));
}

std::vector<std::string> math_names() {
    std::vector<std::string> names{"frac", "sqrt", "text", "mathbf", "mathrm", "mathit", "mathbb", "mathcal", "left", "right"};
    for (const auto& a : kAccents) names.push_back(a.first);
    for (const auto& s : symbols()) names.push_back(s.first);
    return names;
}

std::string character_at(const std::string& text, std::size_t at) {
    std::size_t n = 1;
    while (at + n < text.size() && (static_cast<unsigned char>(text[at + n]) & 0xc0) == 0x80) ++n;
    return text.substr(at, n);
}

std::string tex_of_symbol(const std::string& character) {
    if (character == "\u2212") return "-";
    if (character == "\u2009") return "\\,";
    if (character == "\u2005") return "\\:";
    if (character == "\u2032") return "'";
    if (character.empty() || static_cast<unsigned char>(character[0]) < 0x80) return "";
    for (const auto& [name, symbol] : symbols())
        if (character == symbol.text) return "\\" + name + " ";
    for (const char* alphabet : {"mathbb", "mathcal"})
        for (char letter = 'A'; letter <= 'Z'; ++letter)
            if (math_letter(alphabet, letter) == character) return std::string("\\") + alphabet + "{" + letter + "}";
    return "";
}

std::string tex_of_accent(const std::string& character) {
    for (const auto& [name, known] : kAccents)
        if (character == known) return std::string("\\") + name;
    return "";
}

}  // namespace isoparm
