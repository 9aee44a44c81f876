#include "certificate_file.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <ostream>

#include "isoparm_version.h"
#include "scene/json.h"
#include "scene/suggest.h"
#include "text/json_text.h"

namespace isoparm {
namespace {

constexpr int kVersion = 1;

std::string list(const Vec2& p) {
    std::string text = "[";
    return text += to_text(p.x) + ", " + to_text(p.y) + "]";
}

}  // namespace

bool slides(const CertifiedTriangle& t) {
    for (const auto& edge : t.slide)
        for (const Vec2& w : edge)
            if (w.x != 0 || w.y != 0) return true;
    return false;
}

namespace {

void write_triangle(std::ostream& out, const CertifiedTriangle& t) {
    out << "{\"corners\": [" << t.corner[0] << ", " << t.corner[1] << ", " << t.corner[2] << "], \"bound\": " << to_text(t.bound) << ", \"method\": ";
    if (!slides(t)) {
        out << "\"parametric\"}";
        return;
    }
    out << "\"sliding\", \"slides\": [";
    for (int k = 0; k < 3; ++k) out << (k ? ", " : "") << list(t.slide[k][0]) << ", " << list(t.slide[k][1]);
    out << "]}";
}

/// Reads JSON whose keys come in a known order.
class Scanner {
public:
    Scanner(const std::string& text, const std::string& path) : text_(text), path_(path) {}

    void expect(char c) {
        if (!next_is(c)) fail(quoted(std::string(1, c)));
        ++at_;
    }
    bool next_is(char c) {
        skip_space();
        return at_ < text_.size() && text_[at_] == c;
    }
    /// "name":
    void key(const char* name) {
        skip_space();
        const std::size_t start = at_;
        if (string() != name) at_ = start, fail("the key " + quoted(name));
        expect(':');
    }
    double number() {
        skip_space();
        double x = 0;
        const auto [stop, error] = std::from_chars(text_.data() + at_, text_.data() + text_.size(), x);
        if (error != std::errc() || !std::isfinite(x)) fail("a number");
        at_ = std::size_t(stop - text_.data());
        return x;
    }
    std::uint32_t index() {
        skip_space();
        std::uint32_t x = 0;
        const auto [stop, error] = std::from_chars(text_.data() + at_, text_.data() + text_.size(), x);
        if (error != std::errc()) fail("a whole number that is not negative");
        at_ = std::size_t(stop - text_.data());
        return x;
    }
    std::string string() {
        expect('"');
        std::string r;
        for (; at_ < text_.size() && text_[at_] != '"'; ++at_) {
            if (text_[at_] != '\\') r += text_[at_];
            else if (++at_; at_ < text_.size() && text_[at_] == 'n') r += '\n';
            else if (at_ < text_.size() && text_[at_] == 'u') r += code();
            else if (at_ < text_.size()) r += text_[at_];
        }
        expect('"');
        return r;
    }
    /// [item, item, ...]
    template <class Item> void each(char open, char close, Item item) {
        expect(open);
        for (bool first = true; !next_is(close); first = false) {
            if (!first) expect(',');
            item();
        }
        expect(close);
    }
    Vec2 pair() {
        expect('[');
        const double x = number();
        expect(',');
        const double y = number();
        expect(']');
        return {x, y};
    }
    void end() {
        skip_space();
        if (at_ < text_.size()) fail("the end of the file");
    }
    [[noreturn]] void fail(const std::string& expected) const {
        std::string found = "the end of the file";
        if (at_ < text_.size()) found = quoted(text_.substr(at_, std::clamp<std::size_t>(text_.find_first_of("\n,]}", at_) - at_, 1, 16)));
        throw LocatedError(path_ + ":" + line_and_column(text_, at_) + ": found " + found + ", expected " + expected);
    }
    /// read() and what it returns, unless that is not as expected.
    template <class Read, class Good> auto only(Read read, Good good, const std::string& expected) {
        skip_space();
        const std::size_t start = at_;
        auto x = read();
        if (!good(x)) at_ = start, fail(expected);
        return x;
    }

