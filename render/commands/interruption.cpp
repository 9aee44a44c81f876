#include "commands/interruption.h"

#include <unistd.h>

#include <atomic>
#include <cerrno>

#include "io/atomic_file.h"

namespace isoparm {
namespace {

constexpr int kSignals[] = {SIGINT, SIGTERM};
std::atomic<int> came{0};
std::atomic<bool> tell{false};
static_assert(std::atomic<int>::is_always_lock_free);

extern "C" void isoparm_interrupted(int signal) {
    if (came.exchange(signal) != 0 || writing_to_device()) {  // a FIFO may never get a reader
        remove_temporaries();
        ::signal(signal, SIG_DFL);
        ::raise(signal);
        return;
    }
    const int error = errno;
    constexpr char text[] = "\nisoparm: ending with the picture as it is; once more ends at once, without it\n";
    if (tell && ::write(STDERR_FILENO, text, sizeof text - 1) < 0) { /* nobody to tell */ }
    errno = error;
}

}  // namespace

Interruption::Interruption(bool quiet) {
    came = 0;
    tell = !quiet;
    for (int i = 0; i < 2; ++i) {
        ::sigaction(kSignals[i], nullptr, &before_[i]);
        if (before_[i].sa_handler == SIG_IGN) continue;
        struct sigaction ours {};
        ours.sa_handler = isoparm_interrupted;
        ours.sa_flags = SA_RESTART;
        ::sigemptyset(&ours.sa_mask);
        ::sigaction(kSignals[i], &ours, nullptr);
    }
}
Interruption::~Interruption() {
    for (int i = 0; i < 2; ++i) ::sigaction(kSignals[i], &before_[i], nullptr);
}
int Interruption::signal() const { return came; }

}  // namespace isoparm
