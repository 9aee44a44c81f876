// brep.cpp -- the 3D curves of OpenCASCADE's ASCII BREP files.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "curves/line.h"
#include "curves/modify.h"
#include "io/curve_records.h"

namespace isoparm {
namespace {

constexpr int kMostNested = 10;  // trimmed curves of trimmed curves

/// A record: a curve over its own range, or one that is only a curve when it is cut.
struct Basis {
    FileCurve own;
    enum class Kind { curve, line, conic, other } kind = Kind::curve;
    Point origin, x, y;  // origin + t x of lines, origin + cos(t) x + sin(t) y of conics
};

/// Rational quadratic arcs of equal angle, at most a right one.
Curve arcs(const Basis& b, double from, double to) {
    const int count = std::max(1, int(std::ceil((to - from) / (std::numbers::pi / 2) - 1e-12)));
    const double step = (to - from) / count, middle = std::cos(step / 2);
    std::vector<BezierPiece> pieces;
    const auto at = [&](double angle, double radius) { return b.origin + radius * (std::cos(angle) * b.x + std::sin(angle) * b.y); };
    const bool whole = to - from == 2 * std::numbers::pi;
    Point last = at(from, 1);
    for (int k = 0; k < count; ++k) {
        const double a = from + k * step, end = k + 1 == count ? to : from + (k + 1) * step;
        const Point next = whole && k + 1 == count ? at(from, 1) : at(end, 1);
        pieces.push_back({a, end, {last, at(a + step / 2, 1 / middle), next}, {1, middle, 1}});
        last = next;
    }
    return make_piecewise_bezier(std::move(pieces), std::vector<int>(std::size_t(count - 1), 1));
}

class BrepReader : CurveRecords {
public:
    using CurveRecords::CurveRecords;

    std::vector<FileCurve> run() {
        std::string_view word = in.read();
        if (word != "DBRep_DrawableShape" && word != "CASCADE") in.fail("DBRep_DrawableShape or CASCADE Topology, the begin of an OpenCASCADE file in ASCII");
        while (word != "Curves") {
            if ((word = in.read()).empty()) in.fail("the section Curves");
        }
        const int count = in.integer([] { return std::string("the number of curves"); }, 0, kMostCurves);
        if (count == 0) in.fail("at least one curve");
        while (int(curves.size()) < count) {
            FileCurve c = record(0).own;
            curves.push_back(std::move(c));
        }
        return std::move(curves);
    }

private:
    Basis record(int depth) {
        const int kind = integer("the kind", 1, 9);
        const std::size_t place = in.place();
        Basis b;
        switch (kind) {
            case 1: b = line(); break;
            case 2: b = conic(1); break;
            case 3: b = conic(2); break;
            case 4: b = passed_over(13, "a parabola, which is not supported"); break;
            case 5: b = passed_over(14, "a hyperbola, which is not supported"); break;
            case 6: b = bezier(); break;
            case 7: b = bspline(place); break;
            case 8: b = trimmed(place, depth); break;
            default: b = offset(depth);
        }
        b.own.place = place;
        return b;
    }

