// commands/interruption.h -- a work that ends early, and well, when the user or the system asks for it.
#pragma once
#include <csignal>

namespace isoparm {

/// While this lives, the first SIGINT or SIGTERM is only noted, and told on stderr; the second one, and the first where a pipe or a device is being
/// written, ends the program at once, without leaving a temporary. A signal that is ignored stays ignored. There is one at a time.
class Interruption {
public:
    /// `quiet`: it is not told.
    explicit Interruption(bool quiet);
    ~Interruption();
    Interruption(const Interruption&) = delete;
    Interruption& operator=(const Interruption&) = delete;
    /// The signal that came, or 0. Safe from every thread.
    int signal() const;

private:
    struct sigaction before_[2];
};

}  // namespace isoparm
