#include "math_text.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <map>

#include "suggest.h"

namespace isoparm {
namespace {

constexpr double kScript = 0.70, kSubscript = -0.20, kSuperscript = 0.38;
constexpr int kDeepest = 8;

struct Symbol {
    const char* text;
    bool italic;
};
const std::map<std::string, Symbol>& symbols() {
    static const std::map<std::string, Symbol> all{
        {"alpha", {"α", true}},    {"beta", {"β", true}},   {"gamma", {"γ", true}},   {"delta", {"δ", true}},
        {"epsilon", {"ε", true}},  {"zeta", {"ζ", true}},   {"eta", {"η", true}},     {"theta", {"θ", true}},
        {"iota", {"ι", true}},     {"kappa", {"κ", true}},  {"lambda", {"λ", true}},  {"mu", {"μ", true}},
        {"nu", {"ν", true}},       {"xi", {"ξ", true}},     {"pi", {"π", true}},      {"rho", {"ρ", true}},
        {"sigma", {"σ", true}},    {"tau", {"τ", true}},    {"upsilon", {"υ", true}}, {"phi", {"φ", true}},
        {"chi", {"χ", true}},      {"psi", {"ψ", true}},    {"omega", {"ω", true}},   {"Gamma", {"Γ", false}},
        {"Delta", {"Δ", false}},   {"Theta", {"Θ", false}}, {"Lambda", {"Λ", false}}, {"Xi", {"Ξ", false}},
        {"Pi", {"Π", false}},      {"Sigma", {"Σ", false}}, {"Phi", {"Φ", false}},    {"Psi", {"Ψ", false}},
        {"Omega", {"Ω", false}},   {"cdot", {"·", false}},  {"times", {"×", false}},  {"le", {"≤", false}},
        {"ge", {"≥", false}},      {"ne", {"≠", false}},    {"pm", {"±", false}},     {"infty", {"∞", false}},
        {"partial", {"∂", false}}, {"oplus", {"⊕", false}}, {"to", {"→", false}},     {"prime", {"′", false}},
        {"circ", {"°", false}},    {"ldots", {"…", false}}, {"sin", {"sin", false}},  {"cos", {"cos", false}},
        {"exp", {"exp", false}},   {"sum", {"∑", false}},   {"in", {"∈", false}},     {"quad", {"\u2003", false}}};
    return all;
}

bool letter(char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; }
std::size_t character(const std::string& s, std::size_t at) {  // its bytes
    std::size_t n = 1;
    while (at + n < s.size() && (static_cast<unsigned char>(s[at + n]) & 0xc0) == 0x80) ++n;
    return n;
}

class Parser {
public:
    explicit Parser(const std::string& text) : text_(text) {}

    void prose(std::size_t from, std::size_t to) {
        for (std::size_t i = from; i < to; i += character(text_, i)) put(text_.substr(i, character(text_, i)), false);
    }
    void mathematics(std::size_t from, std::size_t to) {
        for (at_ = from; at_ < to;) atom(to);
    }
    MathText take() { return std::move(runs_); }

private:
    [[noreturn]] void fail(std::size_t at, const std::string& message) const { throw MathTextError(at, message); }

