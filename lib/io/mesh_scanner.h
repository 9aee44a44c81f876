// io/mesh_scanner.h -- words and numbers of text, binary numbers, and faces, as the mesh readers need them; internal to them.
#pragma once
#include <string>
#include <string_view>

#include "io/mesh_reader.h"
#include "text/printable_text.h"

namespace isoparm {

class TextScanner {
public:
    /// Passes over a byte order mark.
    TextScanner(std::string_view text, const std::string& path) : text_(text), path_(path), at_(text.starts_with("\xEF\xBB\xBF") ? 3 : 0), line_start_(at_) {}

    /// The next word, on this line or a later one; empty at the end of the text.
    std::string_view word() { return take(true); }
    /// The next word of this line; empty at its end or at a '#'. A '\' at the end of a line joins the next one to it.
    std::string_view word_on_line() { return take(false); }
    /// To the beginning of the next line; false when there is none.
    bool next_line();
    /// The rest of this line, without its end.
    std::string_view rest_of_line() const { return text_.substr(at_, text_.find_first_of("\r\n", at_) - at_); }

    /// The word as a finite number of at most 1e50 in size, or as an integer.
    double number(std::string_view word, const char* expected) const;
    long long integer(std::string_view word, const char* expected) const;
    /// At the last word.
    [[noreturn]] void fail(const std::string& found, const std::string& expected) const;
    [[noreturn]] void fail_word(std::string_view found, const char* expected) const;  // empty: an end was found

    std::size_t left() const { return text_.size() - at_; }
    std::size_t offset() const { return at_; }

private:
    std::string_view take(bool over_lines);

    std::string_view text_;
    const std::string& path_;
    std::size_t at_, line_start_, word_column_ = 1;
    std::size_t line_ = 1, word_line_ = 1;
};

class ByteScanner {
public:
    ByteScanner(std::string_view bytes, std::size_t at, const std::string& path, bool big_endian) : bytes_(bytes), path_(&path), at_(at), big_endian_(big_endian) {}

    template <class T> T number(const char* expected);
    /// A coordinate: finite, at most 1e50 in size.
    double coordinate(double x) const;
    void skip(std::size_t n, const char* expected);
    [[noreturn]] void fail(const std::string& found, const std::string& expected) const;  // at the last number
    std::size_t left() const { return bytes_.size() - at_; }
    std::size_t offset() const { return at_; }

private:
    std::string_view bytes_;
    const std::string* path_;
    std::size_t at_, last_ = at_;
    bool big_endian_;
};

/// Cuts a polygon into a fan about its first corner.
void add_polygon(MeshFile& file, const std::vector<std::uint32_t>& corners);

/// Most vertices, and triangles, that a mesh may have.
inline constexpr std::size_t kMostElements = 1'000'000'000;

}  // namespace isoparm
