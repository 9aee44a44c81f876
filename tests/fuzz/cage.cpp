// Any bytes as a subdivision cage: a cage, or an isoparm::Error that says where.
#include <cstdint>
#include <string>

#include "error.h"
#include "io/cage_obj.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    try {
        isoparm::read_cage_obj(std::string(reinterpret_cast<const char*>(data), size), "fuzz.obj");
    } catch (const isoparm::Error&) {
    }
    return 0;
}
