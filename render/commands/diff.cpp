#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iostream>

#include "commands/options.h"
#include "commands/output.h"
#include "diff/diff_folders.h"
#include "diff/diff_report.h"
#include "diff/diff_selftest.h"
#include "diff/difference_image.h"
#include "diff/image_diff.h"
#include "error.h"
#include "image/image_header.h"
#include "io/atomic_file.h"
#include "scene/suggest.h"
#include "scratch_folder.h"
#include "text/printable_text.h"

namespace isoparm {
namespace {

namespace fs = std::filesystem;

constexpr const char* kHelp = R"(usage: isoparm diff REF NEW [-fail X] [-warn X] [--json] [--junit FILE] [--html FILE] ...
       isoparm diff REFS/ NEWS/ [--update] ...
       isoparm diff --selftest

How do two images differ? Channels are matched by name, in all parts and layers; numbers are compared as the files hold them
(whole numbers as fractions of their largest, 32-bit integers as they are). What is NaN or Inf in either image fails. Another
size, data window, colour space, or channels and parts that are missing or new, are not comparable. See docs/diff.md.

REF, NEW          .exr, .png, .tif, .tga, .jpg, .bmp, .ppm; or two folders, whose images are paired by name: what is missing on
                  either side fails. NAME.altWORD.png is another reference for NAME.png: one of them has to match
--update          NEW replaces REF where it does not pass, is no damaged file and holds no NaN or Inf; missing references are made
--selftest        changes an image in every way that is claimed to be seen, and tells what was not: exit code 2

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

--json            all numbers as JSON;  --junit FILE  as JUnit XML; - is standard output
--html FILE       one page: side by side, flicker, wipe, heat map, FLIP, histogram; for the first 50 pairs that do not pass
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
    r.perceptual = options.has("--metrics") || options.has("--json") || options.has("--html") || r.limits.flip || r.limits.ssim;
    r.preview = options.has("--html") ? 1200 : 0;
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
        case DiffVerdict::missing:
        case DiffVerdict::fail: return kCheckFailed;
        case DiffVerdict::not_comparable: return mismatch_fails ? kCheckFailed : kNotComparable;
        default: return kIoError;
    }
}

ImageDiff problem(const std::string& a, const std::string& b, DiffVerdict verdict, const std::string& why) {
    ImageDiff d;
    d.a = a, d.b = b, d.verdict = verdict, d.reasons = {why};
    return d;
}

ImageDiff compare_files(const std::string& a, const std::string& b, const DiffRequest& request) {
    try {
        return diff_images(a, b, request);
    } catch (const Error& e) {
        if (e.kind() != ErrorKind::io) throw;
        return problem(a, b, DiffVerdict::unreadable, e.what());
    }
}

/// The best of several references.
ImageDiff compare_pair(const FolderPair& pair, const std::string& references, const std::string& images, const DiffRequest& request) {
    const std::string a = (fs::path(references) / pair.name).string(), b = (fs::path(images) / pair.name).string();
    if (pair.image.empty()) return problem(a, b, DiffVerdict::missing, "the new image is missing");
    if (pair.references.empty()) return problem(a, b, DiffVerdict::missing, "there is no reference (--update makes it one)");
    std::optional<ImageDiff> best;
    for (const std::string& reference : pair.references) {
        ImageDiff d = compare_files(reference, pair.image, request);
        if (!best || d.verdict < best->verdict) best = std::move(d);
        if (best->verdict == DiffVerdict::pass) break;
    }
    return *best;
}

/// To standard output if the name is "-".
void write_report(const Options& options, const std::string& option, const std::string& text) {
    if (options.value(option).value_or("-") == "-") std::cout << text;
    else write_atomically(*options.value(option), [&](std::ostream& out) { out << text; });
}
/// Is standard output taken, by --json or a report?
bool output_is_taken(const Options& options) { return options.has("--json") || options.value("--junit") == "-" || options.value("--html") == "-"; }

void tell(const ImageDiff& d, const DiffRequest& request, const Options& options) {
    if (d.verdict == DiffVerdict::unreadable) std::fprintf(stderr, "isoparm: %s\n", printable(d.reasons.front()).c_str());
    else if (!output_is_taken(options) && !options.quiet() && !options.has("-q")) print_diff_text(std::cout, d, request.limits);
}

