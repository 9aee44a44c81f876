// certificate_check.cpp -- proves a certificate: first that its triangles cover the patches once, then the bound of each by itself.
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "error.h"
#include "meshes/certificate_cover.h"

namespace isoparm {
namespace {

// ---- the bound of one triangle -----------------------------------------------------------------------------------------

/// Bernstein polynomials over a triangle: the coefficient of l0^i l1^j l2^k stands at (n - i)(n - i + 1) / 2 + k, n the degree.
constexpr int size_of(int n) { return (n + 1) * (n + 2) / 2; }
constexpr int place(int n, const std::array<int, 3>& e) { return (n - e[0]) * (n - e[0] + 1) / 2 + e[2]; }
using Cubic = std::array<Interval, size_of(3)>;
using Sextic = std::array<Interval, size_of(6)>;

/// Exponents of a cubic's coefficients, and what products of them become.
struct Products {
    std::array<std::array<int, 3>, size_of(3)> exponents;
    int index[size_of(3)][size_of(3)];
    Interval weight[size_of(3)][size_of(3)];
    Products() {
        for (int i = 0; i <= 3; ++i)
            for (int k = 0; i + k <= 3; ++k) exponents[place(3, {i, 3 - i - k, k})] = {i, 3 - i - k, k};
        const auto multinomial = [](const std::array<int, 3>& e) {
            constexpr double f[7] = {1, 1, 2, 6, 24, 120, 720};
            return f[e[0] + e[1] + e[2]] / (f[e[0]] * f[e[1]] * f[e[2]]);
        };
        for (int p = 0; p < size_of(3); ++p)
            for (int q = 0; q < size_of(3); ++q) {
                const auto &a = exponents[p], &b = exponents[q];
                const std::array<int, 3> sum{a[0] + b[0], a[1] + b[1], a[2] + b[2]};
                index[p][q] = place(6, sum);
                weight[p][q] = Interval(multinomial(a) * multinomial(b)) / Interval(multinomial(sum));
            }
    }
};
const Products kProducts;

Sextic product(const Cubic& a, const Cubic& b) {
    Sextic r{};
    for (int p = 0; p < size_of(3); ++p)
        for (int q = 0; q < size_of(3); ++q) r[kProducts.index[p][q]] += kProducts.weight[p][q] * (a[p] * b[q]);
    return r;
}
/// The same polynomial, of degree 6.
Sextic raised(const Cubic& a) {
    Sextic r{};
    for (int p = 0; p < size_of(3); ++p)
        for (int q = 0; q < size_of(3); ++q) r[kProducts.index[p][q]] += kProducts.weight[p][q] * a[p];
    return r;
}

using Barycentric = std::array<double, 3>;
using Piece = std::array<Barycentric, 3>;  // of a triangle, dyadic and exact

class TriangleProof {
public:
    TriangleProof(const Patch& patch, const Cover& cover, const Certificate& all, const CertifiedPatch& claim, const CertifiedTriangle& t)
        : patch_(patch), cell_(cover.cell_of(t)), bound_(t.bound), net_(cover.net_of(t)) {
        for (int k = 0; k < 3; ++k) points_[k] = all.points[claim.vertex[t.corner[k]]];
    }

    /// Pieces that were looked at; `failure` is filled when the bound is not proved.
    std::size_t run(std::size_t budget, bool& proved, CertificateCheck::Failure& failure) const {
        std::vector<Piece> open{{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}};
        std::size_t count = 0;
        for (proved = true; !open.empty();) {
            const Piece piece = open.back();
            open.pop_back();
            const Norms norms = norms_of(piece);
            ++count;
            if (norms.most <= bound_) continue;
            if (norms.least > bound_ || count >= budget) {
                proved = false;
                failure.exceeded = norms.least > bound_;
                const Barycentric& x = piece[norms.corner];
                failure.uv = {mid(blossom(net_.u, x, x, x)), mid(blossom(net_.v, x, x, x))};
                failure.distance = failure.exceeded ? norms.least : norms.most;
                return count;
            }
            const auto half = [&](int i, int j) {
                return Barycentric{(piece[i][0] + piece[j][0]) / 2, (piece[i][1] + piece[j][1]) / 2, (piece[i][2] + piece[j][2]) / 2};
            };
            const Barycentric a = half(0, 1), b = half(1, 2), c = half(2, 0);
            for (const Piece& part : {Piece{piece[0], a, c}, Piece{a, piece[1], b}, Piece{c, b, piece[2]}, Piece{b, c, a}}) open.push_back(part);
        }
        return count;
    }

private:
    struct Norms {
        double most = HUGE_VAL, least = 0;  // of the distance, anywhere in the piece; at one of its corners
        int corner = 0;
    };

