// function.h -- a real function of one variable, as a value: blends, weights, formulas.
//
// Any object with `template <class S> S operator()(const S& t) const` can be a Function; it is then run on numbers,
// packs, intervals and jets of these. Immutable, cheap to copy, safe to call from every thread.
#pragma once
#include <concepts>
#include <memory>
#include <vector>

#include "scalar/jet.h"
#include "scalar/polynomial.h"

namespace isoparm {

class EdgeScalar;

class Function {
public:
    /// Taylor coefficients out[0..order], order <= 3, at t.
    struct Concept {
        virtual ~Concept() = default;
        virtual void taylor(double t, int order, double* out) const = 0;
        virtual void taylor(const Pack& t, int order, Pack* out) const = 0;
        virtual void taylor(const Interval& t, int order, Interval* out) const = 0;
        /// The exact polynomial, where the function is one; of a model, a model.
        virtual Polynomial exact(const Polynomial& t) const;
    };
    explicit Function(std::shared_ptr<const Concept> impl) : impl_(std::move(impl)) {}
    /// sum coefficients[k] t^k
    static Function polynomial(std::vector<double> coefficients);

    template <class T> void taylor(const T& t, int order, T* out) const { impl_->taylor(t, order, out); }
    double operator()(double t) const {
        double y;
        impl_->taylor(t, 0, &y);
        return y;
    }
    template <class T, int I, int J, int N> Jet<T, I, J, N> operator()(const Jet<T, I, J, N>& t) const {
        T a[N + 1];
        impl_->taylor(t.c[0], N, a);
        return compose(a, t);
    }
    Polynomial operator()(const Polynomial& t) const { return impl_->exact(t); }
    template <std::same_as<EdgeScalar> S> S operator()(const S& t) const { return t.of(*this); }

private:
    std::shared_ptr<const Concept> impl_;
};

/// Runs a formula on jets of the order asked for.
template <class F, class T, class Out> void taylor_of(const F& f, const T& t, int order, Out store) {
    const auto run = [&]<int N>(std::integral_constant<int, N>) { store(f(variable_u<T, N>(t))); };
    switch (order) {
        case 0: return run(std::integral_constant<int, 0>{});
        case 1: return run(std::integral_constant<int, 1>{});
        case 2: return run(std::integral_constant<int, 2>{});
        default: return run(std::integral_constant<int, 3>{});
    }
}

template <class F> class FunctionModel final : public Function::Concept {
public:
    explicit FunctionModel(F f) : f_(std::move(f)) {}
    void taylor(double t, int order, double* out) const override { run(t, order, out); }
    void taylor(const Pack& t, int order, Pack* out) const override { run(t, order, out); }
    void taylor(const Interval& t, int order, Interval* out) const override { run(t, order, out); }
    Polynomial exact(const Polynomial& t) const override {
        if constexpr (requires { { f_(t) } -> std::same_as<Polynomial>; }) return f_(t);
        else return Concept::exact(t);
    }

private:
    template <class T> void run(const T& t, int order, T* out) const {
        taylor_of(f_, t, order, [&](const auto& y) {
            for (int k = 0; k <= order; ++k) out[k] = y.coefficient(k, 0);
        });
    }
    F f_;
};

template <class F> Function make_function(F f) { return Function(std::make_shared<FunctionModel<F>>(std::move(f))); }

}  // namespace isoparm
