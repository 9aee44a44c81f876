#include "tessellate.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>
#include <sstream>
#include <stdexcept>

#include "check_size.h"
#include "error.h"
#include "tessellation/optimize.h"
#include "tessellation/refine.h"
#include "topology.h"

namespace isoparm {
namespace {

double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

constexpr double kBytes = 240;  // that a triangle takes at most while it is refined

std::string too_many(double needed, const TessellationOptions& options) {
    std::ostringstream text;
    text.precision(6);
    text << "about " << std::ceil(needed) << " triangles would be needed (" << needed * kBytes / 1e9 << " GB), the budget is " << options.max_triangles;
    return text.str();
}

[[noreturn]] void give_up(const Refinement& refinement, const TessellationOptions& options, double needed) {
    std::ostringstream text;
    text.precision(6);
    if (refinement.worst_bound() == 0 && options.normal_deviation == 0 && refinement.triangle_count() > options.max_triangles) {
        text << "the tolerance " << options.tolerance << " takes " << (needed > double(refinement.triangle_count()) ? "at least " : "") << refinement.triangle_count() << " triangles (" << double(refinement.triangle_count()) * kBytes / 1e9
             << " GB), the budget is " << options.max_triangles << ". Ask for a larger tolerance or raise the budget (--max-triangles).";
        throw Error(ErrorKind::budget, text.str());
    }
    text << (options.normal_deviation > 0 ? "tolerance and normals were" : "the tolerance " + to_text(options.tolerance) + " was") << " not reached: ";
    if (needed > double(options.max_triangles))
        text << too_many(needed, options);
    else
        text << "no progress with " << refinement.triangle_count() << " triangles";
    if (options.normal_deviation > 0 && refinement.worst_bound() == 0)
        text << "; with " << refinement.triangle_count() << " triangles only the normals turn by more than " << options.normal_deviation
             << " degrees. Ask for a larger angle (--normals) or raise the budget (--max-triangles).";
    else
        text << "; with " << refinement.triangle_count() << " triangles the certified error is " << refinement.worst_bound()
             << ". Ask for a larger tolerance or raise the budget (--max-triangles).";
    throw Error(ErrorKind::budget, text.str());
}

/// Times the budget. Where grids would have had more triangles than that, refinement goes on from single cells, and ends with 0.97 times as many at least, in a hundred
/// meshes of scenes. Should the plan be wrong, the other estimate, the optimum, tells: no mesh whose vertices lie on the surface has much less.
constexpr double kPlannedTooMany = 1.12, kOptimumTooMany = 0.5;

void refuse_hopeless(const Composite& surface, const Refinement& refinement, const TessellationOptions& options) {
    const double planned = refinement.planned_triangles(), most = double(options.max_triangles);
    if (!(planned > kPlannedTooMany * most) || refinement.worst_slack() > options.tolerance) return;
    double optimum = 0;
    for (const Member& m : surface) optimum += optimal_triangles(m.patch, options.tolerance);
    if (optimum > kOptimumTooMany * most)
        throw Error(ErrorKind::budget, "the tolerance " + to_text(options.tolerance) + " was not reached: " + too_many(std::max(planned, optimum), options) +
                                           ". Ask for a larger tolerance or raise the budget (--max-triangles).");
}

/// Strips were no good where a mesh has that many times the triangles that it began with: it is begun anew without.
constexpr std::size_t kGrown = 8;

void refine(Refinement& refinement, const TessellationOptions& options) {
    double start_bound = 0, last_needed = 0;
    constexpr int max_rounds = 400;  // every round halves the worst edges; 2 x 52 bits of parameters and room
    std::size_t at_first = 0;
    int coincident_rounds = 0, lost_rounds = 0, stale_rounds = 0;
    std::size_t fewest_unbounded = SIZE_MAX;
    for (int round = 0; round < max_rounds; ++round) {
        const bool done = refinement.bound_and_mark() && !refinement.mark_with_neighbours();
        if (round == 0) at_first = refinement.triangle_count();
        if (round > 4 && refinement.has_fans() && refinement.more_triangles_than(kGrown * at_first)) refinement.break_fans();
        if (refinement.fans_broken()) return;
        const double needed = refinement.predicted_triangles();
        if (refinement.worst_slack() > options.tolerance)
            throw Error(ErrorKind::budget, "the tolerance " + to_text(options.tolerance) + " cannot be reached: rounding, or a gap between patches that were joined, puts a vertex " +
                                               to_text(refinement.worst_slack()) + " from its surface; ask for a larger tolerance, or move the data nearer to the origin");
        // Triangles without any bound must become fewer as they shrink; where they do not, refining on is in vain.
        const std::size_t unbounded = refinement.unbounded_count();
        stale_rounds = unbounded > 0 && unbounded >= fewest_unbounded ? stale_rounds + 1 : 0;
        fewest_unbounded = std::min(fewest_unbounded, unbounded);
        if (stale_rounds > 40 || unbounded > 200'000)
            throw Error(ErrorKind::budget, "the tolerance " + to_text(options.tolerance) + " was not reached: over " + std::to_string(unbounded) + " of " +
                                               std::to_string(refinement.triangle_count()) +
                                               " triangles nothing could be proved; the surface is not bounded there, or its numbers leave the range that doubles can square");
        // The prediction is good to a small factor once there are some triangles everywhere; while it falls, a few triangles had bounds that said nothing.
        const bool hopeless = round > 8 && needed > 3.0 * double(options.max_triangles) && needed > 0.7 * last_needed;
        last_needed = needed;
        if (hopeless || refinement.more_triangles_than(options.max_triangles)) give_up(refinement, options, needed);
        const bool lost = done && refinement.mark_lost_edges();
        if (lost && lost_rounds++ > 16)
            throw Error(ErrorKind::budget, "the tolerance " + to_text(options.tolerance) +
                                               " was not reached: a part of the surface is so thin that no triangle is left of it; ask for a smaller tolerance, or remove that part");
        if (done && !lost && (coincident_rounds++ > 16 || !refinement.mark_coincident_edges())) return;
        if (options.progress && !done) {
            const double worst = refinement.worst_bound();
            if (round == 0 || !std::isfinite(start_bound)) start_bound = worst;
            const double all = std::log(start_bound / options.tolerance), left = std::log(worst / options.tolerance);
            if (std::isfinite(all) && all > 0 && std::isfinite(left)) options.progress(std::clamp(1 - left / all, 0.0, 1.0));
        }
        refinement.split_marked();
    }
    give_up(refinement, options, 0);
}

/// Of the triangles, then of those left out, each in their order.
void keep_bounds(const Refinement& refinement, const PatchMesh& p, std::vector<double>& bounds) {
    for (const bool left_out : {false, true})
        for (std::uint32_t i = 0; i < p.triangles.size(); ++i)
            if (p.left_out(p.triangles[i]) == left_out) bounds.push_back(refinement.bound_of(p, i));
}

/// The triangles of a patch, and which vertices they name.
MeshPart to_part(const Member& member, std::size_t m, bool flipped, const Refinement& refinement, bool bounds, std::vector<std::uint32_t>& number) {
    const PatchMesh& p = refinement.patches()[m];
    MeshPart part;
    part.name = member.name;
    part.member = m;
    part.flipped = flipped;
    part.certified_error = refinement.worst_bound_of(m);
    if (bounds) keep_bounds(refinement, p, part.bounds);
    part.triangles.reserve(p.triangles.size());
    for (const auto& t : p.triangles) {
        if (p.left_out(t)) {  // a collapsed edge: its two long sides are one mesh edge
            part.left_out.push_back(t.corner);
            continue;
        }
        if (part.flipped) part.triangles.push_back({t.corner[0], t.corner[2], t.corner[1]});
        else part.triangles.push_back(t.corner);
        for (const auto v : p.vertices(t)) std::atomic_ref(number[v]).store(0, std::memory_order_relaxed);  // patches share vertices
    }
    return part;
}

/// Those that are 0 become numbers from 0 on. Their positions; the refinement loses its own unless they are to be kept.
std::vector<Point> number_vertices(std::vector<std::uint32_t>& number, Refinement& refinement, bool keep) {
    const std::vector<Point>& all = refinement.positions();
    constexpr std::size_t chunk = 1 << 14;
    std::vector<std::uint32_t> first((all.size() + chunk - 1) / chunk + 1, 0);
    const auto each = [&](std::size_t k, auto f) {
        for (std::size_t i = k * chunk; i < std::min(all.size(), (k + 1) * chunk); ++i)
            if (number[i] == 0) f(i);
    };
    tbb::parallel_for(std::size_t(0), first.size() - 1, [&](std::size_t k) { each(k, [&](std::size_t) { ++first[k + 1]; }); });
    std::partial_sum(first.begin(), first.end(), first.begin());
    if (!keep && first.back() == all.size()) {
        std::iota(number.begin(), number.end(), 0u);
        return refinement.move_positions();
    }
    std::vector<Point> kept(first.back());
    tbb::parallel_for(std::size_t(0), first.size() - 1, [&](std::size_t k) {
        each(k, [&, next = first[k]](std::size_t i) mutable {
            kept[next] = all[i];
            number[i] = next++;
        });
    });
    return kept;
}

/// Keeps the vertices that a triangle names; number[v] becomes the mesh's number of vertex v, or kNone. The refinement loses its patches unless they are to be kept.
Mesh to_mesh(const Composite& surface, const Topology& topology, Refinement& refinement, const TessellationOptions& options, bool keep, std::vector<std::uint32_t>& number) {
    Mesh mesh;
    number.assign(refinement.positions().size(), kNone);
    mesh.parts.resize(surface.size());
    tbb::parallel_for(std::size_t(0), surface.size(), [&](std::size_t m) {
        mesh.parts[m] = to_part(surface[m], m, topology.flipped[m], refinement, options.bounds, number);
        if (!keep) refinement.drop_triangles(m);
    });
    mesh.positions = number_vertices(number, refinement, keep);
    tbb::parallel_for(std::size_t(0), surface.size(), [&](std::size_t m) {
        MeshPart& part = mesh.parts[m];
        if (keep) part.uv = refinement.patches()[m].uv, part.vertex = refinement.patches()[m].vertex;
        else refinement.move_corners(m, part.uv, part.vertex);
        for (auto& v : part.vertex) v = number[v] == kNone ? 0 : number[v];
    });
    return mesh;
}

/// Upper bounds of angles, in degrees, and the tangent of such a limit, rounded down.
double degrees_up(double tangent) { return std::atan(tangent) * (180 / M_PI) * (1 + 1e-14); }
double tangent_down(double degrees) { return std::tan(degrees * (M_PI / 180)) * (1 - 1e-14); }

void report_normals(const Refinement& refinement, double limit, Tessellation& result) {
    double most = 0;
    for (const PatchMesh& p : refinement.patches())
        for (const PatchTriangle& t : p.triangles) {
            if (p.left_out(t)) continue;
            if (!refinement.turns_little(p, t)) throw std::logic_error("a triangle turns by " + to_text(degrees_up(t.proof.turn)) + " degrees: please report this scene");
            if (std::isfinite(t.proof.turn) && t.proof.turn <= limit) most = std::max<double>(most, t.proof.turn);
            else ++result.normals_unproved;
        }
    result.normal_deviation = degrees_up(most);
}

}  // namespace

double join_tolerance(double tolerance, double diagonal) { return std::min(1e-6 * diagonal, tolerance / 16); }

Tessellation tessellate(const Composite& surface, const TessellationOptions& options) {
    if (!(options.tolerance > 0) || !std::isfinite(options.tolerance)) throw_input("found tolerance " + to_text(options.tolerance) + ", expected a positive number");
    if (!(options.normal_deviation >= 0 && options.normal_deviation < 90))
        throw_input("found a normal deviation of " + to_text(options.normal_deviation) + " degrees, expected one from 0 (any) to below 90");
    if (options.normal_deviation > 0 && options.measure != Measure::geometric) throw_input("a limit of the normal deviation needs the geometric measure");
    if (options.normal_deviation > 0 && options.quality != Quality::fast) throw_input("a limit of the normal deviation needs the fast quality");
    auto start = std::chrono::steady_clock::now();
    const double diagonal = surface.empty() ? 0 : bounding_box(surface).diagonal();
    if (!surface.empty()) check_size(diagonal, "a surface", "tessellate");
    const Topology topology = find_topology(surface, join_tolerance(options.tolerance, diagonal));
    const bool turns = options.measure == Measure::geometric && (options.study || options.normal_deviation > 0);
    const double turn = options.normal_deviation > 0 ? tangent_down(options.normal_deviation) : turns ? TriangleBound::none : TriangleBound::unasked;
    const auto fast = [&] {
        const auto with = [&](bool fans) {
            auto refined = std::make_unique<Refinement>(surface, topology, options.tolerance, options.measure, double(options.max_triangles), turn, fans);
            refuse_hopeless(surface, *refined, options);
            refine(*refined, options);
            return refined;
        };
        auto refined = with(options.fans && !options.bounds && !(options.normal_deviation > 0));
        if (refined->fans_broken()) refined = with(false);
        return refined;
    };
    auto refined = fast();
    if (options.quality == Quality::optimal) {
        const std::size_t triangles = refined->triangle_count();
        optimize(*refined, surface, topology, options.tolerance, options.measure, options.progress);
        refine(*refined, options);  // proves the whole again, and splits what should fail
        if (refined->fans_broken() || refined->triangle_count() > triangles) refined = fast();
    }
    const Refinement& refinement = *refined;

    Tessellation result;
    result.tolerance = options.tolerance;
    std::vector<std::uint32_t> number;
    result.mesh = to_mesh(surface, topology, *refined, options, options.study || turns, number);
    std::vector<std::array<std::uint32_t, 2>> open = refinement.open_edges();
    for (auto& e : open) e = {number[e[0]], number[e[1]]};
    result.topology = analyse(result.mesh, open);
    if (result.topology.t_junctions > 0 || result.topology.degenerate_triangles > 0)
        throw std::logic_error("the mesh has " + std::to_string(result.topology.t_junctions) + " T-junctions: please report this scene");
    result.seconds_tessellate = seconds_since(start);
    start = std::chrono::steady_clock::now();
    std::vector<double> optimal(surface.size(), 0.0);
    if (options.study) tbb::parallel_for(std::size_t(0), optimal.size(), [&](std::size_t m) { optimal[m] = optimal_triangles(surface[m].patch, options.tolerance); });
    for (std::size_t m = 0; m < surface.size(); ++m) {
        const auto& part = result.mesh.parts[m];
        result.certified_error = std::max(result.certified_error, part.certified_error);
        result.surfaces.push_back({part.name, part.triangles.size(), part.certified_error, optimal[m]});
    }
    if (turns) report_normals(refinement, turn, result);
    if (options.study) result.sampled_error = refinement.sampled_error();
    result.seconds_sample = seconds_since(start);
    return result;
}

}  // namespace isoparm
