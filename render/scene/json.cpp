#include "scene/json.h"

#include <json/json.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <new>
#include <string_view>

#include "scene/suggest.h"

namespace isoparm {

namespace {
constexpr int kMaxDepth = 100;
constexpr std::size_t kMaxValues = 2'000'000;
}  // namespace

std::string read_text_file(const std::string& path, std::size_t limit) {
    const auto fail = [&](int error) { throw Error(ErrorKind::io, path + ": cannot be read: " + std::strerror(error)); };
    std::error_code code;
    if (std::filesystem::is_directory(path, code)) fail(EISDIR);
    errno = 0;
    std::ifstream in(path, std::ios::binary);
    if (!in) fail(errno ? errno : EIO);
    std::string text;
    char block[1 << 16];
    while (in.read(block, sizeof block) || in.gcount() > 0) {
        text.append(block, static_cast<std::size_t>(in.gcount()));
        if (text.size() > limit) {
            throw LocatedError(path + ":1:1: found a file of more than " + std::to_string(limit >> 20) + " MiB, expected less");
        }
    }
    if (in.bad()) fail(errno ? errno : EIO);
    return text;
}

std::string line_and_column(const std::string& text, std::size_t offset) {
    offset = std::min(offset, text.size());
    const auto end = text.begin() + static_cast<std::ptrdiff_t>(offset);
    const auto line = std::count(text.begin(), end, '\n') + 1;
    const std::size_t start = offset == 0 ? std::string::npos : text.rfind('\n', offset - 1);
    return std::to_string(line) + ":" + std::to_string(start == std::string::npos ? offset + 1 : offset - start);
}

class JsonDocument {
public:
    struct Node {
        Json::Kind kind = Json::Kind::null;
        bool boolean = false;
        int parent = -1, index = 0;  // which child of its parent
        std::size_t begin = 0, end = 0, key_begin = 0;
        double number = 0;
        std::string string, key;
        std::vector<int> children;
    };
    std::string path, text;
    std::vector<Node> nodes;

    [[noreturn]] void fail(std::size_t offset, const std::string& message) const {
        throw LocatedError(path + ":" + line_and_column(text, offset) + ": at " + message);
    }

    // Where the first byte stands that is not UTF-8 (Unicode 15, table 3-7); npos when all is.
    static std::size_t find_not_utf8(std::string_view s) {
        for (std::size_t i = 0; i < s.size();) {
            const auto byte = [&](std::size_t k) { return i + k < s.size() ? static_cast<unsigned char>(s[i + k]) : 0u; };
            const unsigned c = byte(0), next = byte(1);
            const std::size_t more = c < 0x80 ? 0 : c >= 0xC2 && c < 0xE0 ? 1 : c >= 0xE0 && c < 0xF0 ? 2 : c >= 0xF0 && c < 0xF5 ? 3 : 4;
            if (more == 4) return i;
            for (std::size_t k = 1; k <= more; ++k)
                if ((byte(k) & 0xC0) != 0x80) return i;
            const bool overlong = (c == 0xE0 && next < 0xA0) || (c == 0xF0 && next < 0x90);
            if (overlong || (c == 0xED && next > 0x9F) || (c == 0xF4 && next > 0x8F)) return i;
            i += more + 1;
        }
        return std::string_view::npos;
    }

    // JsonCpp reads "-" as 0, and "+1", "01", "-.5" and "5." as well.
    static bool is_json_number(std::string_view s) {
        std::size_t i = 0;
        const auto digits = [&] {
            const std::size_t start = i;
            while (i < s.size() && s[i] >= '0' && s[i] <= '9') ++i;
            return i - start;
        };
        if (i < s.size() && s[i] == '-') ++i;
        const std::size_t whole = i;
        const std::size_t count = digits();
        if (count == 0 || (count > 1 && s[whole] == '0')) return false;
        if (i < s.size() && s[i] == '.' && (++i, digits() == 0)) return false;
        if (i < s.size() && (s[i] == 'e' || s[i] == 'E')) {
            ++i;
            if (i < s.size() && (s[i] == '+' || s[i] == '-')) ++i;
            if (digits() == 0) return false;
        }
        return i == s.size();
    }

