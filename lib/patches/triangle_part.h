// patches/triangle_part.h -- which part of an interpolant on a triangle a surface draws.
#pragma once

namespace isoparm {
/// The sum, or the one term that belongs to a vertex: P1, P2, P3 of Barnhill, Birkhoff and Gordon, T1, T2, T3 of Nielson.
enum class TrianglePart { sum, of_A, of_B, of_C };

/// 0 to 2; of a part that is not the sum.
constexpr int vertex_of(TrianglePart part) { return static_cast<int>(part) - 1; }
}
