#include "scene/expression.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include "scalar/elementary.h"
#include "scene/suggest.h"

namespace isoparm {

namespace {

constexpr std::size_t kMaxLength = 4096;
constexpr int kMaxDepth = 200, kMaxIntegerPower = 1000;

struct Named {
    const char* name;
    Expression::Op op;
    int least, most;  // arguments
};
constexpr Named kFunctions[] = {
    {"sin", Expression::Op::sin, 1, 1},   {"cos", Expression::Op::cos, 1, 1},     {"exp", Expression::Op::exp, 1, 1},
    {"sqrt", Expression::Op::sqrt, 1, 1}, {"abs", Expression::Op::abs, 1, 1},     {"min", Expression::Op::min, 2, 64},
    {"max", Expression::Op::max, 2, 64},  {"pow", Expression::Op::power, 2, 2},   {"if", Expression::Op::choose, 3, 3},
};

bool starts_name(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool continues_name(char c) { return starts_name(c) || (c >= '0' && c <= '9'); }

// Coefficients of a polynomial in t while every one of them is exact; otherwise nothing.
struct Coefficients {
    std::vector<double> c;  // empty: not an exact polynomial
    Coefficients() = default;
    explicit Coefficients(double x) : c{x} {}
    explicit Coefficients(std::vector<double> x) : c(std::move(x)) {}
};
constexpr std::size_t kMaxCoefficients = 33;

Coefficients operator+(const Coefficients& a, const Coefficients& b) {
    if (a.c.empty() || b.c.empty()) return {};
    std::vector<double> r(std::max(a.c.size(), b.c.size()), 0.0);
    for (std::size_t i = 0; i < r.size(); ++i) {
        const double x = i < a.c.size() ? a.c[i] : 0, y = i < b.c.size() ? b.c[i] : 0, s = x + y, t = s - x;
        if ((x - (s - t)) + (y - t) != 0) return {};  // TwoSum (Knuth)
        r[i] = s;
    }
    return Coefficients(std::move(r));
}
Coefficients operator*(const Coefficients& a, const Coefficients& b) {
    if (a.c.empty() || b.c.empty() || a.c.size() + b.c.size() - 1 > kMaxCoefficients) return {};
    Coefficients r(std::vector<double>(a.c.size() + b.c.size() - 1, 0.0));
    for (std::size_t i = 0; i < a.c.size(); ++i) {
        std::vector<double> row(i + b.c.size(), 0.0);
        for (std::size_t j = 0; j < b.c.size(); ++j) {
            const double p = a.c[i] * b.c[j];
            if (std::fma(a.c[i], b.c[j], -p) != 0 || (p == 0 && a.c[i] != 0 && b.c[j] != 0)) return {};
            row[i + j] = p;
        }
        r = r + Coefficients(std::move(row));
    }
    return r;
}
Coefficients operator-(Coefficients a) {
    for (double& x : a.c) x = -x;
    return a;
}
Coefficients operator-(const Coefficients& a, const Coefficients& b) { return a + (-b); }
Coefficients operator/(const Coefficients&, const Coefficients&) { return {}; }
Coefficients square(const Coefficients& a) { return a * a; }

// Runs the nodes below one node on a scalar.
template <class S> struct Run {
    const std::vector<Expression::Node>& nodes;
    const S& t;

    S quotient(const Expression::Node& n) const {
        if constexpr (std::is_same_v<S, Polynomial>) {  // a polynomial over a number is one
            if (nodes[n.b].op == Expression::Op::number) return at(n.a) * Polynomial(Interval(1.0) / Interval(nodes[n.b].value));
        }
        return at(n.a) / at(n.b);
    }
    S at(int k) const {
        using Op = Expression::Op;
        const Expression::Node& n = nodes[k];
        switch (n.op) {
            case Op::number: return S(n.value);
            case Op::variable: return t;
            case Op::add: return at(n.a) + at(n.b);
            case Op::subtract: return at(n.a) - at(n.b);
            case Op::multiply: return at(n.a) * at(n.b);
            case Op::divide: return quotient(n);
            case Op::negate: return -at(n.a);
            case Op::power_integer:
                if (std::is_same_v<S, Coefficients> && n.value < 0) return S();
                return power(at(n.a), static_cast<int>(n.value));
            default: break;
        }
        if constexpr (std::is_same_v<S, Coefficients>) {
            return S();
        } else {
            using std::cos, std::exp, std::log, std::pow, std::sin, std::sqrt;
            switch (n.op) {
                case Op::power_real: return pow(at(n.a), n.value);
                case Op::power: return exp(at(n.b) * log(at(n.a)));
                case Op::sin: return sin(at(n.a));
                case Op::cos: return cos(at(n.a));
                case Op::exp: return exp(at(n.a));
                case Op::sqrt: return sqrt(at(n.a));
                case Op::abs: return absolute(at(n.a));
                case Op::min: return smaller(at(n.a), at(n.b));
                case Op::max: return larger(at(n.a), at(n.b));
                default: {
                    const Expression::Node& c = nodes[n.a];
                    return choose(static_cast<Comparison>(c.value), at(c.a), at(c.b), at(n.b), at(n.c), n.value != 0);
                }
            }
        }
    }
};

}  // namespace

bool Expression::has_kinks() const {
    return std::any_of(nodes_.begin(), nodes_.end(), [](const Node& n) { return n.op == Op::abs || n.op == Op::min || n.op == Op::max || n.op == Op::choose; });
}
double Expression::operator()(double t) const { return Run<double>{nodes_, t}.at(static_cast<int>(nodes_.size()) - 1); }

bool Expression::valid_name(std::string_view name) {
    return !name.empty() && starts_name(name[0]) && std::all_of(name.begin(), name.end(), continues_name);
}
bool Expression::reserved(const std::string& name) {
    return name == "t" || name == "pi" || name == "e" ||
           std::any_of(std::begin(kFunctions), std::end(kFunctions), [&](const Named& f) { return name == f.name; });
}

class ExpressionParser {
public:
    using Op = Expression::Op;
    using Node = Expression::Node;
    ExpressionParser(std::string_view text, const std::map<std::string, double>& names, bool formula)
        : text_(text), names_(names), formula_(formula) {}

