// progress.h -- how far a long piece of work is, on a terminal only.
#pragma once
#include <chrono>
#include <string>

namespace isoparm {

/// Shows "TITLE  42% [======>       ] 12 s left" on stderr when that is a terminal and the work takes longer than a
/// second; the line is wiped in the end. Not thread-safe: one thread reports.
class ProgressBar {
public:
    /// `quiet`: shows nothing.
    explicit ProgressBar(std::string title, bool quiet = false);
    ~ProgressBar();
    ProgressBar(const ProgressBar&) = delete;
    ProgressBar& operator=(const ProgressBar&) = delete;
    void operator()(double fraction);
    /// Something to say beside the title: "noise 0.01".
    void note(const std::string& text) { note_ = text; }
    bool enabled() const { return enabled_; }

private:
    using Clock = std::chrono::steady_clock;
    std::string title_, note_;
    bool enabled_, shown_ = false;
    Clock::time_point start_ = Clock::now(), next_ = start_ + std::chrono::seconds(1);
};

/// The line that is shown, at most `columns` wide.
std::string progress_line(const std::string& title, double fraction, double seconds, int columns);

}  // namespace isoparm
