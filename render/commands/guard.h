// commands/guard.h -- what an exception means to the shell.
#pragma once
#include <functional>

namespace isoparm {
/// Runs `work` and returns its exit code. An exception is told on stderr and becomes its exit code: usage 64, input 65,
/// input/output 4, a budget that is used up 2, anything else 70.
int guarded(const std::function<int()>& work);
/// For the whole program: a crash, or an exception where none may pass, in whatever library and thread, is told on stderr and leaves no
/// temporary file. After an exception the exit code is 70; after a signal it is that signal's, as a debugger wants it.
void tell_crashes();
/// What tell_crashes() did is undone: in a child whose parent tells.
void leave_crashes();
}  // namespace isoparm
