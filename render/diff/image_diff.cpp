#include "diff/image_diff.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <set>

#include "diff/difference_image.h"
#include "diff/ssim.h"
#include "error.h"
#include "image/image_colors.h"
#include "io/atomic_file.h"
#include "scene/suggest.h"

namespace isoparm {
namespace {

struct Pair {
    ImageDecoder a, b;
    std::vector<int> part_of_b;  // by part of a
};

bool all_named(const std::vector<ImagePart>& parts) {
    std::set<std::string> names;
    for (const ImagePart& p : parts) names.insert(p.name);
    return names.size() == parts.size() && names.count("") == 0;
}

std::string called(const ImagePart& p, std::size_t number) { return p.name.empty() ? std::to_string(number) : quoted(p.name); }

/// Parts by name where all have one, otherwise by number. Tells what is missing, or what keeps one from being compared.
std::vector<std::string> match_parts(Pair& p) {
    std::vector<std::string> why;
    const auto &a = p.a.parts(), &b = p.b.parts();
    const bool by_name = all_named(a) && all_named(b);
    std::set<std::size_t> used;
    for (std::size_t i = 0; i < a.size(); ++i) {
        std::size_t j = i;
        if (by_name) j = static_cast<std::size_t>(std::find_if(b.begin(), b.end(), [&](const ImagePart& q) { return q.name == a[i].name; }) - b.begin());
        if (j >= b.size()) {
            why.push_back("part " + called(a[i], i) + " is missing");
            continue;
        }
        used.insert(j);
        p.part_of_b.push_back(static_cast<int>(j));
        if (!by_name && a[i].name != b[j].name && a.size() > 1) why.push_back("part " + std::to_string(i) + ": found the name " + quoted(b[j].name) + ", expected " + quoted(a[i].name));
        for (const std::string& w : incomparable(a[i], b[j])) why.push_back((a.size() > 1 ? "part " + called(a[i], i) + ": " : "") + w);
    }
    for (std::size_t j = 0; j < b.size(); ++j)
        if (used.count(j) == 0) why.push_back("part " + called(b[j], j) + " is not in the reference");
    return why;
}

void check_channel_limits(const std::vector<ImagePart>& parts, const DiffLimits& limits) {
    for (const auto& [pattern, value] : limits.channels) {
        bool fits = false;
        std::vector<std::string> names;
        for (const ImagePart& p : parts)
            for (const std::string& c : p.channels) {
                names.push_back(c);
                fits = fits || c == pattern || (pattern.back() == '*' && c.rfind(pattern.substr(0, pattern.size() - 1), 0) == 0);
            }
        if (!fits) throw Error(ErrorKind::usage, "--channel: found " + quoted(pattern) + ", expected one of: " + listed(names) + did_you_mean(pattern, names));
    }
}

/// Rows of both parts, a block at a time: look(block of a, block of b, first row, rows).
void for_rows(Pair& p, std::size_t part, RowKind kind, const auto& look) {
    const ImagePart &a = p.a.parts()[part], &b = p.b.parts()[static_cast<std::size_t>(p.part_of_b[part])];
    const int most = std::min(p.a.most_rows(static_cast<int>(part)), p.b.most_rows(p.part_of_b[part]));
    const int tile = std::max({a.tile_height, b.tile_height, 1}), rows = std::min({std::max((64 + tile - 1) / tile * tile, 1), most, a.data.height});
    p.a.begin(static_cast<int>(part), rows, kind);
    p.b.begin(p.part_of_b[part], rows, kind);
    for (int first = 0, k = 0; first < a.data.height; first += rows, ++k) {
        const void* of_a = p.a.block(k);
        const void* of_b = p.b.block(k);
        look(of_a, of_b, first, std::min(rows, a.data.height - first));
    }
}

DiffMask read_mask(const DiffRequest& request, const ImageWindow& window) {
    DiffMask mask;
    if (request.mask.empty()) return mask;
    ImageDecoder file(request.mask, request.image);
    file.open();
    const ImagePart& p = file.parts().front();
    if (p.data.width != window.width || p.data.height != window.height)
        throw Error(ErrorKind::usage, "--mask: found " + std::to_string(p.data.width) + " x " + std::to_string(p.data.height) + " pixels in " + request.mask + ", expected " + std::to_string(window.width) + " x " + std::to_string(window.height) + ", as the images have");
    mask.resize(static_cast<std::size_t>(p.data.width) * static_cast<std::size_t>(p.data.height));
    const int rows = std::min(file.most_rows(0), 64);
    file.begin(0, rows, RowKind::floats);
    bool any = false;
    for (int first = 0, k = 0; first < p.data.height; first += rows, ++k) {
        const auto* values = static_cast<const float*>(file.block(k));
        const std::size_t from = static_cast<std::size_t>(first) * static_cast<std::size_t>(p.data.width), n = static_cast<std::size_t>(std::min(rows, p.data.height - first)) * static_cast<std::size_t>(p.data.width);
        for (std::size_t i = 0; i < n; ++i) any |= mask[from + i] = values[i * p.channels.size()] > 0.5f;
    }
    if (!any) throw Error(ErrorKind::usage, "--mask: found no pixel above one half in the first channel of " + request.mask + ", so that nothing would be compared");
    return mask;
}

/// The pictures of a page, made while rows go by.
class PreviewMaker {
public:
    PreviewMaker(const ImageWindow& w, int most) : width_(w.width) {
        preview_.factor = std::max((std::max(w.width, w.height) + most - 1) / most, 1);
        for (Image* i : {&preview_.a, &preview_.b}) {
            i->width = (w.width + preview_.factor - 1) / preview_.factor, i->height = (w.height + preview_.factor - 1) / preview_.factor;
            i->pixels.assign(4 * static_cast<std::size_t>(i->width) * static_cast<std::size_t>(i->height), 0);
        }
        preview_.difference.assign(preview_.a.pixels.size() / 4, 0);
    }
    void add(const float* a, const float* b, const float* difference, int y) {
        for (int x = 0; x < width_; ++x) {
            const int px = x / preview_.factor, py = y / preview_.factor;
            for (int k = 0; k < 3; ++k) preview_.a.at(px, py)[k] += a[3 * x + k], preview_.b.at(px, py)[k] += b[3 * x + k];
            preview_.a.at(px, py)[3] += 1, preview_.b.at(px, py)[3] += 1;
            float& most = preview_.difference[static_cast<std::size_t>(py) * static_cast<std::size_t>(preview_.a.width) + static_cast<std::size_t>(px)];
            most = std::max(most, difference[x]);
        }
    }
    void add_flip(const float* row, int y) {
        if (preview_.flip.empty()) preview_.flip.assign(preview_.difference.size(), 0);
        for (int x = 0; x < width_; ++x) {
            float& most = preview_.flip[static_cast<std::size_t>(y / preview_.factor) * static_cast<std::size_t>(preview_.a.width) + static_cast<std::size_t>(x / preview_.factor)];
            most = std::max(most, row[x]);
        }
    }
    DiffPreview result() {
        for (Image* i : {&preview_.a, &preview_.b})
            for (std::size_t k = 0; k < i->pixels.size(); k += 4) {
                const float n = i->pixels[k + 3];
                for (std::size_t c = 0; c < 3; ++c) i->pixels[k + c] = std::isfinite(i->pixels[k + c]) ? i->pixels[k + c] / n : 1;
                i->pixels[k + 3] = 1;
            }
        return std::move(preview_);
    }

private:
    int width_;
    DiffPreview preview_;
};

/// FLIP and SSIM of one part: a second look at both files, and with HDR-FLIP a look at the reference's luminances before.
void compare_perceptually(Pair& p, std::size_t part, const DiffRequest& request, const DiffMask& mask, ImageDiff& result, PreviewMaker* preview) {
    const ImagePart& a = p.a.parts()[part];
    const ImagePart& b = p.b.parts()[static_cast<std::size_t>(p.part_of_b[part])];
    const ImageColors in_a(a), in_b(b);
    const auto width = static_cast<std::size_t>(a.data.width);
    const auto counts = [&](std::size_t x, int y) { return mask.empty() || mask[static_cast<std::size_t>(y) * width + x]; };
    FlipOptions options = request.flip_options;
    options.hdr = request.flip == FlipKind::hdr || (request.flip == FlipKind::automatic && !a.integers);
    std::vector<float> colors[2], lumas[2];
    if (options.hdr && options.exposures <= 1) {
        LuminanceMeter luminance;
        for_rows(p, part, RowKind::floats, [&](const void* rows_a, const void*, int, int rows) {
            in_a.linear(static_cast<const float*>(rows_a), width * static_cast<std::size_t>(rows), colors[0]);
            luminance.add(colors[0].data(), width * static_cast<std::size_t>(rows));
        });
        choose_exposures(luminance.largest(), luminance.median(), options);
    }
    double flip = 0, ssim = 0;
    std::uint64_t flips = 0, ssims = 0;
    FlipMeter flip_meter(a.data.width, a.data.height, options, [&](int y, const float* row) {
        double sum = 0;
        for (std::size_t x = 0; x < width; ++x)
            if (counts(x, y)) sum += row[x], ++flips;
        flip += sum;
        if (preview) preview->add_flip(row, y);
    });
    SsimMeter ssim_meter(a.data.width, [&](int y, const double* row) {
        double sum = 0;
        for (std::size_t x = SsimMeter::radius; x + SsimMeter::radius < width; ++x)
            if (counts(x, y)) sum += row[x - SsimMeter::radius], ++ssims;
        ssim += sum;
    });
    for_rows(p, part, RowKind::floats, [&](const void* rows_a, const void* rows_b, int, int rows) {
        const std::size_t n = width * static_cast<std::size_t>(rows);
        in_a.linear(static_cast<const float*>(rows_a), n, colors[0]), in_b.linear(static_cast<const float*>(rows_b), n, colors[1]);
        in_a.luma(static_cast<const float*>(rows_a), n, lumas[0]), in_b.luma(static_cast<const float*>(rows_b), n, lumas[1]);
        flip_meter.add(colors[0].data(), colors[1].data(), rows);
        ssim_meter.add(lumas[0].data(), lumas[1].data(), rows);
    });
    if (flips > 0) result.flip = flip / static_cast<double>(flips);
    if (ssims > 0) result.ssim = ssim / static_cast<double>(ssims);
    result.flip_options = options;
}

/// Of all parts and channels together.
void sum_up(ImageDiff& r) {
    double sum = 0, squares = 0, peak = 1, samples = 0, worst = -1;
    for (const PartDiff& p : r.parts) {
        r.pixels += p.pixels, r.failing += p.failing, r.warning += p.warning, r.nonfinite += p.nonfinite;
        for (const ChannelDiff& c : p.channels) {
            sum += c.sum, squares += c.squares, samples += static_cast<double>(c.samples), peak = std::max(peak, c.peak), r.max = std::max(r.max, c.max);
            const double size = c.nonfinite > 0 ? std::numeric_limits<double>::infinity() : c.max;
            if (size > worst && (c.differing > 0 || c.nonfinite > 0))
                worst = size, r.worst = c.worst, r.worst_channel = (r.parts.size() > 1 ? (p.name.empty() ? "part " + std::to_string(&p - r.parts.data()) : p.name) + "/" : "") + c.name;
        }
    }
    r.mean = samples > 0 ? sum / samples : 0;
    r.rms = samples > 0 ? std::sqrt(squares / samples) : 0;
    r.psnr = squares > 0 ? 20 * std::log10(peak / r.rms) : std::numeric_limits<double>::infinity();
}

void check_more_limits(ImageDiff& r, const DiffLimits& limits) {
    const auto fail = [&](const std::string& what) {
        r.reasons.push_back(what);
        r.verdict = DiffVerdict::fail;
    };
    if (limits.rms && r.rms > *limits.rms) fail("rms: found " + to_text(r.rms) + ", expected at most " + to_text(*limits.rms));
    if (limits.flip && !(r.flip && *r.flip <= *limits.flip)) fail("flip: found " + (r.flip ? to_text(*r.flip) : "none, the images have no finite R, G, B") + ", expected at most " + to_text(*limits.flip));
    if (limits.ssim && !(r.ssim && *r.ssim >= *limits.ssim)) fail("ssim: found " + (r.ssim ? to_text(*r.ssim) : "none, the images are too small or have no finite R, G, B") + ", expected at least " + to_text(*limits.ssim));
}

/// The part that pictures, FLIP and SSIM are of: the first with colours.
std::size_t colored_part(const std::vector<ImagePart>& parts) {
    for (std::size_t i = 0; i < parts.size(); ++i)
        if (ImageColors(parts[i]).any()) return i;
    return 0;
}

void compare(Pair& p, const DiffRequest& request, ImageDiff& result, DifferenceImage* output) {
    const auto& parts = p.a.parts();
    const DiffMask mask = read_mask(request, parts.front().data);
    const std::size_t colored = colored_part(parts);
    std::unique_ptr<PreviewMaker> preview;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        const ImagePart& b = p.b.parts()[static_cast<std::size_t>(p.part_of_b[i])];
        if (!mask.empty() && !(parts[i].data == parts.front().data)) throw Error(ErrorKind::usage, "--mask: part " + called(parts[i], i) + " has another size than the mask");
        const bool doubles = parts[i].exact || b.exact, pictures = request.preview > 0 && i == colored;
        const ImageColors in_a(parts[i]), in_b(b);
        if (pictures) preview = std::make_unique<PreviewMaker>(parts[i].data, request.preview);
        DiffMeter meter(parts[i], b, request.limits, mask);
        DifferenceRows differences(parts[i], b, mask);
        std::vector<float> colors[2];
        const bool halves = parts[i].halves && b.halves && !output && !pictures;
        for_rows(p, i, doubles ? RowKind::doubles : halves ? RowKind::halves : RowKind::floats, [&](const void* rows_a, const void* rows_b, int first, int rows) {
            if (halves) return meter.add(static_cast<const HalfBits*>(rows_a), static_cast<const HalfBits*>(rows_b), rows);
            if (doubles) meter.add(static_cast<const double*>(rows_a), static_cast<const double*>(rows_b), rows);
            else meter.add(static_cast<const float*>(rows_a), static_cast<const float*>(rows_b), rows);
            if (!output && !pictures) return;
            differences.subtract(rows_a, rows_b, doubles, first, rows);
            if (output) output->add(i, differences.values(), first, rows);
            if (!pictures) return;
            const std::size_t n = static_cast<std::size_t>(parts[i].data.width) * static_cast<std::size_t>(rows);
            in_a.linear(rows_a, doubles, n, colors[0]), in_b.linear(rows_b, doubles, n, colors[1]);
            const std::vector<float> largest = differences.largest();
            for (int y = 0; y < rows; ++y) {
                const std::size_t at = static_cast<std::size_t>(y) * static_cast<std::size_t>(parts[i].data.width);
                preview->add(&colors[0][3 * at], &colors[1][3 * at], &largest[at], first + y);
            }
        });
        result.parts.push_back(meter.result());
    }
    const ImageColors in_color(parts[colored]);
    if (request.perceptual && in_color.any()) {
        std::uint64_t differing = 0, nonfinite = 0;
        for (const ChannelDiff& c : result.parts[colored].channels)
            if (in_color.uses(c.in_a)) differing += c.differing, nonfinite += c.nonfinite + c.allowed_nonfinite;
        if (nonfinite > 0) { /* neither is defined where a number is not finite */ }
        else if (differing > 0) compare_perceptually(p, colored, request, mask, result, preview.get());
        else result.flip = 0, result.ssim = 1;
    }
    if (preview) result.preview = preview->result();
}

}  // namespace

ImageDiff diff_images(const std::string& a, const std::string& b, const DiffRequest& request) {
    ImageDiff result;
    result.a = a, result.b = b;
    Pair p{{a, request.image}, {b, request.image}, {}};  // both start at once
    p.a.open(), p.b.open();
    result.reasons = match_parts(p);
    if (!result.reasons.empty()) {
        result.verdict = DiffVerdict::not_comparable;
        return result;
    }
    check_channel_limits(p.a.parts(), request.limits);
    const auto differs = [&] { return std::any_of(result.parts.begin(), result.parts.end(), [](const PartDiff& d) { return std::any_of(d.channels.begin(), d.channels.end(), [](const ChannelDiff& c) { return c.differing > 0; }); }); };
    if (request.output.empty()) compare(p, request, result, nullptr);
    else write_difference(request.output, p.a.parts(), request.absolute, request.scale, [&](DifferenceImage& output) {
        compare(p, request, result, &output);
        return !request.output_if_different || differs();
    });
    sum_up(result);
    result.verdict = judge(result.parts, request.limits);
    check_more_limits(result, request.limits);
    return result;
}

}  // namespace isoparm
