#include "drawing/comb.h"

#include <algorithm>
#include <cmath>

namespace isoparm {

Point curvature_vector(const Curve& curve, double t) {
    Point x[3];
    curve.taylor(t, 2, x);
    const Point d = x[1], dd = 2.0 * x[2];
    const double speed = dot(d, d);
    const Point k = (dd - (dot(dd, d) / speed) * d) / speed;
    return finite(k) ? k : Point();
}

namespace {

std::vector<double> parameters(const Curve& curve, int teeth) {
    std::vector<double> list;
    for (int k = 0; k < teeth; ++k) list.push_back(k + 1 == teeth ? curve.end() : curve.begin() + (curve.end() - curve.begin()) * k / (teeth - 1));
    for (const Break& b : curve.breaks()) list.insert(list.end(), {std::nextafter(b.t, curve.begin()), b.t});  // at a break: of the piece to its right
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
    return list;
}

}  // namespace

std::vector<std::array<Point, 2>> comb_teeth(const Curve& curve, const Comb& comb, double size) {
    std::vector<std::array<Point, 2>> teeth;
    if (comb.teeth < 2) return teeth;
    double most = 0;
    for (const double t : parameters(curve, comb.teeth)) {
        teeth.push_back({curve(t), curvature_vector(curve, t)});
        most = std::max(most, length(teeth.back()[1]));
    }
    const double scale = comb.scale ? *comb.scale : most > 0 ? size / 8 / most : 0;
    for (auto& [foot, tip] : teeth) tip = foot - scale * tip;
    return teeth;
}

}  // namespace isoparm
