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

Function Function::polynomial(std::vector<double> coefficients) {
    if (coefficients.empty()) coefficients = {0};
    return make_function(PolynomialFunction{std::move(coefficients)});
}

}  // namespace isoparm
