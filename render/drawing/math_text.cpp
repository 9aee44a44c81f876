#include "drawing/math_text.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>

#include "drawing/math_spacing.h"
#include "drawing/math_symbols.h"
#include "scene/suggest.h"

namespace isoparm {
namespace {

constexpr double kScript = 0.70, kSubscript = -0.20, kSuperscript = 0.38;
constexpr double kIndex = 0.55, kIndexRise = 0.45, kIndexOver = 0.33;  // of a root: its size and place, ems, and how far it stands over the sign
constexpr int kDeepest = 8;

bool letter(char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; }

class Parser {
public:
    explicit Parser(const std::string& text) : text_(text) {}

    void prose(std::size_t from, std::size_t to) {
        const bool before = prose_;
        prose_ = true;
        for (std::size_t i = from; i < to; i += character_at(text_, i).size()) {
            if (text_[i] == '\\' && i + 1 < to && text_[i + 1] == '$') ++i;
            put(character_at(text_, i), false);
        }
        prose_ = before;
    }
    void mathematics(std::size_t from, std::size_t to) {
        begin();
        for (at_ = from; at_ < to;) atom(to);
        begin();
    }
    MathText take() { return std::move(runs_); }

private:
    [[noreturn]] void fail(std::size_t at, const std::string& message) const { throw MathTextError(at, message); }

