#include <algorithm>
#include <cctype>
#include <cmath>

#include "drawing/math_symbols.h"
#include "drawing/math_text.h"

namespace isoparm {
namespace {

std::vector<std::string> characters(const std::string& text) {
    std::vector<std::string> all;
    for (std::size_t i = 0; i < text.size(); i += all.back().size()) all.push_back(character_at(text, i));
    return all;
}

std::string escaped(const std::string& character) {
    if (character == "\\") return "\\textbackslash{}";
    if (character == "~") return "\\textasciitilde{}";
    if (character == "^") return "\\textasciicircum{}";
    return character.find_first_of("#$%&_{}") == std::string::npos ? character : "\\" + character;
}

/// In scripts it stays mathematics.
bool prose(const TextRun& run) { return run.prose && run.scale == 1; }

bool letter(const std::string& character) { return character.size() == 1 && std::isalpha(static_cast<unsigned char>(character[0])); }

std::string mathematics(const TextRun& run) {
    std::string all;
    const auto list = characters(run.text);
    for (std::size_t i = 0; i < list.size(); ++i) {
        const std::string& c = list[i];
        std::string name = tex_of_symbol(c), closing;
        for (; i + 1 < list.size() && !tex_of_accent(list[i + 1]).empty(); ++i) all += tex_of_accent(list[i + 1]) + "{", closing += "}";
        if (!run.italic && !run.bold && closing.empty() && letter(c) && i + 1 < list.size() && letter(list[i + 1])) {  // sin, max
            all += "\\operatorname{";
            for (; i < list.size() && letter(list[i]); ++i) all += list[i];
            all += "}", --i;
            continue;
        }
        if (!name.empty()) all += name;
        else if (c.size() > 1) all += "\\text{" + c + "}";
        else if (run.bold && letter(c)) all += "\\mathbf{" + c + "}";
        else if (!run.italic && letter(c)) all += "\\mathrm{" + c + "}";
        else all += escaped(c);
        all += closing;
    }
    return all;
}

/// Opens and closes _{ and ^{ as base lines and sizes change.
class Writer {
public:
    std::string run(const MathText& text) {
        write(text);
        leave();
        return out_;
    }

private:
    struct Level {
        double scale, rise;
    };
    void write(const MathText& text) {
        for (std::size_t i = 0; i < text.size(); ++i) {
            const std::size_t sign = root_of(text, i);
            const MathText index(text.begin() + static_cast<std::ptrdiff_t>(i), text.begin() + static_cast<std::ptrdiff_t>(sign));
            i = sign;
            if (text[i].covers > 0) root(text[i], i + text[i].covers, index);
            else if (prose(text[i]) && roots_.empty()) words(text[i]);
            else formula(text[i]);
            while (!roots_.empty() && roots_.back().last == i) end_root();
        }
    }
    void words(const TextRun& r) {
        leave();
        for (const std::string& c : characters(r.text)) {
            const std::string name = tex_of_symbol(c);
            out_ += name.empty() ? escaped(c) : "$" + name + "$";
        }
    }
    /// The radical sign whose index begins there, the outer one of several; `i` where none does.
    static std::size_t root_of(const MathText& text, std::size_t i) {
        for (std::size_t sign = text.size() - 1; sign > i; --sign)
            if (text[sign].index > 0 && text[sign].index == sign - i) return sign;
        return i;
    }
    static std::string index_of(MathText index) {
        const TextRun base = *std::max_element(index.begin(), index.end(), [](const TextRun& a, const TextRun& b) { return a.scale < b.scale; });
        for (TextRun& i : index) i.scale /= base.scale, i.rise = (i.rise - base.rise) / base.scale;
        Writer writer;  // within a formula, and a root
        writer.inside_ = true;
        writer.roots_.push_back({std::string::npos, 1});
        writer.write(index);
        while (writer.levels_.size() > 1) writer.close();
        return writer.out_.find(']') == std::string::npos ? writer.out_ : "{" + writer.out_ + "}";
    }
    /// \sqrt, up to the end of that run.
    void root(const TextRun& r, std::size_t last, const MathText& index) {
        formula({"", false, false, r.scale, r.rise});
        out_ += "\\sqrt";
        if (!index.empty()) out_ += "[" + index_of(index) + "]";
        out_ += "{";
        roots_.push_back({last, levels_.size()});
        levels_.push_back({r.scale, r.rise});
    }
    void end_root() {
        while (levels_.size() > roots_.back().levels) close();
        roots_.pop_back();
    }
    void formula(const TextRun& r) {
        if (!inside_) out_ += "$", inside_ = true;
        const auto same = [&](const Level& l) { return std::fabs(l.scale - r.scale) < 1e-9 && std::fabs(l.rise - r.rise) < 1e-9; };
        while (!same(levels_.back()) && levels_.size() > 1 && levels_.back().scale <= r.scale + 1e-9) close();
        if (!same(levels_.back())) {
            out_ += r.rise < levels_.back().rise ? "_{" : "^{";
            levels_.push_back({r.scale, r.rise});
        }
        out_ += mathematics(r);
    }
    void close() {
        out_ += "}";
        levels_.pop_back();
    }
    void leave() {
        while (levels_.size() > 1) close();
        if (inside_) out_ += "$";
        inside_ = false;
    }
    struct Root {
        std::size_t last, levels;
    };
    std::vector<Root> roots_;
    std::string out_;
    bool inside_ = false;
    std::vector<Level> levels_{{1, 0}};
};

}  // namespace

std::string tex_of(const MathText& text) { return Writer().run(text); }

}  // namespace isoparm
