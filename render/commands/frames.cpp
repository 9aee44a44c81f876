#include "commands/frames.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "commands/output.h"
#include "commands/render_options.h"
#include "drawing/drawn.h"
#include "drawing/paper.h"
#include "error.h"
#include "image/image.h"
#include "scene/suggest.h"

namespace isoparm {

namespace {

/// The path of frame k: %d or %0Nd replaced.
std::string path_of(const Options& options, const std::string& pattern, int k) {
    const std::size_t percent = pattern.find('%');
    std::size_t end = percent == std::string::npos ? pattern.size() : percent + 1;
    const bool zeros = end < pattern.size() && pattern[end] == '0';
    int width = 0;
    while (end < pattern.size() && pattern[end] >= '0' && pattern[end] <= '9' && width < 10) width = 10 * width + (pattern[end++] - '0');
    const bool good = end < pattern.size() && pattern[end] == 'd' && width < 10 && (zeros || width == 0) && pattern.find('%', end) == std::string::npos;
    if (!good) options.fail("-o: found " + quoted(pattern) + ", expected a name with one %d or %04d, which becomes the number of the frame");
    char number[16];
    std::snprintf(number, sizeof number, "%0*d", width, k);
    return pattern.substr(0, percent) + number + pattern.substr(end + 1);
}

struct Range {
    std::string name;
    double from, to;
};

bool read_number(const std::string& text, double& x) {
    const char* end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, x);
    return !text.empty() && error == std::errc() && stop == end && std::isfinite(x);
}

/// "p=A:B", or "p": from the parameter's min to its max.
Range read_range(const Options& options, const std::string& text, const Scene& scene) {
    const std::size_t equals = text.find('='), colon = text.find(':', equals == std::string::npos ? 0 : equals);
    Range r{text.substr(0, equals), 0, 0};
    const auto known = scene.ranges.find(r.name);
    if (known == scene.ranges.end()) {
        std::vector<std::string> names;
        for (const auto& p : scene.ranges) names.push_back(p.first);
        options.fail("--animate " + r.name + ": " + scene.path + " has no such parameter (has: " + listed(names) + ")" + did_you_mean(r.name, names));
    }
    const auto [least, most] = known->second;
    if (equals == std::string::npos) {
        if (!std::isfinite(least) || !std::isfinite(most)) options.fail("--animate " + r.name + ": the parameter has no min and max, expected --animate " + r.name + "=FROM:TO");
        return {r.name, least, most};
    }
    if (colon == std::string::npos || !read_number(text.substr(equals + 1, colon - equals - 1), r.from) || !read_number(text.substr(colon + 1), r.to))
        options.fail("--animate: found " + quoted(text) + ", expected PARAMETER or PARAMETER=FROM:TO, such as h=0:1");
    for (const double x : {r.from, r.to})
        if (!(x >= least && x <= most)) options.fail("--animate " + text + ": found " + to_text(x) + ", expected values from " + to_text(least) + " to " + to_text(most));
    return r;
}

}  // namespace

std::vector<Frame> frames_of(const Options& options, const std::string& pattern) {
    const auto count = options.integer("--frames", 2, 10'000);
    if (!count) options.fail("--frames is missing: the number of pictures that --animate and --turntable make");
    if (!options.has("--animate") && !options.has("--turntable"))
        options.fail("--animate is missing, or --turntable: what goes from frame to frame, such as --animate h=0:1, or --turntable 360");
    const double turn = options.number("--turntable").value_or(0);
    if (!(std::fabs(turn) <= 36'000)) options.fail("--turntable: found " + quoted(*options.value("--turntable")) + ", expected degrees, from -36000 to 36000");
    // Whole turns end one step before where they began, so that the film can go round and round.
    const double steps = std::remainder(turn, 360) == 0 ? *count : *count - 1;
    const Scene scene = options.scene();
    std::vector<Range> ranges;
    for (const std::string& text : options.values("--animate")) {
        ranges.push_back(read_range(options, text, scene));
        for (std::size_t i = 0; i + 1 < ranges.size(); ++i)
            if (ranges[i].name == ranges.back().name) options.fail("--animate " + ranges.back().name + " is given twice, expected every parameter once");
    }
    std::vector<NamedFile> inputs = inputs_of(scene);
    if (const auto camera = options.value("--camera")) inputs.push_back({"--camera", *camera});
    std::vector<Frame> frames;
    for (int k = 0; k < *count; ++k) {
        Frame& f = frames.emplace_back(Frame{path_of(options, pattern, k), {}, turn * k / steps});
        const double t = static_cast<double>(k) / (*count - 1);
        for (const Range& r : ranges) f.parameters[r.name] = std::clamp((1 - t) * r.from + t * r.to, std::min(r.from, r.to), std::max(r.from, r.to));
        check_picture_path(options, f.path);
        std::vector<NamedFile> outputs;
        for (const std::string& file : paper_files(f.path)) outputs.push_back({"-o", file});
        check_outputs(options, outputs, inputs);
    }
    return frames;
}

std::vector<Point> points_of(const std::vector<Frame>& frames, const Options& options) {
    // The farthest in each of many directions, spread evenly over the sphere: their hull is that of all points, or about.
    constexpr int kDirections = 400;
    std::vector<Point> directions, farthest;
    for (int i = 0; i < kDirections; ++i) {
        const double z = 1 - (2 * i + 1.0) / kDirections, r = std::sqrt(1 - z * z), turn = i * std::numbers::pi * (3 - std::sqrt(5.0));
        directions.push_back({r * std::cos(turn), r * std::sin(turn), z});
    }
    for (const Frame& f : frames) {
        if (&f != &frames.front() && f.parameters == frames.front().parameters) continue;
        for (const Point& p : drawn_points(options.scene(f.parameters))) {
            if (farthest.empty()) farthest.assign(kDirections, p);
            for (int i = 0; i < kDirections; ++i)
                if (dot(p, directions[i]) > dot(farthest[i], directions[i])) farthest[i] = p;
        }
    }
    return farthest;
}

}  // namespace isoparm
