#include "batch/batch_quotient.h"

#include <algorithm>

#include "batch/batch_kernel.h"

namespace isoparm {

QuotientCell::QuotientCell(const PolynomialCells::Form& form) : good_(parts * parts) {
    for (const Polynomial& p : form) degree_ = std::max({degree_, p.degree_u(), p.degree_v()});
    while (degree_ <= PolynomialCells::max_degree && !batch_kernel(Isa::baseline, degree_, true, false)) ++degree_;
    if (degree_ > PolynomialCells::max_degree) return;
    constexpr double half = 0.5;  // of the square's width, as PolynomialCells measures derivatives
    double largest = 0;
    const std::vector<FrameError> errors = quotient_errors(form, {0, 1}, {0, 1}, parts, largest);
    const auto good = [&](const FrameError& e) { return std::max({e.position, half * e.du, half * e.dv}) <= PolynomialCells::accuracy * largest; };
    std::transform(errors.begin(), errors.end(), good_.begin(), good);
    if (std::none_of(good_.begin(), good_.end(), [](std::uint8_t one) { return one != 0; })) return;
    const std::size_t side = static_cast<std::size_t>(degree_) + 1;
    c_.assign(form.size() * side * side, 0.0);
    for (std::size_t axis = 0; axis < form.size(); ++axis)
        for (int p = 0; p <= form[axis].degree_u(); ++p)
            for (int q = 0; q <= form[axis].degree_v(); ++q) c_[(axis * side + static_cast<std::size_t>(p)) * side + static_cast<std::size_t>(q)] = mid(form[axis].coefficient(p, q));
}

void QuotientCell::frames(Isa isa, std::size_t n, const double* u, const double* v, double* const* out) const {
    batch_kernel(isa, degree_, true, false)(c_.data(), 0.5, 0.5, n, u, v, out);
}

}  // namespace isoparm
