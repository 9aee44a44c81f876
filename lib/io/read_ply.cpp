#include <algorithm>
#include <iterator>

#include "error.h"
#include "io/mesh_scanner.h"

namespace isoparm {
namespace {

enum class Scalar { i8, u8, i16, u16, i32, u32, f32, f64 };
constexpr std::size_t kSize[] = {1, 1, 2, 2, 4, 4, 4, 8};

struct Property {
    std::string name;
    bool list = false;
    Scalar count{}, value{};
};
struct Element {
    std::string name;
    std::size_t count = 0;
    std::vector<Property> properties;

    const Property* find(std::initializer_list<const char*> names, bool list) const {
        for (const Property& p : properties)
            if (p.list == list && std::find(names.begin(), names.end(), p.name) != names.end()) return &p;
        return nullptr;
    }
};

class PlyReader {
public:
    PlyReader(const std::string& bytes, const std::string& path) : bytes_(bytes), path_(path), text_(bytes, path), binary_(bytes, 0, path, false) {}

    MeshFile run() {
        header();
        for (const Element& e : elements_) {
            refuse_more_than_there_is(e);
            if (e.name == "vertex") vertices(e);
            else if (e.name == "face") faces(e);
            else pass_over(e);
        }
        refuse_surplus();
        return std::move(file_);
    }

private:
    // ---- header
    std::string_view word(const char* expected) {
        const std::string_view w = text_.word_on_line();
        if (w.empty()) text_.fail_word(w, expected);
        return w;
    }
    Scalar type() {
        static constexpr const char* names[][2] = {{"char", "int8"}, {"uchar", "uint8"}, {"short", "int16"}, {"ushort", "uint16"},
                                                   {"int", "int32"}, {"uint", "uint32"}, {"float", "float32"}, {"double", "float64"}};
        const std::string_view w = word("a type");
        for (int k = 0; k < 8; ++k)
            if (w == names[k][0] || w == names[k][1]) return static_cast<Scalar>(k);
        text_.fail_word(w, "a type: char, uchar, short, ushort, int, uint, float, double");
    }
    void next_header_line() {
        if (!text_.next_line()) text_.fail("the end of the file", "end_header");
    }
    void header() {
        if (const auto w = text_.word_on_line(); w != "ply") text_.fail_word(w, "\"ply\"");
        for (next_header_line();; next_header_line()) {
            const std::string_view w = text_.word_on_line();
            if (w == "end_header") break;
            if (w == "format") format();
            else if (w == "element") element();
            else if (w == "property") property();
            else if (w != "comment" && w != "obj_info" && !w.empty()) text_.fail_word(w, "format, element, property, comment, obj_info or end_header");
        }
        if (file_.format.empty()) text_.fail("no format", "a line \"format ...\" in the header");
        text_.next_line();
        binary_ = ByteScanner(bytes_, text_.offset(), path_, big_endian_);
        const auto vertex = std::find_if(elements_.begin(), elements_.end(), [](const Element& e) { return e.name == "vertex"; });
        const auto face = std::find_if(elements_.begin(), elements_.end(), [](const Element& e) { return e.name == "face"; });
        if (vertex == elements_.end() || !vertex->find({"x"}, false) || !vertex->find({"y"}, false) || !vertex->find({"z"}, false))
            throw_input(path_ + ": found no element vertex with the properties x, y and z, expected one");
        if (face == elements_.end() || !face->find({"vertex_indices", "vertex_index"}, true))
            throw_input(path_ + ": found no element face with a list vertex_indices, expected one");
    }
    void format() {
        const std::string_view w = word("a format");
        if (w != "ascii" && w != "binary_little_endian" && w != "binary_big_endian") text_.fail_word(w, "ascii, binary_little_endian or binary_big_endian");
        ascii_ = w == "ascii";
        big_endian_ = w == "binary_big_endian";
        file_.format = ascii_ ? "PLY, ascii" : big_endian_ ? "PLY, binary, big-endian" : "PLY, binary, little-endian";
    }
    void element() {
        Element e;
        e.name = word("the name of an element");
        const std::string_view w = word("a number of elements");
        const long long n = text_.integer(w, "a number of elements");
        if (n < 0 || static_cast<unsigned long long>(n) > kMostElements) text_.fail(in_quotes(w), "a number of elements from 0 to " + std::to_string(kMostElements));
        for (const Element& other : elements_)
            if (other.name == e.name) text_.fail("a second element " + in_quotes(e.name), "one of each name");
        e.count = static_cast<std::size_t>(n);
        elements_.push_back(std::move(e));
    }
    void property() {
        if (elements_.empty()) text_.fail("a property", "an element before it");
        Property p;
        TextScanner ahead = text_;
        p.list = ahead.word_on_line() == "list";
        if (p.list) {
            text_.word_on_line();
            p.count = type();
            if (p.count >= Scalar::f32) text_.fail("a list whose length is no integer", "an integer type");
        }
        p.value = type();
        p.name = word("the name of a property");
        if (p.list && elements_.back().name == "face" && p.value >= Scalar::f32 && (p.name == "vertex_indices" || p.name == "vertex_index"))
            text_.fail("vertex indices that are no integers", "an integer type");
        elements_.back().properties.push_back(std::move(p));
    }

