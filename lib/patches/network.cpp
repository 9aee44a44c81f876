#include "patches/network.h"

#include "curves/hermite.h"
#include "curves/modify.h"
#include "patches/compatibility.h"
#include "patches/hermite_surface.h"

namespace isoparm {
namespace {

std::string name(const char* family, std::size_t k) { return std::string(family) + "[" + std::to_string(k) + "]"; }

/// The network with its curves run over [0,n] and [0,m].
Network over_nodes(const Network& network) {
    if (network.a.size() < 2 || network.b.size() < 2)
        throw_input("found " + std::to_string(network.a.size()) + " curves a and " + std::to_string(network.b.size()) + " curves b, expected at least two of each");
    Network n;
    for (const auto& c : network.a) n.a.push_back(reparametrized(c, 0, double(network.b.size() - 1)));
    for (const auto& c : network.b) n.b.push_back(reparametrized(c, 0, double(network.a.size() - 1)));
    return n;
}

/// x_u(i,.) of the curves r(0,.), ..., r(m,.) by the differences (6.25).
std::vector<Curve> differences(const std::vector<Curve>& r) {
    const std::size_t m = r.size() - 1;
    if (m == 1) return {linear_combination({-1, 1}, r), linear_combination({-1, 1}, r)};
    std::vector<Curve> d;
    d.push_back(linear_combination({-1.5, 2, -0.5}, {r[0], r[1], r[2]}));  // 2 r1 - 2 r0 - (r2 - r0)/2
    for (std::size_t i = 1; i < m; ++i) d.push_back(linear_combination({-0.5, 0.5}, {r[i - 1], r[i + 1]}));
    d.push_back(linear_combination({0.5, -2, 1.5}, {r[m - 2], r[m - 1], r[m]}));  // 2 rm - 2 r(m-1) - (rm - r(m-2))/2
    return d;
}

/// The curve's derivative at t, which must be the same from both sides.
Point tangent(const Curve& c, double t, const std::string& name, double size) {
    const Point right = c.derivative(t);
    if (t > c.begin() && t < c.end())
        require_equal("C1: the tangents of " + name + " from both sides at " + to_text(t), -reversed(c).derivative(c.begin() + (c.end() - t)), right, size + length(right));
    return right;
}

void require_c1(const std::vector<Curve>& curves, const char* family) {
    for (std::size_t k = 0; k < curves.size(); ++k)
        for (const Break& b : curves[k].breaks())
            if (b.continuity < 1) tangent(curves[k], b.t, name(family, k), size_of({&curves[k]}));
}

Patch make(const Network& net, const CrossDerivatives& cross, Twist twist, bool tangents_agree, Part part) {
    HermiteNetwork h;
    for (std::size_t i = 0; i < net.a.size(); ++i) h.f.push_back(net.a[i]), h.f.push_back(reparametrized(cross.A[i], 0, double(net.b.size() - 1)));
    for (std::size_t j = 0; j < net.b.size(); ++j) h.g.push_back(net.b[j]), h.g.push_back(reparametrized(cross.B[j], 0, double(net.a.size() - 1)));
    h.name = [](char family, std::size_t k) {
        return name(family == 'f' ? (k % 2 ? "A" : "a") : (k % 2 ? "B" : "b"), k / 2);
    };
    return make_patch_with_edges(hermite_surface(h, twist, tangents_agree, part));
}

}  // namespace

CrossDerivatives finite_differences(const Network& network) {
    const Network net = over_nodes(network);
    return {differences(net.a), differences(net.b)};
}

CrossDerivatives from_twists(const Network& network, const Grid<Point>& d) {
    const Network net = over_nodes(network);
    const std::size_t m = net.a.size() - 1, n = net.b.size() - 1;
    if (d.size() != m + 1) throw_input("found twists for " + std::to_string(d.size()) + " curves a, expected " + std::to_string(m + 1));
    for (const auto& row : d)
        if (row.size() != n + 1) throw_input("found a row of " + std::to_string(row.size()) + " twists, expected one for each of the " + std::to_string(n + 1) + " curves b");
    const double size = std::max(size_of({&net.a.front(), &net.a.back()}), size_of({&net.b.front(), &net.b.back()}));
    CrossDerivatives cross;
    for (std::size_t i = 0; i <= m; ++i) {
        std::vector<Point> values;
        for (std::size_t j = 0; j <= n; ++j) values.push_back(tangent(net.b[j], double(i), name("b", j), size));
        cross.A.push_back(make_hermite(values, d[i]));
    }
    for (std::size_t j = 0; j <= n; ++j) {
        std::vector<Point> values, twists;
        for (std::size_t i = 0; i <= m; ++i) {
            values.push_back(tangent(net.a[i], double(j), name("a", i), size));
            twists.push_back(d[i][j]);
        }
        cross.B.push_back(make_hermite(values, twists));
    }
    return cross;
}

Patch make_network(const Network& network, Twist twist, Part part) {
    return make(over_nodes(network), finite_differences(network), twist, false, part);
}

Patch make_network(const Network& network, const CrossDerivatives& cross, Twist twist, Part part) {
    const Network net = over_nodes(network);
    if (cross.A.size() != net.a.size() || cross.B.size() != net.b.size())
        throw_input("found " + std::to_string(cross.A.size()) + " cross derivatives A and " + std::to_string(cross.B.size()) + " B, expected one for each of the " +
                    std::to_string(net.a.size()) + " curves a and " + std::to_string(net.b.size()) + " curves b");
    require_c1(cross.A, "A");
    require_c1(cross.B, "B");
    return make(net, cross, twist, true, part);
}

}  // namespace isoparm
