#include <opensubdiv/far/primvarRefiner.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "subdivision/limit_refiner.h"

namespace isoparm {
namespace {

namespace Far = OpenSubdiv::Far;

/// A point as PrimvarRefiner wants it.
struct Primvar {
    Point p{0, 0, 0};
    void Clear() { p = {0, 0, 0}; }
    void AddWithWeight(const Primvar& q, double weight) { p += weight * q.p; }
};

/// A face of some level: where its corners are in the patch it belongs to.
struct Place {
    int face = -1, corner = -1;
    std::vector<Vec2> uv;
};

Vec2 between(const Vec2& a, const Vec2& b) { return {0.5 * a.x + 0.5 * b.x, 0.5 * a.y + 0.5 * b.y}; }

/// Places of the next level's faces, by the vertices that they have from their parent.
std::vector<Place> refined(const std::vector<Place>& places, const Far::TopologyLevel& coarse, const Far::TopologyLevel& fine, bool loop) {
    std::vector<Place> next(fine.GetNumFaces());
    for (int f = 0; f < coarse.GetNumFaces(); ++f) {
        const auto vertices = coarse.GetFaceVertices(f), edges = coarse.GetFaceEdges(f);
        const int n = vertices.size();
        const Place& at = places[f];
        for (const int child : coarse.GetFaceChildFaces(f)) {
            if (child < 0) continue;
            Place& to = next[child];
            to.face = at.face, to.corner = at.corner;
            const auto own = fine.GetFaceVertices(child);
            to.uv.resize(own.size());
            if (n != (loop ? 3 : 4)) {  // the quad of a corner
                for (int k = 0; k < n; ++k)
                    if (own[0] == coarse.GetVertexChildVertex(vertices[k])) to.corner = k;
                to.uv = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
                continue;
            }
            for (int i = 0; i < own.size(); ++i)
                for (int k = 0; k < n; ++k) {
                    if (own[i] == coarse.GetVertexChildVertex(vertices[k])) to.uv[i] = at.uv[k];
                    else if (own[i] == coarse.GetEdgeChildVertex(edges[k])) to.uv[i] = between(at.uv[k], at.uv[(k + 1) % n]);
                    else if (!loop && own[i] == coarse.GetFaceChildVertex(f)) to.uv[i] = between(at.uv[0], at.uv[2]);
                }
        }
    }
    return next;
}

/// Ends of creases get the mask of smooth vertices, those of valence 2 that of corners.
bool mask_is_exact(const Far::TopologyLevel& level, int v) {
    if (level.IsVertexInfSharp(v)) return true;
    int sharp = 0;
    for (const int e : level.GetVertexEdges(v)) {
        if (level.IsEdgeSemiSharp(e)) return false;
        sharp += level.IsEdgeInfSharp(e) || level.IsEdgeBoundary(e);
    }
    return !level.IsVertexSemiSharp(v) && (sharp >= 2 || (sharp == 0 && level.GetVertexFaces(v).size() != 2));
}

/// Several at creases; on boundaries the masks are of the modified rules of Biermann, Levin and Zorin 2000, and those of Catmull and Clark with two faces only.
bool has_normal(const Far::TopologyLevel& level, int v, bool loop) {
    if (level.IsVertexInfSharp(v) || (!loop && level.IsVertexBoundary(v) && level.GetVertexFaces(v).size() != 2)) return false;
    for (const int e : level.GetVertexEdges(v))
        if (level.GetEdgeSharpness(e) > 0 && !level.IsEdgeBoundary(e)) return false;
    return true;
}

/// The limit's direction along each edge of a smooth vertex inside, in the order of the edges. OpenSubdiv's first tangent goes along edge 0; the
/// second along edge 1 (Catmull-Clark), or at right angles to the first in the eigenvectors' plane (Loop).
std::vector<Point> directions(const Far::TopologyLevel& level, int v, const Point& along, const Point& across, bool loop) {
    const int n = level.GetVertexEdges(v).size();
    if (n < 3 || level.IsVertexBoundary(v) || level.IsVertexNonManifold(v) || level.GetVertexSharpness(v) > 0) return {};
    for (const int e : level.GetVertexEdges(v))
        if (level.GetEdgeSharpness(e) > 0) return {};
    const double turn = 2 * std::numbers::pi / n;
    const Point side = loop ? across : (across - std::cos(turn) * along) / std::sin(turn);
    std::vector<Point> all;
    for (int i = 0; i < n; ++i) all.push_back(std::cos(i * turn) * along + std::sin(i * turn) * side);
    return all;
}
Point direction(const Far::TopologyLevel& level, int v, int edge, const std::vector<Point>& all) {
    const auto edges = level.GetVertexEdges(v);
    return all.empty() ? Point(NAN, NAN, NAN) : all[static_cast<std::size_t>(std::find(edges.begin(), edges.end(), edge) - edges.begin())];
}

}  // namespace

std::vector<LimitSample> limit_samples(const Cage& cage, Scheme scheme, int levels) {
    const OsdMessages messages;
    const Refiner refiner = make_refiner(cage, scheme, messages);
    Far::TopologyRefiner::UniformOptions options(levels);
    options.fullTopologyInLastLevel = true;
    refiner->RefineUniform(options);
    const Far::PrimvarRefinerReal<double> primvars(*refiner);

    std::vector<Primvar> points(cage.positions.size());
    for (std::size_t k = 0; k < points.size(); ++k) points[k].p = cage.positions[k];
    std::vector<Place> places(cage.faces.size());
    const bool loop = scheme == Scheme::loop;
    for (std::size_t f = 0; f < places.size(); ++f) {
        places[f].face = static_cast<int>(f);
        places[f].uv = loop ? std::vector<Vec2>{{0, 0}, {1, 0}, {0, 1}} : std::vector<Vec2>{{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    }
    for (int k = 0; k < levels; ++k) {
        const auto &coarse = refiner->GetLevel(k), &fine = refiner->GetLevel(k + 1);
        std::vector<Primvar> next(fine.GetNumVertices());
        primvars.Interpolate(k + 1, points, next);
        points = std::move(next);
        places = refined(places, coarse, fine, loop);
    }
    const auto& last = refiner->GetLevel(levels);
    std::vector<Primvar> limit(last.GetNumVertices()), along = limit, across = limit;
    primvars.Limit(points, limit, along, across);
    std::vector<LimitSample> samples;
    std::vector<std::vector<Point>> ways(last.GetNumVertices());
    for (int v = 0; v < last.GetNumVertices() && scheme != Scheme::bilinear; ++v) ways[v] = directions(last, v, along[v].p, across[v].p, loop);
    for (int f = 0; f < last.GetNumFaces(); ++f) {
        if (last.IsFaceHole(f)) continue;
        const auto vertices = last.GetFaceVertices(f), edges = last.GetFaceEdges(f);
        const int n = vertices.size();
        for (int k = 0; k < n; ++k) {
            const int v = vertices[k];
            LimitSample s{places[f].face, places[f].corner, places[f].uv[k].x, places[f].uv[k].y, limit[v].p, Point(NAN, NAN, NAN), {}, {}, false};
            if (has_normal(last, v, loop)) s.normal = normalized(cross(along[v].p, across[v].p));
            s.next = direction(last, v, edges[k], ways[v]), s.previous = direction(last, v, edges[(k + n - 1) % n], ways[v]);
            s.exact = scheme == Scheme::bilinear || mask_is_exact(last, v);
            samples.push_back(s);
        }
    }
    return samples;
}

}  // namespace isoparm
