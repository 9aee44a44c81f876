#include "curves/isocurve.h"

#include <cmath>

#include "curves/lane_by_lane.h"
#include "error.h"
#include "exact_parts.h"

namespace isoparm {
namespace {

/// Third derivatives are not in a PointJet; over intervals they come from the enclosure.
class Isocurve final : public Curve::Concept {
public:
    Isocurve(Patch patch, Along along, double at) : patch_(std::move(patch)), along_(along), at_(at) {}
    double begin() const override { return along_ == Along::u ? patch_.rect().u0 : patch_.rect().v0; }
    double end() const override { return along_ == Along::u ? patch_.rect().u1 : patch_.rect().v1; }
    std::vector<Break> breaks() const override {
        std::vector<Break> list;
        for (double t : along_ == Along::u ? patch_.breaks_u() : patch_.breaks_v()) list.push_back({t, continuity(t)});
        return list;
    }
    void taylor(double t, int order, Vec3<double>* out) const override {
        const auto j = along_ == Along::u ? patch_.jet(t, at_) : patch_.jet(at_, t);
        store(j, std::min(order, 2), out);
        if (order < 3) return;
        const auto e = enclose(Interval(t));
        for (int axis = 0; axis < 3; ++axis) out[3][axis] = mid(e.over[axis].coefficient(along_ == Along::u ? 3 : 0, along_ == Along::u ? 0 : 3));
    }
    void taylor(const Pack& t, int order, Vec3<Pack>* out) const override { lane_by_lane(*this, t, order, out); }
    void taylor(const Interval& t, int order, Vec3<Interval>* out) const override { store(enclose(t).over, order, out); }

    /// On a line of cells of a patch that has exact forms there, and wherever cells have exact forms.
    Vec3<Quotient> quotient(const Polynomial& t) const override {
        const bool along_u = along_ == Along::u;
        const auto lines = along_u ? patch_.lines_u() : patch_.lines_v(), others = along_u ? patch_.lines_v() : patch_.lines_u();
        const Interval range = t.range();
        const std::size_t i = cell_at(lines, mid(range)), j = cell_at(others, at_);
        const double slack = 1e-9 * (lines[i + 1] - lines[i]);
        if (range.lo < lines[i] - slack || range.hi > lines[i + 1] + slack) return none();
        const std::size_t m = along_u ? i : j, n = along_u ? j : i;
        auto form = patch_.exact_cell(m, n);
        const double centre = mid(Interval(lines[i], lines[i + 1]));
        Interval beside = Interval(at_) - Interval(mid(Interval(others[j], others[j + 1])));
        const bool line_form = has_edge_forms(form);
        if (line_form) {
            if (at_ != others[j] && at_ != others[j + 1]) return none();
            const bool upper = at_ == others[j + 1];
            const std::size_t edge = along_u ? (upper ? 2 : 0) : (upper ? 1 : 3);
            form = patch_.exact_cell(m + (edge + 1) * (patch_.lines_u().size() - 1), n);
            if (!has_line_form(form)) return none();
            form.resize(form[3].degree_u() > 0 ? 4 : 3);
            beside = Interval(0);
        } else if (form.size() != 3 && form.size() != 4) {
            return none();
        }
        const Polynomial step = t - Polynomial(centre);
        const bool first = along_u || line_form;  // of the two variables of the form
        const auto on_line = [&](const Polynomial& f) {
            Polynomial sum;
            for (int k = first ? f.degree_u() : f.degree_v(); k >= 0; --k) {
                Interval c(0);
                for (int l = first ? f.degree_v() : f.degree_u(); l >= 0; --l) c = c * beside + (first ? f.coefficient(k, l) : f.coefficient(l, k));
                sum = sum * step + Polynomial(c);
            }
            return sum;
        };
        Vec3<Quotient> x;
        for (int axis = 0; axis < 3; ++axis) x[axis] = form.size() == 4 ? Quotient(on_line(form[std::size_t(axis)]), {on_line(form[3])}) : Quotient(on_line(form[std::size_t(axis)]));
        return x;
    }

private:
    static Vec3<Quotient> none() { return {Polynomial::nothing(), Polynomial::nothing(), Polynomial::nothing()}; }
    static std::size_t cell_at(const std::vector<double>& lines, double t) {
        std::size_t i = 0;
        while (i + 2 < lines.size() && t >= lines[i + 1]) ++i;
        return i;
    }
    /// A patch does not tell what jumps at its breaks: 1 if the slopes of both sides agree up to rounding, else 0.
    int continuity(double t) const {
        Vec3<double> low[2], high[2];
        taylor(std::nextafter(t, begin()), 1, low);
        taylor(t, 1, high);
        return distance(low[1], high[1]) <= 1e-9 * (length(low[1]) + length(high[1])) ? 1 : 0;
    }
    Enclosure enclose(const Interval& t) const { return patch_.enclose(along_ == Along::u ? Box{t, Interval(at_)} : Box{Interval(at_), t}); }
    template <class T, int N> void store(const Vec3<JetUV<T, N>>& j, int order, Vec3<T>* out) const {
        for (int k = 0; k <= order; ++k)
            for (int axis = 0; axis < 3; ++axis) out[k][axis] = along_ == Along::u ? j[axis].coefficient(k, 0) : j[axis].coefficient(0, k);
    }
    Patch patch_;
    Along along_;
    double at_;
};

}  // namespace

Curve make_isocurve(const Patch& patch, Along along, double at) {
    if (patch.domain() == Domain::triangle) throw_input("found a surface on a triangle, expected one on a rectangle, which alone has isocurves");
    const Rect r = patch.rect();
    const double low = along == Along::u ? r.v0 : r.u0, high = along == Along::u ? r.v1 : r.u1;
    if (!(at >= low && at <= high))
        throw_input("found " + std::string(along == Along::u ? "v" : "u") + " = " + to_text(at) + ", expected a value in [" + to_text(low) + ", " + to_text(high) + "]");
    return Curve(std::make_shared<Isocurve>(patch, along, at));
}

}  // namespace isoparm
