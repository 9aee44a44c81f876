// release.h -- memory given back at once.
#pragma once
#include <vector>

namespace isoparm {

/// `v = {}` would only empty the vector, and keep its memory.
template <class T> void release(std::vector<T>& v) { v = std::vector<T>(); }

}  // namespace isoparm
