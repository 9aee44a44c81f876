// curve.h -- a parametric curve in space, as a value.
//
// A Curve runs on numbers, packs, intervals, jets of these and exact polynomials. Immutable, cheap to copy, safe to call
// from every thread. Its domain is [begin(), end()]; it is C1 there unless breaks() says otherwise.
#pragma once
#include <concepts>
#include <memory>
#include <span>
#include <vector>

#include "function.h"
#include "scalar/jet.h"
#include "scalar/polynomial.h"
#include "scalar/quotient.h"

namespace isoparm {

class EdgeScalar;
class PiecewiseBezier;

/// An interior parameter where derivatives of order continuity + 1 may jump.
struct Break {
    double t;
    int continuity;
};

class Curve {
public:
    struct Concept {
        virtual ~Concept() = default;
        virtual double begin() const = 0;
        virtual double end() const = 0;
        virtual std::vector<Break> breaks() const { return {}; }
        /// Taylor coefficients out[k] = x^(k)(t)/k!, k = 0..order, order <= 3. At a break: of the piece to its right.
        /// Over an interval that spans a break, derivatives beyond its continuity + 1 are Interval::all().
        virtual void taylor(double t, int order, Vec3<double>* out) const = 0;
        virtual void taylor(const Pack& t, int order, Vec3<Pack>* out) const = 0;
        virtual void taylor(const Interval& t, int order, Vec3<Interval>* out) const = 0;
        /// The exact polynomial, where the curve is one over the range of t (or everywhere on its domain: then t may leave it). Of a model, a
        /// model where the curve is smooth over the range of t.
        virtual Vec3<Polynomial> exact(const Polynomial& t) const;
        /// The same as quotients of polynomials; t is no model.
        virtual Vec3<Quotient> quotient(const Polynomial& t) const { return Vec3<Quotient>(exact(t)); }
        /// Its exact (rational) Bezier pieces, where it has them.
        virtual const PiecewiseBezier* bezier() const { return nullptr; }
    };
    explicit Curve(std::shared_ptr<const Concept> impl) : impl_(std::move(impl)) {}

    double begin() const { return impl_->begin(); }
    double end() const { return impl_->end(); }
    std::vector<Break> breaks() const { return impl_->breaks(); }
    const PiecewiseBezier* bezier() const { return impl_->bezier(); }

    template <class T> void taylor(const T& t, int order, Vec3<T>* out) const { impl_->taylor(t, order, out); }
    Point operator()(double t) const {
        Point p;
        impl_->taylor(t, 0, &p);
        return p;
    }
    template <class T, int I, int J, int N> Vec3<Jet<T, I, J, N>> operator()(const Jet<T, I, J, N>& t) const {
        Vec3<T> a[N + 1];
        impl_->taylor(t.c[0], N, a);
        return compose(a, t);
    }
    Vec3<Polynomial> operator()(const Polynomial& t) const { return impl_->exact(t); }
    Vec3<Quotient> quotient(const Polynomial& t) const { return impl_->quotient(t); }
    template <std::same_as<EdgeScalar> S> Vec3<S> operator()(const S& t) const { return t.of(*this); }
    Point derivative(double t) const {
        Point p[2];
        impl_->taylor(t, 1, p);
        return p[1];
    }

private:
    std::shared_ptr<const Concept> impl_;
};

/// Makes a Curve of a formula: an object with begin, end (numbers) and `template <class S> auto operator()(S t) const`
/// returning a Vec3 of S; breaks() is optional.
template <class F> class CurveModel final : public Curve::Concept {
public:
    explicit CurveModel(F f) : f_(std::move(f)) {}
    double begin() const override { return f_.begin; }
    double end() const override { return f_.end; }
    std::vector<Break> breaks() const override {
        if constexpr (requires { f_.breaks(); }) return f_.breaks();
        else return {};
    }
    void taylor(double t, int order, Vec3<double>* out) const override { run(t, order, out); }
    void taylor(const Pack& t, int order, Vec3<Pack>* out) const override { run(t, order, out); }
    void taylor(const Interval& t, int order, Vec3<Interval>* out) const override { run(t, order, out); }
    Vec3<Polynomial> exact(const Polynomial& t) const override { return f_(t); }
    Vec3<Quotient> quotient(const Polynomial& t) const override {
        if constexpr (requires { f_.quotient(t); }) return f_.quotient(t);
        else return Vec3<Quotient>(f_(t));
    }

private:
    template <class T> void run(const T& t, int order, Vec3<T>* out) const {
        taylor_of(f_, t, order, [&](const auto& p) {
            for (int k = 0; k <= order; ++k) out[k] = {p.x.coefficient(k, 0), p.y.coefficient(k, 0), p.z.coefficient(k, 0)};
        });
    }
    F f_;
};
template <class F> Curve make_curve(F f) { return Curve(std::make_shared<CurveModel<F>>(std::move(f))); }

/// Breaks closer than this, as a fraction of the domain, are one break that was rounded in different ways.
inline constexpr double break_rounding = 1e-13;
/// The breaks of curves over the same domain, in order, each with the least continuity that any of them has there.
std::vector<Break> breaks_of(std::span<const Curve> curves);
std::vector<double> break_parameters(const std::vector<Curve>& curves);

/// The same curve run over [begin, end] (affinely).
Curve reparametrized(const Curve& c, double begin, double end);

}  // namespace isoparm