    /// One letter, symbol, group or script.
    void atom(std::size_t to) {
        const char c = text_[at_];
        if (c == '_' || c == '^') return script(to);
        after_subscript_ = false;
        if (c == '{') return group(to);
        if (c == '}') fail(at_, "found \"}\", expected a \"{\" before it");
        if (c == '\\') return command(to);
        if (c == ' ') return put("\u2009", false), void(++at_);  // thin
        if (c == '-') return put("\u2212", false), void(++at_);
        if (c == '\'') return put("\u2032", false), void(++at_);
        const std::string one = text_.substr(at_, character(text_, at_));
        at_ += one.size();
        put(one, letter(c));
    }
    void group(std::size_t to) {
        const std::size_t open = at_++;
        if (++depth_ > kDeepest)
            fail(open, "found brackets nested deeper than " + std::to_string(kDeepest) + " levels, expected fewer");
        while (at_ < to && text_[at_] != '}') atom(to);
        if (at_ >= to) fail(open, "found \"{\" without an end, expected \"}\"");
        ++at_;
        --depth_;
    }
    void script(std::size_t to) {
        const std::size_t sign = at_++;
        const bool below = text_[sign] == '_';
        if (at_ >= to || text_[at_] == '_' || text_[at_] == '^')
            fail(sign, std::string("found nothing behind \"") + text_[sign] + "\", expected a character or {several}");
        const bool over = !below && after_subscript_;
        const double scale = scale_, rise = rise_;
        rise_ += scale_ * (below ? kSubscript : kSuperscript);
        scale_ *= kScript;
        next_ = below ? TextRun::Begins::subscript : over ? TextRun::Begins::over_subscript : TextRun::Begins::behind;
        fresh_ = true;
        atom(to);
        scale_ = scale;
        rise_ = rise;
        fresh_ = true;
        next_ = TextRun::Begins::behind;
        after_subscript_ = below;
    }
    void command(std::size_t to) {
        const std::size_t start = at_++;
        while (at_ < to && letter(text_[at_])) ++at_;
        const std::string name = text_.substr(start + 1, at_ - start - 1);
        if (name == "mathbf" || name == "mathrm") {
            const bool bold = bold_, upright = upright_;
            (name == "mathbf" ? bold_ : upright_) = true;
            if (at_ >= to || text_[at_] != '{') fail(start, "found \"\\" + name + "\", expected {letters} behind it");
            group(to);
            bold_ = bold;
            upright_ = upright;
            return;
        }
        const auto known = symbols().find(name);
        if (known == symbols().end()) {
            std::vector<std::string> names{"mathbf", "mathrm"};
            for (const auto& s : symbols()) names.push_back(s.first);
            fail(start, "found \"\\" + name + "\", expected the name of a Greek letter or sign, such as \\alpha" +
                            did_you_mean(name, names));
        }
        put(known->second.text, known->second.italic);
    }
    void put(const std::string& letters, bool italic) {
        italic = italic && !upright_ && !bold_;
        if (!fresh_ && !runs_.empty() && runs_.back().italic == italic && runs_.back().bold == bold_) {
            runs_.back().text += letters;
            return;
        }
        runs_.push_back({letters, italic, bold_, scale_, rise_, next_});
        fresh_ = false;
        next_ = TextRun::Begins::behind;
    }

    const std::string& text_;
    std::size_t at_ = 0;
    MathText runs_;
    double scale_ = 1, rise_ = 0;
    bool bold_ = false, upright_ = false, fresh_ = true, after_subscript_ = false;
    TextRun::Begins next_ = TextRun::Begins::behind;
    int depth_ = 0;
};

bool looks_like_mathematics(const std::string& s) {
    if (s.find_first_of("_^\\") != std::string::npos) return true;
    for (std::size_t i = 0; i + 1 < s.size(); ++i)
        if ((letter(s[i]) || (s[i] & 0x80)) && (letter(s[i + 1]) || (s[i + 1] & 0x80))) return false;
    return true;
}

}  // namespace

MathText parse_math_text(const std::string& text, bool prose) {
    Parser parser(text);
    if (text.find('$') == std::string::npos) {
        if (!prose && looks_like_mathematics(text))
            parser.mathematics(0, text.size());
        else
            parser.prose(0, text.size());
        return parser.take();
    }
    bool inside = false;
    for (std::size_t from = 0; from <= text.size();) {
        const std::size_t to = std::min(text.find('$', from), text.size());
        if (inside && to == text.size())
            throw MathTextError(from - 1, "found \"$\" without an end, expected another \"$\"");
        if (inside)
            parser.mathematics(from, to);
        else
            parser.prose(from, to);
        inside = !inside;
        from = to + 1;
    }
    return parser.take();
}

std::string tex_of_symbol(const std::string& character) {
    if (character == "\u2212") return "-";
    if (character == "\u2009") return "\\,";
    if (character == "\u2032") return "'";
    for (const auto& [name, symbol] : symbols())
        if (character == symbol.text && static_cast<unsigned char>(character[0]) >= 0x80) return "\\" + name + " ";
    return "";
}

MathText number_text(double x, int digits) {
    char text[64];
    std::snprintf(text, sizeof text, "%.*f", digits, x == 0 ? 0.0 : x);
    std::string s = text;
    if (s.find('.') != std::string::npos) {
        s.erase(s.find_last_not_of('0') + 1);
        if (s.back() == '.') s.pop_back();
    }
    if (s == "-0") s = "0";
    if (s[0] == '-') s.replace(0, 1, "\u2212");
    return {{s}};
}

}  // namespace isoparm
