// io/curve_file.h -- curves from other programs' files: OpenCASCADE's ASCII BREP (its 3D curves only) and LOP loops.
//
// `text` is the whole file, `path` is for messages only: they give path:line:column, what was found and what was expected. Throws
// Error(input). At most 10 000 poles a curve and 100 000 a file. Safe to call from every thread.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "curve.h"

namespace isoparm {

struct FileCurve {
    std::optional<Curve> curve;
    std::vector<Point> points;  // its control points, of Bezier and B-spline curves
    std::string unusable;       // why there is no curve: "an infinite line ..."
    std::size_t place = 0;      // bytes from the begin of the file
};

/// The section "Curves" of a file "DBRep_DrawableShape" or "CASCADE Topology V...", records in their order: 1 line, 2 circle, 3 ellipse, 6 Bezier,
/// 7 B-spline (periodic ones are unrolled over one period), 8 trimmed. A circle or ellipse is made of exact rational arcs of at most 90 degrees, so it
/// runs at another speed than OpenCASCADE's, whose parameter is an angle. Lines and the kinds 4 parabola, 5 hyperbola and 9 offset are no curves of
/// their own here, but a trimmed line is. (Format: "BRep Format" of the OpenCASCADE documentation, 5.1.)
std::vector<FileCurve> read_brep_curves(const std::string& text, const std::string& path);

/// How many curves; for each its degree, count of knots, knots, count of points, points; nothing after them.
std::vector<FileCurve> read_lop(const std::string& text, const std::string& path);

/// Either, by the name's ending; `expected_curve_file` says which there are.
std::vector<FileCurve> read_curve_file(const std::string& text, const std::string& path);
inline constexpr const char* expected_curve_file = "a file that ends in .brep, .brp or .lop";

}  // namespace isoparm
