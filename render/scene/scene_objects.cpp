#include "scene/scene_objects.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "promises.h"
#include "scene/scene_axes.h"
#include "scene/scene_light.h"
#include "scene/suggest.h"

namespace isoparm {

namespace {

using Kind = Json::Kind;

Isolines read_isolines(const Json& j, const SceneValues& values) {
    must_be_object(j, "isolines {\"u\": count, \"v\": count}");
    j.allow_keys({"u", "v", "width", "color", "opacity"});
    Isolines lines;
    if (const auto u = j.find("u")) lines.u = values.integer(*u, 0, 1000, "a number of lines");
    if (const auto v = j.find("v")) lines.v = values.integer(*v, 0, 1000, "a number of lines");
    if (const auto width = j.find("width")) lines.width = read_pixels(*width, values, 1000, "a width");
    if (const auto color = j.find("color")) lines.color = values.color(*color);
    if (const auto opacity = j.find("opacity")) lines.opacity = values.in_range(*opacity, 0, 1, "an opacity from 0 to 1");
    return lines;
}

ControlNet net_named(const Json& name, SceneBuilder& builder) {
    const std::string& wanted = builder.values().text(name, "the name of a surface or curve with control points");
    std::vector<std::string> names = builder.surface_names();
    const bool surface = std::find(names.begin(), names.end(), wanted) != names.end();
    const auto curves = builder.curve_names();
    names.insert(names.end(), curves.begin(), curves.end());
    if (std::find(names.begin(), names.end(), wanted) == names.end()) {
        name.expected("the name of a surface or curve (have: " + listed(names) + ")" + did_you_mean(wanted, names));
    }
    ControlNet net = surface ? builder.surface(name).net : builder.curve(name).net;
    if (net.points.empty()) name.expected("a surface or curve with control points (bezier, bspline, bezier_triangle, line ...)");
    return net;
}

// ---- labels and lines -----------------------------------------------------------------------------------------------

Hidden read_hidden(const Json& j, const SceneValues& values) { return static_cast<Hidden>(values.word(j, {"ghost", "hide", "show", "dash"})); }

LineStyle read_line(const Json& j, const SceneValues& values, LineStyle line) {
    const auto width = j.find("line"), dash = j.find("dash"), hidden = j.find("hidden");
    if (width) line.width = read_pixels(*width, values, 1000, "a width");
    if (dash) {
        if (!(line.width > 0)) dash->fail_at_key("found \"dash\" without \"line\", expected the width of a flat line too, such as \"line\": 2");
        for (const Json& d : values.list(*dash, 1, 16, "lengths in pixels: on, off, ...")) line.dash.push_back(read_pixels(d, values, 10000, "a length"));
    }
    if (hidden) line.hidden = read_hidden(*hidden, values);
    return line;
}

/// true, or {"width": ..., and how it looks}.
Outline read_outline(const Json& j, const SceneValues& values) {
    Outline outline;
    outline.line.width = 2;
    if (j.is(Kind::boolean)) {
        if (!j.boolean()) outline.line.width = 0;
        return outline;
    }
    if (!j.is(Kind::object)) j.expected("true, false, or an outline {\"width\": ..., \"color\": ...}");
    j.allow_keys({"width", "color", "opacity", "dash", "hidden"});
    if (const auto width = j.find("width")) outline.line.width = read_pixels(*width, values, 1000, "a width");
    outline.line = read_line(j, values, outline.line);
    if (const auto color = j.find("color")) outline.color = values.color(*color);
    if (const auto opacity = j.find("opacity")) outline.opacity = values.in_range(*opacity, 0, 1, "an opacity from 0 to 1");
    return outline;
}

void read_place(const Json& at, const SceneValues& values, SceneBuilder& builder, const Json& name, SceneObject& o) {
    if (o.kind == SceneObject::Kind::curve) {
        o.label.at = place_on(builder.curve(name).curve, at, values);
        return;
    }
    const BuiltSurface s = builder.surface(name);
    if (s.patches.size() != 1) at.fail("found a place on a surface of " + std::to_string(s.patches.size()) + " patches, expected one of a single patch");
    o.label.at_uv = place_on(s.patches[0].patch, at, values);
}

/// "text", or {"text": ..., and how it looks}. `name`: the curve or surface.
void read_label(const Json& j, SceneBuilder& builder, const Json& name, SceneObject& o) {
    const SceneValues& values = builder.values();
    if (j.is(Kind::string)) {
        o.label.text = read_math_text(j, values, false);
        return;
    }
    if (!j.is(Kind::object)) j.expected("a text, or {\"text\": ..., \"at\": ..., \"side\": ...}");
    const bool placed = o.kind == SceneObject::Kind::curve || o.kind == SceneObject::Kind::surface;
    if (placed) j.allow_keys({"text", "at", "side", "leader", "size", "color", "hidden"});
    else j.allow_keys({"text", "side", "leader", "size", "color", "hidden"});
    o.label.text = read_math_text(j.at("text", "the text of the label"), values, false);
    if (const auto at = j.find("at")) read_place(*at, values, builder, name, o);
    if (const auto side = j.find("side")) {
        o.label.side = static_cast<int>(values.word(*side, {"right", "above right", "above", "above left", "left", "below left", "below", "below right", "center"}));
    }
    if (const auto leader = j.find("leader")) o.label.leader = values.boolean(*leader);
    if (const auto size = j.find("size")) o.label.size = read_pixels(*size, values, 1000, "a size of letters");
    if (const auto color = j.find("color")) o.label.color = values.color(*color);
    if (const auto hidden = j.find("hidden")) o.label.hidden = read_hidden(*hidden, values);
}

/// "P": P_{00}, P_{01}, ...; or {"text": "P", and how they look}.
std::vector<Label> read_net_labels(const Json& j, const SceneValues& values, const ControlNet& net) {
    Label look;
    if (j.is(Kind::object)) {
        j.allow_keys({"text", "size", "color", "hidden"});
        if (const auto size = j.find("size")) look.size = read_pixels(*size, values, 1000, "a size of letters");
        if (const auto color = j.find("color")) look.color = values.color(*color);
        if (const auto hidden = j.find("hidden")) look.hidden = read_hidden(*hidden, values);
    } else if (!j.is(Kind::string)) {
        j.expected("the letter of the points, such as \"P\", or {\"text\": \"P\", ...}");
    }
    const Json letter = j.is(Kind::object) ? j.at("text", "the letter of the points, such as \"P\"") : j;
    read_math_text(letter, values, false);
    if (letter.string().find_first_of("_$") != std::string::npos) letter.expected("a letter without _ and $, to which the indices are added");
    if (net.indices.size() != net.points.size()) j.expected("no labels: the points of this net have no indices");
    std::vector<Label> labels(net.points.size(), look);
    for (std::size_t i = 0; i < labels.size(); ++i) labels[i].text = parse_math_text(letter.string() + "_{" + net.indices[i] + "}");
    return labels;
}

// ---- smoothness -----------------------------------------------------------------------------------------------------

ColorBy read_color_by(const Json& j, const Json& object, const SceneValues& values) {
    ColorBy by;
    by.what = static_cast<ColorBy::What>(1 + values.word(j, {"gaussian", "mean", "k1", "k2", "reflection", "isophotes"}));
    const auto range = object.find("range"), legend = object.find("legend"), stripes = object.find("stripes"), direction = object.find("direction");
    for (const auto* key : {&range, &legend})
        if (*key && !by.curvature()) (*key)->fail_at_key("found " + quoted((*key)->key()) + " with stripes, expected it with a curvature");
    for (const auto* key : {&stripes, &direction})
        if (*key && by.curvature()) (*key)->fail_at_key("found " + quoted((*key)->key()) + " with a curvature, expected it with \"reflection\" or \"isophotes\"");
    if (range) by.range = values.interval(*range);
    if (legend) by.legend = values.boolean(*legend);
    if (stripes) by.stripes = values.in_range(*stripes, 1, 1000, "a number of pairs of stripes in 360 degrees, from 1 to 1000");
    if (direction) {
        by.direction = values.point(*direction);
        if (!(length(*by.direction) > 0) || !std::isfinite(length(*by.direction))) direction->expected("a direction that is not zero");
    }
    return by;
}

JumpHeat read_jumps(const Json& j, const SceneValues& values) {
    must_be_object(j, "{\"of\": \"g1\" or \"g2\"}");
    j.allow_keys({"of", "top", "width", "legend"});
    JumpHeat heat;
    heat.of = static_cast<JumpHeat::Of>(1 + values.word(j.at("of", "what jumps: \"g1\" or \"g2\""), {"g1", "g2"}));
    if (const auto top = j.find("top")) heat.top = values.positive(*top, "a positive number: the jump of the last colour");
    if (const auto width = j.find("width")) heat.width = read_pixels(*width, values, 1000, "a width");
    if (const auto legend = j.find("legend")) heat.legend = values.boolean(*legend);
    return heat;
}

Comb read_comb(const Json& j, const SceneValues& values) {
    Comb comb;
    comb.teeth = 60;
    if (j.is(Kind::boolean)) {
        if (!j.boolean()) comb.teeth = 0;
        return comb;
    }
    must_be_object(j, "true, or a comb {\"teeth\": count, \"scale\": s}");
    j.allow_keys({"teeth", "scale", "width", "color"});
    if (const auto teeth = j.find("teeth")) comb.teeth = values.integer(*teeth, 2, 10000, "a number of teeth");
    if (const auto scale = j.find("scale")) comb.scale = values.positive(*scale, "a positive scale: the length of a tooth where the curvature is 1");
    if (const auto width = j.find("width")) comb.width = read_pixels(*width, values, 1000, "a width");
    if (const auto color = j.find("color")) comb.color = values.color(*color);
    return comb;
}

TwistArrows read_twists(const Json& j, const Json& surface, SceneBuilder& builder) {
    const SceneValues& values = builder.values();
    TwistArrows twists;
    if (j.is(Kind::boolean)) twists.on = j.boolean();
    else {
        must_be_object(j, "true, or arrows {\"scale\": s, \"width\": pixels, \"legend\": true}");
        j.allow_keys({"scale", "width", "legend"});
        twists.on = true;
        if (const auto scale = j.find("scale")) twists.scale = values.positive(*scale, "a positive scale: the length of the arrow of a twist of length 1");
        if (const auto width = j.find("width")) twists.width = read_pixels(*width, values, 1000, "a width");
        if (const auto legend = j.find("legend")) twists.legend = values.boolean(*legend);
    }
    const auto examine = builder.surface(surface).examine;
    if (twists.on && (!examine || examine().twists.empty()))
        j.fail_at_key("found \"twists\" of " + quoted(surface.string()) + ", expected a surface whose data have twists: coons_hermite or network, whole (no \"part\"), or a composite or a moved copy of such");
    return twists;
}

/// 0.5 of "0.5pt".
std::optional<double> in_points(const Json& j) {
    if (!j.is(Kind::string) || j.string().size() < 3 || !j.string().ends_with("pt")) return {};
    const std::string& text = j.string();
    const char* end = text.data() + text.size() - 2;
    double points = 0;
    const auto [stop, error] = std::from_chars(text.data(), end, points);
    return error == std::errc() && stop == end ? std::optional(points) : std::nullopt;
}

}  // namespace

/// A number of pixels, or a text such as "0.5pt": points of the printed picture.
Extent read_pixels(const Json& j, const SceneValues& values, double most, const std::string& what) {
    const std::string expected = what + " in pixels, from 0.01 to " + to_text(most) + ", or in points of the printed picture, such as \"0.5pt\"";
    if (const auto points = in_points(j)) {
        if (!(*points >= 0.01 && *points <= most)) j.expected(expected);
        return {*points, true};
    }
    return values.in_range(j, 0.01, most, expected);
}

void must_be_object(const Json& j, const std::string& what) {
    if (!j.is(Kind::object)) j.expected(what);
}

MathText read_math_text(const Json& j, const SceneValues& values, bool prose) {
    try {
        return parse_math_text(values.text(j, "a text"), prose);
    } catch (const MathTextError& e) {
        j.fail_inside(e.offset, std::string(e.what()) + ", in the text " + quoted(j.string()));
    }
}

SceneObject read_object(const Json& j, SceneBuilder& builder) {
    const SceneValues& values = builder.values();
    must_be_object(j, "an object with one of the keys surface, curve, net, point, axes or arrow");
    const auto surface = j.find("surface"), curve = j.find("curve"), net = j.find("net"), point = j.find("point"), axes = j.find("axes"), arrow = j.find("arrow");
    j.must_have_one({"surface", "curve", "net", "point", "axes", "arrow"});

    SceneObject o;
    if (surface) {
        j.allow_keys({"surface", "color", "back", "opacity", "isolines", "boundary", "outline", "material", "radius", "label", "line", "dash", "hidden", "color_by", "range", "legend", "stripes", "direction", "jumps", "twists"});
        o.kind = SceneObject::Kind::surface;
        o.name = values.text(*surface, "the name of a surface");
        builder.surface(*surface);
        if (const auto back = j.find("back")) o.back = values.color(*back);
        if (const auto lines = j.find("isolines")) o.isolines = read_isolines(*lines, values);
        if (const auto by = j.find("color_by")) o.color_by = read_color_by(*by, j, values);
        else
            for (const char* key : {"range", "legend", "stripes", "direction"})
                if (const auto extra = j.find(key)) extra->fail_at_key("found " + quoted(key) + " without \"color_by\", expected what the colours say");
        if (const auto jumps = j.find("jumps")) o.jumps = read_jumps(*jumps, values);
        if (const auto twists = j.find("twists")) o.twists = read_twists(*twists, *surface, builder);
        if (const auto boundary = j.find("boundary")) o.boundary = values.boolean(*boundary);
        if (const auto outline = j.find("outline")) o.outline = read_outline(*outline, values);
    } else if (curve) {
        j.allow_keys({"curve", "color", "opacity", "material", "radius", "label", "line", "dash", "hidden", "comb"});
        if (const auto comb = j.find("comb")) o.comb = read_comb(*comb, values);
        o.kind = SceneObject::Kind::curve;
        o.name = values.text(*curve, "the name of a curve");
        builder.curve(*curve);
    } else if (net) {
        j.allow_keys({"net", "color", "opacity", "material", "radius", "label", "labels", "line", "dash", "hidden"});
        o.kind = SceneObject::Kind::net;
        o.net = net_named(*net, builder);
        o.name = net->string();
        if (const auto labels = j.find("labels")) o.net_labels = read_net_labels(*labels, values, o.net);
    } else if (point) {
        j.allow_keys({"point", "color", "opacity", "material", "radius", "label", "dot", "hidden"});
        o.kind = SceneObject::Kind::point;
        o.point = values.point(*point);
    } else if (arrow) {
        j.allow_keys({"arrow", "color", "opacity", "line", "dash", "hidden", "label"});
        o.kind = SceneObject::Kind::arrow;
        o.arrow = read_arrow(*arrow, builder);
        o.line.width = 2;
    } else {
        j.allow_keys({"axes", "color", "opacity", "line", "hidden", "size"});
        o.kind = SceneObject::Kind::axes;
        o.axes = read_axes(*axes, values);
        o.line.width = 1.5;
        if (const auto size = j.find("size")) o.label.size = read_pixels(*size, values, 1000, "a size of letters");
    }
    if (const auto dot = j.find("dot")) o.line.width = read_pixels(*dot, values, 1000, "a diameter");
    o.line = read_line(j, values, o.line);
    if (surface && o.line.width > 0 && !o.boundary) j.find("line")->fail_at_key("found \"line\" without \"boundary\", expected \"boundary\": true, which it draws");
    if (const auto radius = j.find("radius")) {
        if (o.line.width > 0 && !net)
            radius->fail_at_key(std::string("found both \"radius\" and \"") + (point ? "dot\", expected a ball or a flat dot" : "line\", expected a tube or a flat line"));
        const std::string expected = "a positive radius in scene units, or in points of the printed picture, such as \"0.5pt\"";
        const auto points = in_points(*radius);
        if (points && !(*points >= 0.01 && *points <= 1000)) radius->expected(expected);
        o.radius = points ? Extent(*points, true) : Extent(values.positive(*radius, expected));
    }
    if (const auto label = j.find("label")) read_label(*label, builder, surface ? *surface : curve ? *curve : *label, o);
    if (const auto color = j.find("color")) o.color = values.color(*color);
    if (const auto opacity = j.find("opacity")) o.opacity = values.in_range(*opacity, 0, 1, "an opacity from 0 to 1");
    if (const auto material = j.find("material")) o.material = read_material(*material, values);
    return o;
}

}  // namespace isoparm
