// io/obj_statements.h -- the statements of a Wavefront OBJ file, one after the other, as tokens with their places.
#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace isoparm {

/// Keeps references to both strings; tokens are views of the text. Not for several threads.
class ObjStatements {
public:
    struct Place {
        int line = 0, column = 0;
    };
    struct Token {
        std::string_view text;
        Place place;
    };
    ObjStatements(const std::string& text, const std::string& path) : text_(text), path_(path) {}

    /// Goes to the next statement that is not empty: lines that end with a backslash outside of comments are joined with the next one, comments are left out. False at the end.
    bool advance();
    /// Throws Error(input): path:line:column: found ..., expected ...
    [[noreturn]] void fail(Place p, const std::string& found, const std::string& expected) const;

    const Token& keyword() const { return tokens_[0]; }
    std::size_t left() const { return tokens_.size() - next_; }
    bool more() const { return next_ < tokens_.size(); }
    /// Where the next token is, or the end of the line.
    Place place() const { return more() ? tokens_[next_].place : end_; }
    Place end() const { return end_; }
    int line() const { return line_; }  // the last one that was read

    // What follows the keyword; `expected` is for the message when it is not there, or is something else.
    Token token(const char* expected);
    /// Finite, at most 1e100 in size: squares and products of lengths stay finite.
    double number(const char* expected);
    int integer(const char* expected);
    /// A part of a token, or all of it.
    int integer(std::string_view text, const Token& t, const char* expected) const;
    void nothing_more(const char* after) const;

private:
    void split(std::string_view line);

    const std::string& text_;
    const std::string& path_;
    std::size_t at_ = 0;
    int line_ = 0;
    std::vector<Token> tokens_;  // of this statement, the keyword first
    std::size_t next_ = 1;
    Place end_;                  // of its last line
};

}  // namespace isoparm