    // ---- data
    /// Counts are believed only as far as there are bytes for them.
    void refuse_more_than_there_is(const Element& e) const {
        std::size_t least = 0;
        for (const Property& p : e.properties) least += ascii_ ? 2 : kSize[static_cast<int>(p.list ? p.count : p.value)];
        const std::size_t left = ascii_ ? text_.left() + 1 : binary_.left();
        if (e.count > 0 && least > 0 && e.count > left / least)
            throw_input(path_ + ": byte " + std::to_string(ascii_ ? text_.offset() : binary_.offset()) + ": found " + std::to_string(e.count) + " elements " + in_quotes(e.name) + " announced and " +
                        std::to_string(ascii_ ? text_.left() : left) + " bytes left, expected at least " + std::to_string(e.count * least) + " bytes");
    }
    /// What follows was perhaps meant to be read: a count that is too small. Blanks are let pass.
    void refuse_surplus() {
        if (ascii_) {
            if (const auto w = text_.word(); !w.empty()) text_.fail_word(w, "the end of the file, after the last element that the header announces");
            return;
        }
        const std::size_t more = bytes_.find_first_not_of(" \t\r\n", binary_.offset());
        if (more != std::string::npos)
            throw_input(path_ + ": byte " + std::to_string(binary_.offset()) + ": found " + std::to_string(binary_.left()) + " bytes after the last element, expected the end of the file: the header announces fewer than there are");
    }
    double number(Scalar type, const char* expected) {
        if (ascii_) return text_.number(text_.word(), expected);
        switch (type) {
            case Scalar::i8: return binary_.number<std::int8_t>(expected);
            case Scalar::u8: return binary_.number<std::uint8_t>(expected);
            case Scalar::i16: return binary_.number<std::int16_t>(expected);
            case Scalar::u16: return binary_.number<std::uint16_t>(expected);
            case Scalar::i32: return binary_.number<std::int32_t>(expected);
            case Scalar::u32: return binary_.number<std::uint32_t>(expected);
            case Scalar::f32: return binary_.number<float>(expected);
            default: return binary_.number<double>(expected);
        }
    }
    [[noreturn]] void fail(const std::string& found, const std::string& expected) const {
        if (ascii_) text_.fail(found, expected);
        binary_.fail(found, expected);
    }
    long long integer(Scalar type, const char* expected) {
        const double x = number(type, expected);
        if (!(x >= -1e10 && x <= 1e10 && x == static_cast<double>(static_cast<long long>(x)))) fail(to_text(x), expected);
        return static_cast<long long>(x);
    }
    /// Its items are at least a byte each (in text two, but for the last one).
    std::size_t length(const Property& p) {
        const long long n = integer(p.count, "the length of a list");
        const std::size_t left = ascii_ ? text_.left() / 2 + 1 : binary_.left() / kSize[static_cast<int>(p.value)];
        if (n < 0 || static_cast<unsigned long long>(n) > left) fail("a list of " + std::to_string(n), "a length for which there is data: 0 to " + std::to_string(left));
        return static_cast<std::size_t>(n);
    }
    void pass_over(const Property& p) {
        const std::size_t n = p.list ? length(p) : 1;
        if (!ascii_) return binary_.skip(n * kSize[static_cast<int>(p.value)], "a property");
        for (std::size_t k = 0; k < n; ++k)
            if (const auto w = text_.word(); w.empty()) text_.fail_word(w, "a property");
    }
    void pass_over(const Element& e) {
        if (e.properties.empty()) return;
        for (std::size_t k = 0; k < e.count; ++k)
            for (const Property& p : e.properties) pass_over(p);
    }
    void vertices(const Element& e) {
        file_.mesh.points.reserve(e.count);
        for (std::size_t k = 0; k < e.count; ++k) {
            Point point;
            for (const Property& p : e.properties) {
                const bool coordinate = !p.list && p.name.size() == 1 && p.name[0] >= 'x' && p.name[0] <= 'z';
                if (!coordinate) pass_over(p);
                else {
                    const double x = number(p.value, "a coordinate");
                    point[p.name[0] - 'x'] = ascii_ ? x : binary_.coordinate(x);
                }
            }
            file_.mesh.points.push_back(point);
        }
    }
    /// The vertices may follow the faces: then it is their announced number that counts.
    void faces(const Element& e) {
        std::size_t count = 0;
        for (const Element& other : elements_)
            if (other.name == "vertex") count = other.count;
        const Property* indices = e.find({"vertex_indices", "vertex_index"}, true);
        std::vector<std::uint32_t> corners;
        file_.mesh.triangles.reserve(e.count);
        for (std::size_t k = 0; k < e.count; ++k)
            for (const Property& p : e.properties) {
                if (&p != indices) {
                    pass_over(p);
                    continue;
                }
                const std::size_t n = length(p);
                if (n < 3) fail("a face of " + std::to_string(n) + " vertices", "at least 3");
                corners.resize(n);
                for (auto& c : corners) {
                    const long long i = integer(p.value, "a vertex index");
                    if (i < 0 || static_cast<unsigned long long>(i) >= count)
                        fail("the vertex index " + std::to_string(i), "an index from 0, below the number of vertices, " + std::to_string(count));
                    c = static_cast<std::uint32_t>(i);
                }
                add_polygon(file_, corners);
            }
    }

    const std::string& bytes_;
    const std::string& path_;
    TextScanner text_;
    ByteScanner binary_;
    bool ascii_ = true, big_endian_ = false;
    std::vector<Element> elements_;
    MeshFile file_;
};

}  // namespace

MeshFile read_ply(const std::string& bytes, const std::string& path) { return PlyReader(bytes, path).run(); }

}  // namespace isoparm
