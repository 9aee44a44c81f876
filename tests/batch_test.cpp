// batch_test.cpp -- Patch::frames in arrays: equal to the bit for every instruction set, odd size and way to cut; as close to the surface as
// promised; and no instruction beyond the baseline's outside of the loops that ask the machine first.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "batch/batch_quotient.h"
#include "curves/bezier.h"
#include "curves/bezier_cells.h"
#include "curves/line.h"
#include "error.h"
#include "patches/cone.h"
#include "patches/coons.h"
#include "patches/side_vertex.h"
#include "patches/tensor_bezier.h"
#include "patches/tensor_bezier_points.h"
#include "run_program.h"
#include "samples.h"

namespace isoparm::tests {
namespace {

using Numbers = std::vector<double>;

std::vector<Isa> isas_here() {
    std::vector<Isa> here;
    for (const Isa isa : all_isas)
        if (runs(isa)) here.push_back(isa);
    return here;
}

/// The nine arrays, each `shift` numbers into its own memory: not aligned.
struct Result {
    std::array<Numbers, 9> numbers;
    std::size_t size, shift;
    explicit Result(std::size_t n, std::size_t s = 1) : size(n), shift(s) { numbers.fill(Numbers(n + s, -7)); }
    FrameArrays arrays() {
        const auto part = [&](int k) { return std::span(numbers[k]).subspan(shift); };
        const auto three = [&](int k) { return std::array{part(k), part(k + 1), part(k + 2)}; };
        return {three(0), three(3), three(6)};
    }
    double at(int k, std::size_t i) const { return numbers[k][shift + i]; }
};
bool same_bits(const Result& a, const Result& b) {
    for (int k = 0; k < 9; ++k)
        for (std::size_t i = 0; i < a.size; ++i)
            if (std::bit_cast<std::uint64_t>(a.at(k, i)) != std::bit_cast<std::uint64_t>(b.at(k, i)) &&
                !(std::isnan(a.at(k, i)) && std::isnan(b.at(k, i))))
                return false;
    return true;
}

/// Anywhere, on breaks, on edges and at the corners.
void parameters(Random& r, const Patch& patch, std::size_t n, Numbers& u, Numbers& v) {
    const auto lines_u = patch.lines_u(), lines_v = patch.lines_v();
    for (std::size_t i = 0; i < n; ++i) {
        Vec2 p = random_parameter(r, patch);
        if (i % 4 == 1) p = patch.edge_point(int(i / 4) % patch.edges(), i % 8 < 4 ? r.number() : double(i % 3 == 0));
        if (i % 4 == 2 && patch.domain() == Domain::quad) p.x = lines_u[std::size_t(r.integer(0, int(lines_u.size()) - 1))];
        if (i % 8 == 3 && patch.domain() == Domain::quad) p.y = lines_v[std::size_t(r.integer(0, int(lines_v.size()) - 1))];
        u.push_back(p.x), v.push_back(p.y);
    }
}

class BatchLaw : public ::testing::TestWithParam<PatchType> {
protected:
    PatchSample sample_ = [] {
        Random random(1);
        return GetParam().make(random);
    }();
    const Patch& patch_ = sample_.patch;
};

TEST_P(BatchLaw, EveryInstructionSetAndSizeGivesTheSameBits) {
    Random r(2);
    for (const std::size_t n : {0, 1, 7, 8, 9, 1000}) {
        Numbers u(1), v(1);  // shifted as the results are
        parameters(r, patch_, n, u, v);
        const auto us = std::span<const double>(u).subspan(1), vs = std::span<const double>(v).subspan(1);
        Result whole(n);
        patch_.frames(us, vs, whole.arrays(), Isa::baseline);
        for (const Isa isa : isas_here())
            for (const std::size_t shift : {0, 1, 3}) {
                Result other(n, shift);
                patch_.frames(us, vs, other.arrays(), isa);
                EXPECT_TRUE(same_bits(whole, other)) << n << " points, " << to_text(isa);
                for (const auto& x : other.numbers)
                    for (std::size_t i = 0; i < shift; ++i) EXPECT_EQ(x[i], -7) << "written before its beginning";
            }
        for (std::size_t i = 0; i < std::min<std::size_t>(n, 100); ++i) {  // one by one, each a row of one point
            Result one(1);
            patch_.frames(us.subspan(i, 1), vs.subspan(i, 1), one.arrays());
            for (int k = 0; k < 9; ++k) EXPECT_TRUE(one.at(k, 0) == whole.at(k, i) || std::isnan(whole.at(k, i)));
        }
    }
}

TEST_P(BatchLaw, ARowIsItsPoints) {
    Random r(3);
    Numbers u, v;
    parameters(r, patch_, 100, u, v);
    const double least = *std::min_element(v.begin(), v.end());  // in the domain with every u, also of a triangle
    for (const double at : {least, patch_.domain() == Domain::quad ? v[5] : least}) {
        const Numbers every(u.size(), at);
        for (const Isa isa : isas_here()) {
            Result row(u.size()), points(u.size());
            patch_.frames(u, std::span(&at, 1), row.arrays(), isa);
            patch_.frames(u, every, points.arrays(), isa);
            EXPECT_TRUE(same_bits(row, points)) << to_text(isa);
        }
    }
}

TEST_P(BatchLaw, AgreesWithTheFormula) {
    Random r(4);
    Numbers u, v;
    parameters(r, patch_, 500, u, v);
    Result x(u.size());
    patch_.frames(u, v, x.arrays());
    const Rect rect = patch_.rect();
    const double size = size_of_sample(patch_), cells = double(patch_.breaks_u().size() + patch_.breaks_v().size() + 2);
    const double width = std::min(rect.u1 - rect.u0, rect.v1 - rect.v0) / cells;
    for (std::size_t i = 0; i < u.size(); ++i) {
        const PointFrame f = patch_.frame(u[i], v[i]);
        for (int k = 0; k < 9; ++k) {
            const double wanted = f[k % 3].c[k / 3], found = x.at(k, i);
            if (std::isnan(wanted)) {
                EXPECT_FALSE(found > 1e6 * size) << "where the formula has no derivative";
                continue;
            }
            EXPECT_LE(std::fabs(found - wanted), 1e-12 * (k < 3 ? size : size / width + std::fabs(wanted)))
                << "number " << k << " at " << u[i] << ", " << v[i];
        }
    }
}

TEST_P(BatchLaw, BezierCellsAreTheSurface) {
    Random r(5);
    const double size = size_of_sample(patch_);
    for (const BezierCell& cell : bezier_cells(patch_))
        for (int n = 0; n < 20; ++n) {
            double u = r.number(cell.u0, cell.u1), v = r.number(cell.v0, cell.v1);
            if (patch_.domain() == Domain::triangle && u + v > 1) u = 1 - u, v = 1 - v;
            EXPECT_LE(distance(cell(u, v), patch_.point(u, v)), 1e-12 * size) << u << ", " << v;
        }
}
INSTANTIATE_TEST_SUITE_P(All, BatchLaw, ::testing::ValuesIn(patch_types()), name_of);

Grid<Point> net_at(Random& r, double offset) {
    Grid<Point> net(4, std::vector<Point>(4));
    for (auto& row : net)
        for (Point& p : row) p = r.vector() + Point{offset, offset, offset};
    return net;
}
PolynomialCells::Form form_of(const Grid<Point>& net) {  // the power form by the binomial theorem, over [0,1]^2 and its middle
    const auto u = Polynomial::variable_u({0, 1}), v = Polynomial::variable_v({0, 1});
    const auto bernstein = [](const Polynomial& t, int i) {
        Polynomial b(binomial(3, i));
        for (int k = 0; k < 3; ++k) b = b * (k < i ? t : Polynomial(1) - t);
        return b;
    };
    PolynomialCells::Form form(3, Polynomial(0));
    for (int axis = 0; axis < 3; ++axis)
        for (int i = 0; i < 4; ++i)
            for (int j = 0; j < 4; ++j) form[axis] = form[axis] + bernstein(u, i) * bernstein(v, j) * Polynomial(net[i][j][axis]);
    return form;
}

TEST(Batch, ErrorsStayBelowTheProvedBound) {
    Random r(5);
    for (const double offset : {0.0, 1e3}) {
        const Grid<Point> net = net_at(r, offset);
        const PolynomialCells cells({0, 1}, {0, 1}, {form_of(net)});
        ASSERT_TRUE(cells.exist());
        EXPECT_LE(cells.error().position, PolynomialCells::accuracy * (1 + offset));
        EXPECT_GT(cells.error().position, 0);
        const Patch patch = make_bezier_patch(net);
        Numbers u, v;
        parameters(r, patch, 200, u, v);
        Result x(u.size());
        cells.frames(Isa::baseline, u, v, x.arrays());
        const double bound[] = {cells.error().position, cells.error().du, cells.error().dv};
        for (std::size_t i = 0; i < u.size(); ++i) {
            const Enclosure e = patch.enclose({u[i], v[i]});
            for (int k = 0; k < 9; ++k) {
                const Interval exact = e.over[k % 3].c[k / 3];
                EXPECT_GE(x.at(k, i), exact.lo - bound[k / 3]);
                EXPECT_LE(x.at(k, i), exact.hi + bound[k / 3]);
            }
        }
    }
}

TEST(Batch, WhatCannotBeProvedIsLeftToTheFormula) {
    const auto u = Polynomial::variable_u({0, 1}), v = Polynomial::variable_v({0, 1});
    Polynomial high(1);
    for (int k = 0; k < PolynomialCells::max_degree + 1; ++k) high = high * u;
    EXPECT_FALSE(PolynomialCells({0, 1}, {0, 1}, {{high, u, v}}).exist()) << "a degree without loops";
    EXPECT_TRUE(PolynomialCells({0, 1}, {0, 1}, {{u * v, u, v}}).exist());
    EXPECT_FALSE(PolynomialCells({0, 1}, {0, 1}, {{u * Polynomial(Interval(1, 1 + 1e-9)), u, v}}).exist()) << "a coefficient known to nine digits";
    EXPECT_FALSE(PolynomialCells({0, 1}, {0, 1}, {{u * Polynomial(Interval::all()), u, v}}).exist()) << "an unknown coefficient";
    EXPECT_TRUE(PolynomialCells({0, 1}, {0, 1}, {{u, v, u, u + Polynomial(1)}}).exist());
    EXPECT_FALSE(PolynomialCells({0, 1}, {0, 1}, {{u, v, u, u}}).exist()) << "a denominator that vanishes";
}

/// The enclosure of the formula is the reference; near the vertices, where the denominator vanishes, the formula itself has to answer.
TEST(Batch, AQuotientIsTheSurfaceButForItsVertices) {
    const Point A{2, 0, 0}, B{-1, 1.7, 0.3}, C{-1, -1.7, 0};
    const Patch patch = make_side_vertex({make_bezier({B, {-1.1, 0.8, 1.5}, {-1.1, -0.8, 1.2}, C}), make_bezier({C, {0, -1.4, 1.5}, {1.1, -0.6, 0.7}, A}), make_bezier({A, {1.2, 0.6, 1.5}, {0.1, 1.3, 2}, B})},
                                         Function::polynomial({0, 0, 1}));
    const auto form = patch.exact_cell(0, 0);
    ASSERT_EQ(form.size(), 4u);
    const QuotientCell cell(form);
    auto wrong = form, vague = form;
    wrong[1] = wrong[1] + Polynomial(1e-9), vague[1] = vague[1] * Polynomial(Interval(1, 1 + 1e-9));
    const QuotientCell other(wrong);
    ASSERT_TRUE(cell.exists() && other.exists());
    EXPECT_FALSE(QuotientCell(vague).exists()) << "a coefficient known to nine digits";
    for (const Vec2& vertex : {Vec2{0, 0}, {1, 0}, {0, 1}, {1e-3, 1e-3}, {0.999, 5e-4}}) EXPECT_FALSE(cell.covers(vertex.x, vertex.y));

    Random r(8);
    std::size_t by_quotient = 0, worse = 0;
    for (int i = 0; i < 2000; ++i) {
        const double near = i % 4 == 0 ? 0.1 : 1, a = r.number(), b = r.number(), u = near * std::min(a, b), v = near * (1 - std::max(a, b));
        Result x(1);
        const double us[] = {u}, vs[] = {v};
        patch.frames(us, vs, x.arrays());
        if (!cell.covers(u, v)) {
            const PointFrame f = patch.frame(u, v);
            for (int k = 0; k < 9; ++k) EXPECT_EQ(std::bit_cast<std::uint64_t>(x.at(k, 0)), std::bit_cast<std::uint64_t>(f[k % 3].c[k / 3]));
            continue;
        }
        ++by_quotient;
        const auto place = patch.enclose_points({Interval(u), Interval(v)});
        double out[9], *rows[9];
        for (int k = 0; k < 9; ++k) rows[k] = &out[k];
        other.frames(Isa::baseline, 1, us, vs, rows);
        for (int axis = 0; axis < 3; ++axis) EXPECT_LE(mag(place[axis] - Interval(x.at(axis, 0))), 3 * PolynomialCells::accuracy);  // the surface is about 2 wide
        worse += mag(place[1] - Interval(out[1])) > 3 * PolynomialCells::accuracy;
    }
    EXPECT_GT(by_quotient, 1400u);
    EXPECT_EQ(worse, by_quotient) << "a coefficient that is off by 1e-9 is seen";
}

TEST(Batch, PolesAndApexesHaveNoNaN) {
    const Curve circle = make_line({1, 0, 0}, {0, 1, 0});
    const Grid<Point> pole{{{0, 0, 1}, {0, 0, 1}, {0, 0, 1}}, {{1, 0, 1}, {1, 1, 1}, {0, 1, 1}}, {{1, 0, 0}, {1, 1, 0}, {0, 1, 0}}};
    const double h = std::sqrt(0.5);
    for (const Patch& patch : {make_cone(circle, {0, 0, 1}), make_bezier_patch(pole), make_bezier_patch(pole, {{1, h, 1}, {h, 0.5, h}, {1, h, 1}})}) {
        const Numbers u{0, 0, 0, 1, 1}, v{0, 0.5, 1, 0, 1};
        Result x(u.size());
        patch.frames(u, v, x.arrays());
        for (int k = 0; k < 9; ++k)
            for (std::size_t i = 0; i < u.size(); ++i) EXPECT_TRUE(std::isfinite(x.at(k, i)));
    }
}

TEST(Batch, BezierCellsOfBezierPatchesAreTheirPoles) {
    Random r(6);
    const Grid<Point> net = net_at(r, 0);
    const std::vector<BezierCell> cells = bezier_cells(make_bezier_patch(net));
    ASSERT_EQ(cells.size(), 1u);
    ASSERT_EQ(cells[0].poles.size(), net.size() * net[0].size());
    for (std::size_t k = 0; k < cells[0].poles.size(); ++k) EXPECT_LT(distance(cells[0].poles[k], net[k / net[0].size()][k % net[0].size()]), 1e-13);
    EXPECT_TRUE(cells[0].weights.empty());
}

/// Points by lanes, alone, some or many, are those of the formula: of all degrees, rational or not, and across the breaks of B-splines.
TEST(Batch, BezierPointsAreTheFormulasToTheBit) {
    Random random(73000);
    const auto equal = [](const Point& a, const Point& b) { return std::bit_cast<std::array<std::uint64_t, 3>>(a) == std::bit_cast<std::array<std::uint64_t, 3>>(b); };
    std::size_t compared = 0;
    for (int round = 0; round < 200; ++round) {
        const int p = random.integer(1, 9), q = random.integer(0, 1) == 0 ? p : random.integer(1, 9);
        const bool rational = random.integer(0, 1) == 0, cells = random.integer(0, 3) == 0;
        const std::size_t rows = std::size_t(p) + 1 + 2 * cells, columns = std::size_t(q) + 1 + cells;
        Grid<Point> points(rows, std::vector<Point>(columns));
        Grid<double> weights(rational ? rows : 0, std::vector<double>(columns));
        for (auto& row : points)
            for (Point& x : row) x = {random.number() - 0.5, random.number(), 3 * random.number()};
        for (auto& row : weights)
            for (double& w : row) w = 0.5 + random.number();
        const auto knots = [](int degree, int inner) {
            std::vector<double> k(std::size_t(degree) + 1, 0.0);
            for (int i = 1; i <= inner; ++i) k.push_back(0.3 * i);
            k.insert(k.end(), std::size_t(degree) + 1, 1.0);
            return k;
        };
        const Patch patch = cells ? make_bspline_patch(p, q, knots(p, 2), knots(q, 1), points, weights) : make_bezier_patch(points, weights);
        const std::size_t n = std::size_t(random.integer(1, 40));
        std::vector<double> u(n), v(n);
        for (std::size_t k = 0; k < n; ++k) u[k] = random.integer(0, 9) == 0 ? 0.3 : random.number(), v[k] = random.integer(0, 9) == 0 ? 1 : random.number();
        if (cells) std::sort(u.begin(), u.end());
        std::vector<Point> found(n);
        patch.points(n, u.data(), v.data(), found.data());
        for (std::size_t k = 0; k < n; ++k) EXPECT_TRUE(equal(found[k], patch.point(u[k], v[k]))) << round << ", point " << k;
        compared += n;
        if (cells || std::max(p, q) > BezierCoefficients::max_degree) continue;
        std::vector<double> c;
        for (int axis = 0; axis < (rational ? 4 : 3); ++axis)
            for (int i = 0; i <= p; ++i)
                for (int j = 0; j <= q; ++j) {
                    const double w = rational ? weights[std::size_t(i)][std::size_t(j)] : 1;
                    c.push_back(axis == 3 ? w : w * points[std::size_t(i)][std::size_t(j)][axis]);
                }
        for (const Isa isa : isas_here()) {
            bezier_points(isa, {p, q, rational, 0, 1, 0, 1, c.data()}, n, u.data(), v.data(), found.data());
            for (std::size_t k = 0; k < n; ++k)
                if (!rational) EXPECT_TRUE(equal(found[k], patch.point(u[k], v[k]))) << to_text(isa) << ", " << round << ", point " << k;
                else EXPECT_LT(distance(found[k], patch.point(u[k], v[k])), 1e-14) << to_text(isa) << ", " << round << ", point " << k;  // w x is rounded
        }
    }
    EXPECT_GT(compared, 2000u);
}

TEST(Batch, RefusesArraysOfOtherSizes) {
    Random r(6);
    const Patch patch = make_bezier_patch(net_at(r, 0));
    const Numbers three(3, 0.5), two(2, 0.5);
    Result x(3), small(2);
    EXPECT_NO_THROW(patch.frames(three, three, x.arrays()));
    EXPECT_THROW(patch.frames(three, two, x.arrays()), std::invalid_argument);
    EXPECT_THROW(patch.frames(three, three, small.arrays()), std::invalid_argument);
    FrameArrays mixed = x.arrays();
    mixed.dv[2] = mixed.dv[2].first(2);
    EXPECT_THROW(patch.frames(three, three, mixed), std::invalid_argument);
}

TEST(Batch, TheEnvironmentNamesAnInstructionSetOfThisMachine) {
    EXPECT_EQ(isa_named("baseline"), Isa::baseline);
    EXPECT_EQ(isa_named(nullptr), isas_here().back());
    EXPECT_EQ(isa_named(""), isas_here().back());
    for (const Isa isa : isas_here()) EXPECT_EQ(isa_named(to_text(isa)), isa);
    try {
        isa_named("sse9");
        FAIL();
    } catch (const Error& e) {
        EXPECT_EQ(e.kind(), ErrorKind::usage);
        EXPECT_NE(std::string(e.what()).find("baseline"), std::string::npos) << e.what();
    }
}

TEST(Batch, PicturesAreTheSameWithEveryInstructionSet) {
    const test::TemporaryFolder t;
    const auto picture = [&](const char* isa) {
        ::setenv("ISOPARM_ISA", isa, 1);
        const std::string file = t / (std::string("picture_") + isa + ".exr");
        const test::Outcome o = test::run("render " + test::source_folder() + "/scenes/teapot.json -o " + file +
                                          " --size 40x30 --samples 2 --tolerance 1e-2rel --reproducible --quiet");
        ::unsetenv("ISOPARM_ISA");
        EXPECT_EQ(o.code, *isa == '?' ? 64 : 0) << o.err;
        return test::read_all(file);
    };
    const std::string baseline = picture("baseline");
    EXPECT_FALSE(baseline.empty());
    EXPECT_EQ(picture(to_text(isas_here().back())), baseline);
    picture("?");
}

}  // namespace
}  // namespace isoparm::tests
