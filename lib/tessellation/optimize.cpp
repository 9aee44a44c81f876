#include "tessellation/optimize.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>

#include "tessellation/optimize_worker.h"

namespace isoparm {
namespace {

constexpr int kMostRounds = 8;
constexpr double kLeastGain = 0.004;  // of the triangles, in a round that another one follows
constexpr int kSweeps = 2;            // of moves and flips in a round

/// Moves and flips, then removals, the cheapest first.
void round_of(Worker& worker, const FreeComposite& all, std::vector<Site> sites, bool relax, const std::function<void(double)>& progress) {
    const auto live = [&](Site s) { return all.patches()[s.patch].corners()[s.corner].live(); };
    for (int sweep = 0; sweep < kSweeps; ++sweep) {
        for (const Site& s : sites) worker.improve(s);
        for (const Site& s : sites) worker.flip_around(s);
    }
    std::vector<std::pair<double, std::size_t>> order;
    for (std::size_t i = 0; i < sites.size(); ++i)
        if (const double cost = worker.cost_of_removal(sites[i]); cost < (relax ? double(kMostCost) : 1)) order.push_back({cost, i});
    std::sort(order.begin(), order.end());
    for (std::size_t k = 0; k < order.size(); ++k) {
        if (live(sites[order[k].second])) worker.remove(sites[order[k].second], relax);
        if (progress && k % 64 == 0) progress(double(k) / double(order.size()));
    }
}

std::vector<Site> sites_in(const FreePatch& patch, std::uint32_t member) {
    std::vector<Site> list;
    for (std::uint32_t i = 0; i < patch.corners().size(); ++i)
        if (patch.corners()[i].live() && patch.corners()[i].freedom != Freedom::fixed) list.push_back({member, i});
    return list;
}

/// Points on rims between two patches, one list a rim.
std::vector<std::vector<Site>> sites_between(FreeComposite& all, std::size_t rims) {
    std::vector<std::vector<Site>> list(rims);
    for (const RimPoint& p : all.rim_points()) {
        const Rim& rim = all.rim_of(p);
        if (!p.live || rim.uses.size() < 2 || rim.uses[0].member == rim.uses[1].member) continue;
        const Site site{rim.uses[0].member, p.corner[0]};
        if (all.patches()[site.patch].corners()[site.corner].freedom == Freedom::rim) list[p.rim].push_back(site);
    }
    return list;
}

}  // namespace

void optimize(Refinement& refinement, const Composite& surface, const Topology& topology, double tolerance, Measure measure,
              const std::function<void(double)>& progress) {
    FreeComposite all(refinement, surface, topology, tolerance, measure);
    double gain = 1;
    for (int round = 0; round < kMostRounds && gain > kLeastGain; ++round) {
        const std::size_t before = all.count();
        const bool relax = round > 0;
        const auto report = [&](double part) { progress((round + part) / kMostRounds); };
        // Patches share nothing but rims between two of them, which stay as they are meanwhile.
        if (surface.size() == 1) {
            Worker worker(all, {0});
            round_of(worker, all, sites_in(all.patches()[0], 0), relax, progress ? report : std::function<void(double)>());
        } else {
            tbb::parallel_for(std::uint32_t(0), std::uint32_t(surface.size()), [&](std::uint32_t m) {
                Worker worker(all, {m});
                round_of(worker, all, sites_in(all.patches()[m], m), relax, {});
            });
        }
        for (const auto& sites : sites_between(all, topology.rims.size())) {
            if (sites.empty()) continue;
            const auto& uses = all.rim_of(all.rim_points()[all.patches()[sites[0].patch].corners()[sites[0].corner].rim_point]).uses;
            Worker worker(all, {uses[0].member, uses[1].member});
            round_of(worker, all, sites, relax, {});
        }
        gain = relax ? 1 - double(all.count()) / double(before) : 1;
        if (progress) report(1);
    }
    all.write(refinement);
}

}  // namespace isoparm
