#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iostream>

#include "commands/options.h"
#include "commands/output.h"
#include "diff_report.h"
#include "difference_image.h"
#include "error.h"
#include "image_diff.h"
#include "io/atomic_file.h"
#include "suggest.h"

namespace isoparm {
namespace {

namespace fs = std::filesystem;

constexpr const char* kHelp = R"(usage: isoparm diff REF NEW [-fail X] [-warn X] [--json] ...

How do two images differ? Channels are matched by name, in all parts and layers; numbers are compared as the files hold them
(whole numbers as fractions of their largest, 32-bit integers as they are). What is NaN or Inf in either image fails. Another
size, data window, colour space, or channels and parts that are missing or new, are not comparable. See docs/diff.md.

as in idiff (with one dash or two)
-fail X           a pixel fails when a channel differs by more than X (1e-6) ...
-failpercent P    ... and the comparison when more than P percent of the pixels do (0) ...
-hardfail X       ... or one differs by more than X
-warn X, -warnpercent P, -hardwarn X   the same for a warning
-o FILE           the image REF - NEW: .exr holds all parts and channels; -abs: |REF - NEW|; -scale S: times S; -od: only if
                  they differ
-q                nothing but errors and the exit code;  -a  all parts, as always

--channel NAME=X  another X for a channel, or for all whose names begin so, as in N.*; may be repeated
--mask FILE       compare only pixels where the first channel of FILE is above one half
--allow-nonfinite NaN equals NaN and Inf equals Inf in the same place
--mismatch-fails  what is not comparable fails: exit code 2 instead of 3

--metrics         SSIM and FLIP too, of R, G and B; always part of --json, and computed when they have a limit:
--fail-flip X, --fail-rms X, --fail-ssim X   fail when the mean FLIP or the RMS is above X, the mean SSIM below
--ppd X           pixels per degree for FLIP (67.02: a 4K screen 0.7 m wide, 0.7 m away)
--flip WORD       auto (HDR-FLIP for images of floating point), ldr or hdr; --exposures START,STOP,N  for HDR-FLIP, in stops

--json            all numbers as JSON
--max-pixels N    refuse larger files (536870912);  --max-memory MIB  for decoding one (768);  --max-seconds S  (120)
--quiet           as -q; --threads N  at most N threads: the result is the same for every N

exit codes        0 pass, 1 warning, 2 fail, 3 not comparable, 4 a file cannot be read or written, 64 usage
)";

/// With one dash, as in idiff, or with two.
std::optional<double> number(const Options& options, const std::string& name, double least, double most) {
    for (const std::string& spelled : {"--" + name, "-" + name})
        if (const auto x = options.number(spelled)) {
            if (!(*x >= least && *x <= most)) options.fail(spelled + ": found " + to_text(*x) + ", expected a number " + (std::isfinite(most) ? "from " + to_text(least) + " to " + to_text(most) : "not below " + to_text(least)));
            return x;
        }
    return {};
}
bool has(const Options& options, const std::string& name) { return options.has("--" + name) || options.has("-" + name); }

constexpr double kInfinity = std::numeric_limits<double>::infinity();

void read_tier(const Options& options, const std::string& name, DiffTier& tier) {
    tier.value = number(options, name, 0, kInfinity).value_or(tier.value);
    tier.percent = number(options, name + "percent", 0, 100).value_or(tier.percent);
    tier.hard = number(options, "hard" + name, 0, kInfinity).value_or(tier.hard);
}

double parsed(const Options& options, const std::string& option, const std::string& text) {
    double x = 0;
    const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), x);
    if (text.empty() || error != std::errc() || stop != text.data() + text.size() || !std::isfinite(x)) options.fail(option + ": found " + quoted(text) + ", expected a number");
    return x;
}

void read_channels(const Options& options, DiffLimits& limits) {
    for (const std::string& given : options.values("--channel")) {
        const std::size_t equals = given.rfind('=');
        if (equals == std::string::npos || equals == 0) options.fail("--channel: found " + quoted(given) + ", expected NAME=X");
        const double x = parsed(options, "--channel", given.substr(equals + 1));
        if (x < 0) options.fail("--channel: found " + quoted(given) + ", expected a limit that is not negative");
        limits.channels.emplace_back(given.substr(0, equals), x);
    }
}

void read_flip(const Options& options, DiffRequest& r) {
    const std::string kind = options.word("--flip", {"auto", "ldr", "hdr"});
    r.flip = kind == "ldr" ? FlipKind::ldr : kind == "hdr" ? FlipKind::hdr : FlipKind::automatic;
    r.flip_options.pixels_per_degree = number(options, "ppd", 1, 1000).value_or(r.flip_options.pixels_per_degree);
    const auto given = options.value("--exposures");
    if (!given) return;
    const std::size_t first = given->find(','), second = first == std::string::npos ? first : given->find(',', first + 1);
    if (second == std::string::npos) options.fail("--exposures: found " + quoted(*given) + ", expected START,STOP,N");
    if (r.flip == FlipKind::ldr) options.fail("--exposures are for HDR-FLIP, and --flip is ldr");
    r.flip = FlipKind::hdr;
    r.flip_options.start = parsed(options, "--exposures", given->substr(0, first));
    r.flip_options.stop = parsed(options, "--exposures", given->substr(first + 1, second - first - 1));
    const double n = parsed(options, "--exposures", given->substr(second + 1));
    if (!(n >= 2 && n <= 64 && n == std::floor(n)) || std::fabs(r.flip_options.start) > 60 || std::fabs(r.flip_options.stop) > 60) options.fail("--exposures: found " + quoted(*given) + ", expected two numbers of stops up to 60, and 2 to 64 exposures");
    r.flip_options.exposures = static_cast<int>(n);
}

