#include "image/png_file.h"

#include <png.h>

#include <algorithm>
#include <csetjmp>
#include <cstdio>
#include <stdexcept>

namespace isoparm {
namespace {

void append(png_structp png, png_bytep data, std::size_t size) {
    // Exceptions do not pass through C.
    try {
        static_cast<std::string*>(png_get_io_ptr(png))->append(reinterpret_cast<const char*>(data), size);
        return;
    } catch (const std::exception&) {
    }
    png_error(png, "out of memory");
}

void fail(png_structp png, png_const_charp message) {
    std::snprintf(static_cast<char*>(png_get_error_ptr(png)), 200, "%s", message);
    png_longjmp(png, 1);
}
void ignore(png_structp, png_const_charp) {}

/// False where libpng gave up. Nothing here has a destructor: libpng leaves by longjmp.
bool written(png_structp png, png_infop info, const png_uint_32 (&size)[2], int channels, const std::uint8_t* pixels, const png_text* texts, int text_count, const std::array<int, 2>& at) {
    if (setjmp(*png_set_longjmp_fn(png, longjmp, sizeof(jmp_buf)))) return false;
    png_set_user_limits(png, PNG_UINT_31_MAX, PNG_UINT_31_MAX);  // images have limits of their own
    png_set_IHDR(png, info, size[0], size[1], 8, channels == 4 ? PNG_COLOR_TYPE_RGB_ALPHA : PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_sRGB_gAMA_and_cHRM(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
    if (at[0] != 0 || at[1] != 0) png_set_oFFs(png, info, at[0], at[1], PNG_OFFSET_PIXEL);
    if (text_count > 0) png_set_text(png, info, texts, text_count);
    png_write_info(png, info);
    for (png_uint_32 y = 0; y < size[1]; ++y) png_write_row(png, pixels + std::size_t(y) * size[0] * static_cast<std::size_t>(channels));
    png_write_end(png, info);
    return true;
}

}  // namespace

std::string png_file(int width, int height, int channels, const std::vector<std::uint8_t>& pixels, const Metadata& metadata, const std::array<int, 2>& at) {
    Metadata kept = metadata;  // libpng wants to write to them
    std::vector<png_text> texts;
    for (auto& [name, value] : kept) {
        name.resize(std::min(name.size(), std::size_t(79)));
        png_text t{};
        const bool plain = std::all_of(value.begin(), value.end(), [](char c) { return static_cast<unsigned char>(c) < 128; });
        t.compression = plain ? PNG_TEXT_COMPRESSION_NONE : PNG_ITXT_COMPRESSION_NONE;
        t.key = name.data(), t.text = value.data();
        (plain ? t.text_length : t.itxt_length) = value.size();
        texts.push_back(t);
    }
    std::string file;
    char error[200] = "out of memory";
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, error, fail, ignore);
    png_infop info = png ? png_create_info_struct(png) : nullptr;
    if (info) png_set_write_fn(png, &file, append, [](png_structp) {});
    const bool done = info && written(png, info, {static_cast<png_uint_32>(width), static_cast<png_uint_32>(height)}, channels, pixels.data(), texts.data(), static_cast<int>(texts.size()), at);
    png_destroy_write_struct(&png, &info);
    if (!done) throw std::runtime_error(std::string("libpng: ") + error);
    return file;
}

}  // namespace isoparm
