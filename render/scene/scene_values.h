// scene_values.h -- numbers, points, grids, colours and formulas as scene files write them.
//
// Wherever a number may stand, a string may stand that holds an expression in the parameters. Every function throws
// LocatedError: where, what was found, what was expected.
#pragma once
#include <map>
#include <string>
#include <vector>

#include "patches/tensor_bezier.h"
#include "scene/expression.h"
#include "scene/json.h"
#include "scene/scene.h"
#include "transform.h"

namespace isoparm {

class SceneValues {
public:
    std::map<std::string, double> parameters;

    double number(const Json& j, const std::string& what = "a number") const;
    double positive(const Json& j, const std::string& what) const;
    double in_range(const Json& j, double low, double high, const std::string& what) const;
    int integer(const Json& j, int low, int high, const std::string& what) const;
    bool boolean(const Json& j) const;
    const std::string& text(const Json& j, const std::string& what) const;
    /// One of the words; its index.
    std::size_t word(const Json& j, const std::vector<std::string>& words) const;

    Point point(const Json& j) const;
    /// An array with at least `least` elements, and at most `most` of them when that is not 0.
    std::vector<Json> list(const Json& j, std::size_t least, std::size_t most, const std::string& what) const;
    std::vector<double> numbers(const Json& j, std::size_t least, std::size_t most, const std::string& what) const;
    std::vector<Point> points(const Json& j, std::size_t least, std::size_t most = 0) const;
    Grid<Point> grid(const Json& j, std::size_t least_u, std::size_t least_v, std::size_t most) const;
    std::vector<double> weights(const Json& j, std::size_t count) const;
    Grid<double> weight_grid(const Json& j, const Grid<Point>& points) const;
    std::vector<double> knots(const Json& j, int degree, std::size_t points) const;
    std::array<double, 2> interval(const Json& j) const;

    Expression formula(const Json& j) const;
    /// A formula over [begin, end], which must not jump and must be finite there.
    Function function(const Json& j, double begin, double end) const;
    /// Any of the keys translate, rotate, scale, mirror, matrix of the object j; at least one.
    Transform transform(const Json& j) const;
    static const std::vector<std::string>& transform_keys();
    /// A basic name of CSS ("red"), "#rrggbb", "#rgb" or [r,g,b]: sRGB in [0,1], turned into linear.
    /// `or_else`: what else may stand there, in the message.
    Color color(const Json& j, const std::string& or_else = "") const;
};

}  // namespace isoparm
