// machine.h -- where the numbers were measured.
#pragma once
#include <string>

namespace isoparm::bench {

/// Processor, cores that this process may use, compiler.
std::string machine_line();
/// Load average of the last minute; negative where the system has none.
double load_average();

}  // namespace isoparm::bench