    std::string word(const std::vector<std::string>& words) {
        return only([&] { return string(); }, [&](const std::string& x) { return std::find(words.begin(), words.end(), x) != words.end(); }, quoted(words[0]) + " or " + quoted(words[1]));
    }

private:
    void skip_space() { at_ = std::min(text_.find_first_not_of(" \t\r\n", at_), text_.size()); }
    /// Of a control character, the only ones that are written so.
    char code() {
        unsigned x = 0;
        const auto first = text_.data() + at_ + 1;
        if (at_ + 5 > text_.size() || std::from_chars(first, first + 4, x, 16).ptr != first + 4 || x >= 0x20) fail("\\u0000 to \\u001f");
        at_ += 4;
        return static_cast<char>(x);
    }
    const std::string& text_;
    const std::string path_;
    std::size_t at_ = 0;
};

CertifiedTriangle read_triangle(Scanner& in) {
    CertifiedTriangle t;
    in.expect('{'), in.key("corners"), in.expect('[');
    for (int k = 0; k < 3; ++k) {
        if (k) in.expect(',');
        t.corner[k] = in.index();
    }
    in.expect(']'), in.expect(','), in.key("bound");
    t.bound = in.number();
    in.expect(','), in.key("method");
    if (in.word({"parametric", "sliding"}) == "sliding") {
        in.expect(','), in.key("slides"), in.expect('[');
        for (int k = 0; k < 6; ++k) {
            if (k) in.expect(',');
            t.slide[k / 2][k % 2] = in.pair();
        }
        in.expect(']');
    }
    in.expect('}');
    return t;
}

CertifiedPatch read_patch(Scanner& in) {
    CertifiedPatch p;
    in.expect('{'), in.key("name");
    p.name = in.string();
    in.expect(','), in.key("corners");
    in.each('[', ']', [&] {
        in.expect('[');
        const double u = in.number();
        in.expect(',');
        const double v = in.number();
        in.expect(',');
        p.uv.push_back({u, v}), p.vertex.push_back(in.index());
        in.expect(']');
    });
    in.expect(','), in.key("triangles");
    in.each('[', ']', [&] { p.triangles.push_back(read_triangle(in)); });
    in.expect('}');
    return p;
}

}  // namespace

void write_certificate(std::ostream& out, const CertificateFile& file) {
    const Certificate& c = file.certificate;
    out << "{\"isoparm_certificate\": " << kVersion << ", \"program\": \"isoparm " ISOPARM_VERSION "\",\n \"scene\": " << json_text(file.scene) << ", \"sha256\": " << json_text(file.sha256)
        << ", \"surface\": " << json_text(file.surface.value_or("")) << ", \"parameters\": {";
    bool first = true;
    for (const auto& [name, value] : file.parameters) out << (first ? "" : ", ") << json_text(name) << ": " << to_text(value), first = false;
    out << "},\n \"measure\": " << json_text(file.measure) << ", \"tolerance\": " << to_text(c.tolerance) << ", \"certified_error\": " << to_text(c.certified_error) << ",\n \"vertices\": [";
    const char* before = "\n";
    const auto line = [&]() -> std::ostream& {
        out << before;
        before = ",\n";
        return out;
    };
    for (const Point& p : c.points) line() << "[" << to_text(p.x) << ", " << to_text(p.y) << ", " << to_text(p.z) << "]";
    out << "],\n \"patches\": [";
    for (const CertifiedPatch& p : c.patches) {
        out << (&p == &c.patches.front() ? "\n" : ",\n") << "{\"name\": " << json_text(p.name) << ", \"corners\": [";
        before = "\n";
        for (std::size_t i = 0; i < p.uv.size(); ++i) line() << "[" << to_text(p.uv[i].x) << ", " << to_text(p.uv[i].y) << ", " << p.vertex[i] << "]";
        out << "],\n \"triangles\": [";
        before = "\n";
        for (const CertifiedTriangle& t : p.triangles) write_triangle(line(), t);
        out << "]}";
    }
    out << "]}\n";
}

CertificateFile read_certificate(const std::string& text, const std::string& path) {
    CertificateFile file;
    Certificate& c = file.certificate;
    Scanner in(text, path);
    const auto next = [&](const char* key) { in.expect(','), in.key(key); };
    in.expect('{'), in.key("isoparm_certificate");
    in.only([&] { return in.number(); }, [](double x) { return x == kVersion; }, "version " + std::to_string(kVersion) + " of the format");
    next("program"), in.string();
    next("scene"), file.scene = in.string();
    next("sha256"), file.sha256 = in.string();
    next("surface");
    if (const std::string name = in.string(); !name.empty()) file.surface = name;
    next("parameters");
    in.each('{', '}', [&] {
        const std::string name = in.string();
        in.expect(':');
        file.parameters[name] = in.number();
    });
    next("measure"), file.measure = in.word({"geometric", "parametric"});
    next("tolerance"), c.tolerance = in.number();
    next("certified_error"), c.certified_error = in.number();
    next("vertices");
    in.each('[', ']', [&] {
        Point p;
        in.expect('[');
        for (int axis = 0; axis < 3; ++axis) {
            if (axis) in.expect(',');
            p[axis] = in.number();
        }
        in.expect(']');
        c.points.push_back(p);
    });
    next("patches");
    in.each('[', ']', [&] { c.patches.push_back(read_patch(in)); });
    in.expect('}'), in.end();
    return file;
}

}  // namespace isoparm
