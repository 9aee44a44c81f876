// expression.h -- formulas that scene files write as text: "3*t^2 - 2*t^3", "1 - 2*te".
//
//   sum     = product { ("+" | "-") product }          product = signed { ("*" | "/") signed }
//   signed  = ("-" | "+") signed | power               power   = primary [ "^" signed ]       (so -2^2 = -4, 2^3^2 = 512)
//   primary = number | "(" sum ")" | name | function "(" sum { "," sum } ")" | "if" "(" sum comparison sum "," sum "," sum ")"
//
// Names: pi, e, the parameters that are given, and t in a formula. Functions: sin cos exp sqrt abs min max pow if.
// Parts without t are computed once, in double; what is proved is proved about the formula with these numbers.
#pragma once
#include <array>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "curve.h"
#include "error.h"
#include "function.h"

namespace isoparm {

/// offset: where in the text, in bytes. what(): found ..., expected ...
class ExpressionError : public Error {
public:
    ExpressionError(std::size_t offset, const std::string& message) : Error(ErrorKind::input, message), offset(offset) {}
    std::size_t offset;
};

class Expression {
public:
    enum class Op : unsigned char {
        number, variable, add, subtract, multiply, divide, negate, power_integer, power_real, power,
        sin, cos, exp, sqrt, abs, min, max, compare, choose
    };
    struct Node {
        Op op = Op::number;
        int a = -1, b = -1, c = -1;  // operands, earlier in the list
        double value = 0;            // number; exponent; Comparison of compare; choose: 1 when it is continuous
    };

    /// Throws ExpressionError. `formula`: t may appear.
    static Expression parse(std::string_view text, const std::map<std::string, double>& names, bool formula);

    bool constant() const { return nodes_.back().op == Op::number; }
    double value() const { return nodes_.back().value; }
    /// Numbers t where a choice of the form t < number switches, in order.
    const std::vector<double>& switches() const { return switches_; }
    bool has_kinks() const;
    double operator()(double t) const;
    const std::vector<Node>& nodes() const { return nodes_; }

    static bool reserved(const std::string& name);
    static bool valid_name(std::string_view name);

private:
    friend class ExpressionParser;
    std::vector<Node> nodes_;  // the last one is the whole
    std::vector<double> switches_;
};

/// As a function of t. Polynomials with exact coefficients are recognised and run as such. At a kink (abs, min, max, if) derivatives are
/// those to its right.
Function make_formula(const Expression& formula);
/// The same over [begin, end]; at `end` derivatives are those to the left. Throws Error(input) when it jumps or is not finite there: at
/// 129 sample points, at its switches, or where interval arithmetic cannot bound it however small the interval (a pole; 0/0).
Function make_formula(const Expression& formula, double begin, double end);
/// (x(t), y(t), z(t)) over [begin, end], each checked so.
Curve make_formula_curve(const std::array<Expression, 3>& xyz, double begin, double end);

}  // namespace isoparm