DiffRequest read_request(const Options& options) {
    DiffRequest r;
    read_tier(options, "fail", r.limits.fail);
    read_tier(options, "warn", r.limits.warn);
    read_channels(options, r.limits);
    read_flip(options, r);
    r.limits.allow_nonfinite = options.has("--allow-nonfinite");
    r.limits.flip = number(options, "fail-flip", 0, 1);
    r.limits.rms = number(options, "fail-rms", 0, kInfinity);
    r.limits.ssim = number(options, "fail-ssim", -1, 1);
    r.perceptual = options.has("--metrics") || options.has("--json") || r.limits.flip || r.limits.ssim;
    r.mask = options.value("--mask").value_or("");
    r.output = options.value("-o").value_or("");
    r.output_if_different = has(options, "od"), r.absolute = has(options, "abs");
    r.scale = number(options, "scale", -kInfinity, kInfinity).value_or(1);
    r.image.pixels = static_cast<std::uint64_t>(number(options, "max-pixels", 1, 1e12).value_or(static_cast<double>(r.image.pixels)));
    r.image.memory = static_cast<std::size_t>(number(options, "max-memory", 16, 1 << 20).value_or(768)) << 20;
    r.image.seconds = static_cast<int>(number(options, "max-seconds", 1, 1e6).value_or(120));
    if (const auto threads = options.integer("--threads", 1, 4096)) r.image.threads = *threads;
    return r;
}

int exit_code(DiffVerdict verdict, bool mismatch_fails) {
    switch (verdict) {
        case DiffVerdict::pass: return kSuccess;
        case DiffVerdict::warn: return kWarning;
        case DiffVerdict::fail: return kCheckFailed;
        case DiffVerdict::not_comparable: return mismatch_fails ? kCheckFailed : kNotComparable;
        default: return kIoError;
    }
}

ImageDiff compare_files(const std::string& a, const std::string& b, const DiffRequest& request) {
    try {
        return diff_images(a, b, request);
    } catch (const Error& e) {
        if (e.kind() != ErrorKind::io) throw;
        ImageDiff unreadable;
        unreadable.a = a, unreadable.b = b, unreadable.verdict = DiffVerdict::unreadable;
        unreadable.reasons = {e.what()};
        return unreadable;
    }
}

void tell(const ImageDiff& d, const DiffRequest& request, const Options& options) {
    if (d.verdict == DiffVerdict::unreadable) std::fprintf(stderr, "isoparm: %s\n", d.reasons.front().c_str());
    else if (options.has("--json")) std::cout << diff_json(d) << "\n";
    else if (!options.quiet() && !options.has("-q")) print_diff_text(std::cout, d, request.limits);
}

std::vector<Options::Known> known_options() {
    std::vector<Options::Known> known;
    for (const char* name : {"-fail", "--fail", "-failpercent", "--failpercent", "-hardfail", "--hardfail", "-warn", "--warn", "-warnpercent", "--warnpercent", "-hardwarn", "--hardwarn", "-scale", "--scale", "-o", "--channel", "--mask",
                             "--fail-flip", "--fail-rms", "--fail-ssim", "--ppd", "--flip", "--exposures", "--max-pixels", "--max-memory", "--max-seconds"})
        known.push_back({name, true});
    for (const char* name : {"-abs", "--abs", "-od", "--od", "-q", "-a", "--all", "--allow-nonfinite", "--mismatch-fails", "--metrics", "--json"}) known.push_back({name, false});
    known.push_back({"-p", false, "use --fail-flip"});
    return known;
}

int run(const std::vector<std::string>& arguments) {
    const Options options("diff", arguments, known_options());
    if (options.words().size() != 2) options.fail("found " + std::to_string(options.words().size()) + " file names, expected a reference and a new image");
    const std::string &a = options.words()[0], &b = options.words()[1];
    const DiffRequest request = read_request(options);
    if (!request.output.empty()) {
        check_difference_path(request.output);
        check_outputs(options, {{"-o", request.output}}, {{"REF", a}, {"NEW", b}, {"--mask", request.mask.empty() ? a : request.mask}});
    }
    const ImageDiff d = compare_files(a, b, request);
    tell(d, request, options);
    return exit_code(d.verdict, options.has("--mismatch-fails"));
}

}  // namespace

const Command diff_command = {"diff", "how two images differ, for people and for continuous integration", kHelp, run};

}  // namespace isoparm
