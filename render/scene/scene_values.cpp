#include "scene/scene_values.h"

#include <cmath>
#include <utility>

#include "scene/suggest.h"

namespace isoparm {

namespace {
using Kind = Json::Kind;

std::string count_of(std::size_t least, std::size_t most, const std::string& what) {
    if (least == most) return "an array of " + std::to_string(least) + " " + what;
    if (most == 0) return "an array of at least " + std::to_string(least) + " " + what;
    return "an array of " + std::to_string(least) + " to " + std::to_string(most) + " " + what;
}
}  // namespace

// ---- single values --------------------------------------------------------------------------------------------------

double SceneValues::number(const Json& j, const std::string& what) const {
    if (j.is(Kind::number)) {
        if (!std::isfinite(j.number())) j.expected(what + " that a double can hold");
        return j.number();
    }
    if (!j.is(Kind::string)) j.expected(what + ", or an expression in quotes");
    try {
        return Expression::parse(j.string(), parameters, false).value();
    } catch (const ExpressionError& e) {
        j.fail_inside(e.offset, std::string(e.what()) + ", in the expression " + quoted(j.string()));
    }
}

double SceneValues::in_range(const Json& j, double low, double high, const std::string& what) const {
    const double x = number(j, what);
    if (!(x >= low && x <= high)) j.fail("found " + to_text(x) + ", expected " + what);
    return x;
}
double SceneValues::positive(const Json& j, const std::string& what) const {
    const double x = number(j, what);
    if (!(x > 0)) j.fail("found " + to_text(x) + ", expected " + what);
    return x;
}
int SceneValues::integer(const Json& j, int low, int high, const std::string& what) const {
    const std::string range = what + ", a whole number from " + std::to_string(low) + " to " + std::to_string(high);
    const double x = in_range(j, low, high, range);
    if (x != std::floor(x)) j.fail("found " + to_text(x) + ", expected " + range);
    return static_cast<int>(x);
}
bool SceneValues::boolean(const Json& j) const {
    if (!j.is(Kind::boolean)) j.expected("true or false");
    return j.boolean();
}
const std::string& SceneValues::text(const Json& j, const std::string& what) const {
    if (!j.is(Kind::string)) j.expected(what);
    return j.string();
}
std::size_t SceneValues::word(const Json& j, const std::vector<std::string>& words) const {
    const std::string expected = "one of: " + listed(words);
    const std::string& found = text(j, expected);
    for (std::size_t k = 0; k < words.size(); ++k)
        if (words[k] == found) return k;
    j.expected(expected + did_you_mean(found, words));
}

// ---- arrays ---------------------------------------------------------------------------------------------------------

std::vector<Json> SceneValues::list(const Json& j, std::size_t least, std::size_t most, const std::string& what) const {
    if (!j.is(Kind::array) || j.size() < least || (most > 0 && j.size() > most)) j.expected(count_of(least, most, what));
    return j.children();
}
std::vector<double> SceneValues::numbers(const Json& j, std::size_t least, std::size_t most, const std::string& what) const {
    std::vector<double> r;
    for (const Json& x : list(j, least, most, what)) r.push_back(number(x));
    return r;
}
Point SceneValues::point(const Json& j) const {
    if (!j.is(Kind::array) || j.size() != 3) j.expected("a point [x, y, z]");
    return {number(j[0], "the number x"), number(j[1], "the number y"), number(j[2], "the number z")};
}
std::vector<Point> SceneValues::points(const Json& j, std::size_t least, std::size_t most) const {
    std::vector<Point> r;
    for (const Json& p : list(j, least, most, "points [x, y, z]")) r.push_back(point(p));
    return r;
}
Grid<Point> SceneValues::grid(const Json& j, std::size_t least_u, std::size_t least_v, std::size_t most) const {
    Grid<Point> g;
    std::size_t columns = 0;
    for (const Json& row : list(j, least_u, most, "rows of points")) {
        g.push_back(columns == 0 ? points(row, least_v, most) : points(row, columns, columns));
        columns = g.front().size();
    }
    return g;
}
std::vector<double> SceneValues::weights(const Json& j, std::size_t count) const {
    std::vector<double> r;
    for (const Json& w : list(j, count, count, "weights, one a point")) r.push_back(positive(w, "a positive weight"));
    return r;
}
Grid<double> SceneValues::weight_grid(const Json& j, const Grid<Point>& points) const {
    Grid<double> g;
    for (const Json& row : list(j, points.size(), points.size(), "rows of weights, like the points")) g.push_back(weights(row, points.front().size()));
    return g;
}
std::vector<double> SceneValues::knots(const Json& j, int degree, std::size_t points) const {
    const std::size_t count = points + static_cast<std::size_t>(degree) + 1;
    std::vector<double> r;
    for (const Json& k : list(j, count, count, "knots (points + degree + 1)")) {
        r.push_back(number(k, "a knot"));
        if (r.size() > 1 && r.back() < r[r.size() - 2]) k.fail("found the knot " + to_text(r.back()) + " after " + to_text(r[r.size() - 2]) + ", expected knots that do not decrease");
    }
    return r;
}
std::array<double, 2> SceneValues::interval(const Json& j) const {
    const auto x = numbers(j, 2, 2, "numbers [from, to]");
    if (!(x[0] < x[1])) j.fail("found the interval [" + to_text(x[0]) + ", " + to_text(x[1]) + "], expected from < to");
    return {x[0], x[1]};
}

// ---- formulas, transforms, colours ----------------------------------------------------------------------------------

Expression SceneValues::formula(const Json& j) const {
    if (j.is(Kind::number)) return Expression::parse(to_text(number(j)), parameters, true);
    if (!j.is(Kind::string)) j.expected("a formula in t, such as \"3*t^2 - 2*t^3\"");
    try {
        return Expression::parse(j.string(), parameters, true);
    } catch (const ExpressionError& e) {
        j.fail_inside(e.offset, std::string(e.what()) + ", in the formula " + quoted(j.string()));
    }
}

Function SceneValues::function(const Json& j, double begin, double end) const {
    const Expression e = formula(j);
    try {
        return make_formula(e, begin, end);
    } catch (const Error& error) {
        j.fail(error.what());
    }
}

const std::vector<std::string>& SceneValues::transform_keys() {
    static const std::vector<std::string> keys{"matrix", "mirror", "scale", "rotate", "translate"};
    return keys;
}

namespace {

Transform matrix_of(const SceneValues& values, const Json& j) {
    Transform m;
    const auto rows = values.list(j, 4, 4, "rows of 4 numbers, row-major");
    for (int i = 0; i < 4; ++i) {
        const auto row = values.numbers(rows[i], 4, 4, "numbers");
        for (int k = 0; k < 4; ++k) {
            if (i < 3) m.m[i][k] = row[k];
            else if (row[k] != (k == 3 ? 1 : 0)) rows[i].expected("the last row [0, 0, 0, 1] of an affine map");
        }
    }
    return m;
}
Transform rotation_of(const SceneValues& values, const Json& j) {
    if (j.is(Kind::array)) {
        const auto x = values.numbers(j, 4, 4, "numbers [x, y, z, degrees]");
        return Transform::rotate({x[0], x[1], x[2]}, x[3]);
    }
    if (!j.is(Kind::object)) j.expected("{\"axis\": [x, y, z], \"degrees\": angle} or [x, y, z, degrees]");
    j.allow_keys({"axis", "degrees"});
    return Transform::rotate(values.point(j.at("axis", "the axis [x, y, z]")), values.number(j.at("degrees", "the angle in degrees")));
}
Transform mirror_of(const SceneValues& values, const Json& j) {
    if (j.is(Kind::array)) {
        const auto x = values.numbers(j, 3, 4, "numbers: the plane's normal x, y, z, and its offset if it is not 0");
        return Transform::mirror({x[0], x[1], x[2]}, x.size() == 4 ? x[3] : 0);
    }
    if (!j.is(Kind::object)) j.expected("a plane {\"normal\": [x, y, z], \"offset\": d} or [x, y, z]");
    j.allow_keys({"normal", "offset"});
    const auto offset = j.find("offset");
    return Transform::mirror(values.point(j.at("normal", "the plane's normal [x, y, z]")), offset ? values.number(*offset) : 0);
}
Transform scale_of(const SceneValues& values, const Json& j) {
    if (j.is(Kind::array)) return Transform::scale(values.point(j));
    const double s = values.number(j, "a factor, or [x, y, z]");
    return Transform::scale({s, s, s});
}
Transform transform_of(const SceneValues& values, const std::string& key, const Json& j) {
    if (key == "matrix") return matrix_of(values, j);
    if (key == "mirror") return mirror_of(values, j);
    if (key == "scale") return scale_of(values, j);
    if (key == "rotate") return rotation_of(values, j);
    return Transform::translate(values.point(j));
}

}  // namespace

Transform SceneValues::transform(const Json& j) const {
    Transform all;
    bool any = false;
    for (const auto& key : transform_keys()) {
        const auto value = j.find(key);
        if (!value) continue;
        any = true;
        Transform one;
        try {
            one = transform_of(*this, key, *value);
        } catch (const LocatedError&) {
            throw;
        } catch (const Error& e) {
            value->fail(e.what());
        }
        if (!(std::fabs(one.determinant()) > 0 && std::isfinite(one.determinant()))) {
            value->fail("found a map that flattens space (determinant " + to_text(one.determinant()) + "), expected one that can be undone");
        }
        all = one * all;
    }
    if (!any) j.fail("found no map, expected one of: " + listed(transform_keys()));
    return all;
}

namespace {
double linear(double s) { return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4); }

int hex_digit(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    return -1;
}

/// The basic colours of CSS (its second level: the sixteen of HTML 4, and orange), in letters of any case.
constexpr std::pair<const char*, const char*> kColorNames[] = {
    {"aqua", "#00ffff"}, {"black", "#000000"}, {"blue", "#0000ff"}, {"fuchsia", "#ff00ff"}, {"gray", "#808080"}, {"grey", "#808080"}, {"green", "#008000"},
    {"lime", "#00ff00"}, {"maroon", "#800000"}, {"navy", "#000080"}, {"olive", "#808000"}, {"orange", "#ffa500"}, {"purple", "#800080"},
    {"red", "#ff0000"}, {"silver", "#c0c0c0"}, {"teal", "#008080"}, {"white", "#ffffff"}, {"yellow", "#ffff00"}};
std::vector<std::string> color_names() {
    std::vector<std::string> names;
    for (const auto& named : kColorNames) names.push_back(named.first);
    return names;
}
}  // namespace

Color SceneValues::color(const Json& j, const std::string& or_else) const {
    const std::string expected = "a colour: [r, g, b] with values from 0 to 1, \"#rrggbb\" or a basic name of CSS (" + listed(color_names()) + ")" + or_else;
    Color c;
    if (j.is(Kind::array) && j.size() == 3) {
        for (int i = 0; i < 3; ++i) c[i] = linear(in_range(j[i], 0, 1, "a part of a colour, from 0 to 1"));
        return c;
    }
    if (!j.is(Kind::string)) j.expected(expected);
    std::string s = lower_case(j.string());
    for (const auto& [name, hex] : kColorNames)
        if (s == name) s = hex;
    if ((s.size() != 4 && s.size() != 7) || s[0] != '#') j.expected(expected + did_you_mean(s, color_names()));
    for (int i = 0; i < 3; ++i) {
        const bool brief = s.size() == 4;
        const int high = hex_digit(s[brief ? 1 + i : 1 + 2 * i]), low = hex_digit(s[brief ? 1 + i : 2 + 2 * i]);
        if (high < 0 || low < 0) j.expected(expected);
        c[i] = linear((16 * high + low) / 255.0);
    }
    return c;
}

}  // namespace isoparm
