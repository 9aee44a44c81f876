// peer.cpp -- whole meshes a second, beside OpenCASCADE's BRepMesh: its linear deflection is the tolerance, its angular one the default.
#include "study/peer.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <memory>

#include "cases.h"
#include "tessellate.h"

namespace isoparm::bench {
namespace {

double largest(const TriangleNumbers& numbers) {
    double most = 0;
    for (const auto& part : numbers)
        for (const double x : part) most = std::max(most, x);
    return most;
}

/// How good its meshes are; told once, not measured again and again.
struct PeerMesh {
    std::unique_ptr<Peer> peer;
    std::vector<std::pair<std::string, double>> facts;
};

Case peer_case(const std::string& table, const Composite& surface, double tolerance) {
    const auto state = std::make_shared<PeerMesh>();
    Case c{table, "OpenCASCADE " + Peer::version(), "meshes", [state, tolerance] {
               state->peer->mesh(tolerance);
               return Work{1, state->facts};
           }};
    c.prepare = [state, surface, tolerance] {
        if (state->peer) return;
        state->peer = std::make_unique<Peer>(surface);
        state->peer->mesh(tolerance);
        const StudyMesh made = state->peer->result();
        state->facts = {{"triangles", double(made.mesh.triangle_count())}, {"seen/tolerance", largest(sampled_errors(surface, made.mesh)) / tolerance}};
    };
    c.reference = true;
    return c;
}

Case own_case(const std::string& table, const Composite& surface, double tolerance, Quality quality) {
    const auto made = [surface, tolerance, quality](bool study) {
        TessellationOptions options;
        options.tolerance = tolerance;
        options.measure = Measure::geometric;
        options.study = study;
        options.fans = true;
        options.quality = quality;
        return tessellate(surface, options);
    };
    const auto facts = std::make_shared<std::vector<std::pair<std::string, double>>>();
    const auto tell = [facts, tolerance](const Tessellation& t) {
        *facts = {{"triangles", double(t.mesh.triangle_count())}, {"seen/tolerance", t.sampled_error / tolerance}, {"proved/tolerance", t.certified_error / tolerance}};
    };
    if (quality == Quality::optimal) {  // takes many seconds: once
        Case c{table, "isoparm, optimal", "meshes", [made, facts, tell] {
                   tell(made(true));
                   return Work{1, *facts};
               }};
        c.repetitions = 1;
        return c;
    }
    Case c{table, "isoparm, fast", "meshes", [made, facts] {
               made(false);
               return Work{1, *facts};
           }};
    c.prepare = [made, facts, tell] {
        if (facts->empty()) tell(made(true));
    };
    return c;
}

}  // namespace

std::vector<Case> peer_cases() {
    std::vector<Case> cases;
    if (!has_peer()) {
        std::fprintf(stderr, "OpenCASCADE was not found when this was built: no comparison with it\n");
        return cases;
    }
    for (const auto& [scene, title] : {std::pair{"teapot", "teapot"}, {"sphere", "sphere, 8 rational octants"}, {"coons", "Coons patch"}}) {
        const Composite surface = patches_of(scene);
        for (const auto& [text, relative] : {std::pair{"1e-2", 1e-2}, {"1e-3", 1e-3}, {"1e-4", 1e-4}, {"1e-5", 1e-5}}) {
            const double tolerance = relative * bounding_box(surface).diagonal();
            const std::string table = std::string("beside OpenCASCADE: ") + title + " at " + text;
            for (Case& c : std::array{peer_case(table, surface, tolerance), own_case(table, surface, tolerance, Quality::fast)}) {
                c.repetitions = relative < 5e-5 ? 2 : 5;
                cases.push_back(std::move(c));
            }
            if (relative > 5e-4) cases.push_back(own_case(table, surface, tolerance, Quality::optimal));  // below that they take minutes
        }
    }
    return cases;
}

}  // namespace isoparm::bench
