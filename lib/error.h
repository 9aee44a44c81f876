// error.h -- what isoparm throws.
//
// Every failure that a caller can cause is an isoparm::Error of one of these kinds. The command line maps the kind to
// its exit code; messages are complete sentences: what was found, what was expected, what to do.
#pragma once
#include <stdexcept>
#include <string>

namespace isoparm {

enum class ErrorKind {
    input,     // data that cannot be used (a curve that does not meet its neighbour, knots that decrease): exit 65
    budget,    // what was asked could not be proved within the budget: exit 2
    io,        // reading or writing failed: exit 4
    usage,     // the command line: exit 64
};

class Error : public std::runtime_error {
public:
    Error(ErrorKind kind, const std::string& message) : std::runtime_error(message), kind_(kind) {}
    ErrorKind kind() const { return kind_; }

private:
    ErrorKind kind_;
};

/// Data that does not fit together: which condition, the gap that was measured, and the tolerance it had to stay below; `advice`, if any,
/// tells what would repair it.
class IncompatibleError : public Error {
public:
    IncompatibleError(const std::string& condition, double gap, double tolerance, const std::string& advice = "");
    const std::string& condition() const { return condition_; }
    double gap() const { return gap_; }
    double tolerance() const { return tolerance_; }
    const std::string& advice() const { return advice_; }

private:
    std::string condition_, advice_;
    double gap_, tolerance_;
};

/// %.17g without trailing noise: the shortest decimal that reads back as the same double.
std::string to_text(double x);

[[noreturn]] void throw_input(const std::string& message);

}  // namespace isoparm