/// NEW becomes the reference, unless it is damaged or holds what never passes, or there was no comparison because something failed that does not fail again
/// (no memory, no files left): then the verdict stays.
void update(ImageDiff& d, const std::string& reference, const std::string& image, DiffRequest request, const Options& options) {
    if (d.verdict == DiffVerdict::pass || image.empty()) return;
    request.output.clear(), request.perceptual = false, request.preview = 0, request.mask.clear();
    request.limits.flip = request.limits.ssim = request.limits.rms = {};
    if (d.verdict == DiffVerdict::unreadable && compare_files(reference, image, request).verdict != DiffVerdict::unreadable) {
        std::fprintf(stderr, "isoparm: %s was not updated: it could not be compared, for a reason that has passed; compare again\n", printable(reference).c_str());
        return;
    }
    if (const ImageDiff self = compare_files(image, image, request); self.verdict != DiffVerdict::pass) {
        if (!options.quiet() || self.verdict == DiffVerdict::unreadable)
            std::fprintf(stderr, "isoparm: note: %s was not updated: %s\n", printable(reference).c_str(), verdict_line(self, request.limits).c_str());
        d.verdict = std::max(d.verdict == DiffVerdict::missing ? DiffVerdict::pass : d.verdict, self.verdict);
        return;
    }
    replace_file(reference, image);
    if (!options.quiet()) std::fprintf(stderr, "isoparm: note: %s was updated\n", printable(reference).c_str());
    d.verdict = DiffVerdict::pass;
}

std::vector<ImageDiff> compare_folders(const FolderPairs& found, const std::string& references, const std::string& images, DiffRequest request, const Options& options) {
    std::vector<ImageDiff> all;
    int pictures = 0;
    const int preview = request.preview;
    if (!found.unread.empty() && !options.quiet() && !options.has("-q"))
        std::fprintf(stderr, "isoparm: note: %zu images are of formats that are not read, and were not compared: %s%s\n", found.unread.size(), printable(found.unread.front()).c_str(), found.unread.size() > 1 ? ", ..." : "");
    for (const FolderPair& pair : found.pairs) {
        request.preview = pictures < 50 ? preview : 0;
        all.push_back(compare_pair(pair, references, images, request));
        ImageDiff& d = all.back();
        if (d.verdict == DiffVerdict::pass) d.preview.reset();
        pictures += d.preview.has_value();
        make_figures(d);
        tell(d, request, options);
        if (!options.has("--update")) continue;
        const std::string reference = (fs::path(references) / pair.name).string();
        if (!pair.alternative) update(d, reference, pair.image, request, options);
        else if (d.verdict != DiffVerdict::pass && !options.quiet()) std::fprintf(stderr, "isoparm: note: %s was not updated: its name is that of another reference\n", printable(reference).c_str());
    }
    if (all.empty()) throw Error(ErrorKind::io, references + " and " + images + ": found no images");
    return all;
}

int selftest(const Options& options) {
    const ScratchFolder folder;
    const auto trials = diff_selftest(folder.path());
    std::size_t missed = 0;
    for (const DiffTrial& t : trials) {
        missed += !t.caught();
        if (!t.caught() || !(options.quiet() || options.has("-q"))) std::cout << (t.caught() ? "ok      " : "MISSED  ") << t.what << ": " << t.found << (t.caught() ? "" : ", expected " + t.expected) << "\n";
    }
    std::cout << trials.size() << " changes, " << missed << " missed\n";
    return missed ? kCheckFailed : kSuccess;
}

/// `found`: of two folders. No report replaces an image of theirs, nor one that --update makes.
void check_files(const Options& options, const DiffRequest& request, const std::string& a, const std::string& b, bool folders, const FolderPairs& found) {
    std::vector<NamedFile> outputs, inputs{{"REF", a}, {"NEW", b}};
    for (const FolderPair& pair : found.pairs) {
        inputs.push_back({"REF", (fs::path(a) / pair.name).string()}), inputs.push_back({"NEW", (fs::path(b) / pair.name).string()});
        for (const std::string& reference : pair.references) inputs.push_back({"REF", reference});
    }
    for (const std::string& image : found.unread) inputs.push_back({"REF or NEW", image});
    if (!request.mask.empty()) inputs.push_back({"--mask", request.mask});
    if (!request.output.empty()) {
        if (folders) options.fail("-o is for two images, and these are folders");
        check_difference_path(request.output);
        outputs.push_back({"-o", request.output});
    }
    for (const char* name : {"--junit", "--html"})
        if (const auto file = options.value(name)) outputs.push_back({name, *file});
    if (options.has("--json") + (options.value("--junit") == "-") + (options.value("--html") == "-") > 1) options.fail("found more than one of --json, --junit - and --html -, which all go to standard output");
    check_outputs(options, outputs, inputs);
}

