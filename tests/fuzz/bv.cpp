// Any bytes as a BV file: patches, or an isoparm::Error that says where.
#include <cstdint>
#include <string>

#include "error.h"
#include "io/bv.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    try {
        for (const auto& member : isoparm::read_bv(std::string(reinterpret_cast<const char*>(data), size), "fuzz.bv")) {
            const auto r = member.patch.rect();
            isoparm::evaluate(member.patch, r.u0, r.v0);
        }
    } catch (const isoparm::Error&) {
    }
    return 0;
}