    Expression run() {
        if (text_.size() > kMaxLength) {
            throw ExpressionError(0, "found an expression of " + std::to_string(text_.size()) + " characters, expected at most " +
                                         std::to_string(kMaxLength));
        }
        sum();
        skip_spaces();
        if (at_ < text_.size()) {
            const char c = text_[at_];
            const bool operand = continues_name(c) || c == '(' || c == '.';
            fail(operand ? "an operator (a product is written with *) or the end of the expression"
                         : "an operator or the end of the expression");
        }
        if (result_.constant() && !std::isfinite(result_.value())) {
            throw ExpressionError(0, "found an expression whose value is not finite, expected a finite number");
        }
        auto& s = result_.switches_;
        std::sort(s.begin(), s.end());
        s.erase(std::unique(s.begin(), s.end()), s.end());
        return std::move(result_);
    }

private:
    // ---- tokens
    void skip_spaces() {
        while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\t' || text_[at_] == '\n' || text_[at_] == '\r')) ++at_;
    }
    bool next_is(std::string_view symbol) {
        skip_spaces();
        return text_.substr(at_, symbol.size()) == symbol;
    }
    bool accept(std::string_view symbol) {
        if (!next_is(symbol)) return false;
        at_ += symbol.size();
        return true;
    }
    [[noreturn]] void fail_at(std::size_t where, const std::string& expected) {
        std::size_t end = where;
        while (end < text_.size() && continues_name(text_[end])) ++end;
        end = std::min(std::max(end, where + 1), where + 32);
        while (end < text_.size() && (static_cast<unsigned char>(text_[end]) & 0xC0) == 0x80) ++end;
        const std::string found = where >= text_.size() ? "the end of the expression" : quoted(std::string(text_.substr(where, end - where)));
        throw ExpressionError(where, "found " + found + ", expected " + expected);
    }
    [[noreturn]] void fail(const std::string& expected) {
        skip_spaces();
        fail_at(at_, expected);
    }

