// certificate.h -- a mesh with all that is needed to prove again, by little code, how far it is from its surface.
//
// docs/certificates.md, "Certificate files", has the theorem. Made by certificate.cpp from what tessellate() has proved; checked by
// certificate_check.cpp, which shares no code with the bounds that tessellate() is made by, only the enclosures of the surface.
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "composite.h"
#include "scalar/vec.h"

namespace isoparm {

struct CertifiedTriangle {
    std::array<std::uint32_t, 3> corner{};  // of the patch, counter-clockwise in the domain
    /// Of edge k from corner a = k to b = k + 1: the surface's points for it are at the parameters of the cubic Bezier curve a, (2a + b) / 3 + slide[k][0],
    /// (a + 2b) / 3 + slide[k][1], b.
    std::array<std::array<Vec2, 2>, 3> slide{};
    double bound = 0;                       // claimed: no point is farther than that from the surface's point for it
};

struct CertifiedPatch {
    std::string name;
    std::vector<Vec2> uv;               // parameters of each corner
    std::vector<std::uint32_t> vertex;  // and the vertex that it is
    std::vector<CertifiedTriangle> triangles;
};

/// Calls use(parameters of the surface's point, barycentric coordinates) at points of a triangle, its corners among them.
template <class Use> void each_sample(const CertifiedPatch& p, const CertifiedTriangle& t, Use use) {
    constexpr int n = 8;
    for (int i = 0; i <= n; ++i)
        for (int j = 0; i + j <= n; ++j) {
            const std::array<double, 3> l{double(n - i - j) / n, double(i) / n, double(j) / n};
            Vec2 q;
            const auto add = [&q](const Vec2& w, double s) { q = {q.x + s * w.x, q.y + s * w.y}; };
            for (int k = 0; k < 3; ++k) {
                const double a = l[k], b = l[(k + 1) % 3], c = l[(k + 2) % 3];  // the control point inside moves by a quarter of the six slides
                add(p.uv[t.corner[k]], a), add(t.slide[k][0], 3 * a * b * (a + 0.5 * c)), add(t.slide[k][1], 3 * a * b * (b + 0.5 * c));
            }
            use(q, l);
        }
}

struct Certificate {
    double tolerance = 0, certified_error = 0;
    std::vector<Point> points;  // vertices, as in the mesh file
    std::vector<CertifiedPatch> patches;

    std::size_t triangle_count() const;
};

struct Tessellation;
/// Of a mesh that was made with options.bounds; its positions as they will be written. `slide`: surface points may move along the surface
/// (geometric measure). Result does not depend on the number of threads.
Certificate make_certificate(const Composite& surface, const Tessellation& tessellation, bool slide);

/// The largest distance of a point of the mesh from the surface's point for it, at samples.
double sampled_distance(const Composite& surface, const Certificate& certificate);

/// Triangles with two corners in one place are no part of a mesh: each has to be an edge, or a vertex, of others that are. Empty when so.
std::string lost_fault(const Certificate& all);

struct CertificateCheck {
    struct Failure {
        std::size_t patch = 0, triangle = 0;  // from 0, in the order of the certificate
        bool exceeded = false;                // a point that is farther was found; else the bound could not be proved within the budget
        Vec2 uv;                              // a parameter of that point, or of the place where the proof got stuck
        double distance = 0;                  // at least, or at most, how far it is
    };
    std::vector<std::string> faults;  // why this is no certificate of a mesh of the surface, whatever the bounds are; then no bound is looked at
    std::vector<Failure> failures;    // triangles whose bound is not proved
    std::size_t checked = 0;          // triangles; not all once there are most_failures
    std::size_t pieces = 0;           // that they were cut into

    static constexpr std::size_t most_failures = 100;
    bool proved() const { return faults.empty() && failures.empty(); }
};

/// Proves that the mesh is within certified_error of the surface, both ways. `pieces`: the budget for a triangle. The result does not
/// depend on the number of threads.
CertificateCheck check_certificate(const Composite& surface, const Certificate& certificate, std::size_t pieces = 5000, const std::function<void(double)>& progress = {});

}  // namespace isoparm
