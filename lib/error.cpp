#include "error.h"

#include <charconv>

namespace isoparm {

std::string to_text(double x) {
    char text[32];
    const auto end = std::to_chars(text, text + sizeof text, x).ptr;
    return std::string(text, end);
}

IncompatibleError::IncompatibleError(const std::string& condition, double gap, double tolerance, const std::string& advice)
    : Error(ErrorKind::input,
            condition + ": gap " + to_text(gap) + " exceeds the tolerance " + to_text(tolerance) + (advice.empty() ? "" : "; " + advice)),
      condition_(condition), advice_(advice), gap_(gap), tolerance_(tolerance) {}

void throw_input(const std::string& message) { throw Error(ErrorKind::input, message); }

}  // namespace isoparm
