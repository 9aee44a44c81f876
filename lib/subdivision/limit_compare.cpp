#include "subdivision/limit_compare.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "curves/bezier.h"
#include "error.h"
#include "patches/coons.h"

namespace isoparm {
namespace {

/// Bezier points of the cubic with these ends and end derivatives.
std::array<Point, 4> cubic_between(const Point& x0, const Point& d0, const Point& d1, const Point& x1) {
    return {x0, x0 + d0 / 3.0, x1 - d1 / 3.0, x1};
}
/// Bezier points of the cubic with these values at 0, 1/4, 3/4, 1: parameters that are exact in binary, weights that
/// amplify rounding five times at most.
std::array<Point, 4> cubic_through(const Point& x0, const Point& x1, const Point& x2, const Point& x3) {
    return {x0, (-10.0 * x0 + 24.0 * x1 - 8.0 * x2 + 3.0 * x3) / 9.0, (3.0 * x0 - 8.0 * x1 + 24.0 * x2 - 10.0 * x3) / 9.0, x3};
}

/// What the limit shows along one edge line of a face: the curve, and the derivative across it.
struct KnotLine {
    std::array<Point, 4> curve, cross;
    Point tangent(int end) const { return 3.0 * (end == 0 ? curve[1] - curve[0] : curve[3] - curve[2]); }
};
KnotLine knot_line_u(const LimitSurface& limit, int face, double v) {
    const LimitPoint a = limit(face, 0, v), b = limit(face, 0.25, v), c = limit(face, 0.75, v), d = limit(face, 1, v);
    return {cubic_between(a.p, a.du, d.du, d.p), cubic_through(a.dv, b.dv, c.dv, d.dv)};
}
KnotLine knot_line_v(const LimitSurface& limit, int face, double u) {
    const LimitPoint a = limit(face, u, 0), b = limit(face, u, 0.25), c = limit(face, u, 0.75), d = limit(face, u, 1);
    return {cubic_between(a.p, a.dv, d.dv, d.p), cubic_through(a.du, b.du, c.du, d.du)};
}

Curve bezier(const std::array<Point, 4>& b) { return make_bezier({b.begin(), b.end()}); }

/// Keeps the largest; NaN counts as larger than everything, so that it is never overlooked.
void grow(std::optional<double>& largest, double x) {
    if (!largest || x > *largest || std::isnan(x)) largest = std::isnan(x) ? std::numeric_limits<double>::infinity() : x;
}
void grow(std::optional<double>& largest, const std::optional<double>& x) {
    if (x) grow(largest, *x);
}

/// Nothing where a derivative vanishes but for rounding, or both are parallel: there is no normal to compare.
std::optional<Point> normal(const Point& du, const Point& dv, double noise) {
    if (!(length(du) > noise) || !(length(dv) > noise)) return {};
    const Point n = cross(normalized(du), normalized(dv));
    return length(n) > 1e-6 ? std::optional(normalized(n)) : std::nullopt;
}

/// First derivatives of a patch.
struct Tangents {
    Point p, du, dv;
};
Tangents tangents(const Patch& patch, double u, double v) {
    const PointJet j = patch.jet(u, v);
    const auto part = [&](int a, int b) { return Point(j.x.coefficient(a, b), j.y.coefficient(a, b), j.z.coefficient(a, b)); };
    return {part(0, 0), part(1, 0), part(0, 1)};
}

struct FaceReport {
    std::optional<Patch> patch;
    std::optional<double> deviation, normal_degrees, network_gap, bilinear_coons;
    double u = 0, v = 0;
};

double network_gap(const LimitSurface& limit, int face, const HermiteData& data) {
    double gap = 0;
    for (const int i : {0, 1})
        for (const int j : {0, 1}) {
            const LimitPoint x = limit(face, i, j);
            const Point from_f = data.f[1 + i].derivative(j), from_g = data.g[1 + j].derivative(i);
            gap = std::max({gap, distance(data.g[3 * j].derivative(i), x.du), distance(data.f[3 * i].derivative(j), x.dv),
                            distance(from_f, from_g), distance(from_f, x.duv), distance(from_g, x.duv)});
        }
    return gap;
}

FaceReport compare_face(const LimitSurface& limit, int face, int samples, double noise) {
    const HermiteData data = limit_network(limit, face);
    FaceReport report;
    report.network_gap = network_gap(limit, face, data);
    // The twists differ by rounding only, or the gap tells: their mean serves.
    report.patch = make_coons_hermite(data, Twist::average);
    const Patch bilinear = make_coons({data.g[0], data.g[3], data.f[0], data.f[3]});
    for (int i = 0; i < samples; ++i)
        for (int j = 0; j < samples; ++j) {
            const double u = double(i) / (samples - 1), v = double(j) / (samples - 1);
            const LimitPoint x = limit(face, u, v);
            const Tangents s = tangents(*report.patch, u, v);
            const double d = distance(s.p, x.p);
            if (!report.deviation || !(d <= *report.deviation)) report.u = u, report.v = v;
            grow(report.deviation, d);
            grow(report.bilinear_coons, distance(bilinear.point(u, v), x.p));
            const auto n = normal(x.du, x.dv, noise), m = normal(s.du, s.dv, noise);
            if (n && m) grow(report.normal_degrees, degrees_between(*n, *m));
        }
    return report;
}

/// A point of edge k of a face at t along it, and there the derivatives along the edge and into the face.
struct EdgePoint {
    Point p, along, inward;
};
EdgePoint edge_point(const Patch& patch, int k, double t) {
    switch (k) {
        case 0: { const Tangents s = tangents(patch, t, 0); return {s.p, s.du, s.dv}; }
        case 1: { const Tangents s = tangents(patch, 1, t); return {s.p, s.dv, -s.du}; }
        case 2: { const Tangents s = tangents(patch, 1 - t, 1); return {s.p, -s.du, -s.dv}; }
        default: { const Tangents s = tangents(patch, 0, 1 - t); return {s.p, -s.dv, s.du}; }
    }
}

void compare_edge(const LimitEdge& edge, const Patch& a, const Patch& b, int samples, double noise, LimitReport::Edges& report) {
    ++report.compared;
    for (int i = 0; i < samples; ++i) {
        const double t = double(i) / (samples - 1);
        const EdgePoint x = edge_point(a, edge.a.edge, t), y = edge_point(b, edge.b.edge, edge.same_direction ? t : 1 - t);
        grow(report.c0, distance(x.p, y.p));
        grow(report.c1, length(x.inward + y.inward));  // what goes into one face comes out of the other
        const auto n = normal(x.along, x.inward, noise), m = normal(x.along, -y.inward, noise);
        if (n && m) grow(report.g1_degrees, degrees_between(*n, *m));
    }
}

void count(const LimitSurface& limit, LimitReport& report) {
    for (int f = 0; f < limit.faces(); ++f) {
        const LimitFace kind = limit.kind(f);
        ++(kind == LimitFace::regular ? report.regular : kind == LimitFace::irregular ? report.irregular : report.without_limit);
        if (kind != LimitFace::regular) report.not_compared.push_back({f, limit.reason(f)});
    }
}

}  // namespace

HermiteData limit_network(const LimitSurface& limit, int face) {
    std::array<KnotLine, 2> f, g;  // along v at u = 0, 1; along u at v = 0, 1
    for (const int k : {0, 1}) f[k] = knot_line_v(limit, face, k), g[k] = knot_line_u(limit, face, k);
    for (const int i : {0, 1})
        for (const int j : {0, 1}) {
            f[i].cross[3 * j] = g[j].tangent(i);
            g[j].cross[3 * i] = f[i].tangent(j);
        }
    return {{bezier(f[0].curve), bezier(f[0].cross), bezier(f[1].cross), bezier(f[1].curve)},
            {bezier(g[0].curve), bezier(g[0].cross), bezier(g[1].cross), bezier(g[1].curve)}};
}

bool LimitReport::identity_holds() const { return deviation.value_or(0) <= tolerance && network_gap.value_or(0) <= tolerance; }

LimitReport compare_limit(const LimitSurface& limit, const LimitOptions& options) {
    if (options.samples < 2 || options.samples > 1025)
        throw Error(ErrorKind::usage, "samples each way over a face: found " + std::to_string(options.samples) + ", expected 2 to 1025");
    LimitReport report;
    report.scheme = limit.scheme();
    report.faces = limit.faces();
    report.samples = options.samples;
    report.size = reach(limit.cage()), report.diagonal = diagonal(limit.cage());
    report.tolerance = 200 * std::numeric_limits<double>::epsilon() * report.size;
    count(limit, report);
    if (limit.scheme() == Scheme::loop) return report;

    std::vector<FaceReport> faces(limit.faces());
    tbb::parallel_for(0, limit.faces(), [&](int f) {
        if (limit.kind(f) == LimitFace::regular) faces[f] = compare_face(limit, f, options.samples, report.tolerance);
    });
    for (int f = 0; f < limit.faces(); ++f) {
        const FaceReport& r = faces[f];
        if (r.deviation && (report.worst_face < 0 || *r.deviation > *report.deviation))
            report.worst_face = f, report.worst_u = r.u, report.worst_v = r.v;
        grow(report.deviation, r.deviation);
        grow(report.normal_degrees, r.normal_degrees);
        grow(report.network_gap, r.network_gap);
        grow(report.bilinear_coons, r.bilinear_coons);
    }
    for (const LimitEdge& e : limit.shared_edges()) {
        const auto &a = faces[e.a.face].patch, &b = faces[e.b.face].patch;
        if (!a || !b) continue;
        if (e.smooth) compare_edge(e, *a, *b, options.samples, report.tolerance, report.edges);
        else ++report.edges.creases;
    }
    return report;
}

}  // namespace isoparm