    // ---- nodes; every function returns the index of the node it has made
    int add(Op op, int a = -1, int b = -1, int c = -1, double value = 0) {
        auto& nodes = result_.nodes_;
        nodes.push_back({op, a, b, c, value});
        const int k = static_cast<int>(nodes.size()) - 1;
        if (op == Op::number || op == Op::variable || op == Op::compare) return k;
        const auto number = [&](int i) { return i < 0 || nodes[i].op == Op::number; };
        const bool comparison = op == Op::choose;
        if (comparison ? number(nodes[a].a) && number(nodes[a].b) && number(b) && number(c) : number(a) && number(b)) {
            const double folded = Run<double>{nodes, 0.0}.at(k);  // no t below: one number
            nodes[k] = {Op::number, -1, -1, -1, folded};
        }
        return k;
    }
    struct Deeper {
        int& depth;
        explicit Deeper(ExpressionParser& p) : depth(p.depth_) {
            if (++depth > kMaxDepth) throw ExpressionError(p.at_, "found an expression nested deeper than " + std::to_string(kMaxDepth) + " levels, expected fewer");
        }
        ~Deeper() { --depth; }
    };

    int sum() {
        const Deeper guard(*this);
        int left = product();
        for (;;) {
            if (accept("+")) left = add(Op::add, left, product());
            else if (accept("-")) left = add(Op::subtract, left, product());
            else return left;
        }
    }
    int product() {
        int left = with_sign();
        for (;;) {
            if (next_is("**")) fail("one operand (a power is written with ^)");
            if (accept("*")) left = add(Op::multiply, left, with_sign());
            else if (accept("/")) left = add(Op::divide, left, with_sign());
            else return left;
        }
    }
    int with_sign() {
        const Deeper guard(*this);
        if (accept("-")) return add(Op::negate, with_sign());
        if (accept("+")) return with_sign();
        const int left = primary();
        return accept("^") ? power_of(left, with_sign()) : left;
    }
    int power_of(int a, int b) {
        const Node exponent = result_.nodes_[b];
        if (exponent.op != Op::number) return add(Op::power, a, b);
        const double p = exponent.value;
        if (p == std::floor(p) && std::fabs(p) <= kMaxIntegerPower) return add(Op::power_integer, a, -1, -1, p);
        return add(Op::power_real, a, -1, -1, p);
    }
    int primary() {
        skip_spaces();
        if (at_ >= text_.size()) fail("a number, a name or \"(\"");
        const char c = text_[at_];
        if ((c >= '0' && c <= '9') || c == '.') return number();
        if (starts_name(c)) return name();
        if (accept("(")) {
            const int inner = sum();
            if (!accept(")")) fail("\")\"");
            return inner;
        }
        fail("a number, a name or \"(\"");
    }
    int number() {
        double x = 0;
        const auto [end, error] = std::from_chars(text_.data() + at_, text_.data() + text_.size(), x);
        if (error != std::errc()) fail("a finite number");
        at_ = static_cast<std::size_t>(end - text_.data());
        return add(Op::number, -1, -1, -1, x);
    }
    int name() {
        const std::size_t start = at_;
        while (at_ < text_.size() && continues_name(text_[at_])) ++at_;
        const std::string word(text_.substr(start, at_ - start));
        for (const Named& f : kFunctions) {
            if (word == f.name) return call(f);
        }
        if (word == "t" && formula_) return add(Op::variable);
        if (const auto p = names_.find(word); p != names_.end()) return add(Op::number, -1, -1, -1, p->second);
        if (word == "pi") return add(Op::number, -1, -1, -1, std::numbers::pi);
        if (word == "e") return add(Op::number, -1, -1, -1, std::numbers::e);
        if (word == "t") fail_at(start, "no t, which only formulas have");
        std::vector<std::string> known{"pi", "e"};
        if (formula_) known.push_back("t");
        for (const auto& p : names_) known.push_back(p.first);
        std::vector<std::string> all = known;
        for (const Named& f : kFunctions) all.push_back(f.name);
        fail_at(start, "a parameter, constant or function (have: " + listed(known) + ")" + did_you_mean(word, all));
    }
    int call(const Named& f) {
        if (!accept("(")) fail("\"(\" after " + std::string(f.name));
        std::vector<int> args;
        do {
            args.push_back(f.op == Op::choose && args.empty() ? comparison() : sum());
        } while (static_cast<int>(args.size()) < f.most && accept(","));
        if (static_cast<int>(args.size()) < f.least) fail("\",\" and another argument of " + std::string(f.name));
        if (!accept(")")) fail("\")\" after the last argument of " + std::string(f.name));
        if (f.op == Op::choose) return add_choice(args[0], args[1], args[2]);
        if (f.op == Op::power) return power_of(args[0], args[1]);
        if (f.most == 1) return add(f.op, args[0]);
        int r = args[0];
        for (std::size_t i = 1; i < args.size(); ++i) r = add(f.op, r, args[i]);
        return r;
    }
    int comparison() {
        static constexpr std::pair<const char*, Comparison> kinds[] = {
            {"<=", Comparison::less_equal}, {">=", Comparison::greater_equal}, {"==", Comparison::equal},
            {"!=", Comparison::not_equal},  {"<", Comparison::less},           {">", Comparison::greater}};
        const int left = sum();
        for (const auto& [symbol, how] : kinds) {
            if (!accept(symbol)) continue;
            const int right = sum();
            return add(Op::compare, left, right, -1, static_cast<double>(how));
        }
        fail("a comparison (< <= > >= == !=)");
    }
    // A choice between t < number and the rest whose branches meet there is continuous; its place is remembered.
    int add_choice(int condition, int yes, int no) {
        const Node c = result_.nodes_[condition];
        const Node &l = result_.nodes_[c.a], &r = result_.nodes_[c.b];
        const bool at_number = (l.op == Op::variable && r.op == Op::number) || (l.op == Op::number && r.op == Op::variable);
        const auto how = static_cast<Comparison>(c.value);
        double continuous = 0;
        if (at_number && how != Comparison::equal && how != Comparison::not_equal) {
            const double t = l.op == Op::number ? l.value : r.value;
            const Run<double> run{result_.nodes_, t};
            const double a = run.at(yes), b = run.at(no);
            if (std::fabs(a - b) <= 1e-12 * std::max({1.0, std::fabs(a), std::fabs(b)})) continuous = 1;
            result_.switches_.push_back(t);
        }
        return add(Op::choose, condition, yes, no, continuous);
    }