    /// Of three points: a control point of a piece that they are corners of; a value where they are one.
    static Interval blossom(Cubic net, const Barycentric& x, const Barycentric& y, const Barycentric& z) {
        int n = 3;
        for (const Barycentric* l : {&x, &y, &z}) {
            for (int i = --n; i >= 0; --i)
                for (int k = 0; i + k <= n; ++k) {
                    const int j = n - i - k;
                    net[place(n, {i, j, k})] = Interval((*l)[0]) * net[place(n + 1, {i + 1, j, k})] + Interval((*l)[1]) * net[place(n + 1, {i, j + 1, k})] + Interval((*l)[2]) * net[place(n + 1, {i, j, k + 1})];
                }
        }
        return net[0];
    }

    /// Taylor's formula about the middle of a box that holds the parameters of the piece, to the order that serves best.
    Norms norms_of(const Piece& piece) const {
        Cubic u, v;
        Box box;
        for (int p = 0; p < size_of(3); ++p) {
            const auto& e = kProducts.exponents[p];
            const Barycentric &x = piece[e[0] > 0 ? 0 : e[1] > 0 ? 1 : 2], &y = piece[e[0] > 1 ? 0 : e[0] + e[1] > 1 ? 1 : 2], &z = piece[e[0] > 2 ? 0 : e[0] + e[1] > 2 ? 1 : 2];
            u[p] = clip(blossom(net_.u, x, y, z), cell_.u), v[p] = clip(blossom(net_.v, x, y, z), cell_.v);
            box = p == 0 ? Box{u[p], v[p]} : Box{hull(box.u, u[p]), hull(box.v, v[p])};
        }
        // Whatever has its lower end on a break belongs to the cell beyond.
        if (box.u.lo == cell_.u.hi) box.u.lo = std::nextafter(box.u.lo, cell_.u.lo);
        if (box.v.lo == cell_.v.hi) box.v.lo = std::nextafter(box.v.lo, cell_.v.lo);
        const Enclosure e = patch_.enclose(box);
        for (int p = 0; p < size_of(3); ++p) u[p] -= Interval(e.u), v[p] -= Interval(e.v);
        const std::array<Sextic, 3> squares{product(u, u), product(u, v), product(v, v)};
        Norms best;
        for (int order = 3; order >= 0 && !(best.most <= bound_); --order) {
            const Norms n = norms_of(piece, e, u, v, box.u - Interval(e.u), box.v - Interval(e.v), squares, order);
            if (n.most < best.most) best.most = n.most;
            if (n.least > best.least) best.least = n.least, best.corner = n.corner;
        }
        return best;
    }

    Norms norms_of(const Piece& piece, const Enclosure& e, const Cubic& u, const Cubic& v, const Interval& du, const Interval& dv, const std::array<Sextic, 3>& squares, int order) const {
        std::array<Sextic, 3> f;
        for (int axis = 0; axis < 3; ++axis) {
            const auto& c = e.centre[axis].c;
            std::array<Interval, 3> x;  // of the mesh at the corners of the piece
            for (int k = 0; k < 3; ++k) x[k] = Interval(piece[k][0]) * points_[0][axis] + Interval(piece[k][1]) * points_[1][axis] + Interval(piece[k][2]) * points_[2][axis];
            Cubic linear;
            for (int p = 0; p < size_of(3); ++p) {
                const auto& n = kProducts.exponents[p];
                linear[p] = -(double(n[0]) * x[0] + double(n[1]) * x[1] + double(n[2]) * x[2]) / Interval(3);
                if (order > 0) linear[p] += c[0];
                if (order > 1) linear[p] += c[1] * u[p] + c[2] * v[p];
            }
            Interval rest(0);  // the terms of this order, with derivatives from anywhere in the box
            for (int j = 0; j <= order; ++j) {
                Interval term = e.over[axis].c[order * (order + 1) / 2 + j];
                for (int k = 0; k < order; ++k) term *= k < j ? dv : du;
                rest += term;
            }
            f[axis] = raised(linear);
            for (int i = 0; i < size_of(6); ++i) {
                f[axis][i] += rest;
                if (order == 3) f[axis][i] += c[3] * squares[0][i] + c[4] * squares[1][i] + c[5] * squares[2][i];
            }
        }
        Norms n;
        n.most = 0;
        for (int i = 0; i < size_of(6); ++i) {
            const double length = rounding::length_up(mag(f[0][i]), mag(f[1][i]), mag(f[2][i]));
            if (!(length <= n.most)) n.most = std::isnan(length) ? HUGE_VAL : length;
        }
        constexpr int corner[3] = {place(6, {6, 0, 0}), place(6, {0, 6, 0}), place(6, {0, 0, 6})};
        for (int k = 0; k < 3; ++k) {
            const double length = sqrt(square(f[0][corner[k]]) + square(f[1][corner[k]]) + square(f[2][corner[k]])).lo;
            if (length > n.least) n.least = length, n.corner = k;
        }
        return n;
    }

