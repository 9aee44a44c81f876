// commands/frames.h -- the frames of a film: a scene with parameters that go from one value to another, seen by cameras that may go round it.
#pragma once
#include "commands/options.h"

namespace isoparm {

struct Frame {
    std::string path;
    std::map<std::string, double> parameters;
    double degrees = 0;  // how far the cameras have gone
};

/// --frames, --animate and --turntable; every path is checked. `pattern`: a path with one %d or %04d. Throws Error(usage).
std::vector<Frame> frames_of(const Options& options, const std::string& pattern);

/// Points of what all frames draw, for cameras that fit.
std::vector<Point> points_of(const std::vector<Frame>& frames, const Options& options);

}  // namespace isoparm
