// patch.h -- a parametric surface patch, as a value.
//
// Domain: a rectangle (u to the right, v up; [0,1]^2 unless it says otherwise) or the triangle u,v,w >= 0, u + v + w = 1,
// given by (u,v). A patch type is one formula, templated on its scalar; PatchModel runs it on everything below.
// Immutable, cheap to copy, safe to call from every thread.
#pragma once
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "batch.h"
#include "curve.h"
#include "scalar/jet.h"
#include "scalar/polynomial.h"

namespace isoparm {

enum class Domain { quad, triangle };

struct Rect {
    double u0 = 0, u1 = 1, v0 = 0, v1 = 1;
};
struct Box {
    Interval u, v;
};

/// Position and Taylor coefficients to second order: S = x.c[0..], S_u = coefficient(1,0), S_uu = 2 coefficient(2,0) ...
/// A coefficient that does not exist (at a singular corner) is NaN.
using PointJet = Vec3<JetUV<double, 2>>;
/// Position and first derivatives only: all that shading needs, at a fraction of the cost.
using PointFrame = Vec3<JetUV<double, 1>>;

/// What is proved over a box, and at its middle. Coefficients that have no bound there are Interval::all().
struct Enclosure {
    Vec3<JetUV<Interval, 2>> centre;  // at (mid u, mid v), point-like
    Vec3<JetUV<Interval, 3>> over;    // for every point of the box
    double u = 0, v = 0;              // the middle
};

class Patch {
public:
    struct Concept {
        virtual ~Concept() = default;
        virtual Domain domain() const = 0;
        virtual Rect rect() const = 0;
        /// Interior lines u = const, v = const across which derivatives of second order may jump.
        virtual std::vector<double> breaks_u() const = 0;
        virtual std::vector<double> breaks_v() const = 0;
        virtual Point point(double u, double v) const = 0;
        virtual PointJet jet(double u, double v) const = 0;
        virtual PointFrame frame(double u, double v) const = 0;
        /// n positions; bit for bit the same as point().
        virtual void points(std::size_t n, const double* u, const double* v, Point* out) const = 0;
        /// n frames; bit for bit the same as frame().
        virtual void frames(std::size_t n, const double* u, const double* v, PointFrame* out) const = 0;
        /// As Patch::frames(u, v, out), sizes checked.
        virtual void frame_arrays(Isa isa, std::span<const double> u, std::span<const double> v, const FrameArrays& out) const = 0;
        virtual Enclosure enclose(const Box& box) const = 0;
        /// Encloses every position over the box; cheaper than enclose().
        virtual Vec3<Interval> enclose_points(const Box& box) const = 0;
        /// As Patch::batch().
        virtual const PolynomialCells* batch() const { return nullptr; }
        /// As Patch::exact_cell().
        virtual std::vector<Polynomial> exact_cell(std::size_t, std::size_t) const { return {}; }
        /// As Patch::model().
        virtual std::vector<Polynomial> model(const Box&) const { return {}; }
        /// The unit normal at a point where S_u or S_v does not exist, if the surface has one there all the same.
        virtual std::optional<Point> singular_normal(double, double) const { return {}; }
    };
    explicit Patch(std::shared_ptr<const Concept> impl) : impl_(std::move(impl)) {}

    Domain domain() const { return impl_->domain(); }
    Rect rect() const { return impl_->rect(); }
    std::vector<double> breaks_u() const { return impl_->breaks_u(); }
    std::vector<double> breaks_v() const { return impl_->breaks_v(); }
    /// The breaks with the ends of the domain: where cells begin and end.
    std::vector<double> lines_u() const;
    std::vector<double> lines_v() const;
    Point point(double u, double v) const { return impl_->point(u, v); }
    PointJet jet(double u, double v) const { return impl_->jet(u, v); }
    PointFrame frame(double u, double v) const { return impl_->frame(u, v); }
    void points(std::size_t n, const double* u, const double* v, Point* out) const { impl_->points(n, u, v, out); }
    void frames(std::size_t n, const double* u, const double* v, PointFrame* out) const { impl_->frames(n, u, v, out); }
    /// The fast way to many positions and first derivatives, at (u[k], v[k]), or at (u[k], v[0]) when v is one number: a row, which is
    /// several times faster still. Where the surface is polynomial or rational of degree <= 7 between its breaks and
    /// PolynomialCells::accuracy can be proved, if only away from where a denominator vanishes, each coordinate is that close to the exact
    /// surface; elsewhere it is frame()'s bit for bit.
    /// The same bits for every instruction set, for rows and for points, and however a batch is cut in parts. Parameters lie in the
    /// domain; all arrays have u's size, else throws std::invalid_argument. No allocation for polynomial and rational surfaces. This
    /// machine must run `isa`; there is no reason to give it but to measure.
    void frames(std::span<const double> u, std::span<const double> v, const FrameArrays& out, Isa isa = chosen_isa()) const;
    /// What computes frames() with a proved error, where the surface is polynomial or rational as told above; else nullptr.
    const PolynomialCells* batch() const { return impl_->batch(); }
    Enclosure enclose(const Box& box) const { return impl_->enclose(box); }
    Vec3<Interval> enclose_points(const Box& box) const { return impl_->enclose_points(box); }
    /// The surface between lines_u()[i], lines_u()[i+1] and lines_v()[j], lines_v()[j+1], these included: polynomials x, y, z, or x, y, z
    /// and their common denominator, in (u,v) minus the middle of the cell. Empty where it is neither polynomial nor known as rational.
    std::vector<Polynomial> exact_cell(std::size_t i, std::size_t j) const { return impl_->exact_cell(i, j); }
    /// Models (Polynomial::is_model) of x, y, z over a box in one cell, about its middle: valid at all points of the box in the domain. Empty where there
    /// are none: the formula is singular, has a kink or changes too much.
    std::vector<Polynomial> model(const Box& box) const { return impl_->model(box); }
    std::optional<Point> singular_normal(double u, double v) const { return impl_->singular_normal(u, v); }
    /// Encloses the exact position at (u,v).
    Vec3<Interval> enclose_point(double u, double v) const;

    int edges() const { return domain() == Domain::quad ? 4 : 3; }
    /// Parameters on edge k, t in [0,1]. Quad: 0 = c0 (v low), 1 = d1 (u high), 2 = c1 (v high), 3 = d0 (u low), each
    /// along its growing parameter. Triangle: 0 = E1 (B to C, u=0), 1 = E2 (C to A, v=0), 2 = E3 (A to B, w=0). The point
    /// lies on the boundary of the domain exactly (u + v = 1 without rounding on E3).
    Vec2 edge_point(int k, double t) const;
    std::string edge_name(int k) const;
    /// The t at which edge_point() hits a break exactly, growing.
    std::vector<double> edge_breaks(int k) const;

private:
    std::shared_ptr<const Concept> impl_;
};

/// First derivatives, second derivatives and curvature as a user reads them; what does not exist is empty. On a
/// break, where derivatives may jump, those of the cell on its right (greater parameters).
struct SurfacePoint {
    Point position;
    std::optional<Point> du, dv, duu, duv, dvv;
    std::optional<Point> normal;               // unit; the limit at poles and apexes, when there is one
    std::optional<double> gaussian, mean;      // curvatures; mean > 0 bends toward the normal
};
SurfacePoint evaluate(const Patch& patch, double u, double v);

/// The unit normal of a jet at (u,v), by the limit from inside the domain where S_u x S_v vanishes.
std::optional<Point> unit_normal(const Patch& patch, const PointJet& jet, double u, double v);

}  // namespace isoparm
