// golden_test.cpp -- every surface built here against values computed with 50 digits by an independent program:
// position, first and second derivatives and unit normal to 1e-12 relative, and the limits at singular corners.
#include "golden.h"

#include "curves/arc.h"
#include "curves/bezier.h"
#include "curves/isocurve.h"
#include "patches/bbg.h"
#include "patches/bezier_triangle.h"
#include "patches/control_net.h"
#include "patches/coons.h"
#include "patches/coons_hermite.h"
#include "patches/gordon.h"
#include "patches/lagrange.h"
#include "patches/network.h"
#include "patches/nielson.h"
#include "patches/side_vertex.h"
#include "patches/tensor_bezier.h"
#include "patches/tensor_hermite.h"
#include "patches/three_curves.h"
#include "patches/translational.h"

namespace isoparm {
namespace {

using test::golden, test::in_cell, test::magnitude, test::number, test::point, test::points;

constexpr double kTolerance = test::kGoldenTolerance;
const double kHalfRoot = std::sqrt(0.5);

Grid<Point> grid(const Json::Value& v) {
    Grid<Point> rows;
    for (const auto& row : v) rows.push_back(points(row));
    return rows;
}
std::vector<double> numbers(const Json::Value& v) {
    std::vector<double> list;
    for (const auto& x : v) list.push_back(number(x));
    return list;
}
Grid<double> weights(const Json::Value& v) {
    Grid<double> rows;
    for (const auto& row : v) rows.push_back(numbers(row));
    return rows;
}
Curve bezier(const Json::Value& v) { return make_bezier(points(v)); }
Curve quarter_circle(const Point& from, const Point& to) {
    return make_bezier({from, from + to, to}, {1, kHalfRoot, 1});
}

SplineCurve cubic(const Json::Value& v) { return {3, {0, 0, 0, 0, 1, 1, 1, 1}, points(v)}; }

CoonsCurves coons_curves(const Json::Value& d) {
    return {bezier(d["c0"]), bezier(d["c1"]), bezier(d["d0"]), bezier(d["d1"])};
}
HermiteData hermite_data(const Json::Value& d) {
    const auto& f = d["f=[x(0,v),xu(0,v),xu(1,v),x(1,v)]"];
    const auto& g = d["g=[x(u,0),xv(u,0),xv(u,1),x(u,1)]"];
    return {{bezier(f[0]), bezier(f[1]), bezier(f[2]), bezier(f[3])},
            {bezier(g[0]), bezier(g[1]), bezier(g[2]), bezier(g[3])}};
}
std::array<Curve, 3> triangle_edges(const Json::Value& d) {
    if (d.isMember("E1")) return {bezier(d["E1"]), bezier(d["E2"]), bezier(d["E3"])};
    const Point a{1, 0, 0}, b{0, 1, 0}, c{0, 0, 1};  // the octant of the sphere
    return {quarter_circle(b, c), quarter_circle(c, a), quarter_circle(a, b)};
}
Function blend(const std::string& name) {
    if (name == "t") return Function::polynomial({0, 1});
    if (name == "t2") return Function::polynomial({0, 0, 1});
    if (name == "2t3-t4") return Function::polynomial({0, 0, 0, 2, -1});
    if (name == "smoothstep") return cubic_blend();
    throw std::runtime_error("no blend " + name);
}
std::array<Curve, 3> cross_derivatives(const Json::Value& d) { return {bezier(d["D1"]), bezier(d["D2"]), bezier(d["D3"])}; }
std::array<Curve, 3> normals(const Json::Value& d) {
    const auto normal = [&](const char* edge, const char* across) { return make_bezier(test::normal_points(d[edge], d[across])); };
    return {normal("E1", "D1"), normal("E2", "D2"), normal("E3", "D3")};
}
BbgForm bbg_form(const std::string& name) {
    using Kind = BbgForm::Kind;
    if (name == "convex") return {Kind::convex};
    if (name == "symmetric") return {Kind::symmetric};
    if (name == "bool_P1P2") return {Kind::boolean, 1, 2};
    if (name == "bool_P2P1") return {Kind::boolean, 2, 1};
    return {Kind::projector, name.back() - '0'};
}
/// The network of (6.24): parameter lines of a Bezier patch over [0,3] x [0,2], as isocurves or as Bezier curves.
Network network(const Json::Value& d, bool isocurves) {
    const auto p = grid(d["P"]);
    const Patch patch = make_bezier_patch(p);
    const auto casteljau = [](std::vector<Point> b, double t) {
        for (; b.size() > 1; b.pop_back())
            for (std::size_t i = 0; i + 1 < b.size(); ++i) b[i] = (1 - t) * b[i] + t * b[i + 1];
        return b[0];
    };
    Network net;
    for (int i = 0; i <= 3; ++i) {
        std::vector<Point> column;
        for (std::size_t j = 0; j < p[0].size(); ++j) {
            std::vector<Point> along_u;
            for (const auto& row : p) along_u.push_back(row[j]);
            column.push_back(casteljau(along_u, i / 3.0));
        }
        net.a.push_back(isocurves ? make_isocurve(patch, Along::v, i / 3.0) : make_bezier(column));
    }
    for (int j = 0; j <= 2; ++j) {
        std::vector<Point> row;
        for (const auto& along_v : p) row.push_back(casteljau(along_v, j / 2.0));
        net.b.push_back(isocurves ? make_isocurve(patch, Along::u, j / 2.0) : make_bezier(row));
    }
    return net;
}
/// Parameter lines of a Bezier patch over [0,1]^2 at nodes that are not evenly spaced.
GordonNetwork gordon_network(const Json::Value& d) {
    const Patch patch = make_bezier_patch(grid(d["P"]));
    GordonNetwork net{{}, numbers(d["v_nodes"]), {}, numbers(d["u_nodes"])};
    for (double v : net.v_nodes) net.u_curves.push_back(make_isocurve(patch, Along::u, v));
    for (double u : net.u_nodes) net.v_curves.push_back(make_isocurve(patch, Along::v, u));
    return net;
}
/// One of r, u, v, uv at all nodes (i,j).
Grid<Point> at_nodes(const Json::Value& d, const char* what) {
    Grid<Point> rows(3);
    for (int i = 0; i <= 2; ++i)
        for (int j = 0; j <= 2; ++j)
            rows[i].push_back(point(d["nodes (i,j): r,u,v,uv"][std::to_string(i) + "," + std::to_string(j)][what]));
    return rows;
}
Patch lagrange(const Json::Value& list) {
    std::vector<Curve> curves;
    for (const auto& c : list) curves.push_back(bezier(c));
    return make_lagrange(curves, {0, 1, 2, 3});
}

Patch build(const std::string& name, const Json::Value& d) {
    if (name == "coons_bilinear") return make_coons(coons_curves(d));
    if (name == "coons_partially_bicubic") return make_coons(coons_curves(d), cubic_blend());
    if (name == "coons_bicubic_hermite") return make_coons_hermite(hermite_data(d));
    if (name == "bezier_tp_54") return make_bezier_patch(grid(d["P[i][j] (i:u,j:v)"]));
    if (name == "gregory_square") return make_coons_hermite(hermite_data(d), Twist::gregory);
    if (name == "gordon_3x4") return make_gordon(gordon_network(d));
    if (name == "lagrange_surface") return lagrange(d["curves r(u,0..3)"]);
    if (name == "translational") return make_translational(bezier(d["c1"]), bezier(d["c2"]));
    if (name.rfind("hermite_tensor_cell_", 0) == 0)
        return make_tensor_hermite(at_nodes(d, "r"), at_nodes(d, "u"), at_nodes(d, "v"), at_nodes(d, "uv"));
    if (name == "network_624_625_cell_10") return make_network(network(d, false));
    if (name == "sphere_octant") return make_bezier_patch(grid(d["P"]), weights(d["W"]));
    if (name == "bezier_triangle_deg2") {
        const auto e1 = points(d["E1"]), e2 = points(d["E2"]), e3 = points(d["E3"]);
        return make_bezier_triangle(2, {e3[0], e3[1], e3[2], e2[1], e1[1], e1[2]});
    }
    if (name == "tri_side_vertex_quad_H_t2") return make_side_vertex(triangle_edges(d), blend("t2"));
    if (name.rfind("tri_side_vertex_", 0) == 0) {
        const auto form = name.find("_delta_") != std::string::npos ? SideVertexForm::delta : SideVertexForm::seed;
        return make_side_vertex(triangle_edges(d), blend(d["H"].asString()), form);
    }
    const int part = std::isdigit(name.back()) ? name.back() - '0' : 0;
    if (name.rfind("tri_translational_628", 0) == 0) return make_three_curves(triangle_edges(d));
    if (name.rfind("bbg_c0_", 0) == 0) return make_bbg(triangle_edges(d), bbg_form(name.substr(7)));
    if (name.rfind("bbg_c1_", 0) == 0) return make_bbg_c1(triangle_edges(d), cross_derivatives(d), TrianglePart(part));
    if (name == "nielson_g1_normals") return make_nielson_g1(triangle_edges(d), normals(d));
    if (name.rfind("nielson_c1_", 0) == 0) return make_nielson_c1(triangle_edges(d), cross_derivatives(d), TrianglePart(name == "nielson_c1_side_vertex" ? 0 : part));
    throw std::runtime_error("no builder for " + name);
}

void expect_vector(const char* what, const std::optional<Point>& found, const Json::Value& expected, double size) {
    if (expected.isNull()) {
        EXPECT_FALSE(found) << what << " should not exist";
        return;
    }
    ASSERT_TRUE(found) << what << " is missing";
    const Point e = point(expected);
    EXPECT_LE(distance(*found, e), kTolerance * std::max(size, length(e))) << what;
}
void expect_point(const Patch& patch, double u, double v, const Json::Value& e, double size) {
    SCOPED_TRACE("at (" + std::to_string(u) + ", " + std::to_string(v) + ")");
    const SurfacePoint s = evaluate(patch, u, v);
    const std::pair<const char*, std::optional<Point>> found[] = {{"S", s.position}, {"Su", s.du},   {"Sv", s.dv},
                                                                  {"Suu", s.duu},    {"Suv", s.duv}, {"Svv", s.dvv}};
    for (const auto& [what, value] : found)
        if (e.isMember(what)) expect_vector(what, value, e[what], size);
    if (e.isMember("n") && !e["n"].isNull()) expect_vector("n", s.normal, e["n"], 1);
}

class Golden : public ::testing::TestWithParam<std::string> {};

void expect_points(const Patch& patch, const Json::Value& e) {
    for (const auto& p : e["points"])
        expect_point(patch, in_cell(e["data"], 0, p["u"]), in_cell(e["data"], 1, p["v"]), p, magnitude(e["data"]));
}

TEST_P(Golden, AgreesTo1e12) {
    const auto& e = golden()["surfaces"][GetParam()];
    expect_points(build(GetParam(), e["data"]), e);
}

TEST_P(Golden, VertexLimitsExist) {
    const auto& e = golden()["surfaces"][GetParam()];
    const Patch patch = build(GetParam(), e["data"]);
    for (const auto& limit : e["vertex_limits"]) {
        const std::string at = limit["vertex"].asString();
        expect_point(patch, at == "A", at == "B", limit, magnitude(e["data"]));
    }
}

INSTANTIATE_TEST_SUITE_P(Surface, Golden, ::testing::ValuesIn(golden()["surfaces"].getMemberNames()),
                         [](const auto& info) {
                             std::string name = info.param;
                             std::replace(name.begin(), name.end(), '-', '_');
                             return name;
                         });

TEST(GoldenLimits, NetworkThroughIsocurvesIsTheSame) {
    const auto& e = golden()["surfaces"]["network_624_625_cell_10"];
    expect_points(make_network(network(e["data"], true)), e);
}

TEST(GoldenLimits, CoonsIsTheBezierPatchOfItsDiscreteNet) {
    const auto& e = golden()["surfaces"]["coons_bilinear"];
    const Json::Value& d = e["data"];
    const auto net = grid(e["discrete_coons_net"]);
    expect_points(make_bezier_patch(net), e);
    const ControlFrame frame{cubic(d["c0"]), cubic(d["c1"]), cubic(d["d0"]), cubic(d["d1"])};
    const auto found = coons_net(frame);
    ASSERT_EQ(found.size(), net.size());
    for (std::size_t i = 0; i < net.size(); ++i)
        for (std::size_t j = 0; j < net[i].size(); ++j) EXPECT_LE(distance(found[i][j], net[i][j]), kTolerance) << i << j;
    expect_points(make_control_net(frame), e);
    expect_points(make_translational_blend(coons_curves(d)), e);
}

TEST(GoldenLimits, GregoryCornerHasATangentPlaneAndNoSecondDerivatives) {
    const auto& e = golden()["surfaces"]["gregory_square"];
    const auto& limit = e["corner_limit"];
    const double size = magnitude(e["data"]);
    const Patch patch = build("gregory_square", e["data"]);
    const SurfacePoint s = evaluate(patch, 0, 0);
    expect_vector("S", s.position, limit["S"], size);
    expect_vector("Su", s.du, limit["Su"], size);
    expect_vector("Sv", s.dv, limit["Sv"], size);
    EXPECT_FALSE(s.duu || s.duv || s.dvv || s.gaussian || s.mean);
    ASSERT_TRUE(s.normal);
    EXPECT_LE(distance(*s.normal, normalized(cross(*s.du, *s.dv))), 1e-15);
    for (const auto& d : limit["second derivative limits"]) {
        const double h = 1e-13;  // the limit is reached like O(h)
        const SurfacePoint near = evaluate(patch, h * number(d["direction"][0]), h * number(d["direction"][1]));
        EXPECT_LE(distance(near.duu.value(), point(d["Suu"])), 1e-9);
        EXPECT_LE(distance(near.duv.value(), point(d["Suv"])), 1e-9);
        EXPECT_LE(distance(near.dvv.value(), point(d["Svv"])), 1e-9);
    }
}

TEST(GoldenLimits, ConePointOfSideVertexHasDirectionalDerivativesOnly) {
    const auto& e = golden()["surfaces"]["tri_side_vertex_eq3_H_t"];
    const Patch patch = build("tri_side_vertex_eq3_H_t", e["data"]);
    const SurfacePoint vertex = evaluate(patch, 0, 1);
    EXPECT_LE(distance(vertex.position, point(e["data"]["B"])), 1e-15);
    EXPECT_FALSE(vertex.du || vertex.dv || vertex.normal);
    for (const auto& limit : e["vertex_directional_limits"]) {
        ASSERT_EQ(limit["vertex"].asString(), "B");
        const Point d = point(limit["direction(du,dv,dw)"]);
        const double h = 0x1p-40;
        const SurfacePoint near = evaluate(patch, h * d.x, 1 + h * d.y);
        EXPECT_LE(distance(d.x * near.du.value() + d.y * near.dv.value(), point(limit["dS"])), 1e-9);
    }
}

TEST(GoldenLimits, PoleOfTheSphereHasItsNormal) {
    const auto& e = golden()["surfaces"]["sphere_octant"];
    const Patch patch = build("sphere_octant", e["data"]);
    for (double v : {0.0, 0.4, 1.0}) {
        const SurfacePoint s = evaluate(patch, 0, v);
        ASSERT_TRUE(s.normal);
        EXPECT_LE(distance(*s.normal, {0, 0, 1}), 1e-15);
        EXPECT_LE(length(s.dv.value()), 1e-15);
    }
}

TEST(GoldenCurves, QuarterCircle) {
    const auto& e = golden()["curves"]["quarter_circle"];
    std::vector<double> w;
    for (const auto& x : e["w"]) w.push_back(number(x));
    for (const Curve& c : {make_bezier(points(e["P"]), w), make_arc({0, 0, 0}, {1, 0, 0}, {0, 1, 0})})
        for (const auto& p : e["points"]) {
            const double t = number(p["t"]);
            EXPECT_LE(distance(c(t), point(p["x"])), kTolerance);
            EXPECT_LE(distance(c.derivative(t), point(p["dx"])), kTolerance);
        }
}

}  // namespace
}  // namespace isoparm