    Basis line() {
        Basis b;
        b.kind = Basis::Kind::line;
        b.origin = point("the origin"), b.x = point("the direction");
        b.own.unusable = "an infinite line: only a part of one (kind 8, trimmed) is a curve";
        return b;
    }
    Basis conic(int radii) {
        Basis b;
        b.kind = Basis::Kind::conic;
        b.origin = point("the centre");
        point("the axis");
        b.x = point("the direction x"), b.y = point("the direction y");
        double r[2];
        for (int k = 0; k < radii; ++k)
            if (!((r[k] = number("a radius")) > 0)) in.fail(of_curve("a positive radius"));
        b.x = r[0] * b.x, b.y = r[radii - 1] * b.y;
        b.own.curve = made(in.place(), [&] { return arcs(b, 0, 2 * std::numbers::pi); });
        return b;
    }
    Basis passed_over(int numbers, const char* what) {
        for (int k = 0; k < numbers; ++k) number("a number");
        return other(what);
    }
    static Basis other(const char* what) {
        Basis b;
        b.kind = Basis::Kind::other;
        b.own.unusable = what;
        return b;
    }
    Basis bezier() {
        Basis b;
        const std::size_t place = in.place();
        const bool rational = integer("whether it is rational", 0, 1);
        const int degree = integer("the degree", 1, max_degree);
        std::vector<double> weights = poles(b, degree + 1, rational);
        b.own.curve = made(place, [&] { return make_piecewise_bezier({{0, 1, b.own.points, weights}}, {}); });
        return b;
    }
    std::vector<double> poles(Basis& b, int count, bool rational) {
        std::vector<double> weights;
        for (int k = 0; k < count; ++k) {
            b.own.points.push_back(point("a pole"));
            if (!rational) continue;
            weights.push_back(number("a weight"));
            if (!(weights.back() > 0)) in.fail(of_curve("a positive weight"));
        }
        return weights;
    }
    Basis bspline(std::size_t place) {
        Basis b;
        const bool rational = integer("whether it is rational", 0, 1), periodic = integer("whether it is periodic", 0, 1);
        const int degree = integer("the degree", 1, max_degree), count = pole_count(periodic ? 2 : degree + 1);
        const int different = integer("the number of different knots", 2, kMostPoles + 2);
        std::vector<double> weights = poles(b, count, rational), knots;
        std::vector<int> times;
        long sum = 0;
        for (int k = 0; k < different; ++k) {
            knots.push_back(number("a knot"));
            if (k > 0 && !(knots[std::size_t(k)] > knots[std::size_t(k - 1)])) in.fail(of_curve("a knot above the one before"));
            times.push_back(integer("the multiplicity of a knot", 1, degree + 1));
            sum += times.back();
        }
        const long expected = periodic ? count + times.back() : count + degree + 1;
        if (sum != expected || (periodic && (times.front() != times.back() || times.front() > degree)))
            in.fail(of_curve("multiplicities") + " that add up to " + std::to_string(expected) + (periodic ? ", the first as the last and at most the degree" : " = poles + degree + 1") + "; they add up to " + std::to_string(sum));
        std::vector<Point> points = b.own.points;
        std::vector<double> flat;
        for (int k = 0; k < different; ++k) flat.insert(flat.end(), std::size_t(times[std::size_t(k)]), knots[std::size_t(k)]);
        if (periodic) unroll(degree, times.front(), flat, points, weights);
        b.own.curve = made(place, [&] { return make_bspline(degree, flat, points, weights); });
        return b;
    }
    /// One period of a periodic curve: knots of the neighbouring periods on both sides, and the first poles again behind the last
    /// (OpenCASCADE, BSplCLib::KnotSequence and PoleIndex: the first span uses the poles 0..degree).
    static void unroll(int degree, int first_times, std::vector<double>& flat, std::vector<Point>& points, std::vector<double>& weights) {
        const double period = flat.back() - flat.front();
        const std::size_t more = std::size_t(degree + 1 - first_times), n = points.size();
        std::vector<double> all;
        const auto knot = [&](std::ptrdiff_t i) {  // of all periods: n of them are one, from `flat`'s first
            const std::ptrdiff_t size = std::ptrdiff_t(n), turn = i >= 0 ? i / size : -((size - 1 - i) / size);
            return flat[std::size_t(i - turn * size)] + double(turn) * period;
        };
        for (std::ptrdiff_t i = -std::ptrdiff_t(more); i < std::ptrdiff_t(flat.size() + more); ++i) all.push_back(i >= 0 && i < std::ptrdiff_t(flat.size()) ? flat[std::size_t(i)] : knot(i));
        for (std::size_t k = 0; k < more; ++k) {
            points.push_back(points[k % n]);
            if (!weights.empty()) weights.push_back(weights[k % n]);
        }
        flat = std::move(all);
    }
    Basis trimmed(std::size_t place, int depth) {
        if (depth >= kMostNested) in.fail_at(place, "trimmed curves of trimmed curves, " + std::to_string(depth) + " deep", "fewer");
        const double from = number("the first parameter"), to = number("the last parameter");
        if (!(from < to)) in.fail(of_curve("a last parameter above the first"));
        Basis b = record(depth + 1);
        FileCurve& c = b.own;
        if (b.kind == Basis::Kind::line) {
            c.unusable.clear();
            c.points = {b.origin + from * b.x, b.origin + to * b.x};
            c.curve = made(place, [&] { return reparametrized(make_line(c.points[0], c.points[1]), from, to); });
        } else if (b.kind == Basis::Kind::conic) {
            if (!(to - from <= 2 * std::numbers::pi * (1 + 1e-12))) in.fail_at(place, "a part of more than one turn", of_curve("at most one turn"));
            c.curve = made(place, [&] { return arcs(b, from, to); });
        } else if (c.curve) {
            // Other programs write the ends with fewer digits than the knots: rounding is not a part outside.
            const double slack = 1e-9 * (c.curve->end() - c.curve->begin());
            const double a = from > c.curve->begin() - slack ? std::max(from, c.curve->begin()) : from, e = to < c.curve->end() + slack ? std::min(to, c.curve->end()) : to;
            c.points.clear();
            c.curve = made(place, [&] { return segment(*c.curve, a, e, false); });
        }
        b.kind = c.curve ? Basis::Kind::curve : b.kind;
        return b;
    }
    Basis offset(int depth) {
        if (depth >= kMostNested) in.fail("fewer curves made of curves");
        number("the offset");
        point("the direction");
        record(depth + 1);
        return other("an offset curve, which is not supported");
    }
};

}  // namespace

std::vector<FileCurve> read_brep_curves(const std::string& text, const std::string& path) { return BrepReader(text, path).run(); }

}  // namespace isoparm
