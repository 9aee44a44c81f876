#include "commands/guard.h"

#include <cstdio>
#include <exception>
#include <new>

#include "commands/command.h"
#include "error.h"

namespace isoparm {

static int exit_code(ErrorKind kind) {
    switch (kind) {
        case ErrorKind::usage: return kUsage;
        case ErrorKind::input: return kBadInput;
        case ErrorKind::io: return kIoError;
        case ErrorKind::budget: return kCheckFailed;
    }
    return kInternal;
}

int guarded(const std::function<int()>& work) {
    try {
        return work();
    } catch (const Error& e) {
        std::fprintf(stderr, "isoparm: %s\n", e.what());
        return exit_code(e.kind());
    } catch (const std::bad_alloc&) {
        std::fputs("isoparm: not enough memory\n", stderr);
    } catch (const std::exception& e) {
        std::fprintf(stderr, "isoparm: internal error, please report: %s\n", e.what());
    } catch (...) {
        std::fputs("isoparm: internal error, please report\n", stderr);
    }
    return kInternal;
}

}  // namespace isoparm
