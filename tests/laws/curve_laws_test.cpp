// curve_laws_test.cpp -- what every curve type must satisfy. New types: one row in samples_*.cpp.
#include <gtest/gtest.h>

#include "curves/modify.h"
#include "samples.h"

namespace isoparm::tests {
namespace {

constexpr int kInstances = 5;

class CurveLaw : public ::testing::TestWithParam<CurveType> {
protected:
    template <class F> void each(F law) const {
        for (int seed = 1; seed <= kInstances; ++seed) {
            SCOPED_TRACE("seed " + std::to_string(seed));
            Random random(seed);
            const Curve c = GetParam().make(random);
            law(c, random);
        }
    }
    static double parameter(const Curve& c, Random& r, double margin = 0) {
        return c.begin() + (c.end() - c.begin()) * r.number(margin, 1 - margin);
    }
    /// Largest Taylor coefficient of each order: what rounding is relative to.
    static std::array<double, 4> sizes(const Curve& c) {
        std::array<double, 4> s{};
        for (int k = 0; k <= 40; ++k) {
            Point x[4];
            c.taylor(c.begin() + (c.end() - c.begin()) * k / 40, 3, x);
            for (int i = 0; i < 4; ++i) s[i] = std::max(s[i], length(x[i]));
        }
        const double h = c.end() - c.begin();
        for (int i = 1; i < 4; ++i) s[i] = std::max(s[i], s[0] / std::pow(h, i));
        return s;
    }
    static bool near_break(const Curve& c, double t, double h) {
        for (const auto& b : c.breaks())
            if (std::abs(t - b.t) <= 2 * h) return true;
        return false;
    }
};

TEST_P(CurveLaw, JetsAgreeWithCentralDifferences) {
    each([](const Curve& c, Random& r) {
        const double h = 1e-5 * (c.end() - c.begin());
        const auto size = sizes(c);
        for (int n = 0; n < 10; ++n) {
            const double t = parameter(c, r, 0.001);
            if (near_break(c, t, h)) continue;
            Point low[4], at[4], high[4];
            c.taylor(t - h, 3, low), c.taylor(t, 3, at), c.taylor(t + h, 3, high);
            for (int k = 0; k < 3; ++k)  // out[k+1] = out[k]' / (k+1)
                EXPECT_LE(distance((high[k] - low[k]) / (2 * h * (k + 1)), at[k + 1]), 1e-6 * size[k + 1])
                    << "order " << k + 1 << " at " << t;
        }
    });
}

TEST_P(CurveLaw, LowerOrdersAreTheSame) {
    each([](const Curve& c, Random& r) {
        const double t = parameter(c, r);
        Point full[4];
        c.taylor(t, 3, full);
        for (int order = 0; order < 3; ++order) {
            Point x[4];
            c.taylor(t, order, x);
            for (int k = 0; k <= order; ++k) EXPECT_LE(distance(x[k], full[k]), 1e-13 * sizes(c)[k]);
        }
        EXPECT_LE(distance(c(t), full[0]), 1e-14 * sizes(c)[0]);
        EXPECT_LE(distance(c.derivative(t), full[1]), 1e-13 * sizes(c)[1]);
    });
}

TEST_P(CurveLaw, PacksEqualScalarsBitForBit) {
    each([](const Curve& c, Random& r) {
        const double width = c.end() - c.begin();
        for (double spread : {0.0, 1e-3 * width, width})
            for (int order = 0; order <= 3; ++order) {
                const double middle = parameter(c, r);
                Pack t;
                for (int i = 0; i < Pack::lanes; ++i)
                    t.set(i, std::clamp(middle + spread * r.number(-1, 1), c.begin(), c.end()));
                Vec3<Pack> packed[4];
                c.taylor(t, order, packed);
                for (int i = 0; i < Pack::lanes; ++i) {
                    Point x[4];
                    c.taylor(t[i], order, x);
                    for (int k = 0; k <= order; ++k)
                        for (int axis = 0; axis < 3; ++axis)
                            EXPECT_EQ(packed[k][axis][i], x[k][axis])
                                << "order " << k << " of " << order << " at " << t[i];
                }
            }
    });
}

TEST_P(CurveLaw, IntervalsEncloseEveryParameter) {
    each([](const Curve& c, Random& r) {
        const double width = c.end() - c.begin();
        const auto size = sizes(c);
        for (int n = 0; n < 40; ++n) {
            const double reach = width * std::pow(10, -r.number(0, 9));
            double a = parameter(c, r);
            if (const auto breaks = c.breaks(); n % 4 == 0 && !breaks.empty())
                a = breaks[r.integer(0, int(breaks.size()) - 1)].t;  // touch one
            const double lo = std::max(c.begin(), a - (n % 3 ? reach * r.number() : 0)),
                         hi = std::min(c.end(), a + (n % 5 ? reach * r.number() : 0));
            Vec3<Interval> box[4];
            c.taylor(Interval(lo, hi), 3, box);
            for (int s = 0; s < 8; ++s) {
                const double t = std::clamp(s == 0 ? lo : s == 1 ? hi : r.number(lo, hi), lo, hi);
                if (s == 1 && near_break(c, t, 0)) continue;  // the piece to the right is not part of the interval
                Point x[4];
                c.taylor(t, 3, x);
                for (int k = 0; k < 4; ++k)
                    for (int axis = 0; axis < 3; ++axis) {
                        const double slack = 1e-13 * size[k];
                        EXPECT_GE(x[k][axis], box[k][axis].lo - slack)
                            << "order " << k << " at " << t << " in [" << lo << ", " << hi << "]";
                        EXPECT_LE(x[k][axis], box[k][axis].hi + slack)
                            << "order " << k << " at " << t << " in [" << lo << ", " << hi << "]";
                    }
            }
        }
    });
}

TEST_P(CurveLaw, IntervalsHoldByTheMeanValueTheorem) {
    // A chord of each derivative is held by the bound of the next one, also across breaks: there it may be any number.
    each([](const Curve& c, Random& r) {
        const double width = c.end() - c.begin();
        const auto size = sizes(c);
        const auto breaks = c.breaks();
        for (int n = 0; n < 40; ++n) {
            const double reach = width * std::pow(10, -r.number(0, 6));
            const double a = breaks.empty() || n % 2 ? parameter(c, r) : breaks[r.integer(0, int(breaks.size()) - 1)].t;
            const double lo = std::max(c.begin(), a - reach * r.number()),
                         hi = std::min(c.end(), a + reach * r.number());
            Vec3<Interval> box[4];
            c.taylor(Interval(lo, hi), 3, box);
            Point x[4], y[4];
            const double s = r.number(lo, hi), t = r.number(lo, hi);
            if (s == t) continue;
            c.taylor(s, 3, x), c.taylor(t, 3, y);
            for (int k = 1; k < 4; ++k)
                for (int axis = 0; axis < 3; ++axis) {
                    const double chord = (y[k - 1][axis] - x[k - 1][axis]) / ((t - s) * k);
                    const double slack = 1e-12 * size[k - 1] / std::abs(t - s);
                    EXPECT_TRUE(chord >= box[k][axis].lo - slack && chord <= box[k][axis].hi + slack)
                        << "order " << k << " from " << s << " to " << t;
                }
        }
    });
}

TEST_P(CurveLaw, IntervalsAwayFromBreaksAreTight) {
    each([](const Curve& c, Random& r) {
        const double h = 1e-6 * (c.end() - c.begin());
        const auto size = sizes(c);
        for (int n = 0; n < 20; ++n) {
            const double t = parameter(c, r, 0.01);
            if (near_break(c, t, h)) continue;
            Vec3<Interval> box[4];
            c.taylor(Interval(t - h, t + h), 3, box);
            for (int k = 0; k < 3; ++k)  // as wide as the next derivative makes it, and a little
                for (int axis = 0; axis < 3; ++axis)
                    EXPECT_LE(box[k][axis].hi - box[k][axis].lo, 40 * h * (k + 1) * size[k + 1] + 1e-12 * size[k])
                        << "order " << k << " at " << t;
        }
    });
}

TEST_P(CurveLaw, ExactPolynomialsAreTheCurve) {
    each([](const Curve& c, Random& r) {
        std::vector<double> ends{c.begin()};
        for (const auto& b : c.breaks()) ends.push_back(b.t);
        ends.push_back(c.end());
        const auto size = sizes(c);
        for (std::size_t p = 0; p + 1 < ends.size(); ++p) {
            const Interval range(ends[p], ends[p + 1]);
            const Vec3<Polynomial> exact = c(Polynomial::variable_u(range));
            if (!exact.x.exists()) {
                EXPECT_FALSE(exact.y.exists() || exact.z.exists());
                continue;
            }
            for (int n = 0; n < 5; ++n) {
                const double t = r.number(range.lo, range.hi);
                Point x[4];
                c.taylor(t, 3, x);
                for (int axis = 0; axis < 3; ++axis) {
                    JetUV<Interval, 3> jet;
                    exact[axis].jets<3>(mid(range), 0, Interval(t), Interval(0), nullptr, &jet);
                    for (int k = 0; k < 4; ++k)
                        EXPECT_NEAR(mid(jet.coefficient(k, 0)), x[k][axis], 1e-12 * size[k])
                            << "order " << k << " at " << t;
                }
            }
        }
    });
}

TEST_P(CurveLaw, BreaksTellWhatJumps) {
    each([](const Curve& c, Random&) {
        const auto size = sizes(c);
        double last = c.begin();
        for (const auto& b : c.breaks()) {
            EXPECT_GT(b.t, last);
            EXPECT_LT(b.t, c.end());
            last = b.t;
            const double h = 1e-9 * (c.end() - c.begin());
            Point low[4], high[4];
            c.taylor(b.t - h, 3, low), c.taylor(b.t + h, 3, high);
            for (int k = 0; k <= std::min(b.continuity, 2); ++k)
                EXPECT_LE(distance(low[k], high[k]), 1e-6 * (size[k] + size[k + 1])) << "order " << k << " at " << b.t;
        }
    });
}

TEST_P(CurveLaw, MovesWithItsData) {
    const Point offset{1000, -700, 400};
    for (int seed = 1; seed <= kInstances; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        Random here(seed), there(seed, offset);
        const Curve a = GetParam().make(here), b = GetParam().make(there);
        const double h = a.end() - a.begin();
        for (int k = 0; k <= 20; ++k) {
            const double t = a.begin() + h * k / 20;
            EXPECT_LE(distance(a(t) + offset, b(t)), 1e-12 * length(offset)) << t;
            EXPECT_LE(distance(a.derivative(t), b.derivative(t)) * h, 1e-12 * length(offset)) << t;
        }
    }
}

TEST_P(CurveLaw, ReversedSegmentTransformedReparametrizedAgree) {
    each([](const Curve& c, Random& r) {
        const Transform map =
            Transform::rotate({1, 1, 0}, 30) * Transform::scale({2, 1, -1}) * Transform::translate({1, 2, 3});
        const double a = parameter(c, r, 0.1), from = std::min(a, c.end() - 0.05 * (c.end() - c.begin())),
                     to = r.number(from + 0.04 * (c.end() - c.begin()), c.end());
        const Curve back = reversed(c), twice = reversed(back), part = segment(c, from, to),
                    same = segment(c, from, to, false), moved = transformed(c, map), other = reparametrized(c, 2, 5),
                    doubled = linear_combination({2, -1}, {c, c});
        EXPECT_EQ(part.begin(), 0);
        EXPECT_EQ(part.end(), 1);
        EXPECT_EQ(same.begin(), from);
        EXPECT_EQ(same.end(), to);
        EXPECT_EQ(back.begin(), c.begin());
        EXPECT_EQ(back.end(), c.end());
        EXPECT_EQ(other.begin(), 2);
        EXPECT_EQ(other.end(), 5);
        EXPECT_EQ(back.breaks().size(), c.breaks().size());
        EXPECT_EQ(other.breaks().size(), c.breaks().size());
        const auto size = sizes(c);
        for (int n = 0; n <= 12; ++n) {
            const double s = n <= 1 ? n : r.number(), t = c.begin() + s * (c.end() - c.begin());
            EXPECT_LE(distance(back(c.end() - (t - c.begin())), c(t)), 1e-13 * size[0]);
            EXPECT_LE(distance(twice(t), c(t)), 1e-13 * size[0]);
            EXPECT_LE(distance(moved(t), map.point(c(t))), 1e-13 * (6 * size[0] + 10));
            EXPECT_LE(distance(other(2 + 3 * s), c(t)), 1e-13 * size[0]);
            EXPECT_LE(distance(doubled(t), c(t)), 1e-13 * size[0]);
            const double q = std::clamp(from + s * (to - from), from, to);
            EXPECT_LE(distance(part(s), c(q)), 1e-13 * size[0]);
            EXPECT_LE(distance(same(q), c(q)), 1e-13 * size[0]);
            if (near_break(c, t, 1e-9) || near_break(c, q, 1e-9)) continue;
            EXPECT_LE(length(back.derivative(c.end() - (t - c.begin())) + c.derivative(t)), 1e-11 * size[1]);
            EXPECT_LE(distance(moved.derivative(t), map.vector(c.derivative(t))), 1e-12 * 6 * size[1]);
            EXPECT_LE(distance(part.derivative(s), (to - from) * c.derivative(q)),
                      1e-12 * size[1] * (c.end() - c.begin()));
        }
    });
}

INSTANTIATE_TEST_SUITE_P(Type, CurveLaw, ::testing::ValuesIn(curve_types()), name_of);

}  // namespace
}  // namespace isoparm::tests
