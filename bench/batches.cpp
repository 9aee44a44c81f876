// batches.cpp -- positions and first derivatives of many scattered points of one bicubic patch, by every instruction set that the machine
// has, beside loops written for it with intrinsics and OpenSubdiv's Bfr.
#include <cmath>
#include <memory>
#include <random>
#include <stdexcept>

#include "bare_bfr.h"
#include "by_hand_batch.h"
#include "cases.h"

namespace isoparm::bench {
namespace {

constexpr std::size_t kPoints = 4096;  // fit the second-level cache with their parameters

Grid<Point> lively_net(int n) {
    std::mt19937_64 random(20260101);
    std::uniform_real_distribution<double> height(-1, 1);
    Grid<Point> net(n, std::vector<Point>(n));
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) net[i][j] = {i + 0.3 * height(random), j + 0.3 * height(random), height(random)};
    return net;
}

/// A bicubic B-spline with a lively height; random parameters, and those of a row.
struct Batch {
    Grid<Point> net;
    Patch patch, cells;  // one cell; 4 x 4 of them
    BareBfr bfr;
    HandBicubic by_hand;
    std::vector<double> u, v;
    std::vector<double> buffer;
    std::vector<PointFrame> frames = std::vector<PointFrame>(kPoints);

    Batch()
        : net(lively_net(4)), patch(make_bspline_patch(3, 3, knots(4), knots(4), net)),
          cells(make_bspline_patch(3, 3, knots(7), knots(7), lively_net(7))), bfr(net), by_hand(power_form(net)) {
        std::mt19937_64 random(7);
        std::uniform_real_distribution<double> unit(0, 1);
        for (std::size_t i = 0; i < kPoints; ++i) u.push_back(unit(random)), v.push_back(unit(random));
        buffer.resize(9 * (kPoints + kApart));
    }

    /// Arrays that are a multiple of 4096 bytes apart share their places in the caches; so many numbers between them prevent that.
    static constexpr std::size_t kApart = 24;
    double* array(int k, std::size_t apart = kApart) { return buffer.data() + static_cast<std::size_t>(k) * (kPoints + apart); }
    FrameArrays arrays(std::size_t apart = kApart) {
        const auto three = [&](int k) {
            const auto one = [&](int i) { return std::span(array(i, apart), kPoints); };
            return std::array{one(k), one(k + 1), one(k + 2)};
        };
        return {three(0), three(3), three(6)};
    }
    void hand(Isa isa) {
        double* const x[9] = {array(0), array(1), array(2), array(3), array(4), array(5), array(6), array(7), array(8)};
        bench::frames(isa, by_hand, kPoints, u.data(), v.data(), x);
    }
    void opensubdiv() {
        for (std::size_t i = 0; i < kPoints; ++i) bfr.evaluate(u[i], v[i], buffer.data() + 9 * i);
    }

    /// Uniform, for n control points; the domain is [0,1].
    static std::vector<double> knots(int n) {
        std::vector<double> t;
        for (int k = -3; k <= n; ++k) t.push_back(double(k) / (n - 3));
        return t;
    }
    static HandBicubic power_form(const Grid<Point>& net) {
        static constexpr double m[4][4] = {{1, 4, 1, 0}, {-3, 0, 3, 0}, {3, -6, 3, 0}, {-1, 3, -3, 1}};  // over 6: u^i of B-spline k
        HandBicubic s{};
        for (int axis = 0; axis < 3; ++axis)
            for (int i = 0; i < 4; ++i)
                for (int j = 0; j < 4; ++j)
                    for (int k = 0; k < 4; ++k)
                        for (int l = 0; l < 4; ++l) s.c[axis][i][j] += m[i][k] * m[j][l] / 36 * net[k][l][axis];
        return s;
    }

    /// A rate counts only if all compute the same.
    void compare() {
        const auto check = [&](auto number) {
            for (std::size_t i = 0; i < kPoints; ++i) {
                const PointFrame f = patch.frame(u[i], v[i]);
                for (int k = 0; k < 9; ++k)
                    if (!(std::fabs(f[k % 3].c[k / 3] - number(i, k)) <= 1e-12)) throw std::logic_error("two ways to evaluate a batch differ");
            }
        };
        const auto in_arrays = [&](std::size_t i, int k) { return array(k)[i]; };
        for (const Isa isa : all_isas) {
            if (!runs(isa)) continue;
            patch.frames(u, v, arrays(), isa);
            check(in_arrays);
            if (isa == Isa::baseline) continue;
            hand(isa);
            check(in_arrays);
        }
        opensubdiv();
        check([&](std::size_t i, int k) { return buffer[9 * i + k]; });
    }
};

}  // namespace

std::vector<Case> batch_cases() {
    const auto batch = std::make_shared<Batch>();
    std::vector<Case> cases;
    const auto add = [&](const std::string& name, auto run, bool reference = false) {
        Case c{"evaluation: bicubic B-spline, positions and both first derivatives", name, "points", [batch, run] {
                   run(*batch);
                   return Work{double(kPoints)};
               }};
        c.reference = reference;
        c.prepare = [batch] { batch->compare(); };
        cases.push_back(std::move(c));
    };
    for (const Isa isa : all_isas) {
        if (!runs(isa)) continue;
        const std::string name = to_text(isa);
        if (isa != Isa::baseline) add("by hand, " + name + " and FMA", [isa](Batch& b) { b.hand(isa); }, true);
        add("Patch::frames, arrays, " + name, [isa](Batch& b) { b.patch.frames(b.u, b.v, b.arrays(), isa); });
        add("... a row, " + name, [isa](Batch& b) { b.patch.frames(b.u, std::span(b.v).first(1), b.arrays(), isa); });
    }
    add("... the fastest, arrays 4096 bytes apart", [](Batch& b) { b.patch.frames(b.u, b.v, b.arrays(0)); });
    add("... the fastest, scattered over 4 x 4 cells", [](Batch& b) { b.cells.frames(b.u, b.v, b.arrays()); });
    add("the formula in packs of eight", [](Batch& b) { b.patch.frames(kPoints, b.u.data(), b.v.data(), b.frames.data()); });
    add("Patch::frame, one by one", [](Batch& b) {
        for (std::size_t i = 0; i < kPoints; ++i) {
            const PointFrame f = b.patch.frame(b.u[i], b.v[i]);
            for (int k = 0; k < 9; ++k) b.array(k)[i] = f[k % 3].c[k / 3];
        }
    });
    add("OpenSubdiv Bfr", [](Batch& b) { b.opensubdiv(); });
    return cases;
}

}  // namespace isoparm::bench
