#include "limit.h"

#include <opensubdiv/bfr/refinerSurfaceFactory.h>
#include <opensubdiv/bfr/surface.h>
#include <opensubdiv/far/topologyRefiner.h>

#include <algorithm>

#include "check_size.h"
#include "subdivision/limit_refiner.h"

namespace isoparm {
namespace {

namespace Bfr = OpenSubdiv::Bfr;
namespace Far = OpenSubdiv::Far;
using Surface = Bfr::Surface<double>;

/// Which faces are single patches, from the faces and creases around their vertices. Asked before OpenSubdiv is: version
/// 3.5 can write out of bounds when it builds the patches at an interior vertex of valence 2 (its pull requests 1301, 1353).
class Topology {
public:
    Topology(const Far::TopologyLevel& level, Scheme scheme) : level_(level), scheme_(scheme) {}

    /// Empty for a single patch.
    std::string reason(int face) const {
        const auto vertices = level_.GetFaceVertices(face);
        if (vertices.size() != face_size()) return "face of " + std::to_string(vertices.size()) + " vertices";
        if (scheme_ == Scheme::bilinear) return "";
        for (const int v : vertices)
            if (const std::string why = reason_at(face, v); !why.empty()) return why;
        return "";
    }

private:
    int face_size() const { return scheme_ == Scheme::loop ? 3 : 4; }
    int regular_valence() const { return scheme_ == Scheme::loop ? 6 : 4; }
    bool wall(int e) const { return level_.IsEdgeInfSharp(e) || level_.IsEdgeBoundary(e) || level_.IsEdgeNonManifold(e); }

    std::string reason_at(int face, int v) const {
        const auto edges = level_.GetVertexEdges(v);
        const auto count = [&](auto test) { return std::count_if(edges.begin(), edges.end(), test); };
        const auto walls = count([&](int e) { return wall(e); });
        const bool corner = level_.IsVertexInfSharp(v) || walls > 2;  // then nothing beyond the walls matters
        const bool manifold = !level_.IsVertexNonManifold(v), inside = manifold && !level_.IsVertexBoundary(v);
        if (inside && edges.size() == 2) return "extraordinary vertex of valence 2";
        if (level_.IsVertexSemiSharp(v)) return "semi-sharp corner";
        const Sector s = sector(face, v);
        if (s.semi_sharp || (!corner && count([&](int e) { return level_.IsEdgeSemiSharp(e); }))) return "semi-sharp crease";
        if (!s.same_sizes) return "beside a face of another size";
        if (corner ? walls >= 2 && s.faces == 1
            : walls == 0 ? inside && s.faces == regular_valence()
                         : walls == 2 && 2 * s.faces == regular_valence()) return "";

        if (!manifold) return "non-manifold vertex";
        if (corner && !level_.IsVertexCorner(v)) return "sharp vertex inside a sector of several faces";
        if (walls == 1) return "end of a crease";
        if (!inside && s.faces == 1) return "boundary corner that is rounded";
        return (inside ? walls ? "creased vertex of valence " : "extraordinary vertex of valence " : "boundary vertex of valence ") +
               std::to_string(edges.size());
    }

    /// The faces around v that can be reached from this one without crossing a wall.
    struct Sector {
        int faces = 1;
        bool same_sizes = true, semi_sharp = false;
    };
    Sector sector(int face, int v) const {
        const auto [left, right] = edges_at(face, v);
        Sector s;
        for (const int start : {left, right})
            for (int f = face, e = start; !wall(e);) {
                const auto sides = level_.GetEdgeFaces(e);
                f = sides[0] == f ? sides[1] : sides[0];
                s.semi_sharp |= level_.IsEdgeSemiSharp(e);
                if (f == face) return s;  // all around
                ++s.faces;
                s.same_sizes &= level_.GetFaceVertices(f).size() == face_size();
                const auto [a, b] = edges_at(f, v);
                e = a == e ? b : a;
            }
        return s;
    }
    std::pair<int, int> edges_at(int face, int v) const {
        const auto vertices = level_.GetFaceVertices(face);
        const auto edges = level_.GetFaceEdges(face);
        const int n = vertices.size();
        const int k = static_cast<int>(std::find(vertices.begin(), vertices.end(), v) - vertices.begin());
        return {edges[(k + n - 1) % n], edges[k]};
    }

    const Far::TopologyLevel& level_;
    Scheme scheme_;
};

}  // namespace

struct LimitSurface::Impl {
    struct Face {
        LimitFace kind = LimitFace::none;
        Surface surface;             // of regular faces
        std::vector<double> points;  // its control points, xyz
    };
    Cage cage;
    Scheme scheme;
    Refiner refiner;
    std::vector<Face> faces;

