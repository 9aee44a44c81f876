#include "study/peer.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "curves/bezier_cells.h"
#include "error.h"
#include "module.h"
#include "study/peer_module.h"
#include "verify.h"

namespace isoparm {
namespace {

constexpr const char* kModule = "isoparm_opencascade";
#define ISOPARM_PEER(name) module_function<decltype(&isoparm_peer_##name)>(kModule, "isoparm_peer_" #name)

[[noreturn]] void refuse(const std::string& why) { throw Error(ErrorKind::budget, why); }

struct Cell {
    std::size_t member;
    BezierCell bezier;
};

std::vector<Cell> cells_of(const Composite& surface) {
    std::vector<Cell> cells;
    for (std::size_t m = 0; m < surface.size(); ++m) {
        if (surface[m].patch.domain() == Domain::triangle) refuse(surface[m].name + ": OpenCASCADE has no triangular patches");
        const auto own = bezier_cells(surface[m].patch);
        if (own.empty()) refuse(surface[m].name + ": OpenCASCADE has polynomial and rational patches only");
        for (const BezierCell& b : own) cells.push_back({m, b});
    }
    return cells;
}

}  // namespace

bool has_peer() { return !find_module(kModule).empty(); }

struct Peer::Impl {
    const Composite& surface;
    std::vector<Cell> cells;
    void* shell = nullptr;

    explicit Impl(const Composite& s) : surface(s), cells(cells_of(s)) {
        std::vector<std::vector<double>> poles;
        std::vector<IsoparmPeerFace> faces;
        for (const Cell& c : cells) {
            auto& flat = poles.emplace_back();
            for (const Point& p : c.bezier.poles) flat.insert(flat.end(), {p.x, p.y, p.z});
            faces.push_back({c.bezier.degree_u, c.bezier.degree_v, flat.data(), c.bezier.weights.empty() ? nullptr : c.bezier.weights.data()});
        }
        IsoparmPeerError error{};
        shell = ISOPARM_PEER(open)(faces.data(), int(faces.size()), 1e-6 * bounding_box(surface).diagonal(), &error);
        if (!shell) refuse(error.text);
    }
    ~Impl() {
        if (shell) ISOPARM_PEER(close)(shell);
    }
    Impl(const Impl&) = delete;
    Impl& operator=(const Impl&) = delete;
};

Peer::Peer(const Composite& surface) : impl_(std::make_shared<Impl>(surface)) {}

std::string Peer::version() { return ISOPARM_PEER(version)(); }

void Peer::mesh(double deflection, double angle) {
    IsoparmPeerError error{};
    if (ISOPARM_PEER(mesh)(impl_->shell, deflection, angle, &error)) refuse(error.text);
}

namespace {

/// Puts the faces together: nodes with the same coordinates are one vertex.
struct Collector {
    const Composite& surface;
    const std::vector<Cell>& cells;
    Mesh mesh{};
    std::vector<std::array<std::uint32_t, 2>> open{};
    std::map<std::array<double, 3>, std::uint32_t> known{};

    std::uint32_t vertex(const double* x) {
        const std::array<double, 3> at{x[0] + 0.0, x[1] + 0.0, x[2] + 0.0};  // no -0
        const auto [it, fresh] = known.try_emplace(at, std::uint32_t(mesh.positions.size()));
        if (fresh) mesh.positions.push_back({at[0], at[1], at[2]});
        return it->second;
    }
    void add(int face, const IsoparmPeerMesh& m) {
        const Cell& cell = cells[std::size_t(face)];
        const BezierCell& b = cell.bezier;
        MeshPart part;
        part.name = surface[cell.member].name;
        part.member = cell.member;
        for (int k = 0; k < m.nodes; ++k) {
            part.uv.push_back({std::clamp(b.u0 + m.uv[2 * k] * (b.u1 - b.u0), b.u0, b.u1), std::clamp(b.v0 + m.uv[2 * k + 1] * (b.v1 - b.v0), b.v0, b.v1)});
            part.vertex.push_back(vertex(m.xyz + 3 * k));
        }
        for (int k = 0; k < m.triangles; ++k) {
            const std::array<std::uint32_t, 3> t{std::uint32_t(m.corners[3 * k]), std::uint32_t(m.corners[3 * k + 1]), std::uint32_t(m.corners[3 * k + 2])};
            const auto p = part.vertex[t[0]], q = part.vertex[t[1]], r = part.vertex[t[2]];
            (p == q || q == r || r == p ? part.left_out : part.triangles).push_back(t);
        }
        for (int k = 0; k < m.open; ++k) {
            const auto p = part.vertex[std::size_t(m.segments[2 * k])], q = part.vertex[std::size_t(m.segments[2 * k + 1])];
            if (p != q) open.push_back({std::min(p, q), std::max(p, q)});
        }
        mesh.parts.push_back(std::move(part));
    }
};

/// The largest deflection tolerance, tolerance / 2^(1/4), ... whose mesh is proved to be within the tolerance. Around poles its triangles do
/// not follow the parameters, so it is measured as any mesh is (verify.h).
StudyMesh make_peer(const StudyInput& input) {
    Peer peer(input.surface);
    constexpr int steps = 12;
    for (int k = 0; k < steps; ++k) {
        if (input.progress) input.progress(double(k) / steps);
        peer.mesh(input.tolerance * std::exp2(-0.25 * k));
        StudyMesh made = peer.result();
        if (made.mesh.triangle_count() > input.max_triangles)
            refuse("the tolerance " + to_text(input.tolerance) + " was not reached: " + std::to_string(made.mesh.triangle_count()) +
                   " triangles would be needed, the budget is " + std::to_string(input.max_triangles));
        VerifyOptions options;
        options.limit = input.tolerance;
        options.max_triangles = 8 * input.max_triangles;
        const Verification v = verify(triangles_of(made.mesh), input.surface, options);
        made.certified_error = v.upper();
        if (made.certified_error <= input.tolerance) return made;
        if (!v.stopped.empty()) refuse("the tolerance " + to_text(input.tolerance) + " was not reached: " + v.stopped);
    }
    refuse("the tolerance " + to_text(input.tolerance) + " was not reached: with no deflection from it down to a seventh of it");
}

}  // namespace

StudyMesh Peer::result() const {
    Collector all{impl_->surface, impl_->cells};
    IsoparmPeerError error{};
    const auto sink = [](void* user, int face, const IsoparmPeerMesh* mesh) { static_cast<Collector*>(user)->add(face, *mesh); };
    if (ISOPARM_PEER(read)(impl_->shell, sink, &all, &error)) refuse(error.text);
    StudyMesh made;
    made.topology = analyse(all.mesh, all.open);
    made.mesh = std::move(all.mesh);
    return made;
}

const StudyMethod peer_study_method = {"opencascade",
                                       "OpenCASCADE's BRepMesh, sewn: the largest deflection tolerance, tolerance / 2^(1/4), ... whose mesh is proved to be within the tolerance",
                                       make_peer, true};

const std::vector<StudyMethod>& all_study_methods() {
    static const std::vector<StudyMethod> all = [] {
        auto list = study_methods();
        if (has_peer()) list.push_back(peer_study_method);
        return list;
    }();
    return all;
}

const StudyMethod* find_any_study_method(const std::string& name) {
    for (const StudyMethod& m : all_study_methods())
        if (name == m.name) return &m;
    return nullptr;
}

}  // namespace isoparm
