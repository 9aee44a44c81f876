#include <algorithm>

#include "patches/edge_series.h"
#include "patches/forwarding.h"

namespace isoparm {
namespace {

using Forms = std::function<std::vector<Polynomial>(int, std::size_t)>;

class WithTriangleForms final : public ForwardingPatch {
public:
    WithTriangleForms(Patch patch, Forms forms) : ForwardingPatch(std::move(patch)), forms_(std::move(forms)) {}
    std::vector<Polynomial> exact_cell(std::size_t i, std::size_t j) const override { return i >= 1 && i <= 3 ? forms_(static_cast<int>(i) - 1, j) : patch_.exact_cell(i, j); }

private:
    Forms forms_;
};

}  // namespace

Polynomial divided(Polynomial& of, const Polynomial& by, const Polynomial& variable) {
    const auto n = std::size_t(by.degree_u());
    std::vector<Interval> c(n);
    for (int k = 0; k <= of.degree_u(); ++k) c.resize(std::max(c.size(), std::size_t(k) + 1)), c[std::size_t(k)] = of.coefficient(k, 0);
    for (std::size_t k = c.size(); k-- > n;)
        for (std::size_t i = 0; i < n; ++i) c[k - n + i] = c[k - n + i] - by.coefficient(int(i), 0) * c[k];
    const auto sum = [&](std::size_t from, std::size_t to) {
        Polynomial r;
        for (std::size_t k = to; k-- > from;) r = r * variable + Polynomial(c[k]);
        return r;
    };
    of = sum(0, n);
    return sum(n, c.size());
}

std::vector<Interval> parts_of(std::initializer_list<const Curve*> curves) {
    std::vector<double> ends{0, 1};
    for (const Curve* c : curves)
        for (const Break& b : c->breaks())
            if (b.t > 0 && b.t < 1) ends.push_back(b.t);
    std::sort(ends.begin(), ends.end());
    ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
    std::vector<Interval> parts;
    for (std::size_t k = 0; k + 1 < ends.size(); ++k) parts.push_back({ends[k], ends[k + 1]});
    return parts;
}

Patch with_triangle_forms(Patch patch, Forms forms) {
    return Patch(std::make_shared<WithTriangleForms>(std::move(patch), std::move(forms)));
}

}  // namespace isoparm
