// proof.h -- what is proved about a triangle, in less than half the bytes of a TriangleBound: there are millions of them. Internal to refine.h.
#pragma once
#include <bit>
#include <cstdint>

#include "bound.h"

namespace isoparm {

/// A number rounded up to the upper half of a double: by 2^-20 of it at most, over the whole range of doubles. >= 0, or -1; what is no number becomes infinity.
class RoundedUp {
public:
    RoundedUp() = default;
    RoundedUp(double x) {
        if (x == x) half_ = std::uint32_t((std::bit_cast<std::uint64_t>(x) + 0xffffffffu) >> 32);
    }
    operator double() const { return std::bit_cast<double>(std::uint64_t(half_) << 32); }

private:
    std::uint32_t half_ = 0x7ff00000;  // infinity
};

/// A TriangleBound whose numbers are rounded up, its unit to floats; tilt holds what that moved it. docs/certificates.md, "Rounding".
struct Proof {
    RoundedUp parametric, normal;
    std::array<RoundedUp, 3> beside, across{0.0, 0.0, 0.0};
    std::array<float, 3> unit{};
    RoundedUp tilt, turn;
    std::uint8_t quiet : 1 = 0, worst_edge : 2 = 0, worst_turn : 2 = 0, worst_across : 2 = 0;

    Proof() = default;
    Proof(const TriangleBound& b);
    operator TriangleBound() const;
    Point normal_of_plane() const { return {unit[0], unit[1], unit[2]}; }
    double own(Measure measure) const { return measure == Measure::geometric && quiet ? std::min<double>(parametric, normal) : double(parametric); }
};
static_assert(sizeof(Proof) == 56, "there is one for every triangle");

/// As Neighbour, and geometric_bound() of a TriangleBound.
struct ProvedNeighbour {
    const Proof* proof = nullptr;
    int edge = 0;
};
double geometric_bound(const Proof& t, const std::array<ProvedNeighbour, 3>& neighbours);

}  // namespace isoparm
