#include "scene/scene_axes.h"

#include <algorithm>
#include <array>

#include "drawing/comb.h"
#include "scene/scene_objects.h"
#include "scene/suggest.h"

namespace isoparm {

namespace {

using Kind = Json::Kind;

constexpr const char* kAxisNames[3] = {"x", "y", "z"};

struct Ticks {
    std::optional<std::vector<double>> at;
    std::vector<MathText> texts;
};

/// false: none; true: round numbers; [0, 0.5, 1]: these; [[0, "i"], [1, "i+1"]]: these, with texts for their numbers.
Ticks read_ticks(const Json& j, const SceneValues& values) {
    if (j.is(Kind::boolean)) {
        if (j.boolean()) return {};
        return {std::vector<double>{}, {}};
    }
    if (!j.is(Kind::array)) j.expected("true, false, or an array of numbers, or of [number, \"text\"]");
    std::vector<std::pair<double, MathText>> all;
    for (const Json& t : values.list(j, 0, 1000, "numbers, or [number, \"text\"]")) {
        if (!t.is(Kind::array)) {
            all.emplace_back(values.number(t, "a number, or [number, \"text\"]"), MathText{});
            continue;
        }
        const auto pair = values.list(t, 2, 2, "a number and a text");
        all.emplace_back(values.number(pair[0]), read_math_text(pair[1], values, false));
    }
    std::stable_sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    Ticks ticks{std::vector<double>{}, {}};
    for (auto& [number, text] : all) {
        ticks.at->push_back(number);
        ticks.texts.push_back(std::move(text));
    }
    return ticks;
}

}  // namespace

Axes read_axes(const Json& j, const SceneValues& values) {
    must_be_object(j, "axes {\"x\": [from, to], \"y\": [from, to]}");
    j.allow_keys({"x", "y", "z", "ticks", "names", "origin"});
    Axes axes;
    if (const auto origin = j.find("origin")) axes.origin = values.point(*origin);
    const auto ticks = j.find("ticks"), names = j.find("names");
    if (ticks && ticks->is(Kind::object)) ticks->allow_keys({"x", "y", "z"});
    const auto names_of = names ? values.list(*names, 1, 3, "names, one an axis") : std::vector<Json>{};
    std::size_t count = 0;
    for (int k = 0; k < 3; ++k) {
        const auto range = j.find(kAxisNames[k]);
        if (!range) continue;
        const auto [low, high] = values.interval(*range);
        Axes::Axis& axis = *(axes.axis[k] = Axes::Axis());
        axis.low = low;
        axis.high = high;
        if (ticks) {
            const auto own = ticks->is(Kind::object) ? ticks->find(kAxisNames[k]) : nullptr;
            if (own || !ticks->is(Kind::object)) {
                Ticks read = read_ticks(own ? *own : *ticks, values);
                axis.ticks = std::move(read.at);
                axis.tick_texts = std::move(read.texts);
            }
        }
        if (count < names_of.size()) axis.name = read_math_text(names_of[count], values, false);
        ++count;
    }
    if (count == 0) j.fail("found axes without a range, expected at least one of \"x\", \"y\" and \"z\": [from, to]");
    if (names && names_of.size() != count) names->fail("found " + std::to_string(names_of.size()) + " names for " + std::to_string(count) + " axes, expected one each");
    return axes;
}

namespace {

/// The vector of an arrow at a place of a surface.
Point vector_of(const Json& j, const Patch& patch, const Vec2& uv, const SceneValues& values) {
    const auto along = j.at("along", "what it shows: \"u\", \"v\", \"uu\", \"uv\", \"vv\" or \"normal\"");
    const auto which = values.word(along, {"u", "v", "uu", "uv", "vv", "normal"});
    const SurfacePoint s = evaluate(patch, uv.x, uv.y);
    const std::array<std::optional<Point>, 6> all{s.du, s.dv, s.duu, s.duv, s.dvv, s.normal};
    if (!all[which]) along.fail("found " + quoted(along.string()) + " at [" + to_text(uv.x) + ", " + to_text(uv.y) + "], where the surface has no such vector, expected another place");
    return *all[which];
}

/// Of a curve: its derivative, or the unit vector toward its centre of curvature.
Point vector_of(const Json& j, const Curve& curve, double t, const SceneValues& values) {
    const auto along = j.find("along");
    if (!along || values.word(*along, {"tangent", "normal"}) == 0) return curve.derivative(t);
    const Point k = curvature_vector(curve, t);
    const double turning = length(k) * length(curve.derivative(t));  // radians to a unit of the parameter
    if (!(turning > 1e-9)) along->fail("found \"normal\" at " + to_text(t) + ", where the curve is straight, expected another place");
    return normalized(k);
}

}  // namespace

Arrow read_arrow(const Json& j, SceneBuilder& builder) {
    const SceneValues& values = builder.values();
    must_be_object(j, "an arrow {\"from\": point, \"to\": point}, or {\"surface\": ..., \"at\": [u, v], \"along\": \"u\"}, or {\"curve\": ..., \"at\": t}");
    const auto from = j.find("from"), surface = j.find("surface"), curve = j.find("curve");
    j.must_have_one({"from", "surface", "curve"});
    Arrow arrow;
    Point vector;
    if (from) {
        j.allow_keys({"from", "to"});
        arrow.tail = values.point(*from);
        vector = values.point(j.at("to", "the point at the arrow's tip")) - arrow.tail;
    } else {
        j.allow_keys({surface ? "surface" : "curve", "at", "along", "scale", "length"});
        const Json at = j.at("at", surface ? "its place, [u, v]" : "its place, a parameter of the curve");
        if (surface) {
            const Patch patch = builder.patch(*surface);
            const Vec2 uv = place_on(patch, at, values);
            arrow.tail = patch.point(uv.x, uv.y);
            vector = vector_of(j, patch, uv, values);
        } else {
            const Curve c = builder.curve(*curve).curve;
            const double t = place_on(c, at, values);
            arrow.tail = c(t);
            vector = vector_of(j, c, t, values);
        }
        const auto scale = j.find("scale"), size = j.find("length");
        if (scale && size) scale->fail_at_key("found both \"scale\" and \"length\", expected one of them");
        if (scale) vector = values.number(*scale, "a number: the arrow's length, in lengths of the vector") * vector;
        if (size && length(vector) > 0) vector = (values.positive(*size, "a positive length in scene units") / length(vector)) * vector;
    }
    arrow.tip = arrow.tail + vector;
    if (!(length(vector) > 0) || !finite(arrow.tip)) j.fail("found an arrow of no length, or of one beyond all bounds, expected one with a direction");
    return arrow;
}

double place_on(const Curve& curve, const Json& at, const SceneValues& values) {
    return values.in_range(at, curve.begin(), curve.end(), "a parameter of the curve, from " + to_text(curve.begin()) + " to " + to_text(curve.end()));
}

Vec2 place_on(const Patch& patch, const Json& at, const SceneValues& values) {
    const auto uv = values.numbers(at, 2, 2, "numbers [u, v]");
    const Rect r = patch.rect();
    const bool inside = uv[0] >= r.u0 && uv[0] <= r.u1 && uv[1] >= r.v0 && uv[1] <= r.v1 && (patch.domain() == Domain::quad || uv[0] + uv[1] <= 1);
    if (!inside) at.fail("found [" + to_text(uv[0]) + ", " + to_text(uv[1]) + "], expected a point of the domain of the surface");
    return {uv[0], uv[1]};
}

}  // namespace isoparm
