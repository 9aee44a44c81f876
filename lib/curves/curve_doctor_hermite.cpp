#include <tuple>

#include "curves/curve_doctor_parts.h"

namespace isoparm {
namespace {

using doctor::append;
using doctor::changes_of;
using doctor::reversals_of;

/// Sides x(u,0), x(u,1), x(0,v), x(1,v): where HermiteData keeps each and its cross derivative.
constexpr int kCurve[4] = {0, 3, 0, 3}, kCross[4] = {1, 2, 1, 2};
const std::array<Curve, 4>& family(const HermiteData& d, int side) { return side < 2 ? d.g : d.f; }
std::array<Curve, 4>& family(HermiteData& d, int side) { return side < 2 ? d.g : d.f; }
std::string name_of(int side, const int (&index)[4]) { return (side < 2 ? "g[" : "f[") + std::to_string(index[side]) + "]"; }

/// Value and derivative at both ends, over [0,1].
struct EndData {
    Point value[2], derivative[2];
    explicit EndData(const Curve& given) {
        const Curve c = reparametrized(given, 0, 1);
        for (int e = 0; e < 2; ++e) value[e] = c(e), derivative[e] = c.derivative(e);
    }
    EndData turned(bool reversed, bool negated) const {
        EndData r = *this;
        if (reversed) {
            std::swap(r.value[0], r.value[1]);
            std::swap(r.derivative[0], r.derivative[1]);
        }
        for (int e = 0; e < 2; ++e) {
            if (negated) r.value[e] = -r.value[e];
            if (reversed != negated) r.derivative[e] = -r.derivative[e];
        }
        return r;
    }
};

class HermiteDoctor {
public:
    HermiteDoctor(const HermiteData& data, Twist twist) : twist_(twist) {
        for (int k = 0; k < 4; ++k) {
            curves_.push_back(family(data, k)[kCurve[k]]);
            along_.emplace_back(curves_[k]);
            cross_.emplace_back(family(data, k)[kCross[k]]);
        }
    }

    HermiteDoctor(const HermiteDoctor& other, Twist twist) : HermiteDoctor(other) { twist_ = twist; }

    Diagnosis<HermiteRepair> diagnose() const {
        std::vector<std::string> names;
        for (int k = 0; k < 4; ++k) names.push_back(name_of(k, kCurve));
        Diagnosis<HermiteRepair> d;
        const HermiteRepair as_given{{{0, 1, 2, 3}, {false, false, false, false}}, {false, false, false, false}, {false, false, false, false}};
        if (disagreements(as_given, size_of_places(as_given.sides)).empty()) return {true, {}, {}, {}};
        const Diagnosis<Repair> frame = doctor::diagnose_loop({names, doctor::frame_joints, 8, "the frame"}, curves_);
        if (!frame.fits && !frame.repair) {
            d.misfit = frame.misfit;
            return d;
        }
        std::tuple<int, int> cost;
        doctor::for_each_repair(4, [&](const Repair& sides) {
            const double size = size_of_places(sides);
            if (!closes(sides, size)) return;
            for (int mask = 0; mask < 256; ++mask) {
                HermiteRepair r{sides, sides.reversed, std::vector<bool>(4)};
                int extra = 0;
                for (int k = 0; k < 4; ++k) {
                    const bool turn = mask >> k & 1, negate = mask >> (4 + k) & 1;
                    if (turn) r.cross_reversed[k] = !r.cross_reversed[k];
                    r.negated[k] = negate;
                    extra += turn + negate;
                }
                const std::tuple<int, int> c{changes_of(sides) + extra, reversals_of(sides)};
                if ((!d.repair || c < cost) && disagreements(r, size).empty()) d.repair = r, cost = c;
            }
        });
        d.misfit = frame.fits ? disagreements(as_given, size_of_places(as_given.sides)) : frame.misfit;
        if (d.repair) {
            for (int k = 0; k < 4; ++k) {
                const int from = d.repair->sides.order[k];
                append(d.changes, doctor::change_text(name_of(k, kCurve), name_of(from, kCurve), d.repair->sides.reversed[k]));
                append(d.changes, doctor::change_text(name_of(k, kCross), name_of(from, kCross), d.repair->cross_reversed[k], d.repair->negated[k]));
            }
        } else {
            d.misfit += "; no order, direction and sign of the curves and their cross derivatives makes them agree";
            if (twist_ == Twist::compatible && HermiteDoctor(*this, Twist::gregory).disagreements(as_given, size_of_places(as_given.sides)).empty())
                d.misfit += "; only the twists differ, and the twist gregory takes both";
            if (!frame.fits) d.misfit += " (the curves alone close with " + frame.changes + ")";
        }
        return d;
    }

private:
    double size_of_places(const Repair& r) const {
        double size = 0;
        for (std::size_t k = 0; k < 4; ++k) {
            const Curve c = r.reversed[k] ? reversed(curves_[r.order[k]]) : curves_[r.order[k]];
            size = std::max(size, size_of({&c}));
        }
        return size;
    }
    bool closes(const Repair& r, double size) const {
        for (const doctor::Joint& x : doctor::frame_joints) {
            const Point a = along_[r.order[x.a]].turned(r.reversed[x.a], false).value[x.end_a], b = along_[r.order[x.b]].turned(r.reversed[x.b], false).value[x.end_b];
            if (!(distance(a, b) <= doctor::tolerance_of(a, b, size))) return false;
        }
        return true;
    }

