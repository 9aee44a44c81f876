// diff_report.h -- what was found between images, as text, JSON, JUnit XML and one page of HTML.
#pragma once
#include <iosfwd>
#include <string>
#include <vector>

#include "diff/image_diff.h"

namespace isoparm {

/// "pass", "warn", "fail", "not_comparable", "error".
const char* verdict_name(DiffVerdict verdict);
/// The worst of all.
DiffVerdict worst_of(const std::vector<ImageDiff>& all);

/// One line for each channel that differs, and the verdict; equal channels are told in one line.
void print_diff_text(std::ostream& out, const ImageDiff& diff, const DiffLimits& limits);
/// The verdict and why, in one line.
std::string verdict_line(const ImageDiff& diff, const DiffLimits& limits);
/// As docs/diff.md has it. What does not exist is null; numbers that are not finite are "NaN", "Infinity" and "-Infinity", as text.
std::string diff_json(const ImageDiff& diff);
/// Several pairs: {"result", "pairs": [...]}.
std::string diff_json(const std::vector<ImageDiff>& all);
/// One test case for each pair.
std::string diff_junit(const std::vector<ImageDiff>& all, const DiffLimits& limits);
/// The preview as figures of the page, which take less memory; there is no preview afterwards. Throws Error(io).
void make_figures(ImageDiff& diff);
/// A page that needs no other file: side by side, flicker, wipe, heat map, histogram. Pairs without figures have numbers only.
std::string diff_page(const std::vector<ImageDiff>& all, const DiffLimits& limits);

}  // namespace isoparm
