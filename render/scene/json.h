// json.h -- a JSON document that knows where each of its values stands; messages with file, line, column and path.
//
// Comments are allowed; duplicate keys, trailing commas, trailing text, NaN, nesting deeper than 100 and documents above
// 64 MiB or two million values are errors. json.cpp is the only file that includes JsonCpp.
#pragma once
#include <initializer_list>
#include <memory>
#include <string>
#include <vector>

#include "error.h"

namespace isoparm {

/// Data that cannot be used, with its place already in the message.
class LocatedError : public Error {
public:
    explicit LocatedError(const std::string& message) : Error(ErrorKind::input, message) {}
};

/// Whole files. Throws Error(io) when it cannot be read; LocatedError when it is too big.
std::string read_text_file(const std::string& path, std::size_t limit = std::size_t{64} << 20);

/// "3:14" of a byte offset; lines and columns count from 1, columns in bytes.
std::string line_and_column(const std::string& text, std::size_t offset);

class JsonDocument;

/// One value of a document: cheap to copy, valid as long as any value of its document.
class Json {
public:
    enum class Kind { null, boolean, number, string, array, object };

    /// Throws LocatedError.
    static Json parse(const std::string& text, const std::string& path);

    Kind kind() const;
    bool is(Kind k) const { return kind() == k; }
    bool boolean() const;               // the value, which must be of that kind
    double number() const;
    const std::string& string() const;
    const std::string& key() const;     // under which an object holds this value
    std::size_t size() const;           // of an array or object
    std::vector<Json> children() const; // of an array or object, in the order of the file
    Json operator[](std::size_t i) const;
    /// A member; null pointer-like when missing.
    std::unique_ptr<Json> find(const std::string& key) const;
    /// A member; when missing, an error that names the key and what it should hold.
    Json at(const std::string& key, const std::string& expected) const;
    /// Exactly one of these keys must be there; others may be.
    void must_have_one(const std::vector<std::string>& keys) const;
    /// Every key must be one of these.
    void allow_keys(const std::vector<std::string>& keys) const;
    bool same(const Json& o) const { return node_ == o.node_; }

    /// "scenes/a.json:3:14: at $.surfaces.S.c0"
    std::string place() const;
    const std::string& file() const;
    /// What stands here, for a message: "abc", 3, an array of 4, an object.
    std::string description() const;
    /// place: found <description>, expected <expected>
    [[noreturn]] void expected(const std::string& expected) const;
    /// place: <message>
    [[noreturn]] void fail(const std::string& message) const;
    /// The same, at byte `offset` of a string value.
    [[noreturn]] void fail_inside(std::size_t offset, const std::string& message) const;
    /// The same, at the key of this member.
    [[noreturn]] void fail_at_key(const std::string& message) const;

private:
    Json(std::shared_ptr<const JsonDocument> document, int node) : document_(std::move(document)), node_(node) {}
    std::string place_at(std::size_t offset) const;
    std::shared_ptr<const JsonDocument> document_;
    int node_;
};

}  // namespace isoparm
