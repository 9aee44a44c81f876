// provenance.h -- which program made something, and where.
#pragma once
#include <string>

namespace isoparm {
/// "0.1.0", and what git describe said when it was built from a clone: "0.1.0 (972f926-dirty)".
std::string program_version();
/// "g++ 12.2.0".
std::string compiler_name();
/// "Intel(R) Xeon(R) Processor, 2 cores".
std::string machine_line();
/// Now, as 2026-01-31T23:59:59Z.
std::string date_line();
}  // namespace isoparm
