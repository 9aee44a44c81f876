// image_end.cpp -- is an image file whole? Decoders fill up what was cut off, or leave out what no longer is there, and say nothing.
#include <array>
#include <string_view>
#include <vector>

#include "error.h"
#include "image/image_header.h"

namespace isoparm {
namespace {

using Read = std::function<std::string(std::uint64_t, std::size_t)>;

struct File {
    const std::uint64_t size;
    const Read& read;
    const std::string& path;
    bool big_endian = false;

    [[noreturn]] void fail(const std::string& what) const { throw Error(ErrorKind::io, path + ": " + what + ": the file is damaged or cut off"); }
    /// Bytes [at, at + n), which must be there.
    std::string bytes(std::uint64_t at, std::uint64_t n, const char* what) const {
        if (n > size || at > size - n) fail("found " + std::string(what) + " beyond the end");
        std::string found = read(at, static_cast<std::size_t>(n));
        if (found.size() < n) fail("found " + std::string(what) + " beyond the end");
        return found;
    }
    std::uint64_t number(const std::string& from, std::size_t at, std::size_t n) const {
        std::uint64_t x = 0;
        for (std::size_t i = 0; i < n; ++i) x |= std::uint64_t(static_cast<unsigned char>(from[at + i])) << 8 * (big_endian ? n - 1 - i : i);
        return x;
    }
};

/// A PNG file ends in its chunk IEND.
void png(File& f) {
    constexpr std::uint64_t kAround = 12;  // a chunk's length, type and checksum
    f.big_endian = true;
    int chunks = 0;
    for (std::uint64_t at = 8;;) {
        if (++chunks > 2'000'000) f.fail("found more than 2000000 chunks");
        const std::string head = at + kAround <= f.size ? f.read(at, 8) : "";
        if (head.size() < 8) f.fail("found no chunk IEND at the end of the PNG file");
        if (head.substr(4) == "IEND") return;
        at += f.number(head, 0, 4) + kAround;
    }
}

/// All that the directories of a TIFF file name is there: their entries' values, and strips or tiles.
class TiffDirectories {
public:
    explicit TiffDirectories(File& f) : f_(f) {
        const std::string head = f.bytes(0, 8, "the header");
        f.big_endian = head[0] == 'M';
        large_ = f.number(head, 2, 2) == 43;
        std::uint64_t at = large_ ? f.number(f.bytes(8, 8, "the header"), 0, 8) : f.number(head, 4, 4);
        for (int count = 0; at != 0; ++count) {
            if (count == 4096) f.fail("found more than 4096 directories");
            at = directory(at);
        }
    }

private:
    /// Where the next one is; 0: it was the last.
    std::uint64_t directory(std::uint64_t at) {
        const std::size_t width = large_ ? 8 : 4, entry = 4 + 2 * width, counter = large_ ? 8 : 2;
        const std::uint64_t entries = f_.number(f_.bytes(at, counter, "a directory of the TIFF file"), 0, counter);
        if (entries > 4096) f_.fail("found a directory of " + std::to_string(entries) + " entries");
        const std::string all = f_.bytes(at + counter, entries * entry + width, "a directory of the TIFF file");
        std::vector<std::uint64_t> offsets, lengths;
        for (std::size_t i = 0; i < entries; ++i) {
            static constexpr std::array<std::size_t, 19> kSizes{0, 1, 1, 2, 4, 8, 1, 1, 2, 4, 8, 4, 8, 4, 0, 0, 8, 8, 8};
            const std::size_t begin = i * entry;
            const std::uint64_t tag = f_.number(all, begin, 2), type = f_.number(all, begin + 2, 2), count = f_.number(all, begin + 4, width);
            const std::size_t each = type < kSizes.size() ? kSizes[type] : 0;
            if (each == 0 || count == 0) continue;
            if (count > f_.size) f_.fail("found an entry of " + std::to_string(count) + " values in a directory of the TIFF file");
            const bool inside = count * each <= width;
            const std::uint64_t place = inside ? 0 : f_.number(all, begin + 4 + width, width);
            const bool wanted = tag == 273 || tag == 279 || tag == 324 || tag == 325;
            if (!inside && !wanted) f_.bytes(place + count * each - 1, 1, "values of a directory of the TIFF file");
            if (!wanted || each > 8) continue;
            if ((looked_at_ += count * each) > kMost) f_.fail("found more than " + std::to_string(kMost) + " bytes of places of strips");
            const std::string values = inside ? all.substr(begin + 4 + width, width) : f_.bytes(place, count * each, "places of strips of the TIFF file");
            auto& list = tag == 273 || tag == 324 ? offsets : lengths;
            for (std::size_t k = 0; k < count; ++k) list.push_back(f_.number(values, k * each, each));
        }
        for (std::size_t k = 0; k < offsets.size() && k < lengths.size(); ++k)
            if (lengths[k] > f_.size || offsets[k] > f_.size - lengths[k]) f_.fail("found pixels of the TIFF file beyond the end");
        return f_.number(all, entries * entry, width);
    }
    static constexpr std::uint64_t kMost = std::uint64_t{64} << 20;
    File& f_;
    bool large_ = false;
    std::uint64_t looked_at_ = 0;
};

/// A TGA file ends in a footer, or where uncompressed pixels do; of compressed ones without a footer nobody can tell.
void tga(File& f) {
    const std::string_view footer("TRUEVISION-XFILE.\0", 18);
    if (f.size >= 18 + 26 && f.bytes(f.size - 18, 18, "the footer") == footer) return;
    const std::string head = f.bytes(0, 18, "the header");
    const bool compressed = f.number(head, 2, 1) & 8, palette = f.number(head, 1, 1) == 1;
    const std::uint64_t colors = palette ? f.number(head, 5, 2) * ((f.number(head, 7, 1) + 7) / 8) : 0;
    const std::uint64_t pixels = f.number(head, 12, 2) * f.number(head, 14, 2) * ((f.number(head, 16, 1) + 7) / 8);
    if (compressed || f.size != 18 + f.number(head, 0, 1) + colors + pixels) f.fail("found no footer at the end of the TGA file");
}

}  // namespace

void check_image_end(const std::string& format, std::uint64_t size, const Read& read, const std::string& path) {
    File f{size, read, path};
    if (format == "png") png(f);
    if (format == "jpeg" && read(size > 4096 ? size - 4096 : 0, 4096).find("\xff\xd9") == std::string::npos) f.fail("found no marker EOI at the end of the JPEG file");
    if (format == "tiff") TiffDirectories{f};
    if (format == "targa") tga(f);
}

}  // namespace isoparm
