// commands/guard.h -- what an exception means to the shell.
#pragma once
#include <functional>

namespace isoparm {
/// Runs `work` and returns its exit code. An exception is told on stderr and becomes its exit code: usage 64, input 65,
/// input/output 4, a budget that is used up 2, anything else 70.
int guarded(const std::function<int()>& work);
}  // namespace isoparm