    const Patch& patch_;
    const Box cell_;
    const double bound_;
    const CertifiedNet net_;
    std::array<Point, 3> points_;
};

// ---- the whole ----------------------------------------------------------------------------------------------------------

std::string fault_of(const Composite& surface, const Certificate& all, std::size_t m) {
    const CertifiedPatch& p = all.patches[m];
    if (p.vertex.size() != p.uv.size()) return "has not one vertex for each corner";
    for (std::size_t i = 0; i < p.uv.size(); ++i)
        if (p.vertex[i] >= all.points.size() || !std::isfinite(p.uv[i].x) || !std::isfinite(p.uv[i].y)) return "corner " + std::to_string(i) + " names no vertex, or no parameters";
    for (std::size_t t = 0; t < p.triangles.size(); ++t)
        if (!(p.triangles[t].bound >= 0 && p.triangles[t].bound <= all.certified_error))
            return "triangle " + std::to_string(t) + " has the bound " + to_text(p.triangles[t].bound) + ", which is not within the certified error " + to_text(all.certified_error);
    return Cover(surface[m].patch, p).fault();
}

}  // namespace

std::size_t Certificate::triangle_count() const {
    std::size_t n = 0;
    for (const auto& p : patches) n += p.triangles.size();
    return n;
}

CertificateCheck check_certificate(const Composite& surface, const Certificate& all, std::size_t budget, const std::function<void(double)>& progress) {
    CertificateCheck result;
    if (!(all.certified_error <= all.tolerance)) result.faults.push_back("the certified error " + to_text(all.certified_error) + " is not within the tolerance " + to_text(all.tolerance));
    if (surface.size() != all.patches.size()) result.faults.push_back("found " + std::to_string(all.patches.size()) + " patches, expected the surface's " + std::to_string(surface.size()));
    for (const Point& p : all.points)
        if (!finite(p)) result.faults.push_back("found a vertex that is no point");
    for (std::size_t m = 0; result.faults.size() < 10 && m < std::min(surface.size(), all.patches.size()); ++m)
        if (const std::string f = fault_of(surface, all, m); !f.empty()) result.faults.push_back("patch " + all.patches[m].name + ": " + f);
    if (result.faults.empty())
        if (const std::string f = lost_fault(all); !f.empty()) result.faults.push_back(f);
    if (!result.faults.empty()) return result;

    const double count = double(all.triangle_count());
    constexpr std::size_t block = 512;
    for (std::size_t m = 0; m < all.patches.size(); ++m) {
        const CertifiedPatch& claim = all.patches[m];
        const Cover cover(surface[m].patch, claim);
        for (std::size_t first = 0; first < claim.triangles.size(); first += block) {
            const std::size_t last = std::min(first + block, claim.triangles.size());
            std::vector<CertificateCheck::Failure> failures(last - first);
            std::vector<std::size_t> pieces(last - first);
            std::vector<char> proved(last - first);
            tbb::parallel_for(tbb::blocked_range<std::size_t>(first, last, 16), [&](const tbb::blocked_range<std::size_t>& range) {
                for (std::size_t i = range.begin(); i < range.end(); ++i) {
                    bool good = false;
                    failures[i - first].patch = m, failures[i - first].triangle = i;
                    pieces[i - first] = TriangleProof(surface[m].patch, cover, all, claim, claim.triangles[i]).run(budget, good, failures[i - first]);
                    proved[i - first] = good;
                }
            });
            for (std::size_t i = 0; i < failures.size(); ++i) {
                result.pieces += pieces[i];
                if (!proved[i]) result.failures.push_back(failures[i]);
            }
            result.checked += failures.size();
            if (progress) progress(double(result.checked) / count);
            if (result.failures.size() >= CertificateCheck::most_failures) return result;
        }
    }
    return result;
}

}  // namespace isoparm
