// image.h -- pixels and files. image_oiio.cpp, the only file that includes OpenImageIO, is a module loaded when an
// image other than a PNG is first written, or any is read: linking OpenImageIO would cost every start of the program half a second.
#pragma once
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace isoparm {

/// Linear RGBA, alpha premultiplied, rows from the top, float.
struct Image {
    int width = 0, height = 0;
    std::vector<float> pixels;  // 4 * width * height
    float* at(int x, int y) { return &pixels[4 * (static_cast<std::size_t>(y) * width + x)]; }
    const float* at(int x, int y) const { return &pixels[4 * (static_cast<std::size_t>(y) * width + x)]; }
};

/// Where the pixels of a crop lie in the whole picture, y down.
struct CropPlace {
    int x = 0, y = 0, whole_width = 0, whole_height = 0;
};

using Metadata = std::vector<std::pair<std::string, std::string>>;

/// EXR: linear half floats, premultiplied. PNG and other 8-bit formats: sRGB transfer, unpremultiplied, rounded; opaque
/// pictures are written without alpha. Written to a temporary name, read back (but for PNG, where every error of writing is told), synced, renamed. No dates, no command
/// lines: the same picture gives the same bytes. A crop says where it lies: EXR has data and display window, PNG an oFFs chunk, and both
/// the texts isoparm:crop and isoparm:whole. Throws Error(io), or Error(usage) for an unknown extension.
void write_image(const std::string& path, const Image& image, const Metadata& metadata);

/// Further channels of a picture's pixels: float32, rows from the top, each pixel's side by side.
struct Layers {
    std::vector<std::string> channels;  // "N.X"; the part before the dot is the layer
    std::vector<float> values;
};
/// An OpenEXR file of one part: the colours as write_image() has them, then the layers. Throws Error(io), or Error(usage) for
/// another extension.
void write_image(const std::string& path, const Image& image, const Layers& layers, const Metadata& metadata, const std::optional<CropPlace>& crop = {});
/// Is this the path of a file that holds layers?
bool holds_layers(const std::string& path);

/// Throws what write_image() would for the extension or a missing folder: before hours of rendering, not after.
void check_image_path(const std::string& path);

/// The first subimage of any file that OpenImageIO reads, made linear and premultiplied. Throws Error(io).
Image read_image(const std::string& path);

}  // namespace isoparm
