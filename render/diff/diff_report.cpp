#include "diff/diff_report.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ostream>

#include "html_text.h"
#include "text/json_text.h"
#include "text/printable_text.h"
#include "text/short_text.h"

namespace isoparm {
namespace {

std::string at(const DiffSample& s) {
    char text[32];
    std::snprintf(text, sizeof text, "(%d,%d)", s.x, s.y);
    return text;
}
std::string padded(std::string text, std::size_t width) {
    if (text.size() < width) text.resize(width, ' ');
    return text + " ";
}
std::string percent(std::uint64_t part, std::uint64_t whole) { return short_text(whole ? 100 * static_cast<double>(part) / static_cast<double>(whole) : 0) + " %"; }

/// "N.Y: 12 px > 0.004, worst 0.031 at (412,88), patch 3, uv (0.51,0.02)"
std::string patch_line(const PartDiff& p, const PatchFailures& f) {
    const ChannelDiff& c = p.channels[f.channel];
    return printable(c.name) + ": " + std::to_string(f.pixels) + " px > " + short_text(c.fail) + ", worst " + short_text(f.difference) + " at " + at(f.worst) + (f.patch >= 0 ? ", patch " + std::to_string(f.patch) : ", no patch") + ", uv (" + short_text(f.u) + "," + short_text(f.v) + ")";
}

void print_part(std::ostream& out, const PartDiff& p, bool named) {
    if (named) out << "part " << (p.name.empty() ? "without a name" : printable(p.name)) << "\n";
    std::size_t longest = 7, equal = 0;
    for (const ChannelDiff& c : p.channels) longest = std::max(longest, printable(c.name).size());
    const auto differs = [](const ChannelDiff& c) { return c.differing > 0 || c.nonfinite > 0; };
    if (std::any_of(p.channels.begin(), p.channels.end(), differs))
        out << "  " << padded("channel", longest) << padded("max", 10) << padded("mean", 10) << padded("rms", 10) << padded("psnr", 8) << padded("99 %", 10) << padded("px > limit", 20) << "worst\n";
    for (const ChannelDiff& c : p.channels) {
        if (!differs(c)) {
            ++equal;
            continue;
        }
        out << "  " << padded(printable(c.name), longest) << padded(short_text(c.max), 10) << padded(short_text(c.mean()), 10) << padded(short_text(c.rms()), 10) << padded(short_text(c.psnr()), 8) << padded(short_text(c.percentile(0.99)), 10)
            << padded(std::to_string(c.failing) + " > " + short_text(c.fail), 20) << short_text(c.worst.a) << " became " << short_text(c.worst.b) << " at " << at(c.worst);
        if (c.nonfinite > 0) out << "; " << c.nonfinite << " px with NaN or Inf";
        out << "\n";
    }
    if (equal > 0) out << "  " << equal << (equal == p.channels.size() ? " channels are all equal" : equal == 1 ? " channel is equal" : " channels are equal") << "\n";
    for (std::size_t k = 0; k < p.patches.size() && k < 20; ++k) out << "  " << patch_line(p, p.patches[k]) << "\n";
    if (p.patches.size() > 20) out << "  ... and " << p.patches.size() - 20 << " more groups of failing pixels (--json has all)\n";
}

// ---- JSON

/// What is not finite is text: a number would not be JSON, and null would not tell what was found.
std::string json_value(double x) { return std::isnan(x) ? "\"NaN\"" : std::isinf(x) ? (x > 0 ? "\"Infinity\"" : "\"-Infinity\"") : to_text(x); }

std::string json_sample(const DiffSample& s, const std::string& channel) {
    return "{\"x\": " + std::to_string(s.x) + ", \"y\": " + std::to_string(s.y) + ", \"channel\": " + json_text(channel) + ", \"a\": " + json_value(s.a) + ", \"b\": " + json_value(s.b) + "}";
}

std::string json_channel(const ChannelDiff& c) {
    const bool differs = c.differing > 0 || c.nonfinite > 0;
    return "{\"name\": " + json_text(c.name) + ", \"limit\": " + json_text(c.fail) + ", \"mean\": " + json_text(c.mean()) + ", \"rms\": " + json_text(c.rms()) + ", \"max\": " + json_text(c.max) + ", \"psnr\": " + json_text(c.psnr()) +
           ", \"percentiles\": {\"50\": " + json_text(c.percentile(0.5)) + ", \"90\": " + json_text(c.percentile(0.9)) + ", \"99\": " + json_text(c.percentile(0.99)) + ", \"99.9\": " + json_text(c.percentile(0.999)) +
           "}, \"differing\": " + std::to_string(c.differing) + ", \"failing_pixels\": " + std::to_string(c.failing) + ", \"nonfinite_pixels\": " + std::to_string(c.nonfinite) + ", \"worst\": " + (differs ? json_sample(c.worst, c.name) : "null") + "}";
}

std::string json_patch(const PartDiff& p, const PatchFailures& f) {
    const ChannelDiff& c = p.channels[f.channel];
    return "{\"channel\": " + json_text(c.name) + ", \"patch\": " + std::to_string(f.patch) + ", \"pixels\": " + std::to_string(f.pixels) + ", \"limit\": " + json_text(c.fail) + ", \"max\": " + json_value(f.difference) + ", \"uv\": [" + json_text(f.u) + ", " + json_text(f.v) + "], \"worst\": " + json_sample(f.worst, c.name) + "}";
}

std::string json_part(const PartDiff& p) {
    std::string text = "{\"name\": " + json_text(p.name) + ", \"pixels\": " + std::to_string(p.pixels) + ", \"failing_pixels\": " + std::to_string(p.failing) + ",\n   \"channels\": [";
    for (std::size_t k = 0; k < p.channels.size(); ++k) text += (k ? ",\n    " : "\n    ") + json_channel(p.channels[k]);
    text += "],\n   \"patches\": [";
    for (std::size_t k = 0; k < p.patches.size(); ++k) text += (k ? ",\n    " : "\n    ") + json_patch(p, p.patches[k]);
    return text + "]}";
}

}  // namespace

const char* verdict_name(DiffVerdict verdict) {
    switch (verdict) {
        case DiffVerdict::pass: return "pass";
        case DiffVerdict::warn: return "warn";
        case DiffVerdict::missing:
        case DiffVerdict::fail: return "fail";
        case DiffVerdict::not_comparable: return "not_comparable";
        default: return "error";
    }
}

DiffVerdict worst_of(const std::vector<ImageDiff>& all) {
    DiffVerdict worst = DiffVerdict::pass;
    for (const ImageDiff& d : all) worst = std::max(worst, d.verdict);
    return worst;
}

std::string verdict_line(const ImageDiff& d, const DiffLimits& limits) {
    std::string why;
    for (const std::string& r : d.reasons) why += (why.empty() ? "" : "; ") + printable(r);
    if (d.verdict == DiffVerdict::not_comparable) return "NOT COMPARABLE: " + why;
    if (d.verdict == DiffVerdict::unreadable) return "ERROR: " + why;
    if (d.verdict == DiffVerdict::missing) return "FAIL: " + why;
    if (d.nonfinite > 0) why = std::to_string(d.nonfinite) + " of " + std::to_string(d.pixels) + " pixels hold NaN or Inf" + (why.empty() ? "" : "; " + why);
    if (d.failing > d.nonfinite) why += (why.empty() ? "" : "; ") + std::to_string(d.failing) + " of " + std::to_string(d.pixels) + " pixels (" + percent(d.failing, d.pixels) + ") differ by more than " + (limits.channels.empty() ? short_text(limits.fail.value) : "their channels' limits");
    if (d.verdict == DiffVerdict::fail && why.empty()) why = "the largest difference, " + short_text(d.max) + ", is more than " + short_text(limits.fail.hard);
    if (d.verdict == DiffVerdict::warn && why.empty())
        why = d.warning > 0 ? std::to_string(d.warning) + " of " + std::to_string(d.pixels) + " pixels (" + percent(d.warning, d.pixels) + ") differ by more than " + short_text(limits.warn.value) : "the largest difference is " + short_text(d.max);
    const std::string what = d.verdict == DiffVerdict::pass ? "PASS" : d.verdict == DiffVerdict::warn ? "WARNING" : "FAIL";
    return what + (why.empty() ? "" : ": " + why);
}

void print_diff_text(std::ostream& out, const ImageDiff& d, const DiffLimits& limits) {
    out << printable(d.a) << " and " << printable(d.b) << "\n";
    for (const PartDiff& p : d.parts) print_part(out, p, d.parts.size() > 1);
    if (d.compared()) {
        out << "  all: max " << short_text(d.max) << ", mean " << short_text(d.mean) << ", rms " << short_text(d.rms) << ", psnr " << short_text(d.psnr);
        if (d.flip) out << ", flip " << short_text(*d.flip);
        if (d.ssim) out << ", ssim " << short_text(*d.ssim);
        out << "\n";
    }
    out << verdict_line(d, limits) << "\n";
}

std::string diff_json(const ImageDiff& d) {
    std::string text = std::string("{\"result\": \"") + verdict_name(d.verdict) + "\", ";
    if (!d.compared()) text += "\"mean\": null, \"rms\": null, \"max\": null, \"psnr\": null, \"flip\": null, \"ssim\": null, \"failing_pixels\": null, \"worst\": null,\n ";
    else
        text += "\"mean\": " + json_text(d.mean) + ", \"rms\": " + json_text(d.rms) + ", \"max\": " + json_text(d.max) + ", \"psnr\": " + json_text(d.psnr) + ", \"flip\": " + json_text(d.flip) + ", \"ssim\": " + json_text(d.ssim) +
                ", \"failing_pixels\": " + std::to_string(d.failing) + ",\n \"worst\": " + (d.worst_channel.empty() ? "null" : json_sample(d.worst, d.worst_channel)) + ",\n \"pixels\": " + std::to_string(d.pixels) +
                ", \"warning_pixels\": " + std::to_string(d.warning) + ", \"nonfinite_pixels\": " + std::to_string(d.nonfinite) + ", ";
    text += "\"reference\": " + json_text(d.a) + ", \"new\": " + json_text(d.b) + ",\n \"reasons\": [";
    for (std::size_t k = 0; k < d.reasons.size(); ++k) text += (k ? ", " : "") + json_text(d.reasons[k]);
    text += "],\n \"parts\": [";
    for (std::size_t k = 0; k < d.parts.size(); ++k) text += (k ? ",\n  " : "\n  ") + json_part(d.parts[k]);
    return text + "]}";
}

std::string diff_json(const std::vector<ImageDiff>& all) {
    std::string text = std::string("{\"result\": \"") + verdict_name(worst_of(all)) + "\", \"pairs\": [";
    for (std::size_t k = 0; k < all.size(); ++k) text += (k ? ",\n" : "\n") + diff_json(all[k]);
    return text + "]}";
}

std::string diff_junit(const std::vector<ImageDiff>& all, const DiffLimits& limits) {
    std::size_t failures = 0, errors = 0;
    std::string cases;
    for (const ImageDiff& d : all) {
        const bool error = d.verdict > DiffVerdict::fail, failure = d.verdict == DiffVerdict::fail || d.verdict == DiffVerdict::missing;
        failures += failure, errors += error;
        cases += "  <testcase classname=\"isoparm.diff\" name=\"" + escaped(printable(d.b)) + "\">\n";
        const std::string line = escaped(verdict_line(d, limits));
        if (error || failure) cases += std::string("    <") + (error ? "error" : "failure") + " type=\"" + verdict_name(d.verdict) + "\" message=\"" + line + "\"/>\n";
        else if (d.verdict == DiffVerdict::warn) cases += "    <system-out>" + line + "</system-out>\n";
        cases += "  </testcase>\n";
    }
    return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites>\n<testsuite name=\"isoparm diff\" tests=\"" + std::to_string(all.size()) + "\" failures=\"" + std::to_string(failures) + "\" errors=\"" + std::to_string(errors) + "\">\n" + cases +
           "</testsuite>\n</testsuites>\n";
}

}  // namespace isoparm
