#include "function.h"

namespace isoparm {
namespace {

struct PolynomialFunction {
    std::vector<double> c;
    template <class S> S operator()(const S& t) const { return isoparm::polynomial(c.data(), static_cast<int>(c.size()) - 1, t); }
    Polynomial operator()(const Polynomial& t) const {
        Polynomial r(c.back());
        for (int k = static_cast<int>(c.size()) - 2; k >= 0; --k) r = r * t + Polynomial(c[k]);
        return r;
    }
};

}  // namespace

/// A cubic, and third derivatives that differ from its own by what intervals show.
Polynomial Function::Concept::exact(const Polynomial& t) const {
    if (!t.exists() || !t.is_model()) return Polynomial::nothing();
    const Interval range = t.range();
    const double at = mid(range);
    Interval f[4], over[4];
    taylor(Interval(at), 3, f);
    taylor(range, 3, over);
    f[3] = over[3];
    return Polynomial::composed(f, 3, t, at);
}

Function Function::polynomial(std::vector<double> coefficients) {
    if (coefficients.empty()) coefficients = {0};
    return make_function(PolynomialFunction{std::move(coefficients)});
}

}  // namespace isoparm
