#include "batch.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "batch/batch_kernel.h"
#include "error.h"
#include "patch.h"

namespace isoparm {
namespace {

constexpr double kUnit = 0x1p-53;
constexpr int kParts = 8;  // of a cell, along each parameter
/// For sums of positive numbers whose own rounding is below this: bounds stay bounds.
constexpr double kMargin = 1 + 1e-9;

/// Bounds of what rounding adds to a polynomial and its first derivatives over a cell, as the kernel computes them.
struct Error3 {
    double s = 0, u = 0, v = 0;
    void include(const Error3& o) { s = std::max(s, o.s), u = std::max(u, o.u), v = std::max(v, o.v); }
};

/// Half the width of a cell around its middle, as far as a rounded t - middle can reach.
double half_width(const Interval& t) { return std::max(t.hi - mid(t), mid(t) - t.lo) * (1 + 4 * kUnit); }

/// Horner's rule: every term of the sum passes at most 2 (i + j) operations and holds i + j rounded factors t - middle, each good to a
/// factor 1 + d, |d| <= 2^-53 (Higham 2002, 5.1); coefficients are known to their radius; a number that underflows loses less than kTiny.
Error3 rounding_of(const Polynomial& p, double hx, double hy) {
    Error3 e;
    const double relative = (4.0 * (p.degree_u() + p.degree_v()) + 4) * kUnit;
    double x = 1, x_u = 0;  // hx^i, i hx^(i-1)
    for (int i = 0; i <= p.degree_u(); ++i) {
        double y = 1, y_v = 0;
        for (int j = 0; j <= p.degree_v(); ++j) {
            const Interval& c = p.coefficient(i, j);
            const double each = relative * mag(c) + rad(c);
            e.s += each * x * y, e.u += each * x_u * y, e.v += each * x * y_v;
            y_v = (j + 1) * y, y *= hy;
        }
        x_u = (i + 1) * x, x *= hx;
    }
    const auto bound = [](double sum) { return sum * kMargin + 1e6 * rounding::kTiny; };
    return {bound(e.s), bound(e.u), bound(e.v)};
}

using Jets = JetUV<Interval, 1>;

/// The same of x = p / w, x_u = (p_u - x w_u) / w, computed with the reciprocal of w, over a box where p, w and x are as given.
Error3 rounding_of_quotient(const Jets& p, const Error3& p_error, const Jets& w, const Error3& w_error, const Jets& x) {
    const double least = (w.c[0].lo - w_error.s) / kMargin;
    if (!(least > 0)) return {HUGE_VAL, HUGE_VAL, HUGE_VAL};
    const double relative = w_error.s / least + 4 * kUnit;  // of the reciprocal, and of a product with it
    Error3 e;
    e.s = (p_error.s / least + mag(x.c[0]) * relative) * kMargin;
    const auto derivative = [&](int k, double pd_error, double wd_error) {
        const double reach = mag(x.c[0]) + e.s, wd = mag(w.c[k]) + wd_error;
        const double numerator = pd_error + e.s * wd + reach * wd_error + 4 * kUnit * (mag(p.c[k]) + pd_error + reach * wd);
        return (numerator / least + mag(x.c[k]) * relative) * kMargin;
    };
    e.u = derivative(1, p_error.u, w_error.u);
    e.v = derivative(2, p_error.v, w_error.v);
    return e;
}

struct Proved {
    double largest = 0;  // coordinate
    Error3 error;
};
void include(Proved& all, double coordinate, const Error3& error) {
    all.largest = std::max(all.largest, coordinate);
    all.error.include(error);
}

/// That of `parts` equal parts of t which has number k.
Interval part_of(const Interval& t, int parts, int k) {
    const auto at = [&](int i) { return i == 0 ? t.lo : i == parts ? t.hi : t.lo + (t.hi - t.lo) * i / parts; };
    return Interval(at(k), at(k + 1));
}

/// Of a quotient that is centred in the middle of a cell, over boxes in it, in which quotients have tight ranges.
class QuotientProof {
public:
    QuotientProof(const PolynomialCells::Form& form, const Box& cell) : form_(form), u_(mid(cell.u)), v_(mid(cell.v)) {
        for (std::size_t axis = 0; axis < 4; ++axis) rounding_[axis] = rounding_of(form[axis], half_width(cell.u), half_width(cell.v));
    }
    Proved over(const Box& part) const {
        Jets x[4];
        for (std::size_t axis = 0; axis < 4; ++axis) form_[axis].jets<1>(u_, v_, part.u, part.v, nullptr, &x[axis]);
        Proved all;
        for (int axis = 0; axis < 3; ++axis) {
            const Jets q = x[axis] / x[3];
            include(all, mag(q.c[0]), rounding_of_quotient(x[axis], rounding_[axis], x[3], rounding_[3], q));
        }
        return all;
    }

private:
    const PolynomialCells::Form& form_;
    double u_, v_;
    Error3 rounding_[4];
};

Proved prove_rational(const PolynomialCells::Form& form, const Box& cell, int parts) {
    const QuotientProof proof(form, cell);
    Proved all;
    for (int k = 0; k < parts * parts; ++k) {
        const Proved one = proof.over({part_of(cell.u, parts, k / parts), part_of(cell.v, parts, k % parts)});
        include(all, one.largest, one.error);
    }
    return all;
}
Proved prove(const PolynomialCells::Form& form, const Box& cell, int parts) {
    if (form.size() == 4) return prove_rational(form, cell, parts);
    Proved all;
    for (const Polynomial& p : form) include(all, mag(p.range()), rounding_of(p, half_width(cell.u), half_width(cell.v)));
    return all;
}

/// Degrees that have loops: others are filled up with zeros to the next.
int degree_with_loop(int degree) {
    while (degree <= PolynomialCells::max_degree && !batch_kernel(Isa::baseline, degree, false, false)) ++degree;
    return degree;
}
int degree_of(const std::vector<PolynomialCells::Form>& forms) {
    int degree = 1;
    for (const auto& form : forms)
        for (const Polynomial& p : form) degree = std::max({degree, p.degree_u(), p.degree_v()});
    return degree_with_loop(degree);
}

/// Points of several cells, put in the order of their cells, so that the loops have more than one of each.
struct Block {
    static constexpr std::size_t most = 512, most_cells = 1024;
    std::uint32_t cell[most];
    std::uint16_t from[most];                   // where each sorted point came from
    double u[most], v[most], x[9][most + 24];  // see docs/performance.md: not 4096 bytes apart

