// Any bytes as an image file, of every format: pixels and an end, or an isoparm::Error that says what is wrong.
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "error.h"
#include "image/image_header.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    for (const auto& [extension, format] : isoparm::readable_formats()) {
        try {
            const auto h = isoparm::read_image_header({reinterpret_cast<const char*>(data), size}, size, "fuzz." + extension);
            if (h.pixels == 0 || h.row == 0 || h.format != format) std::abort();
            isoparm::check_image_end(h.format, size, [&](std::uint64_t at, std::size_t n) {
                return at < size ? std::string(reinterpret_cast<const char*>(data) + at, std::min<std::size_t>(n, size - at)) : std::string();
            }, "fuzz." + extension);
        } catch (const isoparm::Error&) {
        }
    }
    return 0;
}