    // What JsonCpp has no message with a place for: not an object, too deep, too many, control characters.
    void check_shape() const {
        int depth = 0;
        std::size_t values = 0;
        bool begun = false;
        for (std::size_t i = 0; i < text.size(); ++i) {
            const char c = text[i];
            if (c == '/' && i + 1 < text.size() && text[i + 1] == '/') {
                i = std::min(text.find('\n', i), text.size());
                continue;
            }
            if (c == '/' && i + 1 < text.size() && text[i + 1] == '*') {
                const std::size_t end = text.find("*/", i + 2);
                if (end == std::string::npos) fail(i, "$: found a comment that does not end, expected */");
                i = end + 1;
                continue;
            }
            if (c == ' ' || c == '\n' || c == '\t' || c == '\r') continue;
            if (!begun && c != '{') fail(i, "$: found " + quoted(text.substr(i, 20)) + ", expected a JSON object {...}");
            begun = true;
            if (c == '"') {
                const std::size_t start = i++;
                for (; i < text.size() && text[i] != '"'; ++i) {
                    if (text[i] == '\n') fail(start, "$: found a string that does not end on its line, expected \"");
                    if (text[i] == '\\') ++i;
                }
                if (i >= text.size()) fail(start, "$: found a string that does not end, expected \"");
                const std::size_t bad = find_not_utf8(std::string_view(text).substr(start, i - start));
                if (bad != std::string_view::npos) {
                    char byte[8];
                    std::snprintf(byte, sizeof byte, "0x%02X", static_cast<unsigned>(static_cast<unsigned char>(text[start + bad])));
                    fail(start + bad, "$: found the byte " + std::string(byte) + " in a string, expected UTF-8");
                }
            } else if (c == '{' || c == '[') {
                if (++depth > kMaxDepth) fail(i, "$: found brackets nested deeper than " + std::to_string(kMaxDepth) + " levels, expected fewer");
            } else if (c == '}' || c == ']') {
                --depth;
            }
            if (c == '-' || c == '+' || c == '.' || (c >= '0' && c <= '9')) {
                const std::size_t start = i, end = std::min(text.find_first_not_of("+-.0123456789eE", i), text.size());
                const bool word = end < text.size() && std::isalpha(static_cast<unsigned char>(text[end]));  // -Infinity, 0x10: JsonCpp refuses these
                if (!word && !is_json_number(std::string_view(text).substr(start, end - start)))
                    fail(start, "$: found " + quoted(text.substr(start, std::min<std::size_t>(end - start, 20))) + ", expected a number as JSON writes it, like -0.5 or 1e-3");
                i = end - 1;
            }
            if ((c == ',' || c == '{' || c == '[') && ++values > kMaxValues) {
                fail(i, "$: found more than " + std::to_string(kMaxValues) + " values, expected fewer");
            }
        }
        if (!begun) fail(text.size(), "$: found an empty file, expected a JSON object {...}");
    }

