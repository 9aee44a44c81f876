// lop.cpp -- closed loops of B-splines, as the transfinite-patch models of P. Salvi have them.
#include <filesystem>

#include "io/curve_records.h"
#include "io/extension.h"

namespace isoparm {
namespace {

class LopReader : CurveRecords {
public:
    using CurveRecords::CurveRecords;

    std::vector<FileCurve> run() {
        const int count = in.integer([] { return std::string("the number of curves"); }, 1, kMostCurves);
        while (int(curves.size()) < count) curves.push_back(bspline());
        if (!in.read().empty()) in.fail("the end of the file after " + std::to_string(count) + (count == 1 ? " curve" : " curves"));
        return std::move(curves);
    }

private:
    FileCurve bspline() {
        FileCurve c;
        const int degree = integer("the degree", 1, max_degree);
        c.place = in.place();
        const int count = integer("the number of knots", 2 * degree + 2, kMostPoles + degree + 1);
        std::vector<double> knots;
        while (int(knots.size()) < count) knots.push_back(number("a knot"));
        const int points = pole_count(degree + 1);
        if (points != count - degree - 1) in.fail(std::to_string(count - degree - 1) + " points for " + std::to_string(count) + " knots and degree " + std::to_string(degree));
        while (int(c.points.size()) < points) c.points.push_back(point("a point"));
        c.curve = made(c.place, [&] { return make_bspline(degree, knots, c.points); });
        return c;
    }
};

}  // namespace

std::vector<FileCurve> read_lop(const std::string& text, const std::string& path) { return LopReader(text, path).run(); }

std::vector<FileCurve> read_curve_file(const std::string& text, const std::string& path) {
    const std::string extension = extension_of(path);
    if (extension == ".lop") return read_lop(text, path);
    if (extension == ".brep" || extension == ".brp") return read_brep_curves(text, path);
    throw_input(path + ": found the ending '" + extension + "', expected " + expected_curve_file);
}

}  // namespace isoparm
