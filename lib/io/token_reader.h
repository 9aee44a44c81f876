// io/token_reader.h -- a text file as words between white space, for formats that are little else than numbers.
#pragma once
#include <string>
#include <string_view>

#include "error.h"
#include "scalar/vec.h"

namespace isoparm {

/// Keeps references: text and path must outlive it. Every error is an Error(input) "path:line:column: found ..., expected ...".
class TokenReader {
public:
    TokenReader(const std::string& text, const std::string& path) : text_(text), path_(path) {}

    /// The next word; empty at the end of the file.
    std::string_view read();
    std::string_view token() const { return token_; }
    /// About the word read last.
    [[noreturn]] void fail(const std::string& expected) const;
    /// About the word at that place, as place() told it.
    [[noreturn]] void fail_at(std::size_t place, const std::string& found, const std::string& expected) const;
    std::size_t place() const { return at_; }

    /// The next word as a finite number. `what()` puts into words what it is for, and is asked only when it is missing: most of a file is numbers.
    template <class What> double number(What what) {
        double x = 0;
        if (!next_number(x)) fail(what() + ", a finite number");
        return x;
    }
    /// The next word as a whole number from `low` to `high`.
    template <class What> int integer(What what, int low, int high) {
        int n = 0;
        if (!next_integer(n) || n < low || n > high) fail(what() + ", a whole number from " + std::to_string(low) + " to " + std::to_string(high));
        return n;
    }
    template <class What> Vec3<double> point(What what) {
        Vec3<double> p;
        for (int k = 0; k < 3; ++k) p[k] = number([&] { return std::string("the ") + "xyz"[k] + " of " + what(); });
        return p;
    }

private:
    bool next_number(double& x);
    bool next_integer(int& n);
    const std::string& text_;
    const std::string& path_;
    std::size_t at_ = 0, end_ = 0;
    std::string_view token_;
};

}  // namespace isoparm
