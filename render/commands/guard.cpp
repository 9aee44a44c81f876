#include "commands/guard.h"

#include <signal.h>
#include <string.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <new>
#include <system_error>

#include "commands/command.h"
#include "error.h"
#include "io/atomic_file.h"

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

/// Threads that cannot be started, too.
static bool out_of_memory(const std::exception& e) {
    if (dynamic_cast<const std::bad_alloc*>(&e) || std::strstr(e.what(), "Failed to allocate")) return true;  // the latter is JsonCpp's
    const auto* const system = dynamic_cast<const std::system_error*>(&e);
    return system && (system->code() == std::errc::resource_unavailable_try_again || system->code() == std::errc::not_enough_memory);
}
static constexpr const char* kOutOfMemory = "isoparm: not enough memory\n";

int guarded(const std::function<int()>& work) {
    try {
        return work();
    } catch (const Error& e) {
        std::fprintf(stderr, "isoparm: %s\n", e.what());
        return exit_code(e.kind());
    } catch (const std::exception& e) {
        if (out_of_memory(e)) std::fputs(kOutOfMemory, stderr);
        else std::fprintf(stderr, "isoparm: internal error, please report: %s\n", e.what());
    } catch (...) {
        std::fputs("isoparm: internal error, please report\n", stderr);
    }
    return kInternal;
}

// ---- what no handler above sees: only what is allowed in a signal handler is called ------------------------------------

namespace {

constexpr int kCrashes[] = {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGTRAP, SIGSYS};

void say(const char* text) {
    if (::write(2, text, std::strlen(text)) < 0) { /* nobody to tell */ }
}
[[noreturn]] void end_terminated() {
    remove_temporaries();
    try {
        if (const auto e = std::current_exception()) std::rethrow_exception(e);
        say("isoparm: internal error, please report; there may be not enough memory or threads\n");
    } catch (const std::exception& e) {
        if (out_of_memory(e)) say(kOutOfMemory);
        else say("isoparm: internal error, please report: "), say(e.what()), say("\n");
    } catch (...) {
        say("isoparm: internal error, please report\n");
    }
    ::_exit(kInternal);
}
extern "C" void isoparm_crashed(int signal) {
    remove_temporaries();
    const char* const name = ::sigabbrev_np(signal);
    say("isoparm: crashed (SIG"), say(name ? name : "?"), say("), please report; there may be not enough memory\n");
    ::raise(signal);  // SA_RESETHAND: this time as if there were no handler
}

}  // namespace

void tell_crashes() {
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // which tell more
    std::set_terminate(end_terminated);
    static char room[1 << 16];  // a stack of its own: the other one may have run over
    const stack_t stack{room, 0, sizeof room};
    struct sigaction ours {};
    ours.sa_handler = isoparm_crashed;
    ours.sa_flags = static_cast<int>(SA_RESETHAND) | (::sigaltstack(&stack, nullptr) == 0 ? SA_ONSTACK : 0);
    ::sigemptyset(&ours.sa_mask);
    for (const int s : kCrashes) ::sigaction(s, &ours, nullptr);
#endif
}

void leave_crashes() {
    std::set_terminate(std::abort);
    for (const int s : kCrashes) ::signal(s, SIG_DFL);
}

}  // namespace isoparm
