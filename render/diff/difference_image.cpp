#include "diff/difference_image.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "error.h"
#include "image/image.h"
#include "image/image_loader.h"
#include "io/atomic_file.h"
#include "io/extension.h"

namespace isoparm {

DifferenceRows::DifferenceRows(const ImagePart& a, const ImagePart& b, const DiffMask& mask) : width_(static_cast<std::size_t>(a.data.width)), mask_(mask) {
    for (const std::string& name : a.channels) in_b_.push_back(static_cast<int>(std::find(b.channels.begin(), b.channels.end(), name) - b.channels.begin()));
}

template <class T>
static void subtract_rows(const T* a, const T* b, const std::vector<int>& in_b, std::size_t pixels, std::size_t first, const DiffMask& mask, std::vector<float>& to) {
    const std::size_t n = in_b.size();
    for (std::size_t i = 0; i < pixels; ++i)
        for (std::size_t c = 0; c < n; ++c) {
            const double p = static_cast<double>(a[i * n + c]), q = static_cast<double>(b[i * n + static_cast<std::size_t>(in_b[c])]);
            to[i * n + c] = !mask.empty() && !mask[first + i] ? 0.0f : p == q ? 0.0f : static_cast<float>(p - q);
        }
}

void DifferenceRows::subtract(const void* a, const void* b, bool doubles, int first, int rows) {
    const std::size_t pixels = width_ * static_cast<std::size_t>(rows), from = width_ * static_cast<std::size_t>(first);
    values_.resize(pixels * in_b_.size());
    if (doubles) subtract_rows(static_cast<const double*>(a), static_cast<const double*>(b), in_b_, pixels, from, mask_, values_);
    else subtract_rows(static_cast<const float*>(a), static_cast<const float*>(b), in_b_, pixels, from, mask_, values_);
}

std::vector<float> DifferenceRows::largest() const {
    const std::size_t n = in_b_.size();
    std::vector<float> most(values_.size() / n, 0.0f);
    for (std::size_t i = 0; i < values_.size(); ++i) {
        const float d = std::isfinite(values_[i]) ? std::fabs(values_[i]) : std::numeric_limits<float>::infinity();
        most[i / n] = std::max(most[i / n], d);
    }
    return most;
}

struct DifferenceImage::Layers {
    std::string path;
    std::vector<ImagePart> parts;
    std::vector<std::vector<int>> channels;  // of each layer: places in the part
    bool absolute = false;
    double scale = 1;
    IsoparmImageWriter* file = nullptr;
    std::vector<float> row;

    void check(int failed, const IsoparmImageError& error) const {
        if (failed) throw Error(ErrorKind::io, path + ": writing the image failed: " + error.text);
    }
};

DifferenceImage::DifferenceImage(const std::string& path, const std::string& file, const std::vector<ImagePart>& parts, bool absolute, double scale) : layers_(std::make_unique<Layers>()) {
    Layers& l = *layers_;
    l.path = path, l.parts = parts, l.absolute = absolute, l.scale = scale;
    const bool exr = extension_of(path) == ".exr";
    if (!exr) l.parts.resize(1);
    std::vector<IsoparmImageLayer> layers;
    std::vector<std::vector<const char*>> names(l.parts.size());
    std::vector<std::string> types(l.parts.size());
    for (std::size_t i = 0; i < l.parts.size(); ++i) {
        const ImagePart& p = l.parts[i];
        std::vector<int> places;
        if (exr) {
            for (std::size_t c = 0; c < p.channels.size(); ++c) places.push_back(static_cast<int>(c));
        } else {
            for (const char* name : {"R", "G", "B"})
                if (const auto at = std::find(p.channels.begin(), p.channels.end(), name); at != p.channels.end()) places.push_back(static_cast<int>(at - p.channels.begin()));
            if (places.size() < 3) places = {0};
            if (places.size() < 3 && p.channels.size() >= 3) places = {0, 1, 2};
        }
        for (const int c : places) names[i].push_back(p.channels[static_cast<std::size_t>(c)].c_str());
        types[i].assign(places.size(), exr ? 'f' : 'b');
        const ImageWindow &d = p.data, &f = p.display;
        layers.push_back({{exr ? d.x : 0, exr ? d.y : 0, d.width, d.height, exr ? f.x : 0, exr ? f.y : 0, exr ? f.width : d.width, exr ? f.height : d.height, static_cast<int>(places.size()), 0, 0, 0, 1},
                          p.name.c_str(), names[i].data(), types[i].c_str(), exr ? "Linear" : "sRGB"});
        l.channels.push_back(places);
    }
    IsoparmImageError error{};
    l.file = image_module().create(file.c_str(), extension_of(path).substr(1).c_str(), layers.data(), static_cast<int>(layers.size()), &error);
    l.check(!l.file, error);
}

DifferenceImage::~DifferenceImage() {
    IsoparmImageError ignored{};
    if (layers_->file) image_module().finish(layers_->file, &ignored);
}

void DifferenceImage::add(std::size_t part, const std::vector<float>& differences, int first, int rows) {
    Layers& l = *layers_;
    if (part >= l.parts.size()) return;
    const std::size_t n = l.parts[part].channels.size();
    l.row.clear();
    for (std::size_t i = 0; i < differences.size(); i += n)
        for (const int c : l.channels[part]) {
            const double d = differences[i + static_cast<std::size_t>(c)] * l.scale;
            l.row.push_back(static_cast<float>(l.absolute ? std::fabs(d) : d));
        }
    IsoparmImageError error{};
    l.check(image_module().put(l.file, static_cast<int>(part), first, rows, l.row.data(), &error), error);
}

void DifferenceImage::finish() {
    IsoparmImageError error{};
    IsoparmImageWriter* file = layers_->file;
    layers_->file = nullptr;
    layers_->check(image_module().finish(file, &error), error);
}

namespace {
struct NotWanted {};
}  // namespace

void write_difference(const std::string& path, const std::vector<ImagePart>& parts, bool absolute, double scale, const std::function<bool(DifferenceImage&)>& fill) {
    image_module();  // loaded before there is a file to lose
    try {
        write_atomically_by_name(path, [&](const std::string& file) {
            DifferenceImage image(path, file, parts, absolute, scale);
            if (!fill(image)) throw NotWanted();
            image.finish();
        });
    } catch (const NotWanted&) {
    }
}

void check_difference_path(const std::string& path) { check_image_path(path); }

}  // namespace isoparm
