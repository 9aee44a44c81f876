// image_header.h -- what an image file says of itself, read without any decoder: which format it really is, and how large.
//
// The first look at a file that nobody vouches for. Nothing is allocated from what the file claims, and nothing outside of `bytes` is
// read; any bytes end in a header or an Error. Pure; thread-safe.
#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace isoparm {

struct ImageHeader {
    std::string format;        // OpenImageIO's name: openexr, png, jpeg, tiff, targa, bmp, pnm
    std::uint64_t pixels = 0;  // of all parts together; at least the one that could be read
    std::uint64_t row = 0;     // samples of the longest row
};

/// As much of a file as is looked at.
constexpr std::size_t kHeaderBytes = std::size_t{1} << 20;

/// The extensions that are read, each with its format: {"exr", "openexr"}.
const std::vector<std::pair<std::string, std::string>>& readable_formats();

/// The format that the extension of a path tells; "": none that is read.
std::string format_of_name(const std::string& path);

/// `bytes`: the first kHeaderBytes of the file, or all of it; `size`: of the file; `path` is for messages. The extension of the path and the
/// bytes must agree. Throws Error(io): what was found, and what was expected.
ImageHeader read_image_header(std::string_view bytes, std::uint64_t size, const std::string& path);

/// Is the file whole? A PNG file of `size` bytes ends in its IEND chunk, a JPEG file in its EOI marker, a TGA file in its footer or with its pixels;
/// all that the directories of a TIFF file name lies in it. Decoders fill up what was cut off, and say nothing. `read` gives bytes
/// [at, at + n) of the file, fewer where it ends. Throws Error(io) if not; other formats are not looked at. (image_end.cpp)
void check_image_end(const std::string& format, std::uint64_t size, const std::function<std::string(std::uint64_t at, std::size_t n)>& read, const std::string& path);

}  // namespace isoparm
