// golden_program_test.cpp -- the program from end to end: a scene written from the golden data, `eval --json` on it, and the
// numbers that a user reads against the golden ones. Golden numbers go into the scene as they stand, some of them texts such
// as "sqrt(2)/2", which the scene reads as expressions.
#include "golden.h"

namespace isoparm::test {
namespace {

using Json::Value;

const std::string kRoot = "sqrt(2)/2";

template <class... T> Value list(const T&... items) {
    Value v(Json::arrayValue);
    (v.append(items), ...);
    return v;
}
/// A scene with one surface S; curves are added by name.
class SceneText {
public:
    std::string curve(const Value& points, const Value& weights = {}) {
        Value c;
        c["type"] = "bezier";
        c["points"] = points;
        if (!weights.isNull()) c["weights"] = weights;
        return named(c);
    }
    std::string isocurve(const char* constant, const Value& at) {
        Value c;
        c["type"] = "isocurve";
        c["surface"] = "P";
        c[constant] = at;
        return named(c);
    }
    Value curves(const Value& many) {
        Value names(Json::arrayValue);
        for (const auto& points : many) names.append(curve(points));
        return names;
    }
    void bezier_surface(const char* name, const Value& points) {
        scene["surfaces"][name]["type"] = "bezier";
        scene["surfaces"][name]["points"] = points;
    }
    Value& surface() { return scene["surfaces"]["S"]; }
    std::string string() {
        scene["isoparm"] = 1;
        Json::StreamWriterBuilder b;
        b["precision"] = 17;
        return Json::writeString(b, scene);
    }

private:
    std::string named(const Value& c) {
        const std::string name = "c" + std::to_string(scene["curves"].size());
        scene["curves"][name] = c;
        return name;
    }
    Value scene;
};

// ---- rectangles -----------------------------------------------------------------------------------------------------
void coons(SceneText& t, const Value& d) {
    for (const char* key : {"c0", "c1", "d0", "d1"}) t.surface()[key] = t.curve(d[key]);
}
void coons_hermite(SceneText& t, const Value& d) {
    t.surface()["type"] = "coons_hermite";
    t.surface()["f"] = t.curves(d["f=[x(0,v),xu(0,v),xu(1,v),x(1,v)]"]);
    t.surface()["g"] = t.curves(d["g=[x(u,0),xv(u,0),xv(u,1),x(u,1)]"]);
}
void hermite(SceneText& t, const Value& d) {
    t.surface()["type"] = "hermite";
    const std::pair<const char*, const char*> grids[] = {{"points", "r"}, {"du", "u"}, {"dv", "v"}, {"duv", "uv"}};
    for (const auto& [key, what] : grids)
        for (int i = 0; i <= 2; ++i)
            for (int j = 0; j <= 2; ++j)
                t.surface()[key][i][j] = d["nodes (i,j): r,u,v,uv"][std::to_string(i) + "," + std::to_string(j)][what];
}
void gordon(SceneText& t, const Value& d) {
    t.surface()["type"] = "gordon";
    t.bezier_surface("P", d["P"]);
    for (const auto& v : d["v_nodes"]) t.surface()["u_curves"].append(t.isocurve("v", v));
    for (const auto& u : d["u_nodes"]) t.surface()["v_curves"].append(t.isocurve("u", u));
    t.surface()["u_nodes"] = d["u_nodes"];
    t.surface()["v_nodes"] = d["v_nodes"];
}
void network(SceneText& t, const Value& d) {
    t.surface()["type"] = "network";
    t.bezier_surface("P", d["P"]);
    for (const char* at : {"0", "1/3", "2/3", "1"}) t.surface()["a"].append(t.isocurve("u", at));
    for (const char* at : {"0", "1/2", "1"}) t.surface()["b"].append(t.isocurve("v", at));
}
void lagrange(SceneText& t, const Value& d) {
    t.surface()["type"] = "lagrange";
    t.surface()["curves"] = t.curves(d["curves r(u,0..3)"]);
    t.surface()["nodes"] = list(0, 1, 2, 3);
}

// ---- triangles ------------------------------------------------------------------------------------------------------
void edges(SceneText& t, const Value& d) {
    t.surface()["type"] = "coons_triangle";
    if (d.isMember("E1")) {
        for (const char* key : {"E1", "E2", "E3"}) t.surface()["edges"].append(t.curve(d[key]));
        return;
    }
    const Value a = list(1, 0, 0), b = list(0, 1, 0), c = list(0, 0, 1);  // the octant of the sphere
    const Value corner[] = {list(0, 1, 1), list(1, 0, 1), list(1, 1, 0)}, w = list(1, kRoot, 1);
    t.surface()["edges"] = list(t.curve(list(b, corner[0], c), w), t.curve(list(c, corner[1], a), w), t.curve(list(a, corner[2], b), w));
}
void cross_derivatives(SceneText& t, const Value& d) {
    for (const char* key : {"D1", "D2", "D3"}) t.surface()["cross"].append(t.curve(d[key]));
}
void nielson_g1(SceneText& t, const Value& d) {
    t.surface()["method"] = "nielson_g1";
    for (const char* k : {"1", "2", "3"})
        {
        Value n(Json::arrayValue);
        for (const Point& p : normal_points(d[std::string("E") + k], d[std::string("D") + k])) n.append(list(p.x, p.y, p.z));
        t.surface()["normals"].append(t.curve(n));
    }
}
void side_vertex(SceneText& t, const std::string& name, const Value& d) {
    static const std::map<std::string, std::string> blends{
        {"t", "t"}, {"t2", "t^2"}, {"2t3-t4", "2*t^3 - t^4"}, {"smoothstep", "3*t^2 - 2*t^3"}};
    t.surface()["method"] = "side_vertex";
    t.surface()["H"] = blends.at(d.get("H", "t2").asString());
    t.surface()["form"] = name.find("_delta_") != std::string::npos ? "delta" : "seed";
}
void triangle(SceneText& t, const std::string& name, const Value& d) {
    const auto is = [&](const std::string& start) { return name.rfind(start, 0) == 0; };
    Value& s = t.surface();
    edges(t, d);
    if (is("tri_side_vertex_")) return side_vertex(t, name, d);
    if (is("tri_translational_628")) {
        s["method"] = "three_curves";
    } else if (is("bbg_c0_bool_")) {
        s["method"] = "bbg_boolean";
        s["projectors"] = list(name.substr(12, 2), name.substr(14, 2));
    } else if (name == "bbg_c0_symmetric") {
        s["method"] = "bbg_symmetric";
    } else if (is("bbg_c0_")) {
        s["method"] = "bbg_convex";
        if (is("bbg_c0_P")) s["part"] = name.substr(7);
    } else if (is("bbg_c1_")) {
        s["method"] = "bbg_c1";
        cross_derivatives(t, d);
        if (is("bbg_c1_P")) s["part"] = name.substr(7);
    } else if (is("nielson_c1_")) {
        s["method"] = "nielson_c1";
        cross_derivatives(t, d);
        if (is("nielson_c1_T")) s["part"] = name.substr(11);
    } else if (name == "nielson_g1_normals") {
        nielson_g1(t, d);
    } else {
        throw std::runtime_error("no scene for " + name);
    }
}

std::string scene_of(const std::string& name, const Value& d) {
    SceneText t;
    Value& s = t.surface();
    if (name == "coons_bilinear" || name == "coons_partially_bicubic") {
        s["type"] = "coons";
        if (name != "coons_bilinear") s["blend"] = "cubic";
        coons(t, d);
    } else if (name == "coons_bicubic_hermite") {
        coons_hermite(t, d);
    } else if (name == "gregory_square") {
        coons_hermite(t, d);
        s["twist"] = "gregory";
    } else if (name == "bezier_tp_54") {
        t.bezier_surface("S", d["P[i][j] (i:u,j:v)"]);
    } else if (name == "sphere_octant") {
        t.bezier_surface("S", d["P"]);
        s["weights"] = d["W"];
    } else if (name == "gordon_3x4") {
        gordon(t, d);
    } else if (name == "lagrange_surface") {
        lagrange(t, d);
    } else if (name == "translational") {
        s["type"] = "translational";
        s["c"] = t.curve(d["c1"]);
        s["d"] = t.curve(d["c2"]);
    } else if (name.rfind("hermite_tensor_cell_", 0) == 0) {
        hermite(t, d);
    } else if (name == "network_624_625_cell_10") {
        network(t, d);
    } else if (name == "bezier_triangle_deg2") {
        s["type"] = "bezier_triangle";
        s["degree"] = 2;
        s["points"] = list(d["E3"][0], d["E3"][1], d["E3"][2], d["E2"][1], d["E1"][1], d["E1"][2]);
    } else {
        triangle(t, name, d);
    }
    return t.string();
}

// ---- the comparison -------------------------------------------------------------------------------------------------
class GoldenProgram : public ::testing::TestWithParam<std::string> {};

void expect_golden(const std::string& scene, const Value& e) {
    std::vector<GoldenPoint> points;
    for (const auto& p : e["points"]) points.push_back({in_cell(e["data"], 0, p["u"]), in_cell(e["data"], 1, p["v"]), p});
    for (const auto& limit : e["vertex_limits"]) points.push_back({limit["vertex"] == "A" ? 1.0 : 0, limit["vertex"] == "B" ? 1.0 : 0, limit});
    expect_eval(scene, points, magnitude(e["data"]));
}

TEST_P(GoldenProgram, EvalOfASceneTellsTheGoldenNumbers) {
    const Value& e = golden()["surfaces"][GetParam()];
    expect_golden(scene_of(GetParam(), e["data"]), e);
}

TEST(GoldenTypes, TheBilinearCoonsPatchByOtherTypes) {
    const Value &e = golden()["surfaces"]["coons_bilinear"], &d = e["data"];
    for (const char* type : {"control_net", "translational_blend"}) {
        SCOPED_TRACE(type);
        SceneText t;
        t.surface()["type"] = type;
        coons(t, d);
        expect_golden(t.string(), e);
    }
    SceneText net, generalized, gordon;
    net.bezier_surface("S", e["discrete_coons_net"]);
    expect_golden(net.string(), e);

    Value value[2];
    for (int k : {0, 1}) value[k]["value"] = k;
    Value& s = generalized.surface();
    s["type"] = "generalized_coons";
    for (const char* along : {"u", "v"}) {
        s[along]["functionals"] = list(value[0], value[1]);
        s[along]["blends"] = list("1 - t", "t");
    }
    s["f"] = generalized.curves(list(d["d0"], d["d1"]));
    s["g"] = generalized.curves(list(d["c0"], d["c1"]));
    expect_golden(generalized.string(), e);

    Value& g = gordon.surface();
    g["type"] = "gordon";
    g["u_curves"] = gordon.curves(list(d["c0"], d["c1"]));
    g["v_curves"] = gordon.curves(list(d["d0"], d["d1"]));
    g["u_nodes"] = g["v_nodes"] = list(0, 1);
    expect_golden(gordon.string(), e);
}

INSTANTIATE_TEST_SUITE_P(Surface, GoldenProgram, ::testing::ValuesIn(golden()["surfaces"].getMemberNames()), [](const auto& info) {
    std::string name = info.param;
    std::replace(name.begin(), name.end(), '-', '_');
    return name;
});

}  // namespace
}  // namespace isoparm::test
