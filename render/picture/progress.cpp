#include "picture/progress.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace isoparm {
namespace {

int terminal_columns() {
    winsize size{};
    return ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

std::string time_text(double seconds) {
    const long s = std::lround(std::min(seconds, 1e9));
    if (s < 60) return std::to_string(s) + " s";
    if (s < 3600) return std::to_string(s / 60) + " min " + std::to_string(s % 60) + " s";
    return std::to_string(s / 3600) + " h " + std::to_string(s % 3600 / 60) + " min";
}

}  // namespace

std::string progress_line(const std::string& title, double fraction, double seconds, int columns) {
    const double f = std::clamp(fraction, 0.0, 1.0);
    char percent[16];
    std::snprintf(percent, sizeof percent, "  %3d%%", static_cast<int>(std::floor(100 * f)));
    const std::string left = f > 0.01 ? "  " + time_text(seconds * (1 - f) / f) + " left" : "";
    const int room = std::min(30, columns - 4 - static_cast<int>(title.size() + sizeof "  100%" - 1 + left.size()));
    std::string bar;
    if (room >= 8) {
        const int full = static_cast<int>(f * room);
        bar = " [" + std::string(full, '=') + std::string(room - full, ' ') + "]";
    }
    const std::string line = title + percent + bar + left;
    return line.substr(0, std::max(0, columns - 1));
}

ProgressBar::ProgressBar(std::string title, bool quiet)
    : title_(std::move(title)), enabled_(!quiet && isatty(STDERR_FILENO)) {}

ProgressBar::~ProgressBar() {
    if (shown_) std::fputs("\r\033[K", stderr);
}

void ProgressBar::operator()(double fraction) {
    if (!enabled_) return;
    const auto now = Clock::now();
    if (now < next_) return;
    next_ = now + std::chrono::milliseconds(100);
    shown_ = true;
    const double seconds = std::chrono::duration<double>(now - start_).count();
    std::fprintf(stderr, "\r\033[K%s", progress_line(note_.empty() ? title_ : title_ + ", " + note_, fraction, seconds, terminal_columns()).c_str());
    std::fflush(stderr);
}

}  // namespace isoparm
