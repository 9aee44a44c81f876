// checkpoint.h -- what a long picture has come to, in a file, so that a run that was killed goes on where it was.
//
// The file holds a key, which is everything that the pixels depend on, the films, and a SHA-256 of it all. It is written whole or not at all.
#pragma once
#include <chrono>
#include <functional>
#include <string>
#include <vector>

#include "picture/film.h"

namespace isoparm {

struct Checkpoint {
    std::string path;     // empty: none
    std::string key;      // lines "name value", each name once
    double seconds = 60;  // from one to the next
};

/// Throws Error(io).
void write_checkpoint(const Checkpoint& checkpoint, const std::vector<Film*>& films);
/// Fills the films. False: there is no such file. Throws Error(io) when it cannot be read, Error(input) when it is damaged, or was made for another
/// picture: in what it differs. Nothing in the file is believed: its size must be that of these films, and the numbers such as films have.
bool read_checkpoint(const Checkpoint& checkpoint, const std::vector<Film*>& films);

/// Tells when something that takes time is due again: `seconds` after it was done last, and never more often than once in `share` times
/// what it takes. Safe to ask from every thread.
class PauseTimer {
public:
    PauseTimer(double seconds, double share) : seconds_(seconds), share_(share), next_(Clock::now() + duration(seconds)) {}
    bool due() const { return Clock::now() >= next_; }
    void spend(const std::function<void()>& work);

private:
    using Clock = std::chrono::steady_clock;
    static Clock::duration duration(double seconds) { return std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds)); }
    double seconds_, share_;
    Clock::time_point next_;
};

/// Reads the checkpoint when it is made, and saves it when asked.
class CheckpointTimer {
public:
    CheckpointTimer(const Checkpoint& checkpoint, std::vector<Film*> films);
    bool due() const { return !checkpoint_.path.empty() && timer_.due(); }
    void save();

private:
    const Checkpoint& checkpoint_;
    std::vector<Film*> films_;
    PauseTimer timer_;
};

}  // namespace isoparm
