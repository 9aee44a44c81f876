#include "png_file.h"

#include <tbb/parallel_for.h>
#include <zlib.h>

#include <algorithm>
#include <cstdlib>
#include <new>
#include <stdexcept>

namespace isoparm {
namespace {

using Bytes = std::vector<std::uint8_t>;
constexpr std::size_t kStrip = 1 << 19;    // bytes that are compressed for themselves, side by side; the larger, the smaller the file
constexpr std::size_t kBehind = 1 << 15;  // ... and may repeat what came so far before

void put_number(std::uint32_t x, std::string& to) {
    for (int shift = 24; shift >= 0; shift -= 8) to += static_cast<char>(x >> shift & 0xff);
}

std::string chunk(const char (&name)[5], const std::string& data) {
    if (data.size() > 0x7fffffff) throw std::length_error("a chunk of a PNG file is longer than 2 GiB");
    std::string all;
    put_number(static_cast<std::uint32_t>(data.size()), all);
    all += name;
    all += data;
    put_number(static_cast<std::uint32_t>(crc32_z(0, reinterpret_cast<const Bytef*>(all.data()) + 4, all.size() - 4)), all);
    return all;
}

std::string header(int width, int height, int channels) {
    std::string data;
    put_number(static_cast<std::uint32_t>(width), data), put_number(static_cast<std::uint32_t>(height), data);
    for (const int x : {8, channels == 4 ? 6 : 2, 0, 0, 0}) data += static_cast<char>(x);  // bits, colours, deflate, filters, not interlaced
    return chunk("IHDR", data);
}

/// For readers that do not know sRGB as well.
std::string colours() {
    std::string gamma, primaries;
    put_number(45455, gamma);
    for (const std::uint32_t x : {31270u, 32900u, 64000u, 33000u, 30000u, 60000u, 15000u, 6000u}) put_number(x, primaries);
    return chunk("gAMA", gamma) + chunk("sRGB", std::string(1, '\0')) + chunk("cHRM", primaries);
}

/// Latin-1 where that is ASCII, else UTF-8.
std::string text(const std::string& name, const std::string& value) {
    const bool plain = std::all_of(value.begin(), value.end(), [](char c) { return static_cast<unsigned char>(c) < 128; });
    const std::string key = name.substr(0, 79) + '\0';
    return plain ? chunk("tEXt", key + value) : chunk("iTXt", key + std::string(4, '\0') + value);
}

// ---- filters --------------------------------------------------------------------------------------------------------
int paeth(int a, int b, int c) {
    const int pa = std::abs(b - c), pb = std::abs(a - c), pc = std::abs(a + b - 2 * c);
    return pa <= pb && pa <= pc ? a : pb <= pc ? b : c;
}

/// What is left of a row: `left`, `up` and `corner` are the row, the one above and that one, a pixel later.
void filtered(int kind, const std::uint8_t* x, const std::uint8_t* left, const std::uint8_t* up, const std::uint8_t* corner, std::size_t n, std::uint8_t* out) {
    const auto each = [&](auto guess) {
        for (std::size_t i = 0; i < n; ++i) out[i] = static_cast<std::uint8_t>(x[i] - guess(i));
    };
    if (kind == 0) each([&](std::size_t) { return 0; });
    if (kind == 1) each([&](std::size_t i) { return left[i]; });
    if (kind == 2) each([&](std::size_t i) { return up[i]; });
    if (kind == 3) each([&](std::size_t i) { return (left[i] + up[i]) / 2; });
    if (kind == 4) each([&](std::size_t i) { return paeth(left[i], up[i], corner[i]); });
}

/// The filter of each row is that whose bytes, as numbers around 0, are the smallest in all.
void filter_row(const std::uint8_t* row, const std::uint8_t* above, std::size_t size, std::size_t pixel, std::uint8_t* out) {
    Bytes here(pixel + size), up(pixel + size), attempt(size);
    std::copy_n(row, size, here.begin() + static_cast<std::ptrdiff_t>(pixel));
    if (above) std::copy_n(above, size, up.begin() + static_cast<std::ptrdiff_t>(pixel));
    std::uint64_t least = ~std::uint64_t(0);
    for (int kind = 0; kind < 5; ++kind) {
        filtered(kind, row, here.data(), up.data() + pixel, up.data(), size, attempt.data());
        std::uint64_t sum = 0;
        for (const std::uint8_t b : attempt) sum += static_cast<std::uint64_t>(b < 128 ? b : 256 - b);
        if (sum >= least) continue;
        least = sum;
        out[0] = static_cast<std::uint8_t>(kind);
        std::copy(attempt.begin(), attempt.end(), out + 1);
    }
}

// ---- deflate --------------------------------------------------------------------------------------------------------
/// A part of one stream (RFC 1951), which ends at a whole byte.
std::string deflated(const Bytes& all, std::size_t begin, std::size_t end) {
    z_stream z{};
    if (deflateInit2(&z, Z_DEFAULT_COMPRESSION, Z_DEFLATED, -15, 8, Z_FILTERED) != Z_OK) throw std::bad_alloc();
    std::string out(deflateBound(&z, static_cast<uLong>(end - begin)) + 64, '\0');
    if (const std::size_t behind = std::min(begin, kBehind)) deflateSetDictionary(&z, all.data() + begin - behind, static_cast<uInt>(behind));
    z.next_in = const_cast<Bytef*>(all.data() + begin), z.avail_in = static_cast<uInt>(end - begin);
    z.next_out = reinterpret_cast<Bytef*>(out.data()), z.avail_out = static_cast<uInt>(out.size());
    deflate(&z, end == all.size() ? Z_FINISH : Z_SYNC_FLUSH);
    out.resize(z.total_out);
    deflateEnd(&z);
    return out;
}

}  // namespace

std::string png_file(int width, int height, int channels, const std::vector<std::uint8_t>& pixels, const Metadata& metadata) {
    const std::size_t row = static_cast<std::size_t>(width) * static_cast<std::size_t>(channels), rows = static_cast<std::size_t>(height);
    Bytes rest((row + 1) * rows);
    tbb::parallel_for(std::size_t(0), rows, [&](std::size_t y) {
        filter_row(&pixels[y * row], y > 0 ? &pixels[(y - 1) * row] : nullptr, row, static_cast<std::size_t>(channels), &rest[y * (row + 1)]);
    });
    const std::size_t strips = (rest.size() + kStrip - 1) / kStrip;
    std::vector<std::string> parts(strips);
    std::vector<uLong> sums(strips);
    const auto end_of = [&](std::size_t i) { return std::min(rest.size(), (i + 1) * kStrip); };
    tbb::parallel_for(std::size_t(0), strips, [&](std::size_t i) {
        parts[i] = deflated(rest, i * kStrip, end_of(i));
        sums[i] = adler32_z(1, &rest[i * kStrip], end_of(i) - i * kStrip);
    });
    uLong sum = 1;
    for (std::size_t i = 0; i < strips; ++i) sum = adler32_combine(sum, sums[i], static_cast<z_off_t>(end_of(i) - i * kStrip));
    parts.front().insert(0, "\x78\x9c");  // a stream of zlib's (RFC 1950)
    put_number(static_cast<std::uint32_t>(sum), parts.back());

    std::string file = "\x89PNG\r\n\x1a\n" + header(width, height, channels) + colours();
    for (const auto& [name, value] : metadata) file += text(name, value);
    for (const std::string& part : parts) file += chunk("IDAT", part);
    return file + chunk("IEND", "");
}

}  // namespace isoparm
