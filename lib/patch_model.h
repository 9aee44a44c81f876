// patch_model.h -- runs one formula on every scalar: how a patch type becomes a Patch.
//
// A formula F has `static constexpr Domain domain` and, on a rectangle, `operator()(u, v)`, on the triangle
// `operator()(u, v, w)`, templated on the scalars, returning a Vec3. Optional: rect(), breaks_u(), breaks_v(), and with the parameters of
// operator() homogeneous(), the same as polynomials x, y, z and, when rational, their denominator, which may vanish at corners.
// points(n, u, v, out) does what operator() does with doubles to the bit, or returns false.
// A formula that is made of cells between its breaks picks its cell by cell_of(breaks, u).
#pragma once
#include <algorithm>
#include <cstdint>

#include "batch/batch_quotient.h"
#include "patch.h"

namespace isoparm {

inline double representative(double x) { return x; }
inline double representative(const Pack& x) { return x[0]; }
inline double representative(const Interval& x) { return x.lo; }  // the middle of a tiny one may be its upper end
template <class T, int I, int J, int N> double representative(const Jet<T, I, J, N>& x) { return representative(x.c[0]); }
inline double representative(const Polynomial& x) { return mid(x.range()); }

/// Index of the cell that holds u: to the right of a break that u equals.
template <class S> std::size_t cell_of(const std::vector<double>& breaks, const S& u) {
    return std::upper_bound(breaks.begin(), breaks.end(), representative(u)) - breaks.begin();
}

template <class F> class PatchModel final : public Patch::Concept {
public:
    explicit PatchModel(F f) : f_(std::move(f)) {
        if constexpr (requires { f_.rect(); }) rect_ = f_.rect();
        if constexpr (requires { f_.breaks_u(); }) breaks_u_ = f_.breaks_u(), breaks_v_ = f_.breaks_v();
        edges_u_ = with_ends(rect_.u0, breaks_u_, rect_.u1);
        edges_v_ = with_ends(rect_.v0, breaks_v_, rect_.v1);
        for (std::size_t i = 0; i + 1 < edges_u_.size(); ++i)
            for (std::size_t j = 0; j + 1 < edges_v_.size(); ++j)
                exact_.push_back(exact_form({edges_u_[i], edges_u_[i + 1]}, {edges_v_[j], edges_v_[j + 1]}));
        batch_ = batch_cells();
        if (!batch_.exist() && exact_.size() == 1 && rect_.u0 == 0 && rect_.u1 == 1 && rect_.v0 == 0 && rect_.v1 == 1)
            if (const auto form = exact_cell(0, 0); form.size() == 4) quotient_ = QuotientCell(form);
    }

    Domain domain() const override { return F::domain; }
    Rect rect() const override { return rect_; }
    std::vector<double> breaks_u() const override { return breaks_u_; }
    std::vector<double> breaks_v() const override { return breaks_v_; }

    Point point(double u, double v) const override { return value(run<0>(u, v)); }
    PointJet jet(double u, double v) const override { return run<2>(u, v); }
    PointFrame frame(double u, double v) const override { return run<1>(u, v); }

    void points(std::size_t n, const double* u, const double* v, Point* out) const override {
        if constexpr (requires { f_.points(n, u, v, out); })
            if (f_.points(n, u, v, out)) return;
        in_packs<0>(n, u, v, [&](std::size_t k, const auto& p, int lane) { out[k] = {p.x.c[0][lane], p.y.c[0][lane], p.z.c[0][lane]}; },
                    [&](std::size_t k) { out[k] = point(u[k], v[k]); });
    }
    void frames(std::size_t n, const double* u, const double* v, PointFrame* out) const override {
        in_packs<1>(n, u, v,
                    [&](std::size_t k, const auto& p, int lane) {
                        bool finite = true;
                        for (int axis = 0; axis < 3; ++axis)
                            for (int c = 0; c < out[k].x.size; ++c) {
                                out[k][axis].c[c] = p[axis].c[c][lane];
                                finite = finite && std::isfinite(out[k][axis].c[c]);
                            }
                        if (!finite) out[k] = frame(u[k], v[k]);  // at a singular corner, whose limits packs do not have
                    },
                    [&](std::size_t k) { out[k] = frame(u[k], v[k]); });
    }
    void frame_arrays(Isa isa, std::span<const double> u, std::span<const double> v, const FrameArrays& out) const override {
        if (batch_.exist()) return batch_.frames(isa, u, v, out);
        for (std::size_t k = 0; k < u.size(); k += kBlock) some_frames(isa, u.subspan(k, std::min(kBlock, u.size() - k)), v.size() == 1 ? v : v.subspan(k), k, out);
    }

    Enclosure enclose(const Box& box) const override {
        const std::size_t i0 = cell(breaks_u_, box.u.lo), i1 = last_cell(edges_u_, i0, box.u.hi);
        const std::size_t j0 = cell(breaks_v_, box.v.lo), j1 = last_cell(edges_v_, j0, box.v.hi);
        if (i0 == i1 && j0 == j1) return in_cell(box, i0, j0);
        // Across breaks: the hull of the cells; slopes may jump there, so derivatives of second order have no bound.
        Enclosure all;
        for (std::size_t i = i0; i <= i1; ++i)
            for (std::size_t j = j0; j <= j1; ++j) {
                const Box part{clip(box.u, {edges_u_[i], edges_u_[i + 1]}), clip(box.v, {edges_v_[j], edges_v_[j + 1]})};
                const Enclosure e = in_cell(part, i, j);
                if (i == i0 && j == j0) all = e;
                for (int axis = 0; axis < 3; ++axis)
                    for (int k = 0; k < e.over.x.size; ++k) all.over[axis].c[k] = hull(all.over[axis].c[k], e.over[axis].c[k]);
            }
        for (int axis = 0; axis < 3; ++axis)
            for (int k = 3; k < all.over.x.size; ++k) all.over[axis].c[k] = Interval::all();
        all.u = mid(box.u), all.v = mid(box.v);
        all.centre = run<2>(Interval(all.u), Interval(all.v));
        return all;
    }
    const PolynomialCells* batch() const override { return batch_.exist() ? &batch_ : nullptr; }
    std::vector<Polynomial> exact_cell(std::size_t i, std::size_t j) const override {
        if (i + 1 >= edges_u_.size() || j + 1 >= edges_v_.size()) return {};  // forms beside edges (exact_parts.h)
        if (const auto* p = exact(i, j)) return {p->x, p->y, p->z};
        auto form = homogeneous_form({edges_u_[i], edges_u_[i + 1]}, {edges_v_[j], edges_v_[j + 1]});
        if (!std::all_of(form.begin(), form.end(), [](const Polynomial& x) { return x.exists(); })) form.clear();
        return form;
    }
    std::vector<Polynomial> model(const Box& box) const override {
        const std::size_t i = cell(breaks_u_, box.u.lo), j = cell(breaks_v_, box.v.lo);
        if (i != last_cell(edges_u_, i, box.u.hi) || j != last_cell(edges_v_, j, box.v.hi)) return {};
        const auto x = Polynomial::model_u(box.u), y = Polynomial::model_v(box.v);
        Vec3<Polynomial> p;
        if constexpr (F::domain == Domain::quad) p = f_(x, y);
        else p = f_(x, y, Polynomial(1) - x - y);
        if (!p.x.exists() || !p.y.exists() || !p.z.exists()) return {};
        return {p.x, p.y, p.z};
    }
    Vec3<Interval> enclose_points(const Box& box) const override {
        const std::size_t i0 = cell(breaks_u_, box.u.lo), i1 = last_cell(edges_u_, i0, box.u.hi);
        const std::size_t j0 = cell(breaks_v_, box.v.lo), j1 = last_cell(edges_v_, j0, box.v.hi);
        Vec3<Interval> all;
        for (std::size_t i = i0; i <= i1; ++i)
            for (std::size_t j = j0; j <= j1; ++j) {
                const Box part{clip(box.u, {edges_u_[i], edges_u_[i + 1]}), clip(box.v, {edges_v_[j], edges_v_[j + 1]})};
                const auto x = points_in_cell(part, i, j);
                for (int axis = 0; axis < 3; ++axis) all[axis] = i == i0 && j == j0 ? x[axis] : hull(all[axis], x[axis]);
            }
        return all;
    }

private:
    static std::vector<double> with_ends(double a, const std::vector<double>& inner, double b) {
        std::vector<double> e{a};
        e.insert(e.end(), inner.begin(), inner.end());
        e.push_back(b);
        return e;
    }
    static std::size_t cell(const std::vector<double>& breaks, double t) { return cell_of(breaks, t); }
    static std::size_t last_cell(const std::vector<double>& edges, std::size_t first, double hi) {
        while (first + 2 < edges.size() && hi > edges[first + 1]) ++first;
        return first;
    }
    /// Runs the formula on packs, the last one filled up with copies: store(k, jets, lane) for each point k. Points of different
    /// cells do not share a pack: then alone(k).
    template <int N, class Store, class Alone> void in_packs(std::size_t n, const double* u, const double* v, Store store, Alone alone) const {
        for (std::size_t k = 0; k < n; k += Pack::lanes) {
            const int count = static_cast<int>(std::min<std::size_t>(Pack::lanes, n - k));
            if (count == 1 || !one_cell(u + k, v + k, count)) {
                for (int i = 0; i < count; ++i) alone(k + i);
                continue;
            }
            double x[Pack::lanes], y[Pack::lanes];
            for (int i = 0; i < Pack::lanes; ++i) x[i] = u[k + std::min(i, count - 1)], y[i] = v[k + std::min(i, count - 1)];
            const auto p = run<N>(Pack::load(x), Pack::load(y));
            for (int i = 0; i < count; ++i) store(k + i, p, i);
        }
    }
    bool one_cell(const double* u, const double* v, int count) const {
        if (breaks_u_.empty() && breaks_v_.empty()) return true;
        for (int i = 1; i < count; ++i)
            if (cell(breaks_u_, u[i]) != cell(breaks_u_, u[0]) || cell(breaks_v_, v[i]) != cell(breaks_v_, v[0])) return false;
        return true;
    }

    /// w = 1 - u - v. The larger of u and v goes first: 1 minus a number from 1/2 to 1 is exact, so w keeps all its digits
    /// near the vertices.
    static double third(double u, double v) { return std::max(0.0, v > u ? (1 - v) - u : (1 - u) - v); }
    static Pack third(const Pack& u, const Pack& v) {
        Pack w;
        for (int i = 0; i < Pack::lanes; ++i) w.set(i, third(u[i], v[i]));
        return w;
    }
    static Interval third(const Interval& u, const Interval& v) {
        return clip(v.lo > u.lo ? (Interval(1) - v) - u : (Interval(1) - u) - v, {0, 1});
    }

    /// The formula on jets of order N.
    template <int N, class T> Vec3<JetUV<T, N>> run(const T& u, const T& v) const {
        const auto p = [&] {
            if constexpr (F::domain == Domain::quad) return f_(variable_u<T, N>(u), variable_v<T, N>(v));
            else return f_(variable_u<T, N>(u), variable_v<T, N>(v), variable_w<T, N>(third(u, v)));
        }();
        return {JetUV<T, N>(p.x), JetUV<T, N>(p.y), JetUV<T, N>(p.z)};
    }
    static Point value(const Vec3<JetUV<double, 0>>& p) { return {p.x.c[0], p.y.c[0], p.z.c[0]}; }

    /// what(u, v) or what(u, v, w) on the polynomials that are u, v and w over a box.
    template <class What> static auto on_polynomials(const Interval& u, const Interval& v, What what) {
        const auto x = Polynomial::variable_u(u), y = Polynomial::variable_v(v);
        if constexpr (F::domain == Domain::quad) return what(x, y);
        else return what(x, y, Polynomial(1) - x - y);
    }
    /// At most kBlock points, into `out` from `first` on: by the quotient where it is proved, else by the formula.
    void some_frames(Isa isa, std::span<const double> u, std::span<const double> v, std::size_t first, const FrameArrays& out) const {
        double* to[9];
        for (std::size_t axis = 0; axis < 3; ++axis) to[axis] = &out.position[axis][first], to[3 + axis] = &out.du[axis][first], to[6 + axis] = &out.dv[axis][first];
        double us[kBlock], vs[kBlock], some[9][kBlock];
        std::uint8_t place[2][kBlock];  // of what the formula gets, and the quotient
        std::size_t count[2] = {0, 0};
        const bool row = v.size() == 1;
        for (std::size_t k = 0; k < u.size(); ++k) {
            const bool by = quotient_.exists() && quotient_.covers(u[k], row ? v[0] : v[k]);
            place[by][count[by]++] = static_cast<std::uint8_t>(k);
        }
        if (count[1] == u.size() && !row) return quotient_.frames(isa, u.size(), u.data(), v.data(), to);
        const auto gather = [&](bool by) {
            for (std::size_t i = 0; i < count[by]; ++i) us[i] = u[place[by][i]], vs[i] = v[row ? 0 : place[by][i]];
        };
        if (count[1] > 0) {
            double* from[9];
            for (std::size_t i = 0; i < 9; ++i) from[i] = some[i];
            gather(true);
            quotient_.frames(isa, count[1], us, vs, from);
            for (std::size_t i = 0; i < 9; ++i)
                for (std::size_t k = 0; k < count[1]; ++k) to[i][place[1][k]] = some[i][k];
        }
        if (count[0] == 0) return;
        PointFrame block[kBlock];
        gather(false);
        frames(count[0], us, vs, block);
        for (std::size_t k = 0; k < count[0]; ++k)
            for (std::size_t i = 0; i < 9; ++i) to[i][place[0][k]] = block[k][static_cast<int>(i % 3)].c[i / 3];
    }
    Vec3<Polynomial> exact_form(const Interval& u, const Interval& v) const { return on_polynomials(u, v, f_); }

    PolynomialCells batch_cells() const {
        std::vector<PolynomialCells::Form> forms;
        for (std::size_t i = 0; i + 1 < edges_u_.size(); ++i)
            for (std::size_t j = 0; j + 1 < edges_v_.size(); ++j)
                if (const auto* p = exact(i, j)) forms.push_back({p->x, p->y, p->z});
                else forms.push_back(homogeneous_form({edges_u_[i], edges_u_[i + 1]}, {edges_v_[j], edges_v_[j + 1]}));
        const auto same = [&](const auto& form) { return !form.empty() && form.size() == forms[0].size(); };
        return std::all_of(forms.begin(), forms.end(), same) ? PolynomialCells(edges_u_, edges_v_, forms) : PolynomialCells();
    }
    /// Empty where there is none.
    PolynomialCells::Form homogeneous_form(const Interval& u, const Interval& v) const {
        if constexpr (requires(Polynomial x) { f_.homogeneous(x, x); } || requires(Polynomial x) { f_.homogeneous(x, x, x); })
            return on_polynomials(u, v, [this](const auto&... x) { return f_.homogeneous(x...); });
        else return {};
    }

    const Vec3<Polynomial>* exact(std::size_t i, std::size_t j) const {
        const auto& p = exact_[i * (edges_v_.size() - 1) + j];
        return p.x.exists() && p.y.exists() && p.z.exists() ? &p : nullptr;
    }
    double middle_u(std::size_t i) const { return mid(Interval(edges_u_[i], edges_u_[i + 1])); }
    double middle_v(std::size_t j) const { return mid(Interval(edges_v_[j], edges_v_[j + 1])); }

    /// Formulas pick their cell by the lower end of an interval; exact forms are closed on both sides.
    Vec3<Interval> points_in_cell(const Box& box, std::size_t i, std::size_t j) const {
        Vec3<JetUV<Interval, 0>> x;
        if (const auto* p = exact(i, j)) {
            for (int axis = 0; axis < 3; ++axis) (*p)[axis].template jets<0>(middle_u(i), middle_v(j), box.u, box.v, nullptr, &x[axis]);
        } else {
            x = run<0>(box.u, box.v);
        }
        return {x.x.c[0], x.y.c[0], x.z.c[0]};
    }

    Enclosure in_cell(const Box& box, std::size_t i, std::size_t j) const {
        Enclosure e;
        e.u = mid(box.u), e.v = mid(box.v);
        if (const auto* p = exact(i, j)) {
            for (int axis = 0; axis < 3; ++axis)
                (*p)[axis].template jets<3>(middle_u(i), middle_v(j), box.u, box.v, &e.centre[axis], &e.over[axis]);
        } else {
            // Formulas give a point on a break to the cell on its right: the middle of a tiny box must not be its upper end.
            if (e.u == box.u.hi) e.u = box.u.lo;
            if (e.v == box.v.hi) e.v = box.v.lo;
            e.centre = run<2>(Interval(e.u), Interval(e.v));
            e.over = run<3>(box.u, box.v);
        }
        return e;
    }

    static constexpr std::size_t kBlock = 64;
    F f_;
    Rect rect_;
    std::vector<double> breaks_u_, breaks_v_, edges_u_, edges_v_;
    std::vector<Vec3<Polynomial>> exact_;  // per cell, where the surface is polynomial there
    PolynomialCells batch_;
    QuotientCell quotient_;  // where there are no such cells
};

template <class F> Patch make_patch(F f) { return Patch(std::make_shared<PatchModel<F>>(std::move(f))); }

}  // namespace isoparm
