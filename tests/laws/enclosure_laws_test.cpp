// enclosure_laws_test.cpp -- what is proved over a box holds at every point of it. New types: one row in samples_*.cpp.
//
// Jets in doubles are rounded, so they may leave an enclosure by rounding (kSlack); where the exact value can be had in
// quadruple precision the law is checked without any slack.
#include <gtest/gtest.h>

#include "curves/bezier.h"
#include "patches/bezier_triangle.h"
#include "patches/coons.h"
#include "patches/tensor_bezier.h"
#include "samples.h"

namespace isoparm::tests {
namespace {

constexpr int kInstances = 3;
constexpr double kSlack = 1e-13;

class EnclosureLaw : public ::testing::TestWithParam<PatchType> {
protected:
    template <class F> void each(F law, int instances = kInstances) const {
        for (int seed = 1; seed <= instances; ++seed) {
            SCOPED_TRACE("seed " + std::to_string(seed));
            Random random(seed);
            const Patch patch = GetParam().make(random).patch;
            law(patch, random);
        }
    }
};

bool strictly_inside(const Patch& p, const Box& b) {
    const Rect r = p.rect();
    if (p.domain() == Domain::triangle) return b.u.lo > 0 && b.v.lo > 0 && b.u.hi + b.v.hi < 1;
    const auto holds = [](const std::vector<double>& breaks, const Interval& t) {
        return std::any_of(breaks.begin(), breaks.end(), [&](double x) { return t.contains(x); });
    };
    return b.u.lo > r.u0 && b.u.hi < r.u1 && b.v.lo > r.v0 && b.v.hi < r.v1 && !holds(p.breaks_u(), b.u) &&
           !holds(p.breaks_v(), b.v);
}
/// A box of the domain: anywhere, at a corner or vertex, on an edge, straddling or touching a break; of any size.
Box random_box(Random& r, const Patch& p, int n) {
    const Rect d = p.rect();
    double wu = (d.u1 - d.u0) * std::pow(10, -r.number(0, 7)), wv = (d.v1 - d.v0) * std::pow(10, -r.number(0, 7));
    Vec2 at = random_parameter(r, p);
    if (n % 4 == 1) at = p.edge_point(r.integer(0, p.edges() - 1), r.integer(0, 1));
    if (n % 4 == 2) at = p.edge_point(r.integer(0, p.edges() - 1), r.number());
    if (const auto b = p.breaks_u(); n % 4 == 3 && !b.empty()) at.x = b[r.integer(0, int(b.size()) - 1)];
    if (const auto b = p.breaks_v(); n % 8 == 3 && !b.empty()) at.y = b[r.integer(0, int(b.size()) - 1)];
    const double su = r.integer(0, 2) / 2.0, sv = r.integer(0, 2) / 2.0;  // the point is at an end or in the middle
    const double top_u = p.domain() == Domain::triangle ? 1 : d.u1, top_v = p.domain() == Domain::triangle ? 1 : d.v1;
    return {{std::max(d.u0, at.x - su * wu), std::min(top_u, at.x + (1 - su) * wu)},
            {std::max(d.v0, at.y - sv * wv), std::min(top_v, at.y + (1 - sv) * wv)}};
}
bool in_domain(const Patch& p, double u, double v) { return p.domain() == Domain::quad || u + v <= 1; }
/// On the high side of a box, a break belongs to the cell beyond: not part of the box.
bool of_next_cell(const std::vector<double>& breaks, const Interval& t, double x) {
    return x == t.hi && t.lo < t.hi && std::find(breaks.begin(), breaks.end(), x) != breaks.end();
}

TEST_P(EnclosureLaw, HoldsJetsOfAllItsPoints) {
    each([](const Patch& patch, Random& r) {
        const double size = size_of_sample(patch);
        for (int n = 0; n < 60; ++n) {
            const Box box = random_box(r, patch, n);
            const Enclosure e = patch.enclose(box);
            for (int s = 0; s < 8; ++s) {
                double u = r.number(box.u.lo, box.u.hi), v = r.number(box.v.lo, box.v.hi);
                if (s < 4) u = s % 2 ? box.u.hi : box.u.lo, v = s / 2 ? box.v.hi : box.v.lo;
                if (!in_domain(patch, u, v) || of_next_cell(patch.breaks_u(), box.u, u) ||
                    of_next_cell(patch.breaks_v(), box.v, v))
                    continue;
                const PointJet x = patch.jet(u, v);
                for (int axis = 0; axis < 3; ++axis)
                    for (int k = 0; k < x.x.size; ++k) {
                        const double value = x[axis].c[k];
                        if (std::isnan(value)) continue;  // does not exist there
                        const double slack = kSlack * (10 * size + std::abs(value) + std::abs(x.x.c[k]) +
                                                       std::abs(x.y.c[k]) + std::abs(x.z.c[k]));
                        const Interval& bound = e.over[axis].c[k];
                        EXPECT_TRUE(value >= bound.lo - slack && value <= bound.hi + slack)
                            << "coefficient " << k << " = " << value << " not in [" << bound.lo << ", " << bound.hi
                            << "] at " << u << ", " << v << " in [" << box.u.lo << ", " << box.u.hi << "] x ["
                            << box.v.lo << ", " << box.v.hi << "]";
                    }
            }
        }
    });
}

TEST_P(EnclosureLaw, HoldsByTheMeanValueTheorem) {
    // (f(q) - f(p)) / |q - p| along a parameter is a derivative of f somewhere between, or, across a jump of it, lies
    // between the derivatives of both sides. So chords of each order are held by the bound of the next, breaks or not.
    each([](const Patch& patch, Random& r) {
        const double size = size_of_sample(patch);
        for (int n = 0; n < 60; ++n) {
            const Box box = random_box(r, patch, n);
            const Enclosure e = patch.enclose(box);
            for (int s = 0; s < 4; ++s) {
                const double u = r.number(box.u.lo, box.u.hi), v = r.number(box.v.lo, box.v.hi),
                             u2 = r.number(box.u.lo, box.u.hi), v2 = r.number(box.v.lo, box.v.hi);
                if (!in_domain(patch, u, v) || !in_domain(patch, u2, v) || !in_domain(patch, u, v2)) continue;
                const PointJet p = patch.jet(u, v), pu = patch.jet(u2, v), pv = patch.jet(u, v2);
                for (int axis = 0; axis < 3; ++axis)
                    for (int k = 1; k < e.over.x.size; ++k) {
                        const auto [i, j] = e.over.x.powers[k];
                        const Interval& bound = e.over[axis].c[k];
                        const auto check = [&](const PointJet& q, double step, int below_i, int below_j,
                                               double factor) {
                            if (below_i < 0 || below_j < 0 || step == 0) return;
                            const double a = p[axis].coefficient(below_i, below_j),
                                         b = q[axis].coefficient(below_i, below_j);
                            if (std::isnan(a) || std::isnan(b)) return;
                            const double chord = (b - a) / (step * factor),
                                         slack = 1e-12 * (10 * size + std::abs(a) + std::abs(b)) / std::abs(step);
                            EXPECT_TRUE(chord >= bound.lo - slack && chord <= bound.hi + slack)
                                << chord << " not in [" << bound.lo << ", " << bound.hi << "], coefficient (" << i
                                << "," << j << ") at " << u << ", " << v;
                        };
                        check(pu, u2 - u, i - 1, j, i);
                        check(pv, v2 - v, i, j - 1, j);
                    }
            }
        }
    });
}

TEST_P(EnclosureLaw, CentreIsTheMiddle) {
    each([](const Patch& patch, Random& r) {
        const double size = size_of_sample(patch);
        for (int n = 0; n < 40; ++n) {
            const Box box = random_box(r, patch, n);
            const Enclosure e = patch.enclose(box);
            EXPECT_EQ(e.u, mid(box.u));
            EXPECT_EQ(e.v, mid(box.v));
            if (!in_domain(patch, e.u, e.v)) continue;
            if (std::max(box.u.hi - box.u.lo, box.v.hi - box.v.lo) < 1e-6)
                continue;  // next to a singular corner rounding is large
            const PointJet x = patch.jet(e.u, e.v);
            for (int axis = 0; axis < 3; ++axis)
                for (int k = 0; k < x.x.size; ++k) {
                    const double value = x[axis].c[k], slack = 1e-11 * (10 * size + std::abs(value));
                    if (std::isnan(value)) continue;
                    const Interval& bound = e.centre[axis].c[k];
                    EXPECT_TRUE(value >= bound.lo - slack && value <= bound.hi + slack) << "coefficient " << k;
                    EXPECT_TRUE(!strictly_inside(patch, box) ||
                                bound.hi - bound.lo <= 1e-6 * (10 * size + std::abs(value)))
                        << "coefficient " << k << " of a point should be tight";
                }
        }
    });
}

TEST_P(EnclosureLaw, PointsAreHeldTightly) {
    each([](const Patch& patch, Random& r) {
        const double size = size_of_sample(patch);
        for (int n = 0; n < 60; ++n) {
            Vec2 p = random_parameter(r, patch);
            if (n % 3 == 1) p = patch.edge_point(n % patch.edges(), n % 2 ? r.number() : n % 4 / 2);
            if (const auto b = patch.breaks_u(); n % 3 == 2 && !b.empty()) p.x = b[r.integer(0, int(b.size()) - 1)];
            const Vec3<Interval> e = patch.enclose_point(p.x, p.y);
            const Point x = patch.point(p.x, p.y);
            for (int axis = 0; axis < 3; ++axis) {
                EXPECT_LE(e[axis].lo - kSlack * size, x[axis]);
                EXPECT_GE(e[axis].hi + kSlack * size, x[axis]);
                EXPECT_LE(e[axis].hi - e[axis].lo, 1e-11 * size) << p.x << ", " << p.y;
            }
        }
    });
}

TEST_P(EnclosureLaw, ShrinksWithTheBox) {
    each([](const Patch& patch, Random& r) {
        const double size = size_of_sample(patch);
        const Rect d = patch.rect();
        for (int n = 0; n < 10; ++n) {
            const Vec2 p = random_parameter(r, patch, 0.05);
            const double h = 1e-5;
            const Box box{{p.x - h * (d.u1 - d.u0), p.x + h * (d.u1 - d.u0)},
                          {p.y - h * (d.v1 - d.v0), p.y + h * (d.v1 - d.v0)}};
            if (!strictly_inside(patch, box)) continue;
            const Enclosure e = patch.enclose(box);
            for (int axis = 0; axis < 3; ++axis)
                for (int k = 0; k < e.over.x.size; ++k) {
                    const int order = e.over.x.powers[k].first + e.over.x.powers[k].second;
                    ASSERT_TRUE(e.over[axis].c[k].bounded()) << "coefficient " << k << " at " << p.x << ", " << p.y;
                    EXPECT_TRUE(order == 3 ||
                                e.over[axis].c[k].hi - e.over[axis].c[k].lo <= h * std::pow(20, order + 2) * size)
                        << "coefficient " << k;
                }
        }
    });
}

TEST_P(EnclosureLaw, SecondDerivativesAreBoundedOverTheWholeDomain) {
    // Also at singular corners that have a tangent plane: there the bound of the distance to a triangle rests on them.
    if (!GetParam().smooth_vertices || !GetParam().bounded_vertices || std::string(GetParam().name) == "nurbs_multiple_knots") return;
    each(
        [](const Patch& patch, Random&) {
            for (int k = 0; k < patch.edges(); ++k) {
                const Vec2 p = patch.edge_point(k, 0);
                const Rect d = patch.rect();
                const double h = 1e-3;
                const Box box{{std::max(d.u0, p.x - h), std::min(d.u1, p.x + h)},
                              {std::max(d.v0, p.y - h), std::min(d.v1, p.y + h)}};
                const Enclosure e = patch.enclose(box);
                for (int axis = 0; axis < 3; ++axis)
                    for (int c = 0; c < 6; ++c)
                        EXPECT_TRUE(e.over[axis].c[c].bounded()) << "coefficient " << c << " at corner " << k;
            }
        },
        30);
}

INSTANTIATE_TEST_SUITE_P(Type, EnclosureLaw, ::testing::ValuesIn(patch_types()), name_of);

// ---- without slack, against quadruple precision ---------------------------------------------------------------------
#ifdef __SIZEOF_FLOAT128__
using Quad = __float128;
using QuadPoint = std::array<Quad, 4>;  // weighted

QuadPoint lift(const Point& p, double w) { return {Quad(p.x) * w, Quad(p.y) * w, Quad(p.z) * w, Quad(w)}; }
QuadPoint mix(Quad t, const QuadPoint& a, const QuadPoint& b) {
    QuadPoint r;
    for (int i = 0; i < 4; ++i) r[i] = (1 - t) * a[i] + t * b[i];
    return r;
}
QuadPoint casteljau(std::vector<QuadPoint> p, Quad t) {
    for (; p.size() > 1; p.pop_back())
        for (std::size_t i = 0; i + 1 < p.size(); ++i) p[i] = mix(t, p[i], p[i + 1]);
    return p[0];
}
void expect_holds(const Vec3<Interval>& e, const QuadPoint& x) {
    for (int axis = 0; axis < 3; ++axis) {
        EXPECT_LE(Quad(e[axis].lo), x[axis] / x[3]);
        EXPECT_GE(Quad(e[axis].hi), x[axis] / x[3]);
    }
}

TEST(ExactEnclosure, TensorBezierPoints) {
    for (int seed = 1; seed <= 40; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        Random r(seed);
        const bool rational = seed % 2;
        const auto net = random_net(r, r.integer(1, 6), r.integer(1, 6));
        Grid<double> w;
        for (const auto& row : net) {
            w.emplace_back();
            for (std::size_t j = 0; j < row.size(); ++j) w.back().push_back(r.number(0.3, 3));
        }
        const Patch patch = make_bezier_patch(net, rational ? w : Grid<double>{});
        for (int n = 0; n < 20; ++n) {
            const double u = n < 3 ? n / 2.0 : r.number(), v = n < 9 ? n / 3 / 2.0 : r.number();
            std::vector<QuadPoint> column;
            for (std::size_t i = 0; i < net.size(); ++i) {
                std::vector<QuadPoint> row;
                for (std::size_t j = 0; j < net[i].size(); ++j) row.push_back(lift(net[i][j], rational ? w[i][j] : 1));
                column.push_back(casteljau(row, v));
            }
            const QuadPoint x = casteljau(column, u);
            expect_holds(patch.enclose_point(u, v), x);
            const double h = std::pow(10, -r.number(0, 12));
            const Enclosure e = patch.enclose(
                {{std::max(0.0, u - h), std::min(1.0, u + h)}, {std::max(0.0, v - h), std::min(1.0, v + h)}});
            expect_holds({e.over.x.c[0], e.over.y.c[0], e.over.z.c[0]}, x);
        }
    }
}

TEST(ExactEnclosure, CurvePoints) {
    for (int seed = 1; seed <= 40; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        Random r(seed);
        std::vector<Point> p;
        std::vector<double> w;
        std::vector<QuadPoint> q;
        for (int i = r.integer(1, 8); i >= 0; --i) {
            p.push_back(r.point({}, std::pow(10, r.number(-3, 3))));
            w.push_back(seed % 2 ? r.number(0.1, 5) : 1);
            q.push_back(lift(p.back(), w.back()));
        }
        const Curve c = make_bezier(p, seed % 2 ? w : std::vector<double>{});
        for (int n = 0; n < 30; ++n) {
            const double t = n < 2 ? n : r.number(), h = n % 2 ? 0 : std::pow(10, -r.number(0, 14));
            Vec3<Interval> x;
            c.taylor(Interval(std::max(0.0, t - h), std::min(1.0, t + h)), 0, &x);
            expect_holds(x, casteljau(q, t));
        }
    }
}

TEST(ExactEnclosure, CoonsPoints) {
    for (int seed = 1; seed <= 30; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        Random r(seed);
        const auto net = random_net(r, 4, 4);  // the curves are the border of a net
        const auto curve = [](const std::vector<Point>& p) { return make_bezier(p); };
        std::vector<Point> p[4];  // c0, c1, d0, d1
        for (int i = 0; i < 4; ++i)
            p[0].push_back(net[i][0]), p[1].push_back(net[i][3]), p[2].push_back(net[0][i]), p[3].push_back(net[3][i]);
        const Patch patch = make_coons({curve(p[0]), curve(p[1]), curve(p[2]), curve(p[3])});
        for (int n = 0; n < 20; ++n) {
            const double u = r.number(), v = r.number();
            const auto at = [&](int k, Quad t) {
                std::vector<QuadPoint> q;
                for (const auto& x : p[k]) q.push_back(lift(x, 1));
                return casteljau(q, t);
            };
            const QuadPoint ruled_u = mix(v, at(0, u), at(1, u)), ruled_v = mix(u, at(2, v), at(3, v)),
                            corners = mix(u, mix(v, at(2, 0), at(2, 1)), mix(v, at(3, 0), at(3, 1)));
            QuadPoint x;
            for (int i = 0; i < 4; ++i) x[i] = ruled_u[i] + ruled_v[i] - corners[i];
            expect_holds(patch.enclose_point(u, v), x);
            const double h = std::pow(10, -r.number(0, 12));
            const Enclosure e = patch.enclose(
                {{std::max(0.0, u - h), std::min(1.0, u + h)}, {std::max(0.0, v - h), std::min(1.0, v + h)}});
            expect_holds({e.over.x.c[0], e.over.y.c[0], e.over.z.c[0]}, x);
        }
    }
}

TEST(ExactEnclosure, BezierTrianglePoints) {
    for (int seed = 1; seed <= 30; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        Random r(seed);
        const int degree = r.integer(1, 5);
        const bool rational = seed % 2;
        std::vector<Point> p;
        std::vector<double> w;
        for (int k = 0; k < (degree + 1) * (degree + 2) / 2; ++k)
            p.push_back(r.point()), w.push_back(rational ? r.number(0.3, 3) : 1);
        const Patch patch = make_bezier_triangle(degree, p, rational ? w : std::vector<double>{});
        for (int n = 0; n < 20; ++n) {
            const Vec2 at = random_parameter(r, patch);
            const Quad u = at.x, v = at.y, s = 1 - u - v;
            QuadPoint x{};
            std::size_t i = 0;
            for (int k = 0; k <= degree; ++k)
                for (int j = 0; j <= degree - k; ++j, ++i) {
                    Quad b = binomial(degree, k) * binomial(degree - k, j);
                    for (int m = 0; m < k; ++m) b *= s;
                    for (int m = 0; m < j; ++m) b *= v;
                    for (int m = 0; m < degree - j - k; ++m) b *= u;
                    const QuadPoint q = lift(p[i], w[i]);
                    for (int c = 0; c < 4; ++c) x[c] += b * q[c];
                }
            expect_holds(patch.enclose_point(at.x, at.y), x);
        }
    }
}
#endif

}  // namespace
}  // namespace isoparm::tests