    /// What make_coons_hermite would refuse, with the names of the places; empty: nothing.
    std::string disagreements(const HermiteRepair& r, double size) const {
        std::vector<EndData> along, cross;
        double tangents = size;
        for (int k = 0; k < 4; ++k) {
            along.push_back(along_[r.sides.order[k]].turned(r.sides.reversed[k], false));
            cross.push_back(cross_[r.sides.order[k]].turned(r.cross_reversed[k], r.negated[k]));
            tangents += length(cross[k].value[0]);
        }
        std::string list;
        for (int i = 0; i < 2; ++i)
            for (int j = 0; j < 2; ++j) {
                const int g = j, f = 2 + i;
                const std::string at = " at (" + std::to_string(i) + "," + std::to_string(j) + ")";
                const auto compare = [&](const std::string& what, const Point& a, const Point& b, double scale, const std::string& hint) {
                    const double gap = distance(a, b);
                    if (!(gap <= doctor::tolerance_of(a, b, scale))) append(list, what + at + " differ by " + short_text(gap) + hint);
                };
                compare("the positions of " + name_of(f, kCurve) + " and " + name_of(g, kCurve), along[f].value[j], along[g].value[i], size, "");
                compare(name_of(f, kCross) + " and the derivative of " + name_of(g, kCurve), cross[f].value[j], along[g].derivative[i], tangents,
                        ratio_hint(cross[f].value[j], along[g].derivative[i]));
                compare(name_of(g, kCross) + " and the derivative of " + name_of(f, kCurve), cross[g].value[i], along[f].derivative[j], tangents,
                        ratio_hint(cross[g].value[i], along[f].derivative[j]));
                if (twist_ == Twist::compatible)
                    compare("the twists of " + name_of(f, kCross) + " and " + name_of(g, kCross), cross[f].derivative[j], cross[g].derivative[i], tangents + length(cross[f].derivative[j]),
                            "");
            }
        return list;
    }
    /// Tangents along one line differ by their speed: the parameter or the scale of one of them is another.
    static std::string ratio_hint(const Point& a, const Point& b) {
        const double ratio = dot(a, b) / dot(b, b);
        if (!(length(a - ratio * b) <= 1e-9 * length(a)) || !(length(a) > 0)) return "";
        return " (" + short_text(ratio) + " times it" + (ratio > 0 ? ": reparametrise the one or scale the other)" : ")");
    }

    Twist twist_;
    std::vector<Curve> curves_;
    std::vector<EndData> along_, cross_;
};

}  // namespace

HermiteData HermiteRepair::operator()(const HermiteData& given) const {
    HermiteData r = given;
    for (int k = 0; k < 4; ++k) {
        const auto& from = family(given, sides.order[k]);
        const Curve &curve = from[kCurve[sides.order[k]]], &cross = from[kCross[sides.order[k]]];
        family(r, k)[kCurve[k]] = sides.reversed[k] ? reversed(curve) : curve;
        const Curve turned = cross_reversed[k] ? reversed(cross) : cross;
        family(r, k)[kCross[k]] = negated[k] ? linear_combination({-1}, {turned}) : turned;
    }
    return r;
}

Diagnosis<HermiteRepair> diagnose_hermite(const HermiteData& data, Twist twist) { return HermiteDoctor(data, twist).diagnose(); }

}  // namespace isoparm
