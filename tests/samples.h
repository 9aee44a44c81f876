// samples.h -- one row for each type of curve and of surface: what the law tests are instantiated over.
//
// A new type joins every law by one row in samples_*.cpp. A row makes a random instance from a Random; the same seed
// makes the same instance, and a Random with an offset makes the same instance elsewhere in space.
#pragma once
#include <cstdint>
#include <ostream>
#include <string>
#include <vector>

#include "patch.h"
#include "transform.h"

namespace isoparm::tests {

/// Deterministic on every machine (splitmix64).
class Random {
public:
    explicit Random(std::uint64_t seed, const Point& offset = {}) : state_(seed), offset_(offset) {}
    double number(double low = 0, double high = 1) { return low + (high - low) * (double(next() >> 11) * 0x1p-53); }
    int integer(int low, int high) { return low + int(next() % std::uint64_t(high - low + 1)); }
    Point vector(double size = 1) { return {number(-size, size), number(-size, size), number(-size, size)}; }
    /// A position near p, shifted by the offset.
    Point point(const Point& p = {}, double spread = 1) { return p + vector(spread) + offset_; }
    const Point& offset() const { return offset_; }
    /// The same stream without the offset, for data that is moved afterwards.
    Random here() {
        Random r(next());
        return r;
    }

private:
    std::uint64_t next() {
        std::uint64_t z = (state_ += 0x9e3779b97f4a7c15u);
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
        return z ^ (z >> 31);
    }
    std::uint64_t state_;
    Point offset_;
};

struct CurveType {
    const char* name;
    Curve (*make)(Random&);
};
const std::vector<CurveType>& curve_types();

struct PatchSample {
    Patch patch;
    std::vector<Curve> boundary;  // by edge, along its growing parameter: what the surface promises to interpolate
    std::vector<int> free = {};   // edges that a part of a surface does not interpolate
};
struct PatchType {
    const char* name;
    PatchSample (*make)(Random&);
    bool moves_with_its_data = true;  // translation invariance, which some formulas of the seeds do not have
    bool smooth_vertices = true;      // false: cone points at the vertices of the triangle
    bool bounded_vertices = true;     // false: no bounds of derivatives over boxes that hold a vertex
};
const std::vector<PatchType>& patch_types();

inline std::ostream& operator<<(std::ostream& out, const CurveType& t) { return out << t.name; }
inline std::ostream& operator<<(std::ostream& out, const PatchType& t) { return out << t.name; }
inline constexpr auto name_of = [](const auto& info) { return std::string(info.param.name); };

/// A random parameter of the domain, `margin` (a fraction) away from its border.
Vec2 random_parameter(Random& random, const Patch& patch, double margin = 0);
/// Largest distance of sampled points from `origin`: what errors of rounding are relative to.
double size_of_sample(const Patch& patch, const Point& origin = {});
double size_of_sample(const Curve& curve, const Point& origin = {});

// ---- data to build with ---------------------------------------------------------------------------------------------
Curve random_cubic(Random& random, const Point& from, const Point& to);
/// Four curves that meet at the corners.
struct Frame {
    Curve c0, c1, d0, d1;
};
Frame random_frame(Random& random, Curve (*between)(Random&, const Point&, const Point&) = random_cubic);
/// E1: B to C, E2: C to A, E3: A to B.
std::array<Curve, 3> random_triangle(Random& random,
                                     Curve (*between)(Random&, const Point&, const Point&) = random_cubic);
/// D_k of such edges that fit the tangents at the vertices; inside they are arbitrary (so are the twists).
std::array<Curve, 3> random_cross(Random& random, const std::array<Curve, 3>& edges, double spread = 1);
/// E_k' x D_k for cubic edges and quadratic D_k.
std::array<Curve, 3> normals_of(const std::array<Curve, 3>& edges, const std::array<Curve, 3>& cross);
std::vector<std::vector<Point>> random_net(Random& random, int rows, int columns);

}  // namespace isoparm::tests
