// module.h -- parts of the program that are loaded only when they are needed, as their libraries are slow to load.
#pragma once
#include <string>

namespace isoparm {

/// Where a module lies: beside the program, or in ../lib/isoparm. Empty when it is in neither.
std::string find_module(const std::string& name);

/// A function of a module, which stays loaded. Throws Error(io) when it is not there, cannot be loaded, or is another program's.
void* module_function(const std::string& name, const char* function);
template <class F> F module_function(const std::string& name, const char* function) { return reinterpret_cast<F>(module_function(name, function)); }

}  // namespace isoparm