    std::string_view text_;
    const std::map<std::string, double>& names_;
    bool formula_;
    std::size_t at_ = 0;
    int depth_ = 0;
    Expression result_;
};

Expression Expression::parse(std::string_view text, const std::map<std::string, double>& names, bool formula) {
    return ExpressionParser(text, names, formula).run();
}

namespace {
template <class T, int I, int J, int N> Jet<T, I, J, N> mirrored(Jet<T, I, J, N> x) {
    for (int k = 1; k < x.size; k += 2) x.c[k] = -x.c[k];
    return x;
}
bool reaches(double t, double end) { return t >= end; }
bool reaches(const Interval& t, double end) { return t.lo >= end; }
bool reaches(const Pack& t, double end) {
    bool any = false;
    for (int i = 0; i < Pack::lanes; ++i) any = any || t[i] >= end;
    return any;
}
/// At a kink a formula answers with the piece to its right, at the end of its domain with that to its left.
struct Formula {
    std::shared_ptr<const Expression> e;
    double end = std::numeric_limits<double>::infinity();
    bool kinks = e->has_kinks();

    template <class S> S operator()(const S& t) const {
        if constexpr (IsJet<S>::value)
            if (kinks) return one_sided(t);
        return run(t);
    }

private:
    template <class S> S run(const S& t) const { return Run<S>{e->nodes(), t}.at(static_cast<int>(e->nodes().size()) - 1); }
    template <class T, int N> JetU<T, N> one_sided(const JetU<T, N>& t) const {
        if constexpr (N == 0) {  // a slope shows which side is meant
            return JetU<T, 0>(one_sided(variable_u<T, 1>(t.c[0])).c[0]);
        } else {
            JetU<T, N> x = run(t);
            if (!reaches(t.c[0], end)) return x;
            const JetU<T, N> left = mirrored(run(mirrored(t)));  // run backwards, left is right
            if constexpr (std::is_same_v<T, Pack>) {
                for (int k = 0; k <= N; ++k)
                    for (int i = 0; i < Pack::lanes; ++i)
                        if (reaches(t.c[0][i], end)) x.c[k].set(i, left.c[k][i]);
                return x;
            } else {
                return left;
            }
        }
    }
};
struct FormulaCurve {
    Function x, y, z;
    double begin, end;
    std::vector<double> switches;
    template <class S> Vec3<S> operator()(const S& t) const { return {x(t), y(t), z(t)}; }
    std::vector<Break> breaks() const {
        std::vector<Break> b;
        for (const double t : switches) b.push_back({t, 0});
        return b;
    }
};
}  // namespace

/// Samples step over a pole; enclosures do not: they stay unbounded however small the interval about it. Where they are
/// bounded so is the formula, whatever its derivatives do.
static void check_bounded(const Function& f, const std::string& name, double begin, double end) {
    static constexpr int kPieces = 128, kMaxDepth = 40, kMaxEnclosures = 20'000;
    struct Piece {
        Interval t;
        int depth;
    };
    std::vector<Piece> stack;
    const auto knot = [&](int k) { return k == kPieces ? end : std::min(end, begin + (end - begin) * k / kPieces); };
    for (int k = kPieces; k > 0; --k) stack.push_back({{knot(k - 1), knot(k)}, 0});  // the first one on top
    for (int count = 0; !stack.empty(); ++count) {
        const auto [t, depth] = stack.back();
        stack.pop_back();
        Interval y;
        f.taylor(t, 0, &y);
        if (y.bounded()) continue;
        const double m = mid(t);
        if (depth >= kMaxDepth || count >= kMaxEnclosures || m <= t.lo || m >= t.hi) {
            throw_input("found " + name + "(t) that cannot be bounded near t = " + to_text(m) + ", expected a finite number on the whole domain");
        }
        stack.push_back({{m, t.hi}, depth + 1});
        stack.push_back({{t.lo, m}, depth + 1});
    }
}

static void check_samples(const Expression& e, const std::string& name, double begin, double end) {
    for (int k = 0; k <= 128; ++k) {
        const double t = k == 128 ? end : begin + (end - begin) * k / 128;
        if (!std::isfinite(e(t))) throw_input("found " + name + "(" + to_text(t) + ") = " + to_text(e(t)) + ", expected a finite number on the whole domain");
    }
}
static void check_switches(const Expression& e, const std::string& name, double begin, double end, const char* expected) {
    for (const double t : e.switches()) {
        if (!(t >= begin && t <= end)) continue;
        const double before = e(t > begin ? std::nextafter(t, begin) : t), after = e(t < end ? std::nextafter(t, end) : t);
        if (!(std::fabs(before - after) <= 1e-9 * std::max({1.0, std::fabs(before), std::fabs(after)})))
            throw_input("found " + name + "(t) that jumps from " + to_text(before) + " to " + to_text(after) + " at t = " + to_text(t) + ", expected a continuous " + expected);
    }
}

static Function formula_until(const Expression& formula, double end) {
    const Formula f{std::make_shared<const Expression>(formula), end};
    const Coefficients exact = f(Coefficients(std::vector<double>{0, 1}));
    return exact.c.empty() ? make_function(f) : Function::polynomial(exact.c);
}
static Function checked_formula(const Expression& formula, const std::string& name, double begin, double end, const char* expected) {
    check_samples(formula, name, begin, end);
    check_switches(formula, name, begin, end, expected);
    const Function f = formula_until(formula, end);
    check_bounded(f, name, begin, end);
    return f;
}

Function make_formula(const Expression& formula) { return formula_until(formula, std::numeric_limits<double>::infinity()); }
Function make_formula(const Expression& formula, double begin, double end) { return checked_formula(formula, "H", begin, end, "function"); }

Curve make_formula_curve(const std::array<Expression, 3>& xyz, double begin, double end) {
    const auto part = [&](int i) { return checked_formula(xyz[i], std::string(1, "xyz"[i]), begin, end, "curve"); };
    FormulaCurve curve{part(0), part(1), part(2), begin, end, {}};
    for (const Expression& e : xyz)
        for (const double t : e.switches())
            if (t > begin && t < end) curve.switches.push_back(t);
    std::sort(curve.switches.begin(), curve.switches.end());
    curve.switches.erase(std::unique(curve.switches.begin(), curve.switches.end()), curve.switches.end());
    return make_curve(std::move(curve));
}

}  // namespace isoparm
