// patches/basis.h -- blends H_i for boolean sums: a basis answers basis(t) with those that do not vanish at t.
#pragma once
#include <array>
#include <string>
#include <vector>

#include "curve.h"
#include "patch_model.h"

namespace isoparm {

/// Nodes of one Lagrange basis: with more, the polynomials exceed 1e8 between the nodes.
inline constexpr std::size_t most_nodes = 33;
/// Throws Error(input) unless there is one node a curve, 2 to most_nodes of them, and they grow; `name` begins the message.
void check_nodes(const std::string& name, const std::vector<double>& nodes, std::size_t curves);

/// weights[k] belongs to the datum first + k; all others are 0 there.
template <class Weights> struct Blends {
    std::size_t first;
    Weights weights;
};
template <class S, class... More> auto blends(std::size_t first, S weight, More... more) {
    return Blends<std::array<S, 1 + sizeof...(More)>>{first, {std::move(weight), std::move(more)...}};
}

/// 1 - t, t
struct LinearBasis {
    static std::vector<double> breaks() { return {}; }
    template <class S> auto operator()(const S& t) const { return blends(0, S(1.0 - t), t); }
};

/// 1 - H, H with H(0) = 0, H(1) = 1
struct BlendBasis {
    Function H;
    static std::vector<double> breaks() { return {}; }
    template <class S> auto operator()(const S& t) const {
        const S h = H(t);
        return blends(0, S(1.0 - h), h);
    }
};

/// Any functions.
struct FunctionBasis {
    std::vector<Function> H;
    std::vector<double> nodes;  // inside the domain, where their derivatives may jump
    std::vector<double> breaks() const { return nodes; }
    template <class S> auto operator()(const S& t) const {
        Blends<std::vector<S>> b{0, {}};
        for (const Function& h : H) b.weights.push_back(h(t));
        return b;
    }
};

/// Lagrange's polynomials L_i(t) = prod_{k != i} (t - t_k) / (t_i - t_k), in product form: every L_i is exact to rounding.
class LagrangeBasis {
public:
    explicit LagrangeBasis(std::vector<double> nodes) : nodes_(std::move(nodes)) {
        for (std::size_t i = 0; i < nodes_.size(); ++i) {
            Interval product(1);
            for (std::size_t k = 0; k < nodes_.size(); ++k)
                if (k != i) product = product * (Interval(nodes_[i]) - Interval(nodes_[k]));
            scale_.push_back(Interval(1) / product);
        }
    }
    static std::vector<double> breaks() { return {}; }
    template <class S> auto operator()(const S& t) const {
        const std::size_t n = nodes_.size();
        Blends<std::vector<S>> b{0, {}};
        S before(1.0);  // prod_{k < i} (t - t_k)
        for (std::size_t i = 0; i < n; ++i) {
            b.weights.push_back(before * constant_for<S>(scale_[i]));
            before = before * (t - nodes_[i]);
        }
        S after(1.0);  // prod_{k > i} (t - t_k)
        for (std::size_t i = n; i-- > 0;) {
            b.weights[i] = b.weights[i] * after;
            after = after * (t - nodes_[i]);
        }
        return b;
    }

private:
    std::vector<double> nodes_;
    std::vector<Interval> scale_;
};

/// Nodes t_0 < ... < t_m; in a cell between two of them a local parameter runs over [0,1].
class Cells {
public:
    explicit Cells(std::vector<double> nodes) : nodes_(std::move(nodes)), inner_(nodes_.begin() + 1, nodes_.end() - 1) {}
    const std::vector<double>& inner() const { return inner_; }
    template <class S> std::size_t at(const S& t) const { return cell_of(inner_, t); }
    template <class S> S local(std::size_t cell, const S& t) const {
        const Interval width = Interval(nodes_[cell + 1]) - Interval(nodes_[cell]);
        S x = t - nodes_[cell];
        if (width.lo != 1 || width.hi != 1) x = x * constant_for<S>(Interval(1) / width);
        if constexpr (requires { t.is(0.0); })  // on a line: 1 at the end of the cell, and not up to rounding, as other blends are 0 there
            if (t.is(nodes_[cell + 1])) x.c[0] = Polynomial(1);
        if constexpr (std::is_same_v<S, Polynomial>) return x;
        else return kept_in(x, 0, 1);
    }

private:
    std::vector<double> nodes_, inner_;
};

/// Cubic Hermite polynomials of [0,1]: value at 0, derivative at 0, derivative at 1, value at 1 (H1..H4 of seed 002 (3)).
template <class S> std::array<S, 4> hermite_polynomials(const S& t) {
    static constexpr double h[4][4] = {{1, 0, -3, 2}, {0, 1, -2, 1}, {0, 0, -1, 1}, {0, 0, 3, -2}};
    return {polynomial(h[0], 3, t), polynomial(h[1], 3, t), polynomial(h[2], 3, t), polynomial(h[3], 3, t)};
}

/// C1 hats: 1 at their own node, 0 at the others, slope 0 at all (H_2i of seed 002 (17)).
struct HatBasis {
    Cells cells;
    std::vector<double> breaks() const { return cells.inner(); }
    template <class S> auto operator()(const S& t) const {
        const std::size_t i = cells.at(t);
        const auto h = hermite_polynomials(cells.local(i, t));
        return blends(i, h[0], h[3]);
    }
};

/// C1 hats for values and derivatives at the nodes 0, 1, ... m: datum 2i is the value at i, 2i + 1 the derivative there (seed
/// 002 (15), (17)).
struct HermiteBasis {
    Cells cells;
    explicit HermiteBasis(std::size_t m) : cells(unit_nodes(m)) {}
    std::vector<double> breaks() const { return cells.inner(); }
    template <class S> auto operator()(const S& t) const {
        const std::size_t i = cells.at(t);
        const auto h = hermite_polynomials(cells.local(i, t));
        return blends(2 * i, h[0], h[1], h[3], h[2]);
    }

private:
    static std::vector<double> unit_nodes(std::size_t m) {
        std::vector<double> nodes;
        for (std::size_t i = 0; i <= m; ++i) nodes.push_back(double(i));
        return nodes;
    }
};

}  // namespace isoparm
