// exact_kernel.h -- the arithmetic of rays against the leaves of a patch, several rays side by side; internal to exact_patch.cpp and exact_leaves.cpp.
//
// Each loop is compiled for several instruction sets, which give the same bits. A ray's numbers do not depend on those beside it.
#pragma once
#include <cstdint>

#include "batch.h"
#include "rays/ray_lanes.h"

namespace isoparm {

/// A ray as the two planes through it.
struct RayPlanes {
    Point origin, direction, n1, n2;  // unit, at right angles
};

/// Rays side by side. Loops take whole groups of lanes: those of the last group beyond the last ray must hold some ray too.
struct RayPacket {
    static constexpr int lanes = 16, group = 8;
    alignas(64) double origin[3][lanes];
    double direction[3][lanes], n1[3][lanes], n2[3][lanes];

    RayPlanes at(int lane) const;
    void put(int lane, const RayPlanes& ray);
};

/// S(u + x hu, v + y hv) = s + a x + b y, up to `bend`, for -1 <= x, y <= 1 in the domain.
struct LeafMap {
    Box box;
    double u = 0, v = 0, hu = 0, hv = 0;
    Point s, a, b;
    double size_s = 0, size_a = 0, size_b = 0;  // their lengths
    double bend = 0;                            // infinite where derivatives have no bound
    double turn_u = 0, turn_v = 0;              // at least |S_u hu - a|, |S_v hv - b| anywhere, infinite likewise
    bool slanted = false;                       // u + v = 1 runs through it
    bool outer[4] = {true, true, true, true};   // do its sides x = -1, 1 and y = -1, 1 lie on borders of the patch, or between its cells?
    double uu = 0, uv = 0, vv = 0;              // at least |S_uu| hu^2, |S_uv| hu hv, |S_vv| hv^2 anywhere, infinite likewise
    Point second[3];                            // those three, about, in the middle: where Newton's method begins
};

/// Rays against the linear map of a leaf.
struct AimPacket {
    enum Verdict : std::int64_t { miss, one, open };  // open: the leaf has to be halved
    alignas(64) std::int64_t verdict[RayPacket::lanes];
    double y11[RayPacket::lanes], y12[RayPacket::lanes], y21[RayPacket::lanes], y22[RayPacket::lanes];  // Y
    double x[RayPacket::lanes], y[RayPacket::lanes];                                                    // where the linear map meets the ray
    double wx[RayPacket::lanes], wy[RayPacket::lanes];  // weights of the norm max(|x| / wx, |y| / wy)
    double per_wx[RayPacket::lanes], per_wy[RayPacket::lanes];  // 1 / wx, 1 / wy
    double growth[RayPacket::lanes];                            // 1 / (1 - q), q at least |I - Y J| in that norm
    double slack[RayPacket::lanes];                     // of it: of the border,
    double noise[RayPacket::lanes];                     // and what rounding may make of a step
};

/// Newton's method.
struct NewtonPacket {
    enum State : std::int64_t { active, found, gone, undecided };  // gone: the root lies beyond the leaf
    alignas(64) std::int64_t state[RayPacket::lanes];
    double x[RayPacket::lanes], y[RayPacket::lanes];    // of the leaf's map, and
    double cx[RayPacket::lanes], cy[RayPacket::lanes];  // the nearest place in the leaf and the domain,
    double u[RayPacket::lanes], v[RayPacket::lanes];    // which is S(u,v)
    double before[RayPacket::lanes];                    // the last step
    double distance[RayPacket::lanes];                  // of the point that belongs to (x,y), along the ray
    double step_x[RayPacket::lanes], step_y[RayPacket::lanes];  // Y f there,
    double beyond[RayPacket::lanes];                            // but for an f of at most so much
    double frame[9][RayPacket::lanes];                  // S, S_u, S_v at (u,v)
};

/// Rays that surely meet leaves, each its own, side by side: about where, in; where and how well that is proved, out.
struct CertainPacket {
    enum { U, V, Hu, Hv, Ax, Ay, Az, Bx, By, Bz, far_a, far_b, turn_u, turn_v, uu, uv, vv, sizes, numbers };  // of LeafMap; far_a = size_a + turn_u, ...
    enum { of_s, of_su, of_sv };
    alignas(64) double leaf[numbers][RayPacket::lanes];
    double x[RayPacket::lanes], y[RayPacket::lanes], u[RayPacket::lanes], v[RayPacket::lanes];
    double frame[9][RayPacket::lanes];  // S, S_u, S_v at (u,v), as they were found,
    double off[3][RayPacket::lanes];    // up to so much in each coordinate
    double distance[RayPacket::lanes], error[RayPacket::lanes];  // infinite: not proved

    void put(int lane, const LeafMap& map);
    void set_off(const FrameError& of);  // for all lanes
};

/// Where float32 numbers of rays go: lanes of each.
struct FloatRays {
    float *org_x, *org_y, *org_z, *dir_x, *dir_y, *dir_z, *tfar;
};

/// The longest step, in half leaves, that may be taken as the last without another look at S.
constexpr double kLastStep = 1e-3;

struct ExactKernel {
    /// Rays as Embree takes them: relative to `centre`, and from where they enter the ball around the scene, at start[i], as far eyes must not
    /// cost float32 its digits. Sets `lanes` of `start`, of `to` and, where given, of origins and directions of `packet`: whole groups. Those that have
    /// no bit in `active`, which is not 0, get the first ray that has one.
    void (*enter)(const Ray* rays, std::uint32_t active, int lanes, const Point& centre, double radius, double* start, const FloatRays& to, RayPacket* packet);
    /// The same of a packet whose rays are side by side already.
    void (*enter_lanes)(const RayLanes& rays, const Point& centre, double radius, double* start, const FloatRays& to, RayPacket* packet);
    /// Sets n1 and n2 of the first n lanes.
    void (*planes)(int n, RayPacket& rays);
    /// `border`: rays that pass the border of the leaf within it are not missed.
    void (*aim)(const LeafMap& leaf, const RayPacket& rays, double border, const double* farthest, int n, AimPacket& out);
    /// Begins where the linear map meets the rays, bent as the leaf is in its middle; lanes that are not met once are `gone`.
    void (*begin)(const LeafMap& leaf, const RayPacket& rays, const AimPacket& aim, int n, NewtonPacket& out);
    /// One step with the frames, and where what is left after it is proved to be nothing, with S of where it leads; `newton` or the map that is proved to contract. Is any lane still active?
    /// `between`: roots so far beyond sides between leaves, in parts of what counts as meeting a border, are in both.
    bool (*step)(const LeafMap& leaf, const RayPacket& rays, const AimPacket& aim, bool newton, double between, int n, NewtonPacket& p);
    /// Sets u and v, which are off by a unit in the last place or two.
    void (*parameters)(CertainPacket& p);
    /// One step of Newton's method, which moves u and v, and its proof.
    void (*certify)(const RayPacket& rays, CertainPacket& p);
};
const ExactKernel& exact_kernel(Isa isa);

}  // namespace isoparm
