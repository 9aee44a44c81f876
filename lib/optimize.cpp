#include "optimize.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <chrono>

#include "optimize_worker.h"

namespace isoparm {
namespace {

double env(const char* n, double d) { return getenv(n) ? atof(getenv(n)) : d; }

std::vector<Site> sites_of(const FreePatch& patch, std::uint32_t m) {
    std::vector<Site> list;
    for (std::uint32_t i = 0; i < patch.corners().size(); ++i)
        if (patch.corners()[i].triangle != kNone && patch.corners()[i].freedom != Freedom::fixed) list.push_back({m, i});
    return list;
}

/// One round on the sites of a patch, or of a rim.
std::size_t round_of(Worker& worker, const std::vector<Site>& sites, const FreeComposite& all, double most_cost, int sweeps) {
    for (int s = 0; s < sweeps; ++s) {
        for (const Site& x : sites)
            if (all.patches()[x.patch].corners()[x.corner].triangle != kNone) worker.improve(x);
        for (const Site& x : sites)
            if (all.patches()[x.patch].corners()[x.corner].triangle != kNone) worker.flip_around(x);
    }
    std::vector<std::pair<double, std::size_t>> order;
    for (std::size_t i = 0; i < sites.size(); ++i) {
        if (all.patches()[sites[i].patch].corners()[sites[i].corner].triangle == kNone) continue;
        const double cost = worker.cost_of_removal(sites[i]);
        if (cost < most_cost) order.push_back({cost, i});
    }
    std::sort(order.begin(), order.end());
    std::size_t removed = 0;
    const bool dump = getenv("OPT_DUMP") && sites.size() && sites[0].patch == std::uint32_t(atoi(getenv("OPT_DUMP")));
    if (dump) {
        int hist[30] = {};
        for (const Site& x : sites) if (all.patches()[x.patch].corners()[x.corner].triangle != kNone) hist[int(std::min(2.9, worker.cost_of_removal(x)) * 10)]++;
        for (int k = 0; k < 30; ++k) fprintf(stderr, " %d:%d", k, hist[k]);
        fprintf(stderr, "\n");
    }
    for (const auto& [cost, i] : order) {
        const bool good = worker.remove(sites[i], most_cost > 1);
        removed += good;
        if (dump && !good) {const auto&c=all.patches()[sites[i].patch].corners()[sites[i].corner]; fprintf(stderr, "fail cost %.3f at %g %g worst %g kind %d\n", cost, c.uv.x, c.uv.y, worker.last_worst, worker.last_kind);}
    }
    return removed;
}

}  // namespace

void optimize(Refinement& refinement, const Composite& surface, const Topology& topology, double tolerance, Measure measure,
              const std::function<void(double)>& progress) {
    FreeComposite all(refinement, surface, topology, tolerance, measure);
    const auto t0 = std::chrono::steady_clock::now();
    const auto say = [&](const char* what, int r) {
        if (getenv("OPT_SAY")) fprintf(stderr, "%s %d: %zu  %.2f s\n", what, r, all.count(), std::chrono::duration<double>(std::chrono::steady_clock::now() - t0).count());
    };
    say("start", 0);
    const int rounds = int(env("OPT_ROUNDS", 6)), sweeps = int(env("OPT_SWEEPS", 3));
    for (int r = 0; r < rounds; ++r) {
        const double most = r == 0 ? 1 : env("OPT_COST", 1.8);
        tbb::parallel_for(std::size_t(0), surface.size(), [&](std::size_t m) {
            Worker worker(all, {std::uint32_t(m)});
            round_of(worker, sites_of(all.patches()[m], std::uint32_t(m)), all, most, sweeps);
        });
        say("inside", r);
        for (std::uint32_t rim = 0; rim < topology.rims.size(); ++rim) {
            const auto& uses = topology.rims[rim].uses;
            if (uses.size() < 2 || topology.rims[rim].collapsed) continue;
            std::vector<std::uint32_t> members{uses[0].member};
            if (uses[1].member != uses[0].member) members.push_back(uses[1].member);
            Worker worker(all, members);
            std::vector<Site> sites;
            for (const auto& p : all.rim_points())
                if (p.rim == rim && p.live && p.before != kNone && p.after != kNone && all.patches()[uses[0].member].corners()[p.corner[0]].freedom == Freedom::rim)
                    sites.push_back({uses[0].member, p.corner[0]});
            round_of(worker, sites, all, most, 1);
        }
        say("rims", r);
        if (progress) progress(double(r + 1) / rounds);
    }
    if (getenv("OPT_SAY")) {
        long n = 0, nq = 0, rim = 0, hist[12] = {}, histn[12] = {}, hq[12] = {}; double se = 0, sn = 0, snr = 0, ser = 0;
        for (auto& p : all.patches())
            for (auto& t : p.triangles()) {
                if (!t.live || t.left_out) continue;
                ++n; if (!t.own.quiet) { ++nq; hq[std::min(11, int(t.error * 10))]++; continue; }
                const bool r = t.beside[0] == kNone || t.beside[1] == kNone || t.beside[2] == kNone;
                if (r) { ++rim; snr += t.own.normal; ser += t.error; continue; }
                se += t.error; sn += t.own.normal; hist[std::min(11, int(t.error * 10))]++; histn[std::min(11, int(t.own.normal * 10))]++;
            }
        fprintf(stderr, "n %ld nonquiet %ld rim %ld: rim mean error %.3f normal %.3f; inner mean error %.3f normal %.3f\n", n, nq, rim, ser / rim, snr / rim, se / (n - rim - nq), sn / (n - nq - rim));
        if (getenv("OPT_DUMP")) {
            const auto& p = all.patches()[std::size_t(atoi(getenv("OPT_DUMP")))];
            FILE* f = fopen("/tmp/w/proto/dump.txt", "w");
            for (auto& t : p.triangles()) if (t.live) {
                fprintf(f, "%d %d %g %g %g %g %g", t.left_out, t.own.quiet, t.error, t.own.normal, t.own.across[0], t.own.across[1], t.own.across[2]);
                for (auto c : t.corner) fprintf(f, " %.6f %.6f %d", p.corners()[c].uv.x, p.corners()[c].uv.y, int(p.corners()[c].freedom));
                fprintf(f, "\n");
            }
            fclose(f);
        }
        struct C { long n = 0; double e = 0, h = 0, low = 0; } cat[4];
        std::size_t m = 0;
        for (auto& p : all.patches()) {
            C per; long q = 0;
            for (auto& t : p.triangles()) {
                if (!t.live || t.left_out) continue;
                int touch = 0;
                for (auto c : t.corner) touch += p.corners()[c].freedom == Freedom::rim || p.corners()[c].freedom == Freedom::fixed;
                for (C* c : {&cat[touch], &per}) c->n++, c->e += t.error, c->h += t.own.least(), c->low += t.error < 0.5;
                q += !t.own.quiet;
            }
            fprintf(stderr, "patch %zu: %ld e %.3f h %.3f low %.0f nonquiet %ld\n", m++, per.n, per.e / per.n, per.h / per.n, per.low, q);
        }
        for (int k = 0; k < 4; ++k) fprintf(stderr, "%d rim corners: n %ld e %.3f h %.3f low %.0f\n", k, cat[k].n, cat[k].e / cat[k].n, cat[k].h / cat[k].n, cat[k].low);
        for (int k = 0; k < 0; ++k) fprintf(stderr, "%d: error %ld normal %ld nonquiet %ld\n", k, hist[k], histn[k], hq[k]);
    }
    all.write(refinement);
}

}  // namespace isoparm
