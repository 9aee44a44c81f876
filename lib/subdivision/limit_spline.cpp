#include "subdivision/limit_spline.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "check_size.h"
#include "error.h"
#include "limit.h"

namespace isoparm {
namespace {

/// Control points -1 to m+1 of the uniform cubic spline with these values at 0 to m and these derivatives at its ends:
/// c[i-1] + 4 c[i] + c[i+1] = 6 p[i], c[1] - c[-1] = 2 d0 and so at the other end.
std::vector<Point> spline_through(const std::vector<Point>& p, const Point& d0, const Point& d1) {
    const std::size_t m = p.size() - 1;
    std::vector<Point> right(m + 1);
    std::vector<double> diagonal(m + 1, 4), upper(m + 1, 1);
    upper[0] = 2;
    for (std::size_t i = 0; i <= m; ++i) right[i] = 6.0 * p[i];
    right[0] += 2.0 * d0, right[m] += -2.0 * d1;
    for (std::size_t i = 1; i <= m; ++i) {
        const double factor = (i == m ? 2 : 1) / diagonal[i - 1];
        diagonal[i] -= factor * upper[i - 1];
        right[i] = right[i] - factor * right[i - 1];
    }
    std::vector<Point> c(m + 3);
    for (std::size_t i = m + 1; i-- > 0;) c[i + 1] = (i == m ? right[i] : right[i] - upper[i] * c[i + 2]) / diagonal[i];
    c[0] = c[2] - 2.0 * d0, c[m + 2] = c[m] + 2.0 * d1;
    return c;
}

/// What a patch has at the corners of evenly spaced cells, per cell.
class Samples {
public:
    Samples(const Patch& patch, int m, int n) : patch_(patch), m_(m), n_(n), r_(patch.rect()) {}
    Point position(int i, int j) const { return part(i, j, 0, 0); }
    Point du(int i, int j) const { return part(i, j, 1, 0); }
    Point dv(int i, int j) const { return part(i, j, 0, 1); }
    Point duv(int i, int j) const { return part(i, j, 1, 1); }

private:
    Point part(int i, int j, int a, int b) const {
        const double u = i == m_ ? r_.u1 : r_.u0 + (r_.u1 - r_.u0) * i / m_, v = j == n_ ? r_.v1 : r_.v0 + (r_.v1 - r_.v0) * j / n_;
        const PointJet x = patch_.jet(u, v);
        const double scale = (a ? (r_.u1 - r_.u0) / m_ : 1) * (b ? (r_.v1 - r_.v0) / n_ : 1);
        const Point p = scale * Point(x.x.coefficient(a, b), x.y.coefficient(a, b), x.z.coefficient(a, b));
        if (!finite(p)) throw_input("found no derivative at u = " + to_text(u) + ", v = " + to_text(v) + ", expected one for the spline to begin with; cut the patch before it");
        return p;
    }
    const Patch& patch_;
    int m_, n_;
    Rect r_;
};

/// Cells between evenly spaced lines; 1 where they are not.
int own_cells(const std::vector<double>& lines) {
    const int n = static_cast<int>(lines.size()) - 1;
    for (int k = 1; k < n; ++k)
        if (std::fabs(lines[k] - (lines[0] + (lines[n] - lines[0]) * k / n)) > 1e-9 * (lines[n] - lines[0])) return 1;
    return n;
}

SplineLevel compare(const Patch& patch, const Cage& cage, int m, int n, int samples) {
    const LimitSurface limit(cage, Scheme::catmull_clark);
    const Rect r = patch.rect();
    struct Row {
        double deviation = 0, degrees = -1;
    };
    std::vector<Row> rows(n);
    tbb::parallel_for(0, n, [&](int j) {
        for (int i = 0; i < m; ++i)
            for (int a = 0; a < samples; ++a)
                for (int b = 0; b < samples; ++b) {
                    const double s = double(a) / (samples - 1), t = double(b) / (samples - 1);
                    const LimitPoint x = limit((m + 2) * (j + 1) + i + 1, s, t);
                    const auto y = evaluate(patch, std::min(r.u0 + (r.u1 - r.u0) * (i + s) / m, r.u1), std::min(r.v0 + (r.v1 - r.v0) * (j + t) / n, r.v1));
                    const double off = distance(x.p, y.position);
                    if (!(off <= rows[j].deviation)) rows[j].deviation = off;
                    const Point normal = cross(x.du, x.dv);
                    if (!y.normal || !y.du || !y.dv || !(length(cross(*y.du, *y.dv)) > 1e-9 * (dot(*y.du, *y.du) + dot(*y.dv, *y.dv)))) continue;  // a pole
                    const double angle = degrees_between(normal, *y.normal);
                    rows[j].degrees = std::max(rows[j].degrees, angle);
                }
    });
    SplineLevel level{m, n, 0, {}, {}};
    for (const Row& row : rows) {
        if (!(row.deviation <= level.deviation)) level.deviation = row.deviation;
        if (row.degrees >= 0) level.normal_degrees = std::max(level.normal_degrees.value_or(0), row.degrees);
    }
    return level;
}

}  // namespace

Cage interpolating_cage(const Patch& patch, int m, int n) {
    if (patch.domain() == Domain::triangle) throw_input("found a surface on a triangle, expected one on a rectangle, which alone has a grid of control points");
    const Samples x(patch, m, n);
    const auto along_u = [&](int j, auto value, auto derivative) {
        std::vector<Point> p;
        for (int i = 0; i <= m; ++i) p.push_back((x.*value)(i, j));
        return spline_through(p, (x.*derivative)(0, j), (x.*derivative)(m, j));
    };
    std::vector<std::vector<Point>> rows;
    for (int j = 0; j <= n; ++j) rows.push_back(along_u(j, &Samples::position, &Samples::du));
    const auto low = along_u(0, &Samples::dv, &Samples::duv), high = along_u(n, &Samples::dv, &Samples::duv);
    Cage cage;
    cage.boundary = Cage::Boundary::none;
    cage.positions.resize(std::size_t(m + 3) * std::size_t(n + 3));
    for (int i = 0; i < m + 3; ++i) {
        std::vector<Point> p;
        for (int j = 0; j <= n; ++j) p.push_back(rows[j][i]);
        const auto column = spline_through(p, low[i], high[i]);
        for (int j = 0; j < n + 3; ++j) cage.positions[(m + 3) * j + i] = column[j];
    }
    for (int j = 0; j < n + 2; ++j)
        for (int i = 0; i < m + 2; ++i) {
            const int k = (m + 3) * j + i;
            cage.faces.push_back({k, k + 1, k + m + 4, k + m + 3});
        }
    return cage;
}

SplineReport compare_with_spline(const Member& member, int levels, int samples) {
    SplineReport report{member.name, "", {}, {}};
    const Patch& patch = member.patch;
    try {
        int m = patch.domain() == Domain::quad ? own_cells(patch.lines_u()) : 1, n = patch.domain() == Domain::quad ? own_cells(patch.lines_v()) : 1;
        for (int k = 0; k < levels && (k == 0 || m * n <= 4096); ++k, m *= 2, n *= 2) {
            Cage cage = interpolating_cage(patch, m, n);
            check_size(diagonal(cage), "a surface with a cell around it", "compare");
            SplineLevel level = compare(patch, cage, m, n, samples);
            const double noise = 1e3 * std::numeric_limits<double>::epsilon() * reach(cage);
            if (k > 0 && level.deviation > noise) level.ratio = report.levels.back().deviation / level.deviation;
            report.levels.push_back(level);
            report.finest = std::move(cage);
        }
    } catch (const Error& e) {
        report.refused = e.what();
    }
    return report;
}

}  // namespace isoparm
