#include "patches/control_net.h"

#include <cmath>

#include "curves/bspline.h"
#include "patches/compatibility.h"
#include "patches/coons.h"

namespace isoparm {
namespace {

void require_same_basis(const char* names, const SplineCurve& a, const SplineCurve& b) {
    if (a.degree != b.degree)
        throw_input(std::string(names) + ": found degrees " + std::to_string(a.degree) + " and " + std::to_string(b.degree) + ", expected the same");
    const double tolerance = compatibility_tolerance * (a.knots.back() - a.knots.front());
    bool same = a.knots.size() == b.knots.size();
    for (std::size_t k = 0; same && k < a.knots.size(); ++k) same = std::abs(a.knots[k] - b.knots[k]) <= tolerance;
    if (!same) throw_input(std::string(names) + ": found different knots, expected the same: insert the knots that the other one has");
}

/// Knots with the domain [0,1].
std::vector<double> unit_knots(const SplineCurve& c) {
    const double begin = c.knots[c.degree], end = c.knots[c.points.size()];
    std::vector<double> knots;
    for (const double k : c.knots) knots.push_back((k - begin) / (end - begin));
    return knots;
}

/// Greville abscissae: the control values of the function t. Only with these is the net's surface the Coons patch of the curves.
std::vector<double> greville(int degree, const std::vector<double>& knots, std::size_t points) {
    std::vector<double> s;
    for (std::size_t i = 0; i < points; ++i) {
        double sum = 0;
        for (int k = 1; k <= degree; ++k) sum += knots[i + static_cast<std::size_t>(k)];
        s.push_back(sum / degree);
    }
    return s;
}

}  // namespace

Grid<Point> coons_net(const ControlFrame& frame) {
    const auto &[c0, c1, d0, d1] = frame;
    for (const auto& [name, c] : {std::pair{"c0", &c0}, {"c1", &c1}, {"d0", &d0}, {"d1", &d1}}) check_knots(c->degree, c->knots, c->points.size(), name);
    require_same_basis("c0, c1", c0, c1);
    require_same_basis("d0, d1", d0, d1);
    const auto curve = [](const SplineCurve& c) { return make_bspline(c.degree, unit_knots(c), c.points); };
    const CoonsCurves x = closed_frame({curve(c0), curve(c1), curve(d0), curve(d1)});
    const Point p00 = x.c0(0), p10 = x.c0(1), p01 = x.c1(0), p11 = x.c1(1);
    const auto s = greville(c0.degree, unit_knots(c0), c0.points.size()), t = greville(d0.degree, unit_knots(d0), d0.points.size());
    Grid<Point> net(s.size());
    for (std::size_t i = 0; i < s.size(); ++i)
        for (std::size_t j = 0; j < t.size(); ++j) {
            const double u = s[i], v = t[j];
            net[i].push_back((1 - u) * d0.points[j] + u * d1.points[j] + (1 - v) * c0.points[i] + v * c1.points[i] -
                             ((1 - u) * ((1 - v) * p00 + v * p01) + u * ((1 - v) * p10 + v * p11)));
        }
    return net;
}

Patch make_control_net(const ControlFrame& frame) {
    const auto net = coons_net(frame);
    return make_bspline_patch(frame.c0.degree, frame.d0.degree, unit_knots(frame.c0), unit_knots(frame.d0), net);
}

}  // namespace isoparm
