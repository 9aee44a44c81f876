#include "image/image_header.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <cctype>
#include <cstdlib>

#include "error.h"
#include "io/extension.h"
#include "scene/suggest.h"

namespace isoparm {
namespace {

/// What ends before the reader does ends the reading.
struct Reader {
    std::string_view bytes;
    const std::string& path;
    bool big_endian = false;
    std::size_t at = 0;

    [[noreturn]] void fail(const std::string& what) const { throw Error(ErrorKind::io, path + ": " + what); }
    void need(std::size_t n) const {
        if (at > bytes.size() || n > bytes.size() - at) fail("the file ends within its header, at byte " + std::to_string(bytes.size()));
    }
    std::uint64_t number(int size) {
        need(size);
        std::uint64_t x = 0;
        for (int i = 0; i < size; ++i) x |= std::uint64_t(static_cast<unsigned char>(bytes[at + i])) << 8 * (big_endian ? size - 1 - i : i);
        at += size;
        return x;
    }
    std::uint64_t u8() { return number(1); }
    std::uint64_t u16() { return number(2); }
    std::uint64_t u32() { return number(4); }
    std::int64_t i32() { return static_cast<std::int32_t>(u32()); }
    void skip(std::uint64_t n) {
        if (n > bytes.size()) fail("the file ends within its header, at byte " + std::to_string(bytes.size()));
        need(n);
        at += n;
    }
    /// Up to a zero byte.
    std::string text(std::size_t longest) {
        std::string r;
        for (char c; (c = static_cast<char>(u8())) != 0;) {
            if (r.size() >= longest) fail("found a name of more than " + std::to_string(longest) + " characters in the header");
            r += c;
        }
        return r;
    }
};

void add(ImageHeader& h, Reader& r, std::int64_t width, std::int64_t height, std::uint64_t channels) {
    if (width < 1 || height < 1) r.fail("found an image of " + std::to_string(width) + " x " + std::to_string(height) + " pixels in the header, expected some");
    if (width > 0x7fffffff || height > 0x7fffffff) r.fail("found an image of " + std::to_string(width) + " x " + std::to_string(height) + " pixels in the header, expected at most 2147483647 either way");
    if (channels < 1 || channels > 4096) r.fail("found " + std::to_string(channels) + " channels in the header, expected 1 to 4096");
    h.pixels += static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height);
    h.row = std::max<std::uint64_t>(h.row, static_cast<std::uint64_t>(width) * channels);
}

/// One header of an EXR file. False: the empty one that ends a list of several.
bool exr_part(ImageHeader& h, Reader& r) {
    std::int64_t window[4] = {0, 0, -1, -1};
    std::uint64_t channels = 0;
    bool any = false, has_window = false;
    for (std::string name; !(name = r.text(255)).empty(); any = true) {
        r.text(255);  // the attribute's type
        const std::uint64_t size = r.u32();
        const std::size_t end = r.at + size;
        r.need(size);
        if (name == "dataWindow" && size == 16) {
            for (auto& w : window) w = r.i32();
            has_window = true;
        }
        if (name == "channels")
            while (r.at < end && !r.text(255).empty()) {
                r.skip(16);
                if (++channels > 4096) r.fail("found more than 4096 channels in the header");
            }
        r.at = end;
    }
    if (!any) return false;
    if (!has_window || channels == 0) r.fail(std::string("found no ") + (has_window ? "channels" : "dataWindow") + " in the header");
    add(h, r, window[2] - window[0] + 1, window[3] - window[1] + 1, channels);
    return true;
}

void exr(ImageHeader& h, Reader& r) {
    r.at = 4;
    const std::uint64_t version = r.u32();
    if ((version & 0xff) != 2) r.fail("found version " + std::to_string(version & 0xff) + " of the EXR format, expected 2");
    if (version & 0x800) r.fail("found a deep image (several samples a pixel), which is not compared; flatten both first");
    if (!exr_part(h, r)) r.fail("found an empty header");
    for (int parts = 1; (version & 0x1000) && exr_part(h, r);)
        if (++parts > 4096) r.fail("found more than 4096 parts");
}

void png(ImageHeader& h, Reader& r, std::uint64_t size) {
    r.big_endian = true;
    r.at = 8;
    if (r.u32() != 13 || r.u32() != 0x49484452) r.fail("found no IHDR chunk at the beginning of the PNG file");
    const auto width = static_cast<std::int64_t>(r.u32()), height = static_cast<std::int64_t>(r.u32());
    const std::uint64_t depth = r.u8(), color = r.u8();
    const std::uint64_t channels = color == 6 ? 4 : color == 4 ? 2 : color == 2 ? 3 : 1;
    if ((depth != 1 && depth != 2 && depth != 4 && depth != 8 && depth != 16) || color > 6 || color == 1 || color == 5)
        r.fail("found " + std::to_string(depth) + " bits and colour type " + std::to_string(color) + ", which PNG does not have");
    add(h, r, width, height, color == 3 ? 4 : channels);
    // Deflate makes nothing shorter than by 1032 times.
    if (static_cast<double>(h.pixels) * static_cast<double>(depth * channels) / 8 > 1032.0 * static_cast<double>(size))
        r.fail("found a header of " + std::to_string(width) + " x " + std::to_string(height) + " pixels, which " + std::to_string(size) + " bytes cannot hold: the file is damaged or cut off");
}

void jpeg(ImageHeader& h, Reader& r) {
    r.big_endian = true;
    r.at = 2;
    for (;;) {
        if (r.u8() != 0xff) r.fail("found no marker where a JPEG file has one");
        std::uint64_t marker = r.u8();
        while (marker == 0xff) marker = r.u8();
        if (marker == 0x01 || (marker >= 0xd0 && marker <= 0xd8)) continue;
        if (marker == 0xd9 || marker == 0xda) r.fail("found no size before the data of the JPEG file");
        const std::uint64_t length = r.u16();
        if (length < 2) r.fail("found a JPEG segment of " + std::to_string(length) + " bytes");
        if (marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc) {
            r.skip(1);
            const auto height = static_cast<std::int64_t>(r.u16()), width = static_cast<std::int64_t>(r.u16());
            return add(h, r, width, height, r.u8());
        }
        r.skip(length - 2);
    }
}

void tiff(ImageHeader& h, Reader& r, bool beyond) {
    r.big_endian = r.bytes[0] == 'M';
    r.at = 2;
    const bool large = r.u16() == 43;
    if (large) r.skip(4);
    const std::uint64_t directory = large ? r.number(8) : r.u32();
    if (directory >= r.bytes.size() && beyond) {  // written last, as most programs do: its decoder is asked, within its limits
        h.pixels = h.row = 1;
        return;
    }
    r.at = directory < r.bytes.size() ? static_cast<std::size_t>(directory) : r.bytes.size();
    std::int64_t width = 0, height = 0;
    std::uint64_t channels = 1;
    const std::uint64_t entries = large ? r.number(8) : r.u16();
    for (std::uint64_t i = 0; i < entries; ++i) {
        const std::uint64_t tag = r.u16(), type = r.u16();
        r.skip(large ? 8 : 4);
        const std::size_t field = r.at;
        const auto value = static_cast<std::int64_t>(type == 3 ? r.u16() : r.u32());
        if (tag == 256) width = value;
        if (tag == 257) height = value;
        if (tag == 277) channels = static_cast<std::uint64_t>(value);
        r.at = field;
        r.skip(large ? 8 : 4);
    }
    add(h, r, width, height, channels);
}

void bmp(ImageHeader& h, Reader& r) {
    r.at = 14;
    const bool old = r.u32() == 12;
    const std::int64_t width = old ? static_cast<std::int64_t>(r.u16()) : r.i32();
    const std::int64_t height = old ? static_cast<std::int64_t>(r.u16()) : r.i32();
    add(h, r, width, height < 0 ? -height : height, 4);
}

void pnm(ImageHeader& h, Reader& r) {
    r.at = 2;
    std::int64_t size[2];
    for (auto& s : size) {
        std::string digits;
        for (char c;;) {
            c = static_cast<char>(r.u8());
            if (c == '#')
                while (r.u8() != '\n') {}
            else if (c >= '0' && c <= '9' && digits.size() < 10) digits += c;
            else if (!std::isspace(static_cast<unsigned char>(c))) r.fail("found no width and height in the header");
            else if (!digits.empty()) break;
        }
        s = std::strtoll(digits.c_str(), nullptr, 10);
    }
    add(h, r, size[0], size[1], 3);
}

/// Radiance's format: lines of text up to an empty one, then "-Y height +X width".
void hdr(ImageHeader& h, Reader& r) {
    const auto line = [&] {
        std::string text;
        for (char c; (c = static_cast<char>(r.u8())) != '\n';) {
            if (text.size() >= 4096) r.fail("found a line of more than 4096 characters in the header");
            text += c;
        }
        return text;
    };
    while (!line().empty()) {}
    const std::string size = line();
    int height = 0, width = 0, end = 0;
    if (std::sscanf(size.c_str(), "-Y %9d +X %9d%n", &height, &width, &end) != 2 || end != static_cast<int>(size.size()))
        r.fail("found no line \"-Y height +X width\" after the header; other orders of rows and columns are not read");
    add(h, r, width, height, 3);
}

void tga(ImageHeader& h, Reader& r) {
    r.at = 1;
    const std::uint64_t palette = r.u8(), type = r.u8();
    r.at = 12;
    const auto width = static_cast<std::int64_t>(r.u16()), height = static_cast<std::int64_t>(r.u16());
    const std::uint64_t bits = r.u8();
    if (palette > 1 || (type & ~8u) < 1 || (type & ~8u) > 3 || (bits != 8 && bits != 15 && bits != 16 && bits != 24 && bits != 32)) r.fail("found no header of a TGA file");
    add(h, r, width, height, 4);
}

/// Empty when the bytes begin like no format; TGA files begin like nothing in particular.
std::string format_of_bytes(std::string_view b) {
    const auto begins = [&](std::string_view magic) { return b.substr(0, magic.size()) == magic; };
    using namespace std::string_view_literals;
    if (begins("\x76\x2f\x31\x01"sv)) return "openexr";
    if (begins("\x89PNG\r\n\x1a\n"sv)) return "png";
    if (begins("\xff\xd8\xff"sv)) return "jpeg";
    if (begins("II*\0"sv) || begins("MM\0*"sv) || begins("II+\0"sv) || begins("MM\0+"sv)) return "tiff";
    if (begins("BM"sv)) return "bmp";
    if (begins("#?RADIANCE\n"sv) || begins("#?RGBE\n"sv)) return "hdr";
    if (begins("P6"sv) || begins("P5"sv)) return "pnm";
    return "";
}

}  // namespace