    /// By counting; v may be nullptr.
    void sort(std::size_t n, std::size_t cells, const double* us, const double* vs) {
        std::uint16_t place[most_cells + 1] = {};
        for (std::size_t k = 0; k < n; ++k) ++place[cell[k] + 1];
        for (std::size_t c = 1; c < cells; ++c) place[c] = static_cast<std::uint16_t>(place[c] + place[c - 1]);
        std::uint32_t sorted[most];
        for (std::size_t k = 0; k < n; ++k) {
            const std::size_t at = place[cell[k]]++;
            sorted[at] = cell[k], from[at] = static_cast<std::uint16_t>(k);
            u[at] = us[k], v[at] = vs ? vs[k] : 0;
        }
        std::copy(sorted, sorted + n, cell);
    }
};
/// use(first, count) for runs of equal cells.
template <class Use> void each_run(const std::uint32_t* cell, std::size_t n, Use use) {
    for (std::size_t first = 0, next; first < n; first = next) {
        for (next = first + 1; next < n && cell[next] == cell[first];) ++next;
        use(first, next - first);
    }
}

}  // namespace

FrameError frame_error(const std::vector<Polynomial>& form, const Interval& u, const Interval& v, int parts) {
    const Error3 e = prove(form, {u, v}, parts).error;
    return {e.s, e.u, e.v};
}

std::vector<FrameError> quotient_errors(const std::vector<Polynomial>& form, const Interval& u, const Interval& v, int parts, double& largest) {
    const QuotientProof proof(form, {u, v});
    std::vector<FrameError> errors;
    largest = 0;
    for (int k = 0; k < parts * parts; ++k) {
        const auto [coordinate, e] = proof.over({part_of(u, parts, k / parts), part_of(v, parts, k % parts)});
        errors.push_back({e.s, e.u, e.v});
        if (std::isfinite(e.s)) largest = std::max(largest, coordinate);
    }
    return errors;
}

const char* to_text(Isa isa) { return isa == Isa::avx512 ? "avx512" : isa == Isa::avx2 ? "avx2" : "baseline"; }

Isa isa_named(const char* name) {
    const std::string wanted = name ? name : "";
    Isa best = Isa::baseline;
    std::string here;
    for (const Isa isa : all_isas) {
        if (!runs(isa)) continue;
        if (wanted == to_text(isa)) return isa;
        best = isa;
        if (!here.empty()) here += ", ";
        here += to_text(isa);
    }
    if (wanted.empty()) return best;
    throw Error(ErrorKind::usage, "ISOPARM_ISA: found \"" + wanted + "\", expected one that this machine runs: " + here);
}
Isa chosen_isa() {
    static const Isa chosen = isa_named(std::getenv("ISOPARM_ISA"));
    return chosen;
}

PolynomialCells::PolynomialCells(const std::vector<double>& lines_u, const std::vector<double>& lines_v, const std::vector<Form>& forms)
    : inner_u_(lines_u.begin() + 1, lines_u.end() - 1), inner_v_(lines_v.begin() + 1, lines_v.end() - 1), degree_(degree_of(forms)),
      rational_(forms[0].size() == 4) {
    if (degree_ > max_degree) return;
    double largest = 0, du = 0, dv = 0;  // derivatives times half a cell
    for (std::size_t i = 0; i + 1 < lines_u.size(); ++i)
        for (std::size_t j = 0; j + 1 < lines_v.size(); ++j) {
            const Box cell{{lines_u[i], lines_u[i + 1]}, {lines_v[j], lines_v[j + 1]}};
            const Proved proved = prove(forms[i * (lines_v.size() - 1) + j], cell, kParts);
            const Error3& e = proved.error;
            largest = std::max(largest, proved.largest);
            du = std::max(du, e.u * half_width(cell.u)), dv = std::max(dv, e.v * half_width(cell.v));
            error_ = {std::max(error_.position, e.s), std::max(error_.du, e.u), std::max(error_.dv, e.v)};
        }
    if (!(std::max({error_.position, du, dv}) <= accuracy * largest && std::isfinite(largest))) return;
    const std::size_t side = static_cast<std::size_t>(degree_) + 1;
    for (std::size_t k = 0; k < forms.size(); ++k) {
        const std::size_t i = k / (lines_v.size() - 1), j = k % (lines_v.size() - 1);
        Cell cell{mid({lines_u[i], lines_u[i + 1]}), mid({lines_v[j], lines_v[j + 1]}), {}};
        cell.c.assign(forms[k].size() * side * side, 0.0);
        for (std::size_t axis = 0; axis < forms[k].size(); ++axis)
            for (int p = 0; p <= forms[k][axis].degree_u(); ++p)
                for (int q = 0; q <= forms[k][axis].degree_v(); ++q) cell.c[(axis * side + p) * side + q] = mid(forms[k][axis].coefficient(p, q));
        cells_.push_back(std::move(cell));
    }
}

std::size_t PolynomialCells::cell_at(double u, double v) const {
    const auto index = [](const std::vector<double>& inner, double t) -> std::size_t {
        if (inner.size() > 16) return static_cast<std::size_t>(std::upper_bound(inner.begin(), inner.end(), t) - inner.begin());
        std::size_t k = 0;  // nothing to predict for the processor
        for (const double x : inner) k += t >= x;
        return k;
    };
    return index(inner_u_, u) * (inner_v_.size() + 1) + index(inner_v_, v);
}

void PolynomialCells::frames_in(std::size_t cell, Isa isa, std::size_t n, const double* u, const double* v, double* const* out) const {
    const Cell& c = cells_[cell];
    batch_kernel(isa, degree_, rational_, false)(c.c.data(), c.u, c.v, n, u, v, out);
}

void PolynomialCells::frames(Isa isa, std::span<const double> u, std::span<const double> v, const FrameArrays& out) const {
    const bool row = v.size() == 1;
    const BatchKernel kernel = batch_kernel(isa, degree_, rational_, row);
    const auto run = [&](std::size_t cell, std::size_t n, const double* us, const double* vs, double* const* to) {
        const Cell& c = cells_[cell];
        kernel(c.c.data(), c.u, c.v, n, us, vs, to);
    };
    const auto to = [&](std::size_t first) {
        std::array<double*, 9> x;
        for (std::size_t axis = 0; axis < 3; ++axis)
            x[axis] = out.position[axis].data() + first, x[3 + axis] = out.du[axis].data() + first, x[6 + axis] = out.dv[axis].data() + first;
        return x;
    };
    if (cells_.size() == 1) return run(0, u.size(), u.data(), v.data(), to(0).data());

    Block block;
    for (std::size_t first = 0; first < u.size(); first += Block::most) {
        const std::size_t n = std::min(Block::most, u.size() - first);
        const double *us = u.data() + first, *vs = row ? v.data() : v.data() + first;
        for (std::size_t k = 0; k < n; ++k) block.cell[k] = static_cast<std::uint32_t>(cell_at(us[k], row ? *vs : vs[k]));
        const auto x = to(first);
        if (cells_.size() <= Block::most_cells && n > 16 && !std::is_sorted(block.cell, block.cell + n)) {
            block.sort(n, cells_.size(), us, row ? nullptr : vs);
            each_run(block.cell, n, [&](std::size_t from, std::size_t count) {
                double* part[9];
                for (std::size_t i = 0; i < 9; ++i) part[i] = block.x[i] + from;
                run(block.cell[from], count, block.u + from, row ? vs : block.v + from, part);
            });
            for (std::size_t i = 0; i < 9; ++i)
                for (std::size_t k = 0; k < n; ++k) x[i][block.from[k]] = block.x[i][k];
        } else {
            each_run(block.cell, n, [&](std::size_t from, std::size_t count) {
                run(block.cell[from], count, us + from, row ? vs : vs + from, to(first + from).data());
            });
        }
    }
}

}  // namespace isoparm