    int add(const ::Json::Value& v, int parent, int index, const std::string& key);
    std::size_t find_key(std::size_t value) const;
};

// JsonCpp says "* Line 3, Column 5\n  What is wrong.\n"; the first of its messages counts.
static void rethrow_syntax(const JsonDocument& document, const std::string& messages) {
    unsigned line = 1, column = 1;
    const std::size_t at = messages.find("* Line ");
    if (at != std::string::npos) std::sscanf(messages.c_str() + at, "* Line %u, Column %u", &line, &column);
    std::size_t offset = 0;
    for (unsigned k = 1; k < line && offset < document.text.size(); ++k) {
        offset = document.text.find('\n', offset);
        offset = offset == std::string::npos ? document.text.size() : offset + 1;
    }
    offset = std::min(offset + column - 1, document.text.size());
    const std::size_t begin = messages.find("\n  ", at);
    std::string what = begin == std::string::npos ? messages : messages.substr(begin + 3, messages.find('\n', begin + 3) - begin - 3);
    if (what.size() > 200) what = what.substr(0, 200) + "...";
    if (what.find("Failed to allocate") != std::string::npos) throw std::bad_alloc();
    if (what.rfind("Duplicate key", 0) == 0) what = "found a key for the second time (" + what + "), expected every key once";
    else {
        const std::size_t end = std::min(document.text.find_first_of("\n\r", offset), document.text.size());
        const std::string found = offset >= document.text.size() ? "the end of the file" : offset == end ? "the end of the line" : quoted(document.text.substr(offset, std::min<std::size_t>(end - offset, 20)));
        what = "found " + found + ", expected JSON (" + what + ")";
    }
    document.fail(offset, "$: " + what);
}

int JsonDocument::add(const ::Json::Value& v, int parent, int index, const std::string& key) {
    const int k = static_cast<int>(nodes.size());
    nodes.emplace_back();
    Node node;
    node.parent = parent;
    node.index = index;
    node.key = key;
    node.begin = static_cast<std::size_t>(v.getOffsetStart());
    node.end = static_cast<std::size_t>(v.getOffsetLimit());
    node.key_begin = key.empty() ? node.begin : find_key(node.begin);
    switch (v.type()) {
        case ::Json::nullValue: node.kind = isoparm::Json::Kind::null; break;
        case ::Json::booleanValue: node.kind = isoparm::Json::Kind::boolean, node.boolean = v.asBool(); break;
        case ::Json::stringValue: node.kind = isoparm::Json::Kind::string, node.string = v.asString(); break;
        case ::Json::arrayValue: node.kind = isoparm::Json::Kind::array; break;
        case ::Json::objectValue: node.kind = isoparm::Json::Kind::object; break;
        default: node.kind = isoparm::Json::Kind::number, node.number = v.asDouble(); break;
    }
    if (v.isArray()) {
        node.children.reserve(v.size());
        for (::Json::ArrayIndex i = 0; i < v.size(); ++i) node.children.push_back(add(v[i], k, static_cast<int>(i), ""));
    } else if (v.isObject()) {
        std::vector<std::pair<std::ptrdiff_t, std::string>> members;
        for (auto m = v.begin(); m != v.end(); ++m) members.emplace_back(m->getOffsetStart(), m.name());
        std::sort(members.begin(), members.end());
        for (const auto& m : members) node.children.push_back(add(v[m.second], k, static_cast<int>(node.children.size()), m.second));
    }
    if (find_not_utf8(node.string) != std::string::npos || find_not_utf8(node.key) != std::string::npos)
        fail(node.key_begin, "$: found half of a surrogate pair (\\uD800 to \\uDFFF) in a string, expected both halves");
    nodes[k] = std::move(node);
    return k;
}

// JsonCpp keeps no place of keys: back from the value over the colon to the string before it.
std::size_t JsonDocument::find_key(std::size_t value) const {
    std::size_t i = value;
    const auto back = [&] {
        while (i > 0 && std::strchr(" \t\r\n", text[i - 1])) --i;
    };
    back();
    if (i == 0 || text[--i] != ':') return value;
    back();
    if (i == 0 || text[--i] != '"') return value;
    while (i > 0 && !(text[i - 1] == '"' && (i < 2 || text[i - 2] != '\\'))) --i;
    return i > 0 ? i - 1 : value;
}

Json Json::parse(const std::string& text, const std::string& path) {
    auto document = std::make_shared<JsonDocument>();
    document->path = path;
    document->text = text.rfind("\xEF\xBB\xBF", 0) == 0 ? text.substr(3) : text;
    document->check_shape();

    ::Json::CharReaderBuilder builder;
    builder["collectComments"] = false;
    builder["allowTrailingCommas"] = false;
    builder["strictRoot"] = true;
    builder["failIfExtra"] = true;
    builder["rejectDupKeys"] = true;
    builder["allowSpecialFloats"] = false;
    builder["stackLimit"] = 2 * kMaxDepth;
    const std::unique_ptr<::Json::CharReader> reader(builder.newCharReader());
    ::Json::Value root;
    std::string messages;
    const std::string& t = document->text;
    bool good = false;
    try {
        good = reader->parse(t.data(), t.data() + t.size(), &root, &messages);
    } catch (const ::Json::Exception& e) {
        messages = e.what();
    }
    if (!good) rethrow_syntax(*document, messages);
    document->add(root, -1, 0, "");
    return Json(std::move(document), 0);
}

Json::Kind Json::kind() const { return document_->nodes[node_].kind; }
bool Json::boolean() const { return document_->nodes[node_].boolean; }
double Json::number() const { return document_->nodes[node_].number; }
const std::string& Json::string() const { return document_->nodes[node_].string; }
const std::string& Json::key() const { return document_->nodes[node_].key; }
std::size_t Json::size() const { return document_->nodes[node_].children.size(); }
const std::string& Json::file() const { return document_->path; }
Json Json::operator[](std::size_t i) const { return Json(document_, document_->nodes[node_].children[i]); }

std::vector<Json> Json::children() const {
    std::vector<Json> r;
    r.reserve(size());
    for (const int k : document_->nodes[node_].children) r.push_back(Json(document_, k));
    return r;
}

std::unique_ptr<Json> Json::find(const std::string& key) const {
    for (const int k : document_->nodes[node_].children)
        if (is(Kind::object) && document_->nodes[k].key == key) return std::unique_ptr<Json>(new Json(document_, k));
    return nullptr;
}

Json Json::at(const std::string& key, const std::string& expected) const {
    if (const auto member = find(key)) return *member;
    fail("found no key " + quoted(key) + ", expected " + expected);
}

void Json::must_have_one(const std::vector<std::string>& keys) const {
    const auto found = std::count_if(keys.begin(), keys.end(), [&](const std::string& key) { return find(key) != nullptr; });
    if (found == 1) return;
    if (found == 0)
        for (const Json& member : children())
            if (const std::string meant = did_you_mean(member.key(), keys); !meant.empty())
                member.fail_at_key("found the key " + quoted(member.key()) + ", expected one of: " + listed(keys) + meant);
    fail("found " + std::to_string(found) + " of the keys " + listed(keys) + ", expected one of them");
}

void Json::allow_keys(const std::vector<std::string>& keys) const {
    for (const Json& member : children()) {
        if (std::find(keys.begin(), keys.end(), member.key()) != keys.end()) continue;
        member.fail_at_key("found an unknown key " + quoted(member.key()) + ", expected one of: " + listed(keys) +
                           did_you_mean(member.key(), keys));
    }
}

std::string Json::place_at(std::size_t offset) const {
    std::string path;
    for (int k = node_; document_->nodes[k].parent >= 0; k = document_->nodes[k].parent) {
        const auto& n = document_->nodes[k];
        const bool plain = !n.key.empty() && std::all_of(n.key.begin(), n.key.end(), [](unsigned char c) { return std::isalnum(c) || c == '_' || c == '-' || c == '$'; });
        const bool array = document_->nodes[n.parent].kind == Kind::array;
        path = (array ? "[" + std::to_string(n.index) + "]" : plain ? "." + n.key : "[" + quoted(n.key) + "]") + path;
    }
    return document_->path + ":" + line_and_column(document_->text, offset) + ": at $" + path;
}
std::string Json::place() const { return place_at(document_->nodes[node_].begin); }

std::string Json::description() const {
    const auto& n = document_->nodes[node_];
    switch (n.kind) {
        case Kind::null: return "null";
        case Kind::boolean: return n.boolean ? "true" : "false";
        case Kind::string: return quoted(n.string);
        case Kind::array: return n.children.empty() ? "an empty array" : "an array of " + std::to_string(n.children.size());
        case Kind::object: return "an object";
        default: return document_->text.substr(n.begin, std::min<std::size_t>(n.end - n.begin, 40));
    }
}

void Json::fail(const std::string& message) const { throw LocatedError(place() + ": " + message); }
void Json::expected(const std::string& what) const { fail("found " + description() + ", expected " + what); }
void Json::fail_at_key(const std::string& message) const { throw LocatedError(place_at(document_->nodes[node_].key_begin) + ": " + message); }
void Json::fail_inside(std::size_t offset, const std::string& message) const {
    const auto& n = document_->nodes[node_];
    throw LocatedError(place_at(std::min(n.begin + 1 + offset, n.end)) + ": " + message);
}

}  // namespace isoparm
