// golden.h -- values computed elsewhere with many digits (tests/data): reading them, and how closely they must be met.
#pragma once
#include <gtest/gtest.h>
#include <json/json.h>

#include <cmath>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "run_program.h"
#include "scalar/polynomial.h"
#include "scalar/vec.h"

namespace isoparm::test {

inline constexpr double kGoldenTolerance = 1e-12;  // of the magnitude of the data

inline Json::Value read_golden(const std::string& name) {
    std::ifstream file(source_folder() + "/tests/data/" + name);
    Json::Value v;
    file >> v;
    return v;
}
/// tests/data/golden.json
inline const Json::Value& golden() {
    static const Json::Value root = read_golden("golden.json");
    return root;
}

/// Golden numbers are texts, to keep their digits; two of them are expressions.
inline double number(const Json::Value& v) {
    if (!v.isString()) return v.asDouble();
    const std::string s = v.asString();
    return s == "sqrt(2)/2" ? std::sqrt(0.5) : s == "1/2" ? 0.5 : std::stod(s);
}
inline Point point(const Json::Value& v) { return {number(v[0]), number(v[1]), number(v[2])}; }
inline std::vector<Point> points(const Json::Value& v) {
    std::vector<Point> list;
    for (const auto& p : v) list.push_back(point(p));
    return list;
}
/// Bezier points of the normal E' x D along an edge.
inline std::vector<Point> normal_points(const Json::Value& edge, const Json::Value& across) {
    const auto e = points(edge), d = points(across);
    const int m = int(e.size()) - 2, n = int(d.size()) - 1;
    std::vector<Point> normal(m + n + 1);
    for (int i = 0; i <= m; ++i)
        for (int j = 0; j <= n; ++j)
            normal[i + j] += (binomial(m, i) * binomial(n, j) / binomial(m + n, i + j)) * cross((m + 1.0) * (e[i + 1] - e[i]), d[j]);
    return normal;
}
/// Largest number in the data, which rounding errors scale with.
inline double magnitude(const Json::Value& v) {
    double m = 0;
    if (v.isObject() || v.isArray())
        for (const auto& x : v) m = std::max(m, magnitude(x));
    else if (v.isNumeric() || v.isString())
        m = std::abs(v.isNumeric() ? v.asDouble() : std::strtod(v.asCString(), nullptr));
    return m;
}
/// A number with all digits of a double, for a command line.
inline std::string exactly(double x) {
    std::ostringstream s;
    s.precision(17);
    s << x;
    return s.str();
}
/// Where golden data live in a cell (i,j) of [0,m] x [0,n], local (u,v) are i + u, j + v.
inline double in_cell(const Json::Value& data, int axis, const Json::Value& at) {
    if (!data.isMember("cell")) return number(at);
    const double t = data["cell"][axis].asDouble() + number(at);
    return number(at) == 1 ? std::nextafter(t, 0.0) : t;  // second derivatives may jump to the next cell
}

/// Where eval is asked, and the golden answer: S, Su, Sv, Suu, Suv, Svv, n, those that are known. null: does not exist.
struct GoldenPoint {
    double u, v;
    Json::Value answer;
};
inline void expect_answer(const Json::Value& found, const Json::Value& expected, double size) {
    for (const char* what : {"S", "Su", "Sv", "Suu", "Suv", "Svv", "n"}) {
        const Json::Value &e = expected[what], &f = found[what];
        if (!expected.isMember(what) || (std::string(what) == "n" && e.isNull())) continue;
        ASSERT_EQ(f.isNull(), e.isNull()) << what << " of " << found;
        double length = std::string(what) == "n" ? 1 : size, gap = 0;
        for (int k = 0; k < 3 && !e.isNull(); ++k) {
            length = std::max(length, std::abs(number(e[k])));
            gap = std::max(gap, std::abs(number(e[k]) - f[k].asDouble()));
        }
        EXPECT_LE(gap, kGoldenTolerance * length) << what << " of " << found;
    }
}
/// What `eval --json` says of the surface S of a scene.
inline void expect_eval(const std::string& scene_text, const std::vector<GoldenPoint>& points, double size) {
    std::string at;
    for (const auto& p : points) at += " --at " + exactly(p.u) + "," + exactly(p.v);
    const TemporaryFolder folder;
    const std::string scene = folder / "scene.json";
    write_all(scene, scene_text);
    const Outcome o = run("eval '" + scene + "' --surface S --json" + at);
    ASSERT_EQ(o.code, 0) << o.err << scene_text;
    Json::Value answer;
    std::istringstream(o.out) >> answer;
    ASSERT_EQ(answer["points"].size(), points.size());
    for (int k = 0; k < int(points.size()); ++k) expect_answer(answer["points"][k], points[k].answer, size);
}

}  // namespace isoparm::test