    Impl(const Cage& c, Scheme s) : cage(c), scheme(s) {
        const OsdMessages messages;
        refiner = make_refiner(cage, scheme, messages);
        check_size(diagonal(cage), "a cage", "compare");
        make_surfaces();  // what is said about the patches of irregular faces is of no concern: they are only counted
    }

    void make_surfaces() {
        Bfr::SurfaceFactory::Options options;
        options.SetApproxLevelSmooth(2).SetApproxLevelSharp(2);  // of irregular faces, which are only counted
        const Bfr::RefinerSurfaceFactory<> factory(*refiner, options);
        std::vector<double> xyz;
        for (const Point& p : cage.positions) xyz.insert(xyz.end(), {p.x, p.y, p.z});
        faces.resize(cage.faces.size());
        for (int k = 0; k < static_cast<int>(faces.size()); ++k) {
            Face& f = faces[k];
            if (!factory.FaceHasLimitSurface(k)) continue;
            f.kind = LimitFace::irregular;
            Surface surface;
            if (!topology().reason(k).empty() || !factory.InitVertexSurface(k, &surface) || !single_patch(surface)) continue;
            f.kind = LimitFace::regular;
            f.points.resize(3 * surface.GetNumPatchPoints());
            surface.PreparePatchPoints(xyz.data(), 3, f.points.data(), 3);
            f.surface = surface;
        }
    }

    const Far::TopologyLevel& level() const { return refiner->GetLevel(0); }
    Topology topology() const { return {level(), scheme}; }

    // IsRegular() says no wherever an edge is sharp. There OpenSubdiv keeps a tree of patches, and a tree that needs no
    // points beyond the control points is a single patch on these, just as exact.
    static bool single_patch(const Surface& s) { return s.IsRegular() || s.GetNumPatchPoints() == s.GetNumControlPoints(); }

    /// Where edge e stands in face f.
    int local(int face, int e) const {
        const auto edges = level().GetFaceEdges(face);
        return static_cast<int>(std::find(edges.begin(), edges.end(), e) - edges.begin());
    }
    int vertex(LimitEdge::Side side) const { return cage.faces[side.face][side.edge]; }
};

LimitSurface::LimitSurface(const Cage& cage, Scheme scheme) : impl_(std::make_shared<const Impl>(cage, scheme)) {}
const Cage& LimitSurface::cage() const { return impl_->cage; }
Scheme LimitSurface::scheme() const { return impl_->scheme; }
int LimitSurface::faces() const { return static_cast<int>(impl_->faces.size()); }
LimitFace LimitSurface::kind(int face) const { return impl_->faces.at(face).kind; }

std::string LimitSurface::reason(int face) const {
    if (kind(face) == LimitFace::regular) return "";
    const auto& holes = impl_->cage.holes;  // OpenSubdiv also calls a boundary face without surface a hole
    if (std::find(holes.begin(), holes.end(), face) != holes.end()) return "hole";
    if (kind(face) == LimitFace::none) return "boundary without interpolation";
    const std::string reason = impl_->topology().reason(face);
    return reason.empty() ? "OpenSubdiv uses several patches" : reason;
}

bool LimitSurface::manifold() const {
    const auto& level = impl_->level();
    for (int v = 0; v < level.GetNumVertices(); ++v)
        if (level.IsVertexNonManifold(v)) return false;
    for (int e = 0; e < level.GetNumEdges(); ++e)
        if (level.IsEdgeNonManifold(e)) return false;
    return true;
}

std::vector<LimitEdge> LimitSurface::shared_edges() const {
    const auto& level = impl_->level();
    std::vector<LimitEdge> shared;
    for (int f = 0; f < faces(); ++f)
        for (const int e : level.GetFaceEdges(f)) {
            const auto around = level.GetEdgeFaces(e);
            if (around.size() != 2 || around[0] == around[1] || std::min(around[0], around[1]) != f) continue;
            const int g = std::max(around[0], around[1]);
            const LimitEdge::Side a{f, impl_->local(f, e)}, b{g, impl_->local(g, e)};
            const bool sharp = impl_->scheme == Scheme::bilinear || level.GetEdgeSharpness(e) > 0 || level.IsEdgeNonManifold(e);
            shared.push_back({a, b, impl_->vertex(a) == impl_->vertex(b), !sharp});
        }
    return shared;
}

LimitPoint LimitSurface::operator()(int face, double u, double v) const {
    const auto& f = impl_->faces.at(face);
    const double uv[2] = {u, v};
    double d[6][3];
    f.surface.Evaluate(uv, f.points.data(), 3, d[0], d[1], d[2], d[3], d[4], d[5]);
    const auto point = [&](int k) { return Point(d[k][0], d[k][1], d[k][2]); };
    return {point(0), point(1), point(2), point(3), point(4), point(5)};
}

}  // namespace isoparm
