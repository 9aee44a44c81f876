// Any bytes as a BV, BREP or LOP file: patches or curves, or an isoparm::Error that says where.
#include <cstdint>
#include <string>

#include "error.h"
#include "io/bv.h"
#include "io/curve_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    try {
        for (const auto& member : isoparm::read_bv(std::string(reinterpret_cast<const char*>(data), size), "fuzz.bv")) {
            const auto r = member.patch.rect();
            isoparm::evaluate(member.patch, r.u0, r.v0);
        }
    } catch (const isoparm::Error&) {
    }
    for (const char* path : {"fuzz.brep", "fuzz.lop"}) try {
            for (const auto& c : isoparm::read_curve_file(std::string(reinterpret_cast<const char*>(data), size), path))
                if (c.curve) (*c.curve)(c.curve->begin());
        } catch (const isoparm::Error&) {
        }
    return 0;
}
