#include "image/image.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <filesystem>

#include "error.h"
#include "image/image_loader.h"
#include "image/png_file.h"
#include "io/atomic_file.h"
#include "picture/palette.h"

namespace isoparm {
namespace {

namespace fs = std::filesystem;

struct Format {
    const char* extension;
    bool linear;  // half floats; otherwise bytes with the sRGB transfer
    bool alpha;
    bool lossy;
};
constexpr std::array<Format, 9> kFormats{{{"exr", true, true, false},
                                          {"png", false, true, false},
                                          {"tif", false, true, false},
                                          {"tiff", false, true, false},
                                          {"tga", false, true, false},
                                          {"jpg", false, false, true},
                                          {"jpeg", false, false, true},
                                          {"bmp", false, false, false},
                                          {"ppm", false, false, false}}};

const Format& format_of(const std::string& path) {
    std::string extension = fs::path(path).extension().string();
    if (!extension.empty()) extension.erase(0, 1);
    std::string lower = extension;
    std::transform(lower.begin(), lower.end(), lower.begin(), [](unsigned char c) { return std::tolower(c); });
    for (const Format& f : kFormats)
        if (lower == f.extension) return f;
    std::string known;
    for (const Format& f : kFormats) known += std::string(known.empty() ? "" : ", ") + f.extension;
    throw Error(ErrorKind::usage, path + ": found " +
                                      (extension.empty() ? "no extension" : "the extension \"" + extension + "\"") +
                                      ", expected the extension of an image format: " + known);
}

// ---- bytes --------------------------------------------------------------------------------------------------------
std::uint8_t to_byte(double x) { return static_cast<std::uint8_t>(std::lround(255 * std::clamp(x, 0.0, 1.0))); }
std::uint8_t srgb_byte(double linear) {
    if (linear >= 1) return 255;
    const double x = linear > 0 ? linear : 0;  // NaN is black
    return to_byte(x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055);
}

bool opaque(const Image& image) {
    for (std::size_t i = 3; i < image.pixels.size(); i += 4)
        if (image.pixels[i] < 1) return false;
    return true;
}

/// sRGB bytes, alpha unassociated; without alpha, on white.
std::vector<std::uint8_t> bytes_of(const Image& image, bool with_alpha) {
    std::vector<std::uint8_t> bytes;
    bytes.reserve(image.pixels.size());
    for (std::size_t i = 0; i < image.pixels.size(); i += 4) {
        const double alpha = image.pixels[i + 3];
        for (int k = 0; k < 3; ++k) {
            const double c = image.pixels[i + k];
            bytes.push_back(srgb_byte(!with_alpha ? c + (1 - alpha) : alpha > 0 ? c / alpha : 0));
        }
        if (with_alpha) bytes.push_back(to_byte(alpha));
    }
    return bytes;
}

std::vector<float> without_alpha(const Image& image) {
    std::vector<float> rgb;
    rgb.reserve(image.pixels.size() / 4 * 3);
    for (std::size_t i = 0; i < image.pixels.size(); i += 4)
        rgb.insert(rgb.end(), &image.pixels[i], &image.pixels[i] + 3);
    return rgb;
}

void write_file(const std::string& path, const std::string& file, const Format& format, const Image& image,
                const Layers& layers, const Metadata& metadata, const CropPlace& crop) {
    const bool with_alpha = format.alpha && !opaque(image);
    std::vector<const char*> channels;
    for (const std::string& c : layers.channels) channels.push_back(c.c_str());
    IsoparmImagePixels pixels{image.width, image.height, with_alpha ? 4 : 3, format.linear, nullptr,
                              static_cast<int>(channels.size()), channels.data(), layers.values.data(), crop.x, crop.y, crop.whole_width, crop.whole_height};
    std::vector<std::uint8_t> bytes;
    std::vector<float> rgb;
    if (!format.linear)
        pixels.data = (bytes = bytes_of(image, with_alpha)).data();
    else
        pixels.data = with_alpha ? image.pixels.data() : (rgb = without_alpha(image)).data();
    std::vector<const char*> names, values;
    for (const auto& [name, value] : metadata) {
        names.push_back(name.c_str());
        values.push_back(value.c_str());
    }
    IsoparmImageError error{};
    if (image_module().write(file.c_str(), format.extension, &pixels, format.lossy, names.data(), values.data(), static_cast<int>(names.size()),
                       &error) != 0) {
        std::string told = error.text;  // about the temporary, which is not the user's business
        if (const auto at = told.find(file); at != std::string::npos)
            told.replace(at, file.size(), fs::path(path).filename().string());
        throw Error(ErrorKind::io, path + ": writing the image failed: " + told);
    }
}

void write_png(const std::string& path, const Image& image, const Metadata& metadata, const CropPlace& crop) {
    const bool with_alpha = !opaque(image);
    const std::string file = png_file(image.width, image.height, with_alpha ? 4 : 3, bytes_of(image, with_alpha), metadata, {crop.x, crop.y});
    write_atomically(path, [&](std::ostream& out) { out.write(file.data(), static_cast<std::streamsize>(file.size())); });
}

std::string comma_list(const std::array<int, 4>& numbers) {
    std::string all;
    for (const int n : numbers) all += (all.empty() ? "" : ",") + std::to_string(n);
    return all;
}

void take_pixels(void* user, int width, int height, int channels, int integers, const float* data) {
    Image& image = *static_cast<Image*>(user);
    image.width = width;
    image.height = height;
    image.pixels.resize(4 * static_cast<std::size_t>(width) * height);
    const bool grey = channels < 3;
    for (std::size_t i = 0; i < image.pixels.size() / 4; ++i) {
        const float* in = data + i * channels;
        float* out = &image.pixels[4 * i];
        const float alpha = channels == 4 ? in[3] : channels == 2 ? in[1] : 1.0f;
        for (int k = 0; k < 3; ++k) {
            const float c = in[grey ? 0 : k];
            out[k] = integers ? static_cast<float>(alpha * linear_from_srgb(c)) : c;
        }
        out[3] = alpha;
    }
}

}  // namespace

void check_image_path(const std::string& path) {
    format_of(path);
    std::error_code ignored;
    const fs::path folder = fs::path(path).has_parent_path() ? fs::path(path).parent_path() : fs::path(".");
    if (!fs::is_directory(folder, ignored))
        throw Error(ErrorKind::io, path + ": there is no folder " + folder.string());
}

bool holds_layers(const std::string& path) { return format_of(path).linear; }

void write_image(const std::string& path, const Image& image, const Layers& layers, const Metadata& about, const std::optional<CropPlace>& cropped) {
    const Format& format = format_of(path);
    const CropPlace crop = cropped.value_or(CropPlace{0, 0, image.width, image.height});
    Metadata metadata = about;
    if (cropped) {
        metadata.emplace_back("isoparm:crop", comma_list({crop.x, crop.y, crop.x + image.width, crop.y + image.height}));
        metadata.emplace_back("isoparm:whole", std::to_string(crop.whole_width) + "x" + std::to_string(crop.whole_height));
    }
    if (!layers.channels.empty() && !format.linear) throw Error(ErrorKind::usage, path + ": only .exr holds further channels");
    if (format.extension == std::string("png")) return write_png(path, image, metadata, crop);
    image_module();  // loaded before there is a file to lose
    write_atomically_by_name(path, [&](const std::string& file) { write_file(path, file, format, image, layers, metadata, crop); });
}
void write_image(const std::string& path, const Image& image, const Metadata& metadata) { write_image(path, image, {}, metadata); }

Image read_image(const std::string& path) {
    Image image;
    IsoparmImageError error{};
    std::error_code ignored;
    if (!fs::exists(path, ignored)) throw Error(ErrorKind::io, path + ": there is no such file");
    if (image_module().read(path.c_str(), &take_pixels, &image, &error) != 0)
        throw Error(ErrorKind::io, path + ": cannot be read as an image: " + error.text);
    return image;
}

}  // namespace isoparm
