#include "patches/edge_series.h"
#include "patches/forwarding.h"

namespace isoparm {
namespace {

class WithTriangleForms final : public ForwardingPatch {
public:
    WithTriangleForms(Patch patch, std::function<std::vector<Polynomial>(int)> forms) : ForwardingPatch(std::move(patch)), forms_(std::move(forms)) {}
    std::vector<Polynomial> exact_cell(std::size_t i, std::size_t j) const override { return j == 0 && i >= 1 && i <= 3 ? forms_(static_cast<int>(i) - 1) : patch_.exact_cell(i, j); }

private:
    std::function<std::vector<Polynomial>(int)> forms_;
};

}  // namespace

Patch with_triangle_forms(Patch patch, std::function<std::vector<Polynomial>(int edge)> forms) {
    return Patch(std::make_shared<WithTriangleForms>(std::move(patch), std::move(forms)));
}

}  // namespace isoparm
