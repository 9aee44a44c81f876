#include "patches/coons_hermite.h"

#include "patches/hermite_surface.h"

namespace isoparm {

namespace {
HermiteNetwork network_of(const HermiteData& data) {
    // A Hermite basis of one cell has the order value, derivative, value, derivative.
    static constexpr std::size_t order[4] = {0, 1, 3, 2};
    HermiteNetwork network;
    for (const std::size_t k : order) {
        network.f.push_back(reparametrized(data.f[k], 0, 1));
        network.g.push_back(reparametrized(data.g[k], 0, 1));
    }
    network.name = [](char family, std::size_t k) { return std::string(1, family) + "[" + std::to_string(order[k]) + "]"; };
    return network;
}
}  // namespace

Patch make_coons_hermite(const HermiteData& data, Twist twist, Part part) {
    return make_patch_with_edges(hermite_surface(network_of(data), twist, true, part));
}

Patch gregory_on_edges(const HermiteData& data, bool of_f, double& slack) {
    return make_patch_with_edges(on_edges(hermite_surface(network_of(data), Twist::gregory, true, Part::sum), of_f, &slack));
}

}  // namespace isoparm
