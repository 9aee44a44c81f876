#include "subdivision/limit_levels.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "error.h"
#include "subdivision/limit_cell.h"
#include "subdivision/limit_vertices.h"

namespace isoparm {
namespace {

constexpr double kNoise = 1e4 * std::numeric_limits<double>::epsilon();  // of the cage's size: ratios of numbers below say nothing

using Measure = std::optional<double>;
void grow(Measure& largest, const Measure& x) {
    if (x && (!largest || *x > *largest || std::isnan(*x))) largest = x;
}
void grow(LevelMeasures& all, const LevelMeasures& x) {
    grow(all.deviation, x.deviation), grow(all.normal_deviation, x.normal_deviation), grow(all.normal_degrees, x.normal_degrees);
    grow(all.g1_degrees, x.g1_degrees), grow(all.c1, x.c1);
}

/// Calls f at the samples of a quad, or of a triangle.
template <class F> void sample(Domain domain, int n, const F& f) {
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n && (domain == Domain::quad || i + j < n); ++j) f(double(i) / (n - 1), double(j) / (n - 1));
}

LevelMeasures measure(const LimitCell& cell, const Patch& patch, int samples) {
    LevelMeasures m;
    const LimitFunction surface = limit_function(patch);
    const LimitFrame vertex = cell(0, 0);
    const Point normal = normalized(cross(vertex.du, vertex.dv));
    sample(cell.domain(), samples, [&](double s, double t) {
        const LimitFrame x = cell(s, t), y = surface(s, t);
        const Point off = y.p - x.p, n = cross(x.du, x.dv), k = cross(y.du, y.dv);
        grow(m.deviation, length(off));
        grow(m.normal_deviation, std::fabs(dot(off, normal)));
        if (length(n) > 0 && length(k) > 0) grow(m.normal_degrees, degrees_between(n, k));  // NaN: a corner without derivatives
    });
    return m;
}

/// Across the edge where sector a ends and sector b begins. Its ends are left out: where fewer than the regular number of faces meet, derivatives of the limit vanish, those of
/// surfaces on its curves come near to that, and their directions say nothing.
LevelMeasures measure_edge(const Patch& a, const Patch& b, int samples) {
    LevelMeasures m;
    const LimitFunction left = limit_function(a), right = limit_function(b);
    const double lean = a.domain() == Domain::quad ? 0 : 0.5;  // across a triangle: along its median
    const int steps = std::max(2, samples - 1);
    for (int i = 1; i < steps; ++i) {
        const double t = double(i) / steps;
        const LimitFrame x = left(0, t), y = right(t, 0);
        const Point n = cross(x.du, x.dv), k = cross(y.du, y.dv);
        if (!(length(n) > 0) || !(length(k) > 0)) continue;
        grow(m.g1_degrees, degrees_between(n, k));
        grow(m.c1, length((x.du - lean * x.dv) + (y.dv - lean * y.du)));
    }
    return m;
}

using Levels = std::vector<std::optional<LevelMeasures>>;
/// One vertex by one method. Cells as small as the noise are not measured.
Levels measure_vertex(const LimitFaces& limits, const ExtraordinaryVertex& vertex, const LimitMethod& method, const LevelOptions& options, double noise) {
    Levels levels(options.levels + 1);
    for (int k = 0; k <= options.levels; ++k) {
        std::vector<Patch> ring;
        LevelMeasures m;
        for (const LimitSector& s : vertex.sectors) {
            const auto cell = limits.cell(s, k);
            const auto patch = cell && length((*cell)(0, 0).du) > noise ? method.on(*cell) : std::nullopt;
            if (!patch) break;
            ring.push_back(*patch);
            grow(m, measure(*cell, ring.back(), options.samples));
        }
        if (ring.size() < vertex.sectors.size()) continue;
        for (std::size_t i = 0; i < ring.size(); ++i) grow(m, measure_edge(ring[i], ring[(i + 1) % ring.size()], options.samples));
        levels[k] = m;
    }
    return levels;
}

/// The worst at a level over the vertices that have it, and in comparison with the level before over those that have both.
LimitLevel at_level(const std::vector<const Levels*>& vertices, int k, int valence, const std::string& method, double noise) {
    LimitLevel row{k, valence, method, 0, {}, {}, {}, {}};
    LevelMeasures now, before;
    for (const Levels* v : vertices) {
        if (!(*v)[k]) continue;
        ++row.vertices;
        grow(row.measured, *(*v)[k]);
        if (k == 0 || !(*v)[k - 1]) continue;
        grow(now, *(*v)[k]), grow(before, *(*v)[k - 1]);
    }
    const auto ratio = [](const Measure& a, const Measure& b, double least) { return a && b && *a > least && *b > least ? Measure(*a / *b) : Measure(); };
    row.ratio_deviation = ratio(now.deviation, before.deviation, noise);
    row.ratio_normal = ratio(now.normal_deviation, before.normal_deviation, noise);
    if (row.ratio_normal) row.ratio_g1 = ratio(now.g1_degrees, before.g1_degrees, 1e-9);
    return row;
}

void measure_vertices(const LimitSurface& limit, const LimitFaces& limits, const LevelOptions& options, double noise, LimitLevels& result) {
    const Scheme scheme = limit.scheme();
    const auto vertices = extraordinary_vertices(limit.cage(), scheme);
    const auto& methods = scheme == Scheme::loop ? triangle_methods() : quad_methods();
    std::vector<std::vector<Levels>> all(vertices.size(), std::vector<Levels>(methods.size()));
    tbb::parallel_for(std::size_t(0), vertices.size(), [&](std::size_t v) {
        for (std::size_t m = 0; m < methods.size(); ++m) all[v][m] = measure_vertex(limits, vertices[v], methods[m], options, noise);
    });
    std::map<int, std::vector<std::size_t>> by_valence;
    for (std::size_t v = 0; v < vertices.size(); ++v) {
        const Levels& best = all[v].back();
        const auto first = std::find_if(best.begin(), best.end(), [](const auto& m) { return m.has_value(); });
        if (first == best.end()) continue;
        by_valence[vertices[v].valence].push_back(v);
        grow(result.worst, **first);
        for (const LimitSector& s : vertices[v].sectors) result.compared[s.face] = 1;
    }
    for (const auto& [n, list] : by_valence) {
        const Eigenvalues e = eigenvalues(scheme, n);
        result.valences.push_back({n, static_cast<int>(list.size()), e.lambda, e.mu});
        for (std::size_t m = 0; m < methods.size(); ++m) {
            std::vector<const Levels*> rows;
            for (const std::size_t v : list) rows.push_back(&all[v][m]);
            for (int k = 0; k <= options.levels; ++k)
                if (LimitLevel row = at_level(rows, k, n, methods[m].name, noise); row.vertices > 0) result.by_level.push_back(std::move(row));
        }
    }
}

/// Nielson's surface over a whole regular face against the limit, along the edges: positions and derivatives, which it interpolates.
Measure edge_gap(const LimitCell& face, int samples) {
    const auto patch = triangle_methods().back().on(face);
    if (!patch) return {};
    const LimitFunction surface = limit_function(*patch);
    double gap = 0;
    for (int i = 1; i < samples - 1; ++i) {
        const double t = double(i) / (samples - 1);
        for (const auto& [s, v] : {std::pair(t, 0.0), std::pair(0.0, t), std::pair(t, 1 - t)}) {
            const LimitFrame x = face(s, v), y = surface(s, v);
            for (const double d : {distance(x.p, y.p), distance(x.du, y.du), distance(x.dv, y.dv)})
                if (!(d <= gap)) gap = d;
        }
    }
    return gap;
}

/// Regular faces of Loop's scheme: sub-triangles about the centre, where all methods see the same surface, ever nearer to its Taylor polynomial.
void measure_loop(const LimitSurface& limit, int levels, int samples, double noise, LimitLevels& result) {
    const auto& methods = regular_triangle_methods();
    std::vector<std::vector<std::vector<Measure>>> all(limit.faces());  // of each face: by method and level
    std::vector<Measure> gaps(limit.faces());
    tbb::parallel_for(0, limit.faces(), [&](int f) {
        if (limit.kind(f) != LimitFace::regular) return;
        const LimitCell face(Domain::triangle, [&, f](double u, double v) { const LimitPoint x = limit(f, u, v); return LimitFrame{x.p, x.du, x.dv}; }, 0, 1);
        gaps[f] = edge_gap(face, samples);
        for (const LimitMethod& method : methods) {
            all[f].emplace_back();
            for (int k = 0; k <= levels; ++k) {
                const double h = std::ldexp(1.0, -k), low = (1 - h) / 3;
                const LimitCell cell = face.part({low, low}, {low + h, low}, {low, low + h});
                const auto patch = method.on(cell);
                Measure worst;
                if (patch) sample(Domain::triangle, samples, [&](double s, double t) { grow(worst, distance(patch->point(s, t), cell(s, t).p)); });
                all[f].back().push_back(worst);
            }
        }
    });
    for (const Measure& gap : gaps) grow(result.loop_edges, gap);
    for (std::size_t m = 0; m < methods.size(); ++m)
        for (int k = 0; k <= levels; ++k) {
            Measure now, before;
            for (const auto& face : all)
                if (!face.empty()) {
                    grow(now, face[m][k]);
                    if (k > 0) grow(before, face[m][k - 1]);
                }
            if (!now) continue;
            result.loop.push_back({methods[m].name, methods[m].order, k, *now, before && *now > noise ? Measure(*before / *now) : Measure()});
        }
}

int regular(const LimitSurface& limit) {
    int count = 0;
    for (int f = 0; f < limit.faces(); ++f) count += limit.kind(f) == LimitFace::regular;
    return count;
}

}  // namespace

LimitLevels measure_levels(const LimitSurface& limit, const LevelOptions& options) {
    if (options.levels < 0 || options.levels > 12) throw Error(ErrorKind::usage, "levels: found " + std::to_string(options.levels) + ", expected 0 to 12");
    if (options.samples < 2 || options.samples > 65)
        throw Error(ErrorKind::usage, "samples each way over a cell: found " + std::to_string(options.samples) + ", expected 2 to 65");
    LimitLevels result;
    result.compared.assign(limit.faces(), 0), result.subcells.compared = result.compared;
    const double size = reach(limit.cage());
    if (limit.scheme() == Scheme::loop) measure_loop(limit, std::min(options.levels, 6), options.samples, kNoise * size, result);
    if (limit.faces() == regular(limit) && limit.manifold()) return result;
    try {
        result.faces = std::make_shared<const LimitFaces>(limit.cage(), limit.scheme());
        result.masks_gap = result.faces->masks_gap;
        result.subcells = measure_subcells(limit, result.faces->patches);
        measure_vertices(limit, *result.faces, options, kNoise * size, result);
    } catch (const Error& e) {
        result.refused = e.what();
    }
    return result;
}

}  // namespace isoparm
