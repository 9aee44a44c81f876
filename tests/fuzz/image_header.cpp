// Any bytes as the beginning of an image file, of every format: pixels, or an isoparm::Error that says what is wrong.
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "error.h"
#include "image_header.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    for (const auto& [extension, format] : isoparm::readable_formats()) {
        try {
            const auto h = isoparm::read_image_header({reinterpret_cast<const char*>(data), size}, size, "fuzz." + extension);
            if (h.pixels == 0 || h.row == 0 || h.format != format) std::abort();
        } catch (const isoparm::Error&) {
        }
    }
    return 0;
}
