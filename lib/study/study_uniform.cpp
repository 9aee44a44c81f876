// study_uniform.cpp -- every patch on one grid.
#include <algorithm>
#include <cmath>

#include "error.h"
#include "grid_mesh.h"
#include "study/study_methods.h"

namespace isoparm {
namespace {

class Search {
public:
    explicit Search(const StudyInput& input) : input_(input), topology_(shared_edges(input)), prover_(input.surface) {
        for (const Member& m : input.surface) {
            const double cells = double(m.patch.lines_u().size() - 1) * double(m.patch.lines_v().size() - 1);
            per_square_ += m.patch.domain() == Domain::triangle ? 1 : 2 * cells;
        }
    }

    StudyMesh run() {
        double error = try_n(1);
        while (!best_) {
            if (!(error > 0) || !std::isfinite(error)) {
                error = try_n(2 * fails_);
                continue;
            }
            // Error falls about as 1 / n^2; further away that is a guess only.
            const double guess = std::ceil(double(fails_) * std::sqrt(error / input_.tolerance));
            if (fails_ >= 4 && per_square_ * guess * guess > 4 * double(input_.max_triangles))
                not_reached(input_, per_square_ * guess * guess);
            error = try_n(std::uint32_t(std::clamp(guess, fails_ + 1.0, 4.0 * fails_)));
        }
        for (std::uint32_t step = 1; fits_ - fails_ > 1; step = std::min(2 * step, (fits_ - fails_ + 1) / 2))
            if (!below(fits_ - std::min(step, fits_ - fails_ - 1))) step = 1;
        return checked(std::move(*best_), *proof_);
    }

private:
    LeafMesh mesh(std::uint32_t n) const {
        const double triangles = per_square_ * n * n;
        if (triangles > double(input_.max_triangles)) not_reached(input_, triangles);
        std::vector<Leaves> leaves;
        for (const Member& m : input_.surface) leaves.push_back(grid_leaves(m.patch, n));
        return mesh_of(input_.surface, topology_, leaves);
    }
    /// The error with n, which becomes the best or what fails.
    double try_n(std::uint32_t n) {
        LeafMesh made = mesh(n);
        MeshProof proof = *prover_(made.mesh, input_.tolerance);
        if (proof.geometric <= input_.tolerance && manifold(made))
            keep(n, std::move(made), std::move(proof));
        else
            fails_ = n;
        report(proof.geometric);
        return proof.geometric;
    }
    bool below(std::uint32_t n) {
        LeafMesh made = mesh(n);
        auto proof = prover_(made.mesh, input_.tolerance, true);
        if (!proof || !manifold(made)) {
            fails_ = n;
            return false;
        }
        keep(n, std::move(made), std::move(*proof));
        return true;
    }
    void keep(std::uint32_t n, LeafMesh&& made, MeshProof&& proof) { fits_ = n, best_ = std::move(made), proof_ = std::move(proof); }
    void report(double error) const {
        if (input_.progress && error > 0) input_.progress(std::clamp(0.9 * input_.tolerance / error, 0.0, 0.9));
    }

    const StudyInput& input_;
    const Topology topology_;
    const MeshProver prover_;
    double per_square_ = 0;  // triangles with n = 1
    std::uint32_t fails_ = 0, fits_ = 0;
    std::optional<LeafMesh> best_;
    std::optional<MeshProof> proof_;
};

}  // namespace

StudyMesh make_uniform(const StudyInput& input) { return Search(input).run(); }

}  // namespace isoparm
