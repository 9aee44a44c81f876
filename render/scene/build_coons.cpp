// build_coons.cpp -- surfaces that a scene file gives by curves to interpolate: boolean sums over a rectangle.
#include "network_fit.h"
#include "patches/compatibility.h"
#include "patches/coons.h"
#include "patches/coons_hermite.h"
#include "patches/generalized_coons.h"
#include "patches/gordon.h"
#include "patches/lagrange.h"
#include "patches/network.h"
#include "promises.h"
#include "scene/registry.h"
#include "scene/repair.h"

namespace isoparm {

namespace {

Part part_of(const Json& j, const SceneValues& values) {
    static constexpr Part parts[] = {Part::sum, Part::P1, Part::P2, Part::P1P2};
    const auto part = j.find("part");
    return part ? parts[values.word(*part, {"sum", "P1", "P2", "P1P2"})] : Part::sum;
}

Twist twist_of(const Json& j, const SceneValues& values, Twist otherwise) {
    static constexpr Twist twists[] = {Twist::compatible, Twist::gregory, Twist::average, Twist::zero};
    const auto twist = j.find("twist");
    return twist ? twists[values.word(*twist, {"compatible", "gregory", "average", "zero"})] : otherwise;
}

std::optional<Function> blend_of(const Json& j, const SceneValues& values) {
    const auto blend = j.find("blend");
    if (!blend || (blend->is(Json::Kind::string) && blend->string() == "linear")) return {};
    if (blend->is(Json::Kind::string) && blend->string() == "cubic") return cubic_blend();
    return values.function(*blend, 0, 1);
}

std::array<Curve, 4> four_curves(const Json& j, const char* key, const char* meaning, SceneBuilder& scene) {
    const auto c = scene.curves(j.at(key, meaning), 4, 4);
    return {c[0], c[1], c[2], c[3]};
}

/// The whole surface keeps promises; a part of its construction does not.
BuiltSurface examined(Patch patch, Part part, std::function<DataReport()> by) {
    BuiltSurface s(std::move(patch));
    if (part == Part::sum) s.examine = std::move(by);
    return s;
}

std::vector<double> nodes(const Json& j, const char* key, const SceneValues& values) {
    return values.numbers(j.at(key, "the parameters of the curves"), 2, most_nodes, "parameters");
}

/// A network without nodes: where its curves cross is found.
GordonNetwork on_a_grid(const GordonNetwork& given, const Json& j, SceneBuilder& scene, std::string& detail) {
    NetworkFit fit = fit_network(given.u_curves, given.v_curves);
    const double tolerance = std::max(compatibility_tolerance * fit.size, given.tolerance);
    if (!(fit.gap <= tolerance)) {
        const std::string open = std::to_string(fit.open) + " of " + std::to_string(given.u_curves.size() * given.v_curves.size()) + " crossings are open (sampled), widest " + fit.where;
        throw IncompatibleError("u_curves and v_curves meet", fit.gap, tolerance, open + ": bring the curves together, or give \"tolerance\" of at least the gap: the surface then passes midway, and isoparm check proves how far it misses the curves");
    }
    if (!fit.changes.empty()) scene.note(j, "curves put on a grid: " + fit.changes);
    if (fit.open > 0) scene.note(j, std::to_string(fit.open) + " crossings are open, within the tolerance: widest " + to_text(fit.gap) + ", " + fit.where);
    detail = "crossings found, widest gap " + to_text(fit.gap) + " (sampled)";
    fit.network.tolerance = given.tolerance;
    return fit.network;
}

}  // namespace

CoonsCurves frame_of(const Json& j, SceneBuilder& scene) {
    if (const auto loop = j.find("loop")) {
        for (const char* key : {"c0", "c1", "d0", "d1", "repair"})
            if (const auto also = j.find(key)) also->expected("\"loop\" without \"" + std::string(key) + "\": a loop gives all four curves and is always put in order");
        const auto side = scene.curves(*loop, 4, 4);
        return {side[0], side[2], side[3], side[1]};  // around: c0, d1, c1, d0; fitted() turns and exchanges what does not run so
    }
    return {scene.curve(j, "c0", "the curve x(u,0)"), scene.curve(j, "c1", "the curve x(u,1)"), scene.curve(j, "d0", "the curve x(0,v)"),
            scene.curve(j, "d1", "the curve x(1,v)")};
}

BuiltSurface build_coons(const Json& j, SceneBuilder& scene) {
    const auto blend = blend_of(j, scene.values());
    const Part part = part_of(j, scene.values());
    return fitted(frame_of(j, scene), j, scene, [&](const CoonsCurves& c) { return examined(make_coons(c, blend, part), part, [c] { return examine(c); }); });
}

BuiltSurface build_coons_hermite(const Json& j, SceneBuilder& scene) {
    const HermiteData data{four_curves(j, "f", "the curves x(0,v), x_u(0,v), x_u(1,v), x(1,v)", scene),
                           four_curves(j, "g", "the curves x(u,0), x_v(u,0), x_v(u,1), x(u,1)", scene)};
    const Twist twist = twist_of(j, scene.values(), Twist::compatible);
    const Part part = part_of(j, scene.values());
    return fitted(HermiteCurves{data, twist}, j, scene, [&](const HermiteCurves& d) {
        return examined(make_coons_hermite(d.data, twist, part), part, [data = d.data, twist] { return examine(data, twist); });
    });
}

BuiltSurface build_gordon(const Json& j, SceneBuilder& scene) {
    static constexpr GordonBlend blends[] = {GordonBlend::lagrange, GordonBlend::hermite};
    const SceneValues& values = scene.values();
    const auto blend = j.find("blend");
    const auto tolerance = j.find("tolerance");
    std::string detail;
    GordonNetwork network{scene.curves(j.at("u_curves", "the curves x(u, v_nodes[j])"), 2, most_nodes), {}, scene.curves(j.at("v_curves", "the curves x(u_nodes[i], v)"), 2, most_nodes), {}};
    if (tolerance) network.tolerance = values.positive(*tolerance, "a positive tolerance in scene units");
    if (j.find("u_nodes") || j.find("v_nodes")) {
        network.v_nodes = nodes(j, "v_nodes", values);
        network.u_nodes = nodes(j, "u_nodes", values);
    } else {
        network = on_a_grid(network, j, scene, detail);
    }
    const GordonBlend kind = blend ? blends[values.word(*blend, {"lagrange", "hermite"})] : GordonBlend::lagrange;
    const Part part = part_of(j, values);
    return fitted(network, j, scene, [&](const GordonNetwork& n) {
        const Patch patch = make_gordon(n, kind, part);
        BuiltSurface s = examined(patch, part, [n, kind, domain = patch.rect()] { return examine(n, kind, domain); });
        s.detail = detail;
        return s;
    });
}

BuiltSurface build_lagrange(const Json& j, SceneBuilder& scene) {
    return make_lagrange(scene.curves(j.at("curves", "the curves x(u, nodes[i])"), 2, most_nodes), nodes(j, "nodes", scene.values()));
}

BuiltSurface build_generalized_coons(const Json& j, SceneBuilder& scene) {
    const SceneValues& values = scene.values();
    const auto direction = [&](const char* key, std::vector<Functional>& functionals, std::vector<Function>& blends, const Curve& along) {
        const Json d = j.at(key, "{\"functionals\": [...], \"blends\": [...]}");
        if (!d.is(Json::Kind::object)) d.expected("{\"functionals\": [...], \"blends\": [...]}");
        d.allow_keys({"functionals", "blends"});
        const std::string what = "functionals {\"value\": t} or {\"derivative\": t}";
        for (const Json& l : values.list(d.at("functionals", what), 1, most_nodes, what)) {
            if (!l.is(Json::Kind::object) || l.size() != 1) l.expected("{\"value\": t} or {\"derivative\": t}");
            l.allow_keys({"value", "derivative"});
            const Json at = l.children().front();
            functionals.push_back({at.key() == "value" ? Functional::Kind::value : Functional::Kind::derivative, values.number(at, "a parameter")});
        }
        for (const Json& h : values.list(d.at("blends", "a formula in t for every functional"), functionals.size(), functionals.size(), "formulas in t"))
            blends.push_back(values.function(h, along.begin(), along.end()));
    };
    GeneralizedCoons data;
    const Json f = j.at("f", "a curve f_i(v) for every functional of u"), g = j.at("g", "a curve g_j(u) for every functional of v");
    direction("u", data.u, data.blend_u, scene.curves(g, 1, most_nodes).front());
    direction("v", data.v, data.blend_v, scene.curves(f, 1, most_nodes).front());
    data.f = scene.curves(f, data.u.size(), data.u.size());
    data.g = scene.curves(g, data.v.size(), data.v.size());
    return make_generalized_coons(data, part_of(j, values));
}

BuiltSurface build_network(const Json& j, SceneBuilder& scene) {
    const SceneValues& values = scene.values();
    const Network network{scene.curves(j.at("a", "the curves x(i,v), i = 0..m"), 2, 1000), scene.curves(j.at("b", "the curves x(u,j), j = 0..n"), 2, 1000)};
    const Twist twist = twist_of(j, values, Twist::average);
    const Part part = part_of(j, values);
    const auto cross = j.find("cross");
    if (!cross || cross->is(Json::Kind::string)) {
        if (cross) values.word(*cross, {"finite_difference"});
        return fitted(network, j, scene, [&](const Network& n) {
            return examined(make_network(n, twist, part), part, [n, twist] { return examine(n, nullptr, twist); });
        });
    }
    if (repair_wanted(j, scene))
        j.at("repair", "true or false").expected("no repair of a network with twists or cross derivatives of its own: they would have to change places with the curves");
    const std::string expected = "\"finite_difference\", {\"twists\": [[d_ij]]} or {\"A\": [...], \"B\": [...]}";
    if (!cross->is(Json::Kind::object)) cross->expected(expected);
    const auto twists = cross->find("twists");
    if (twists) cross->allow_keys({"twists"});
    else cross->allow_keys({"twists", "A", "B"});
    const std::size_t m = network.a.size(), n = network.b.size();
    const auto curves = [&](const char* key, const char* meaning, std::size_t count) { return scene.curves(cross->at(key, meaning), count, count); };
    try {
        const CrossDerivatives given = twists ? from_twists(network, values.grid(*twists, 2, 2, 1000)) : CrossDerivatives{curves("A", "the curves x_u(i,v), one for every curve a", m), curves("B", "the curves x_v(u,j), one for every curve b", n)};
        return examined(make_network(network, given, twist, part), part, [network, given, twist] { return examine(network, &given, twist); });
    } catch (const IncompatibleError& error) {
        const auto diagnosis = cure(network);
        if (diagnosis.fits || diagnosis.misfit.empty()) throw;
        throw_advised(error, diagnosis.misfit + (diagnosis.data ? ", but the curves fit with " + diagnosis.changes : ""));
    }
}

}  // namespace isoparm
