#include "commands/render_options.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "drawing/paper.h"
#include "error.h"
#include "isoparm_version.h"
#include "picture/layout.h"
#include "scene/suggest.h"
#include "text/short_text.h"

namespace isoparm {

namespace {
/// Whole numbers with a separator between; nothing when there are not `count` of them.
std::vector<int> whole_numbers(const std::string& text, char separator, std::size_t count) {
    std::vector<int> r;
    const char *at = text.data(), *end = at + text.size();
    for (;;) {
        int n = 0;
        const auto [stop, error] = std::from_chars(at, end, n);
        if (error != std::errc()) return {};
        r.push_back(n);
        if (stop == end) break;
        if (*stop != separator) return {};
        at = stop + 1;
    }
    return r.size() == count ? r : std::vector<int>{};
}


/// "84mm" in points of 1/72 inch; 0 when it is no such length.
double length_in_points(const std::string& text) {
    const char* end = text.data() + text.size();
    double x = 0;
    const auto [stop, error] = std::from_chars(text.data(), end, x);
    if (error != std::errc() || !std::isfinite(x)) return 0;
    const std::string unit(stop, end);
    for (const auto& [name, points] : {std::pair{"mm", 72 / 25.4}, {"cm", 720 / 25.4}, {"in", 72.0}, {"pt", 1.0}})
        if (unit == name) return x * points;
    return 0;
}

/// How large the picture is printed, and its letters.
void read_page(const Options& options, RenderOptions& how) {
    const double dpi = options.number("--dpi").value_or(300);
    if (!(dpi >= 10 && dpi <= 4800)) options.fail("--dpi: found " + quoted(*options.value("--dpi")) + ", expected 10 to 4800 pixels an inch");
    how.pixels_per_point = dpi / 72;
    if (const auto width = options.value("--width")) {
        if (options.has("--size")) options.fail("found both --width and --size, expected one of them: --width with --dpi gives the size in pixels");
        const double points = length_in_points(*width), pixels = points * dpi / 72;
        if (!(points >= 0.99 * 72 / 25.4 && points <= 72 / 25.4 * 2001)) options.fail("--width: found " + quoted(*width) + ", expected a width from 1mm to 2000mm with a unit: mm, cm, in or pt, such as 84mm");
        if (!(pixels >= 16 && pixels <= 32768)) options.fail("--width " + *width + " at " + to_text(dpi) + " pixels an inch is " + to_text(std::round(pixels)) + " pixels wide, expected 16 to 32768: change --dpi");
        how.width = static_cast<int>(std::lround(pixels));
        how.printed = true;
        how.pixels_per_point = how.width / points;
    }
    if (const auto size = options.value("--font-size")) {
        how.letter_points = length_in_points(*size);
        if (!(*how.letter_points >= 1 && *how.letter_points <= 500)) options.fail("--font-size: found " + quoted(*size) + ", expected 1pt to 500pt, such as 8pt");
    }
}
}  // namespace

const std::vector<Options::Known>& paper_options() {
    static const std::vector<Options::Known> all{{"--width", true}, {"--dpi", true}, {"--font-size", true}, {"--text", true}};
    return all;
}

void check_picture_path(const Options& options, const std::string& path) {
    const bool outlines = options.word("--text", {"fonts", "outlines"}) == "outlines";
    if (!is_paper(path)) {
        check_image_path(path);
        if (options.has("--text")) options.fail("--text: found the picture " + quoted(path) + ", expected a .pdf or .svg, whose letters may be text or outlines");
        return;
    }
    if (outlines && paper_files(path).size() > 1) options.fail("--text outlines: found " + quoted(path) + ", expected a .pdf or .svg: the letters of a .tex are the document's");
}

RenderOptions rendering_of(RenderOptions how, const std::string& path) {
    how.vectors = is_paper(path);
    return how;
}

void write_picture(const Options& options, const std::string& path, const Scene& scene, const RenderOptions& how, const Picture& picture) {
    const Metadata metadata = metadata_of(scene, picture);
    if (!is_paper(path)) {
        std::optional<CropPlace> place;
        if (how.crop) {
            const Layout whole = layout_of(scene, how);
            place = {(*how.crop)[0], (*how.crop)[1], whole.width, whole.height};
        }
        return write_image(path, picture.image, picture.layers, metadata, place);
    }
    write_paper(path, {picture.image, picture.drawn, how.pixels_per_point, scene.title, options.word("--text", {"fonts", "outlines"}) == "outlines"}, metadata);
}

std::optional<std::array<int, 2>> read_size(const Options& options, const std::string& name, int least, int most) {
    const auto size = options.value(name);
    if (!size) return {};
    const auto n = whole_numbers(*size, 'x', 2);
    if (n.empty() || std::min(n[0], n[1]) < least || std::max(n[0], n[1]) > most)
        options.fail(name + ": found " + quoted(*size) + ", expected WIDTHxHEIGHT, each from " + std::to_string(least) + " to " + std::to_string(most));
    return std::array<int, 2>{n[0], n[1]};
}

RenderOptions read_render_options(const Options& options) {
    RenderOptions how;
    if (const auto size = read_size(options, "--size", 1, 32768)) how.width = (*size)[0], how.height = (*size)[1];
    read_page(options, how);
    if (const auto samples = options.integer("--samples", 1, 65536)) how.samples = *samples;
    if (const auto noise = options.number("--noise")) {
        if (!(*noise == 0 || (*noise >= 1e-5 && *noise <= 1))) options.fail("--noise: found " + quoted(*options.value("--noise")) + ", expected 0, or 1e-5 to 1; a grey level of 255 is 0.004");
        how.noise = *noise;
    }
    how.tolerance = options.tolerance();
    if (const auto crop = options.value("--crop")) {
        const auto n = whole_numbers(*crop, ',', 4);
        if (n.empty() || n[0] < 0 || n[1] < 0 || n[2] <= n[0] || n[3] <= n[1]) options.fail("--crop: found " + quoted(*crop) + ", expected x0,y0,x1,y1 with 0 <= x0 < x1, 0 <= y0 < y1");
        how.crop = {n[0], n[1], n[2], n[3]};
    }
    return how;
}

std::vector<Aov> read_aovs(const Options& options, const std::string& output) {
    const auto list = options.value("--aov");
    if (!list) return {};
    std::vector<std::string> names;
    for (const AovKind& k : all_aovs()) names.push_back(k.name);
    std::vector<bool> wanted(names.size(), false);
    for (std::size_t from = 0; from <= list->size();) {
        const std::size_t comma = std::min(list->find(',', from), list->size());
        const std::string name = list->substr(from, comma - from);
        from = comma + 1;
        const auto known = std::find(names.begin(), names.end(), name);
        if (name == "all") wanted.assign(names.size(), true);
        else if (known != names.end()) wanted[static_cast<std::size_t>(known - names.begin())] = true;
        else options.fail("--aov: found " + quoted(name) + ", expected all, or some of " + listed(names) + " with commas between" + did_you_mean(name, names));
    }
    if (is_paper(output) || !holds_layers(output)) options.fail("--aov: found " + quoted(output) + ", expected a file with the extension .exr, which alone holds further channels");
    std::vector<Aov> aovs;
    for (const AovKind& k : all_aovs())
        if (wanted[static_cast<std::size_t>(k.aov)]) aovs.push_back(k.aov);
    return aovs;
}

Metadata metadata_of(const Scene& scene, const Picture& picture) {
    Metadata data{{"Software", "isoparm " ISOPARM_VERSION},
            {"isoparm:scene", std::filesystem::path(scene.path).filename().string()},
            {"isoparm:title", scene.title},
            {"isoparm:tolerance", to_text(picture.tolerance)}};
    if (picture.exact) {
        data.push_back({"isoparm:exact_rays", std::to_string(picture.rays.rays)});
        data.push_back({"isoparm:undecided_rays", std::to_string(picture.rays.undecided)});
    } else {
        data.push_back({"isoparm:certified_error", to_text(picture.certified_error)});
        data.push_back({"isoparm:triangles", std::to_string(picture.triangles)});
    }
    const SampleCount& n = picture.samples;
    if (n.target > 0 || !picture.whole) {
        data.push_back({"isoparm:samples", "least " + std::to_string(n.least) + ", mean " + short_text(n.mean) + ", most " + std::to_string(n.most) + ", limit " + std::to_string(n.most_asked)});
        if (n.target > 0) data.push_back({"isoparm:noise", short_text(n.noise) + ", target " + to_text(n.target)});
    }
    if (!picture.whole) data.push_back({"isoparm:unfinished", "ended before all samples were traced"});
    if (!picture.layers.channels.empty()) data.push_back({"isoparm:patches", patch_numbers(scene)});
    return data;
}

std::string summary_of(const Picture& p) {
    char text[200];
    std::string samples;
    if (p.samples.target > 0 || !p.whole) samples = ", " + short_text(p.samples.mean) + " samples a pixel";
    if (p.samples.target > 0) samples += ", noise " + short_text(p.samples.noise);
    if (p.exact) {
        std::snprintf(text, sizeof text, "%dx%d, exact, %zu leaves, %.2f s; of %llu rays %llu ended undecided (tangent, or at a singular point)", p.image.width, p.image.height,
                      p.leaves, p.seconds_mesh + p.seconds_trace, static_cast<unsigned long long>(p.rays.rays), static_cast<unsigned long long>(p.rays.undecided));
        return text + samples;
    }
    std::snprintf(text, sizeof text, "%dx%d, %zu triangles, certified error %.3g (tolerance %.3g), %.2f s", p.image.width, p.image.height, p.triangles, p.certified_error,
                  p.tolerance, p.seconds_mesh + p.seconds_trace);
    return text + samples;
}

}  // namespace isoparm