/// NEW is copied byte by byte: under another extension it would be no image.
void check_format(const Options& options, const std::string& reference, const std::string& image) {
    const std::string old = format_of_name(reference), made = format_of_name(image);
    if (old.empty() || old != made) options.fail("--update: found " + quoted(printable(image)) + " for the reference " + quoted(printable(reference)) + ", expected files of one format; nothing was written");
}

std::string summary(const std::vector<ImageDiff>& all) {
    std::string text;
    for (const DiffVerdict v : {DiffVerdict::pass, DiffVerdict::warn, DiffVerdict::missing, DiffVerdict::fail, DiffVerdict::not_comparable, DiffVerdict::unreadable}) {
        const auto n = std::count_if(all.begin(), all.end(), [&](const ImageDiff& d) { return d.verdict == v; });
        const std::string name = v == DiffVerdict::missing ? "missing" : v == DiffVerdict::not_comparable ? "not comparable" : verdict_name(v);
        if (n > 0) text += (text.empty() ? "" : ", ") + std::to_string(n) + " " + name;
    }
    return std::to_string(all.size()) + " images: " + text;
}

std::vector<Options::Known> known_options() {
    std::vector<Options::Known> known;
    for (const char* name : {"-fail", "--fail", "-failpercent", "--failpercent", "-hardfail", "--hardfail", "-warn", "--warn", "-warnpercent", "--warnpercent", "-hardwarn", "--hardwarn", "-scale", "--scale", "-o", "--channel", "--mask",
                             "--fail-flip", "--fail-rms", "--fail-ssim", "--ppd", "--flip", "--exposures", "--max-pixels", "--max-memory", "--max-seconds", "--junit", "--html"})
        known.push_back({name, true});
    for (const char* name : {"-abs", "--abs", "-od", "--od", "-q", "-a", "--all", "--allow-nonfinite", "--mismatch-fails", "--metrics", "--json", "--update", "--selftest"}) known.push_back({name, false});
    known.push_back({"-p", false, "use --fail-flip"});
    return known;
}

int run(const std::vector<std::string>& arguments) {
    const Options options("diff", arguments, known_options());
    if (options.has("--selftest")) return selftest(options);
    if (options.words().size() != 2) options.fail("found " + std::to_string(options.words().size()) + " file names, expected a reference and a new image");
    const std::string &a = options.words()[0], &b = options.words()[1];
    std::error_code ignored;
    const bool made = options.has("--update") && !fs::exists(a, ignored);
    const bool folders = fs::is_directory(made ? b : a, ignored);
    const std::string missing = !fs::exists(a, ignored) && !made ? a : !fs::exists(b, ignored) ? b : "";
    if (missing.empty() && folders != fs::is_directory(b, ignored)) options.fail("found a folder and a file, expected two images or two folders");
    const DiffRequest request = read_request(options);
    const FolderPairs found = folders && missing.empty() ? pair_folders(a, b) : FolderPairs{};
    check_files(options, request, a, b, folders, found);
    if (options.has("--update") && !folders && missing.empty()) check_format(options, a, b);

    std::vector<ImageDiff> all;
    if (!missing.empty()) {
        all.push_back(problem(a, b, DiffVerdict::unreadable, missing + ": there is no such file or folder"));
        tell(all.front(), request, options);
    } else if (folders) all = compare_folders(found, a, b, request, options);
    else {
        all.push_back(compare_files(a, b, request));
        make_figures(all.front());
        tell(all.front(), request, options);
        if (options.has("--update")) update(all.front(), a, b, request, options);
    }
    if (options.has("--json")) std::cout << (folders ? diff_json(all) : diff_json(all.front())) << "\n";
    if (options.has("--junit")) write_report(options, "--junit", diff_junit(all, request.limits));
    if (options.has("--html")) write_report(options, "--html", diff_page(all, request.limits));
    if (folders && missing.empty() && !output_is_taken(options) && !options.quiet() && !options.has("-q")) std::cout << summary(all) << "\n";
    return exit_code(worst_of(all), options.has("--mismatch-fails"));
}

}  // namespace

const Command diff_command = {"diff", "how two images differ, for people and for continuous integration", kHelp, run};

}  // namespace isoparm
