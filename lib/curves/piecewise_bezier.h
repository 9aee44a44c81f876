// piecewise_bezier.h -- a curve of polynomial or rational Bezier pieces: the form that lines, arcs, splines and NURBS share.
//
// Source: Farin, Curves and Surfaces for CAGD, 5th ed. 2002, ch. 5 (Bezier), 8 (splines), 13 (rational).
#pragma once
#include <vector>

#include "curve.h"

namespace isoparm {

inline constexpr int max_degree = 32;

struct BezierPiece {
    double begin = 0, end = 1;
    std::vector<Point> points;    // degree + 1
    std::vector<double> weights;  // positive, or empty when polynomial
    int degree() const { return static_cast<int>(points.size()) - 1; }
};

class PiecewiseBezier final : public Curve::Concept {
public:
    /// Pieces in order, each beginning where the last one ends; continuity[k] is that of the joint after piece k.
    PiecewiseBezier(std::vector<BezierPiece> pieces, std::vector<int> continuity);

    double begin() const override { return pieces_.front().begin; }
    double end() const override { return pieces_.back().end; }
    std::vector<Break> breaks() const override;
    void taylor(double t, int order, Vec3<double>* out) const override;
    void taylor(const Pack& t, int order, Vec3<Pack>* out) const override;
    void taylor(const Interval& t, int order, Vec3<Interval>* out) const override;
    Vec3<Polynomial> exact(const Polynomial& t) const override;
    Vec3<Quotient> quotient(const Polynomial& t) const override;
    const PiecewiseBezier* bezier() const override { return this; }

    const std::vector<BezierPiece>& pieces() const { return pieces_; }
    const std::vector<int>& continuity() const { return continuity_; }
    bool rational() const;

private:
    std::size_t piece_at(double t) const;
    const BezierPiece* piece_over(const Polynomial& t) const;
    std::vector<BezierPiece> pieces_;
    std::vector<int> continuity_;
};

Curve make_piecewise_bezier(std::vector<BezierPiece> pieces, std::vector<int> continuity);

}  // namespace isoparm
