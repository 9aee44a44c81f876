// No bound of a triangle is below what dense samples show, over random triangles of every type of surface, large and small, inside and at corners.
// ISOPARM_TRIANGLES=N sets how many in all (6000); a million take some minutes.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <memory>

#include "bounds/bound_cell.h"
#include "bounds/triangle_lanes.h"
#include "bounds/triangle_shape.h"
#include "samples.h"

namespace isoparm::tests {
namespace {

struct Tally {
    std::size_t triangles = 0, unbounded = 0, quiet = 0;
    std::size_t violations = 0, within_one_percent = 0;  // the second: bounds that would be wrong were they 1 % smaller
    std::string first;
};

/// Three corners in one cell between breaks, counter-clockwise; on its border every now and then.
std::array<Vec2, 3> random_triangle(Random& random, const Patch& patch, const Box& cell) {
    const bool triangle = patch.domain() == Domain::triangle;
    const double size = std::pow(2.0, -random.number(0, 12)), x = random.number(), y = random.number();
    std::array<Vec2, 3> p;
    for (;;) {
        for (Vec2& c : p) {
            double a = std::clamp(x + size * random.number(-0.5, 0.5), 0.0, 1.0), b = std::clamp(y + size * random.number(-0.5, 0.5), 0.0, 1.0);
            if (random.integer(0, 30) == 0) a = random.integer(0, 1);
            if (random.integer(0, 30) == 0) b = random.integer(0, 1);
            c = {cell.u.lo + a * (cell.u.hi - cell.u.lo), cell.v.lo + b * (cell.v.hi - cell.v.lo)};
            if (triangle && c.x + c.y > 1) c = {1 - c.x, 1 - c.y};
            c = {std::clamp(c.x, cell.u.lo, cell.u.hi), std::clamp(c.y, cell.v.lo, cell.v.hi)};
        }
        const double area = (p[1].x - p[0].x) * (p[2].y - p[0].y) - (p[1].y - p[0].y) * (p[2].x - p[0].x);
        if (area < 0) std::swap(p[1], p[2]);
        const auto outside = [&](const Vec2& c) { return triangle && c.x + c.y > 1; };
        if (area != 0 && !outside(p[0]) && !outside(p[1]) && !outside(p[2])) return p;
    }
}

/// The bounds of one triangle against n points a side.
void look_at(const Patch& patch, const BoundCell& root, Random& random, const std::array<Vec2, 3>& uv, double rounding, Tally& tally) {
    CornerData data;
    data.uv = uv, data.slack = rounding;
    for (int k = 0; k < 3; ++k) data.points[k] = patch.point(uv[k].x, uv[k].y);
    const TriangleBound own = bound_triangle(patch, uv, data.points);
    const BoundCell* cell = &root;
    const TriangleBound b = BoundCell::bound(patch, cell, data, own.parametric * random.number(), Measure::geometric);
    TriangleBound lanes = b;  // those of polynomials, as the refinement uses them
    if (const BoundCell* sharp = root.sharp_cell(patch, box_of(uv))) sharp->bound_all(patch, {&data, 1}, own.parametric * random.number(), Measure::geometric, TriangleBound::unasked, false, &lanes);
    ++tally.triangles, tally.quiet += b.quiet, tally.unbounded += !std::isfinite(std::min(own.parametric, b.parametric));
    bool wrong = false, tight = false;
    const auto compare = [&](double seen, double bound) {
        wrong = wrong || seen > bound * (1 + 1e-12) + 4 * rounding;
        tight = tight || (seen > 0.99 * bound + 4 * rounding && bound > 1e4 * rounding);
    };
    constexpr int n = 12;
    for (int i = 0; i <= n; ++i)
        for (int j = 0; i + j <= n; ++j) {
            const double l[3] = {double(i) / n, double(j) / n, double(n - i - j) / n};
            Vec2 q;
            Point flat;
            for (int k = 0; k < 3; ++k) q = {q.x + l[k] * uv[k].x, q.y + l[k] * uv[k].y}, flat += l[k] * data.points[k];
            const Point d = patch.point(q.x, q.y) - flat;
            compare(length(d), own.parametric);
            for (const TriangleBound& of : {b, lanes}) {
                compare(length(d), of.parametric);
                if (!of.quiet) continue;
                compare(std::fabs(dot(of.unit, d)), of.normal);
                for (int k = 0; k < 3; ++k)
                    if (l[(k + 2) % 3] == 0) {
                        compare(std::fabs(dot(normalized(cross(of.unit, data.points[(k + 1) % 3] - data.points[k])), d)), of.across[k]);
                        compare(std::fabs(dot(of.unit, d)), of.beside[k]);
                    }
            }
        }
    tally.violations += wrong, tally.within_one_percent += tight;
    if (wrong && tally.first.empty())
        for (const Vec2& p : uv) tally.first += "(" + std::to_string(p.x) + ", " + std::to_string(p.y) + ") ";
}

TEST(Soundness, NoBoundIsBelowWhatDenseSamplesShow) {
    const char* wanted = std::getenv("ISOPARM_TRIANGLES");
    const std::size_t each = std::max<std::size_t>(1, (wanted ? std::strtoul(wanted, nullptr, 10) : 6000) / patch_types().size() + 1), of_patch = 50;
    Tally all;
    for (const PatchType& type : patch_types()) {
        Tally tally;
        for (std::uint64_t seed = 70000; tally.triangles < each; ++seed) {
            Random random(seed);
            const Patch patch = type.make(random).patch;
            const auto us = patch.lines_u(), vs = patch.lines_v();
            const std::size_t i = std::size_t(random.integer(0, int(us.size()) - 2)), j = std::size_t(random.integer(0, int(vs.size()) - 2));
            const Box box{{us[i], us[i + 1]}, {vs[j], vs[j + 1]}};
            if (patch.domain() == Domain::triangle && us[i] + vs[j] >= 1) continue;
            const BoundCell root(patch, box);
            const double rounding = 1e-13 * size_of_sample(patch);
            for (std::size_t k = 0; k < of_patch && tally.triangles < each; ++k) look_at(patch, root, random, random_triangle(random, patch, box), rounding, tally);
        }
        EXPECT_EQ(tally.violations, 0u) << type.name << ", the first: " << tally.first;
        all.triangles += tally.triangles, all.violations += tally.violations, all.quiet += tally.quiet, all.unbounded += tally.unbounded, all.within_one_percent += tally.within_one_percent;
    }
    // Were all bounds 1 % smaller, this test would fail this often.
    EXPECT_GT(all.within_one_percent, all.triangles / 200);
    std::printf("%zu triangles: %zu violations; %zu bounds would be violated if they were 1 %% smaller; %zu quiet, %zu without a bound\n", all.triangles, all.violations, all.within_one_percent, all.quiet, all.unbounded);
}

bool same(double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }
bool same(const TriangleBound& a, const TriangleBound& b) {
    bool all = same(a.parametric, b.parametric) && same(a.normal, b.normal) && same(a.tilt, b.tilt) && same(a.turn, b.turn) && a.quiet == b.quiet && a.unit == b.unit;
    for (int k = 0; k < 3; ++k) all = all && same(a.beside[k], b.beside[k]) && same(a.across[k], b.across[k]);
    return all && a.worst_edge == b.worst_edge && a.worst_turn == b.worst_turn && a.worst_across == b.worst_across;
}

/// So the proofs of the one are those of the other. On all instruction sets that run here, in every lane, whatever the others hold, alone or with a
/// second triangle in the same box.
TEST(Soundness, LanesGiveTheBitsOfOneTriangleAtATime) {
    std::size_t compared = 0, quiet = 0;
    for (const PatchType& type : patch_types())
        for (std::uint64_t seed = 72000; seed < 72003; ++seed) {
            Random random(seed);
            const Patch patch = type.make(random).patch;
            const Box box{{patch.lines_u()[0], patch.lines_u()[1]}, {patch.lines_v()[0], patch.lines_v()[1]}};
            const PolynomialCell cell(patch, box);
            if (!cell.exists()) continue;
            for (int round = 0; round < 12; ++round) {
                const int n = random.integer(1, TriangleLanes::size);
                const std::size_t count = round % 2 + 1;
                std::array<std::array<CornerData, TriangleLanes::size>, 2> sets;
                std::array<TriangleLanes, 2> lanes;
                for (int i = 0; i < n; ++i) {
                    auto& data = sets[0];
                    data[i].uv = random_triangle(random, patch, box);
                    if (random.integer(0, 20) == 0) data[i].uv[2] = data[i].uv[1];  // no area
                    for (int k = 0; k < 3; ++k) data[i].points[k] = patch.point(data[i].uv[k].x, data[i].uv[k].y);
                    data[i].slack = 1e-13 * random.number();
                    sets[1][i] = {{Vec2{data[i].uv[0].x, data[i].uv[1].y}, Vec2{data[i].uv[1].x, data[i].uv[2].y}, Vec2{data[i].uv[2].x, data[i].uv[0].y}}, data[i].points, 0};
                    for (std::size_t set = 0; set < count; ++set) lanes[set].set(i, sets[set][i]);
                }
                const LanesAsked asked{random.integer(0, 3) == 0 ? Measure::parametric : Measure::geometric, random.integer(0, 1) == 0 ? 1 : 3, random.integer(0, 2) == 0, random.integer(0, 1) == 0};
                for (const Isa isa : all_isas) {
                    if (!runs(isa)) continue;
                    std::array<TriangleBound, 2 * TriangleLanes::size> bounds;
                    bound_lanes(isa, cell, {lanes.data(), count}, n, asked, bounds.data());
                    for (std::size_t set = 0; set < count; ++set)
                        for (int i = 0; i < n; ++i) {
                            const CornerData& data = sets[set][i];
                            const SecondDerivatives model = asked.parts > 1 ? cell(box_of(data.uv), asked.parts) : cell(box_of(data.uv));
                            const TriangleBound one = model.bounded ? TriangleShape(model, data).bound(asked.measure, asked.least, asked.turns, true) : TriangleBound{};
                            EXPECT_TRUE(same(bounds[set * TriangleLanes::size + i], one)) << type.name << ", " << to_text(isa) << ", seed " << seed << ", set " << set << ", lane " << i;
                            ++compared, quiet += one.quiet;
                        }
                }
            }
        }
    EXPECT_GT(compared, 1000u);
    EXPECT_GT(quiet, compared / 4);
}

double at_most(const Vec3<Interval>& x) { return rounding::length_up(mag(x.x), mag(x.y), mag(x.z)); }
Vec3<Interval> enclosed(const Point& x) { return {Interval(x.x), Interval(x.y), Interval(x.z)}; }

/// What the plain Taylor model says of second derivatives, against intervals at random points of random boxes; and that it is as sharp.
TEST(Soundness, PolynomialCellsEncloseSecondDerivativesAndVertices) {
    std::size_t boxes = 0, tight = 0;
    for (const PatchType& type : patch_types())
        for (std::uint64_t seed = 71000; seed < 71004; ++seed) {
            Random random(seed);
            const Patch patch = type.make(random).patch;
            const auto us = patch.lines_u(), vs = patch.lines_v();
            const PolynomialCell cell(patch, {{us[0], us[1]}, {vs[0], vs[1]}});
            if (!cell.exists()) continue;
            const double size = size_of_sample(patch), wide = std::pow(2.0, -random.number(0, 12));
            const auto piece = [&](double a, double b) {
                if (patch.domain() == Domain::triangle) b = 0.5 * (a + b);
                const double at = a + (b - a) * random.number(0, 0.5), to = std::min(b, at + 0.5 * wide * (b - a));
                return Interval(at, std::max(at, to));
            };
            const Box box{piece(us[0], us[1]), piece(vs[0], vs[1])};
            const SecondDerivatives whole = cell(box), pieces = cell(box, 3), intervals(patch, box);
            ++boxes;
            for (std::size_t k = 0; k < 4; ++k) {
                EXPECT_LE(pieces.t_rad[k], whole.t_rad[k]) << type.name;
                EXPECT_LE(whole.t_rad[k], 1.01 * intervals.t_rad[k] + 1e-11 * (size + intervals.t_size[k])) << type.name;
            }
            for (int n = 0; n < 20; ++n) {
                const double u = random.number(box.u.lo, box.u.hi), v = random.number(box.v.lo, box.v.hi), du = u - whole.u, dv = v - whole.v;
                const Vec3<JetUV<Interval, 2>> exact = patch.enclose({{u, u}, {v, v}}).centre;
                for (const SecondDerivatives& m : {whole, pieces})
                    for (std::size_t k = 0; k < 3; ++k) {
                        const int i = JetUV<Interval, 2>::index(2 - int(k), int(k));
                        const Interval scale(k == 1 ? 1 : 2);
                        const Point here = m.h[k] + du * m.t[k] + dv * m.t[k + 1];
                        const Vec3<Interval> off = Vec3<Interval>{scale * exact.x.c[i], scale * exact.y.c[i], scale * exact.z.c[i]} - enclosed(here);
                        const double seen = at_most(off), allowed = m.h_rad[k] + m.t_rad[k] * std::fabs(du) + m.t_rad[k + 1] * std::fabs(dv);
                        EXPECT_LE(seen, allowed * (1 + 1e-12) + 1e-13 * (m.h_size[k] + size)) << type.name << " at (" << u << ", " << v << ")";
                        tight += seen > 0.25 * allowed && allowed > 1e-10 * m.h_size[k];
                    }
                const Point on = patch.point(u, v), away = on + Point{0, size * random.number(0, 1e-3), 0};
                const double slack = cell.slack({u, v}, away);
                EXPECT_GE(slack, length(away - on) - 1e-14 * size) << type.name;
                EXPECT_LE(slack, length(away - on) + 1e-12 * size) << type.name;
            }
        }
    EXPECT_GT(boxes, 20u);
    EXPECT_GT(tight, 20u);  // radii of a quarter of the size would not do
}

}  // namespace
}  // namespace isoparm::tests