const std::vector<std::pair<std::string, std::string>>& readable_formats() {
    static const std::vector<std::pair<std::string, std::string>> all{{"exr", "openexr"}, {"png", "png"},   {"tif", "tiff"}, {"tiff", "tiff"}, {"tga", "targa"},
                                                                      {"jpg", "jpeg"},    {"jpeg", "jpeg"}, {"bmp", "bmp"},  {"ppm", "pnm"},   {"pgm", "pnm"},   {"hdr", "hdr"}};
    return all;
}

std::string format_of_name(const std::string& path) {
    const std::string extension = extension_of(path);
    for (const auto& [name, format] : readable_formats())
        if (extension == "." + name) return format;
    return "";
}

ImageHeader read_image_header(std::string_view bytes, std::uint64_t size, const std::string& path) {
    ImageHeader h;
    std::vector<std::string> names;
    const std::string extension = extension_of(path);
    h.format = format_of_name(path);
    for (const auto& [name, format] : readable_formats()) names.push_back(name);
    if (h.format.empty()) throw Error(ErrorKind::io, path + ": found " + (extension.empty() ? "no extension" : "the extension " + quoted(extension)) + ", expected an image: " + listed(names));
    Reader r{bytes, path};
    if (size == 0) r.fail("the file is empty");
    if (const std::string found = format_of_bytes(bytes); found != h.format && !(h.format == "targa" && found.empty()))
        r.fail(found.empty() ? "the file does not begin like one of format " + h.format : "found a file of format " + found + ", expected " + h.format + ", as its name says");
    if (h.format == "openexr") exr(h, r);
    else if (h.format == "png") png(h, r, size);
    else if (h.format == "jpeg") jpeg(h, r);
    else if (h.format == "tiff") tiff(h, r, size > bytes.size());
    else if (h.format == "bmp") bmp(h, r);
    else if (h.format == "pnm") pnm(h, r);
    else if (h.format == "hdr") hdr(h, r);
    else tga(h, r);
    return h;
}

}  // namespace isoparm