    /// Nothing before it: where a formula begins or has ended.
    void begin() {
        join(MathClass::none), last_ = MathClass::none, written_ = 0;
    }
    /// The space between what was put last and what comes now. Scripts have none.
    void join(MathClass now) {
        if (scale_ != 1 || prose_) return;
        if (last_ == MathClass::binary && leaves_alone(now)) {  // a sign with nothing behind it
            if (binary_ < runs_.size()) runs_[binary_].before = 0;
            last_ = MathClass::ordinary;
        }
        now = math_class_behind(last_, now);
        if (now == MathClass::none) return;
        before_ = std::max(0.0, space_between(last_, now) - written_);
        if (now == MathClass::binary) binary_ = before_ > 0 ? runs_.size() : std::string::npos;
        last_ = now, written_ = 0;
    }

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
        const std::string one = character_at(text_, at_);
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
        if (name.empty()) return sign(start, to);
        if (const auto symbol = math_symbol(name)) return put(symbol->text, symbol->italic);
        if (const std::string accent = math_accent(name); !accent.empty()) return set(accents_, accents_ + accent, [&] { argument(name, to); });
        if (name == "sqrt" && !accents_.empty()) fail(start, "found a root below an accent, expected letters there");
        if (name == "mathbf" || name == "boldsymbol") return set(bold_, true, [&] { argument(name, to); });
        if (name == "mathrm" || name == "operatorname") return set(upright_, true, [&] { argument(name, to); });
        if (name == "mathbb" || name == "mathcal") return set(alphabet_, name, [&] { argument(name, to); });
        if (name == "mathit") return argument(name, to);
        if (name == "text" || name == "textrm") {
            const auto [from, end] = braces(name, to);
            join(MathClass::ordinary);
            prose(from, end);
            return;
        }
        if (name == "frac" || name == "tfrac" || name == "dfrac") return fraction(name, to);
        if (name == "sqrt") return root(name, to);
        if (name == "left" || name == "right") {
            if (at_ < to && text_[at_] == '.') ++at_;
            return;
        }
        std::vector<std::string> names = math_names();
        fail(start, "found \"\\" + name + "\", expected the name of a Greek letter or sign, such as \\alpha" + did_you_mean(name, names));
    }
    /// Behind a backslash that no letter follows.
    void sign(std::size_t start, std::size_t to) {
        const char c = at_ < to ? text_[at_++] : '\0';
        if (c == ',') put("\u2009", false);
        else if (c == ':' || c == ';' || c == ' ') put("\u2005", false);
        else if (c && std::string("{}_%$#&|").find(c) != std::string::npos) put(c == '|' ? "\u2225" : std::string(1, c), false);
        else if (c != '!') fail(start, "found a \"\\\" without a name, expected one such as \\alpha");
    }
    /// What stands behind a name: {several} or one.
    void argument(const std::string& name, std::size_t to) {
        while (at_ < to && text_[at_] == ' ') ++at_;
        if (at_ >= to || text_[at_] == '_' || text_[at_] == '^') fail(at_ - 1, "found nothing behind \"\\" + name + "\", expected a character or {several}");
        atom(to);
    }
    void root(const std::string& name, std::size_t to) {
        const std::size_t first = runs_.size();
        index(to);
        fresh_ = true;
        put("\u221a", false);
        const std::size_t sign = runs_.size() - 1;
        runs_[sign].index = sign - first;
        if (sign > first) runs_[sign].before = -kIndexOver * scale_;
        fresh_ = true;
        last_ = MathClass::none;
        argument(name, to);
        join(MathClass::none);
        runs_[sign].covers = runs_.size() - 1 - sign;
        fresh_ = true;
        last_ = MathClass::ordinary;
    }
    /// What stands in [ ] behind \sqrt, over the hook of the sign.
    void index(std::size_t to) {
        while (at_ < to && text_[at_] == ' ') ++at_;
        if (at_ >= to || text_[at_] != '[') return;
        const std::size_t open = at_++;
        join(MathClass::ordinary);
        const double scale = scale_, rise = rise_;
        scale_ *= kIndex, rise_ += scale * kIndexRise, fresh_ = true;
        while (at_ < to && text_[at_] != ']') atom(to);
        if (at_++ >= to) fail(open, "found \"[\" without an end, expected \"]\"");
        scale_ = scale, rise_ = rise;
    }
    /// A fraction in one line; what would be read wrongly without brackets gets some.
    void fraction(const std::string& name, std::size_t to) {
        bracketed(name, to, false);
        put("/", false);
        bracketed(name, to, true);
    }
    /// An argument, in brackets if it is a sum or, where `factors` says so, a product.
    void bracketed(const std::string& name, std::size_t to, bool factors) {
        while (at_ < to && text_[at_] == ' ') ++at_;
        bool needs = false;
        if (at_ < to && text_[at_] == '{') {
            const std::size_t here = at_;
            const auto [from, end] = braces(name, to);
            at_ = here;
            Parser inside(text_);
            inside.depth_ = depth_ + 1;
            inside.mathematics(from, end);
            needs = several(inside.runs_, factors);
        }
        if (needs) put("(", false);
        argument(name, to);
        if (needs) put(")", false);
    }
    static bool several(const MathText& runs, bool factors) {
        int found = 0;
        for (const TextRun& r : runs) {
            if (r.rise != 0) continue;  // scripts
            bool digit = false;
            for (std::size_t i = 0; i < r.text.size(); i += character_at(r.text, i).size()) {
                const std::string c = character_at(r.text, i);
                for (const char* sign : {"+", "\u2212", "±", "=", "/", ",", "·", "×"})
                    if (c == sign) return true;
                const bool number = std::isdigit(static_cast<unsigned char>(c[0])) || c == ".";
                const bool none = c == "\u2009" || c == "∂" || !tex_of_accent(c).empty();
                if (!none && !(digit && number)) ++found;
                digit = number;
            }
        }
        return factors && found > 1;
    }
    /// Where the text between the brackets that follow begins and ends; reading goes on behind them.
    std::pair<std::size_t, std::size_t> braces(const std::string& name, std::size_t to) {
        const std::size_t open = at_;
        if (open >= to || text_[open] != '{') fail(open - 1, "found \"\\" + name + "\", expected {letters} behind it");
        for (int depth = 0; at_ < to; ++at_) {
            depth += text_[at_] == '{' ? 1 : text_[at_] == '}' ? -1 : 0;
            if (depth == 0) return {open + 1, at_++};
        }
        fail(open, "found \"{\" without an end, expected \"}\"");
    }
    template <class T, class Do> static void set(T& what, T value, const Do& run) {
        std::swap(what, value);
        run();
        std::swap(what, value);
    }
    void put(const std::string& characters, bool italic) {
        italic = italic && !upright_ && !bold_ && alphabet_.empty();
        if (const double space = space_of(characters); space > 0) written_ += scale_ == 1 && !prose_ ? space : 0;
        else join(math_class(characters));
        if (before_ > 0) fresh_ = true;
        std::string letters;
        for (std::size_t i = 0; i < characters.size(); i += character_at(characters, i).size()) {
            const std::string other = alphabet_.empty() ? "" : math_letter(alphabet_, characters[i]);
            letters += (other.empty() ? character_at(characters, i) : other) + accents_;
        }
        if (!fresh_ && !runs_.empty() && runs_.back().italic == italic && runs_.back().bold == bold_ && runs_.back().prose == prose_) {
            runs_.back().text += letters;
            return;
        }
        runs_.push_back({letters, italic, bold_, scale_, rise_, next_, prose_, before_});
        before_ = 0;
        fresh_ = false;
        next_ = TextRun::Begins::behind;
    }

    const std::string& text_;
    std::size_t at_ = 0;
    MathText runs_;
    double scale_ = 1, rise_ = 0;
    bool bold_ = false, upright_ = false, prose_ = false, fresh_ = true, after_subscript_ = false;
    std::string accents_, alphabet_;  // above each letter; \mathbb or \mathcal
    TextRun::Begins next_ = TextRun::Begins::behind;
    int depth_ = 0;
    MathClass last_ = MathClass::none;  // of what was put last, in the formula's own size
    double written_ = 0, before_ = 0;   // space behind that: what was written, and what goes before the next run
    std::size_t binary_ = 0;            // the run of the last binary sign
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
    const auto dollar = [&](std::size_t from) {
        std::size_t at = text.find('$', from);
        while (at != std::string::npos && at > 0 && text[at - 1] == '\\') at = text.find('$', at + 1);
        return at;
    };
    if (dollar(0) == std::string::npos) {
        if (!prose && looks_like_mathematics(text))
            parser.mathematics(0, text.size());
        else
            parser.prose(0, text.size());
        return parser.take();
    }
    bool inside = false;
    for (std::size_t from = 0; from <= text.size();) {
        const std::size_t to = std::min(dollar(from), text.size());
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
