// study_quadtree.cpp -- a restricted quadtree on every patch (Von Herzen and Barr 1987, with transitions across patches).
#include <algorithm>
#include <cmath>
#include <unordered_set>

#include "error.h"
#include "study/study_methods.h"

namespace isoparm {
namespace {

/// The leaves of one patch, split where asked; lattice points that are corners of leaves.
class Tree {
public:
    explicit Tree(const Patch& patch) : leaves_(patch, steps_for(patch)) {
        for (const Leaf& leaf : leaves_.list)
            for (int c = 0; c < leaf.sides; ++c) corners_.insert(leaf.corner[c].key());
    }

    const Leaves& leaves() const { return leaves_; }
    std::size_t size() const { return leaves_.list.size(); }
    /// Into four; false when the leaf is one step of the lattice.
    bool split(std::uint32_t index) {
        const Leaf leaf = leaves_.list[index];
        if (!divisible(leaf, 2)) return false;
        const auto& c = leaf.corner;
        const auto m = [&](int k) { return middle(c[k], c[(k + 1) % leaf.sides]); };
        if (leaf.sides == 3) {
            leaves_.list[index] = {{m(0), m(1), m(2), m(0)}, 3};
            for (int k = 0; k < 3; ++k) leaves_.list.push_back({{c[k], m(k), m((k + 2) % 3), c[k]}, 3});
        } else {
            const LatticePoint centre = middle(c[0], c[2]);
            corners_.insert(centre.key());
            leaves_.list[index] = {{c[0], m(0), centre, m(3)}, 4};
            leaves_.list.push_back({{m(0), c[1], m(1), centre}, 4});
            leaves_.list.push_back({{centre, m(1), c[2], m(2)}, 4});
            leaves_.list.push_back({{m(3), centre, m(2), c[3]}, 4});
        }
        for (int k = 0; k < leaf.sides; ++k) corners_.insert(m(k).key());
        return true;
    }
    /// Does another leaf of the patch have a corner at a quarter of one of its sides?
    bool too_large(std::uint32_t index) const {
        const Leaf& leaf = leaves_.list[index];
        if (!divisible(leaf, 4)) return false;
        for (int k = 0; k < leaf.sides; ++k) {
            const LatticePoint &a = leaf.corner[k], &b = leaf.corner[(k + 1) % leaf.sides], m = middle(a, b);
            if (corners_.count(middle(a, m).key()) || corners_.count(middle(m, b).key())) return true;
        }
        return false;
    }
    /// Splits what is too large; true when something was.
    bool restrict_sizes() {
        bool any = false;
        for (bool again = true; again;) {
            again = false;
            for (std::uint32_t i = 0; i < size(); ++i)
                while (too_large(i) && split(i)) again = any = true;
        }
        return any;
    }

private:
    static std::uint32_t steps_for(const Patch& patch) {
        const std::size_t cells = std::max(patch.lines_u().size(), patch.lines_v().size());
        std::uint32_t steps = 1u << 18;
        while (double(steps) * double(cells) > 2e9) steps /= 2;
        return steps;
    }
    static bool divisible(const Leaf& leaf, std::uint32_t n) {
        const auto &a = leaf.corner[0], &b = leaf.corner[1];
        return std::max(std::max(a.i, b.i) - std::min(a.i, b.i), std::max(a.j, b.j) - std::min(a.j, b.j)) >= n;
    }

    Leaves leaves_;
    std::unordered_set<std::uint64_t, LatticeHash> corners_;
};

class Forest {
public:
    explicit Forest(const StudyInput& input) : input_(input), topology_(shared_edges(input)), prover_(input.surface) {
        for (const Member& m : input.surface) trees_.emplace_back(m.patch);
    }

    StudyMesh run() {
        for (int round = 0;; ++round) {
            restrict_sizes();
            check_budget(2.0 * double(leaf_count()));
            LeafMesh made = mesh_of(input_.surface, topology_, leaves());
            const MeshProof proof = *prover_(made.mesh, input_.tolerance);
            if (proof.geometric <= input_.tolerance && manifold(made)) return checked(std::move(made), proof);
            if (input_.progress && proof.geometric > 0)
                input_.progress(std::clamp(std::sqrt(input_.tolerance / proof.geometric), 0.0, 0.9));
            if (round > 3) check_budget(0.3 * predicted(proof));
            split(made, proof);
        }
    }

private:
    std::size_t leaf_count() const {
        std::size_t n = 0;
        for (const Tree& t : trees_) n += t.size();
        return n;
    }
    std::vector<Leaves> leaves() const {
        std::vector<Leaves> all;
        for (const Tree& t : trees_) all.push_back(t.leaves());
        return all;
    }
    void check_budget(double triangles) const {
        if (triangles > double(input_.max_triangles)) not_reached(input_, triangles);
    }
    /// A triangle that is k times above the tolerance becomes about k of them.
    double predicted(const MeshProof& proof) const {
        double sum = 0;
        for (const auto& part : proof.bound)
            for (const double b : part) sum += std::isfinite(b) ? std::max(1.0, b / input_.tolerance) : 4;
        return sum;
    }

    /// Splits the leaves of triangles above the tolerance; all of them when only the mesh touches itself.
    void split(const LeafMesh& made, const MeshProof& proof) {
        bool any = false;
        for (std::size_t m = 0; m < trees_.size(); ++m) {
            std::vector<char> marked(trees_[m].size(), 0);
            for (std::size_t i = 0; i < proof.bound[m].size(); ++i)
                if (!(proof.bound[m][i] <= input_.tolerance)) marked[made.leaf[m][proof.to_split[m][i]]] = 1;
            if (proof.geometric <= input_.tolerance) marked.assign(marked.size(), 1);
            for (std::uint32_t i = 0; i < marked.size(); ++i)
                if (marked[i]) any = trees_[m].split(i) || any;
        }
        if (!any)
            throw Error(ErrorKind::budget, "the tolerance " + to_text(input_.tolerance) +
                                               " was not reached: the leaves that fail are as small as they can be");
    }

    void restrict_sizes() {
        for (bool again = true; again;) {
            again = false;
            for (Tree& t : trees_) t.restrict_sizes();
            for (std::uint32_t r = 0; r < topology_.rims.size(); ++r) again = restrict_rim(r) || again;
            check_budget(2.0 * double(leaf_count()));
        }
    }
    /// Splits leaves on either side of a shared rim that are more than twice as long as one opposite.
    bool restrict_rim(std::uint32_t r) {
        const Rim& rim = topology_.rims[r];
        if (rim.collapsed || rim.uses.size() != 2) return false;
        std::array<std::vector<RimPiece>, 2> sides;
        for (int u = 0; u < 2; ++u) sides[u] = rim_pieces(input_.surface, topology_, trees_[rim.uses[u].member].leaves(), r, u);
        std::array<std::vector<std::uint32_t>, 2> large;
        for (int u = 0; u < 2; ++u) {
            const auto &here = sides[u], &there = sides[1 - u];
            std::size_t first = 0;
            for (const RimPiece& p : here) {
                const double room = 1e-7 * (p.f1 - p.f0);
                while (first < there.size() && there[first].f1 <= p.f0 + room) ++first;
                for (std::size_t i = first; i < there.size() && there[i].f0 < p.f1 - room; ++i)
                    if (p.f1 - p.f0 > (2 + 1e-6) * (there[i].f1 - there[i].f0)) {
                        large[u].push_back(p.leaf);
                        break;
                    }
            }
        }
        bool any = false;
        for (int u = 0; u < 2; ++u) {
            std::sort(large[u].begin(), large[u].end());
            large[u].erase(std::unique(large[u].begin(), large[u].end()), large[u].end());
            for (const auto leaf : large[u]) any = trees_[rim.uses[u].member].split(leaf) || any;
        }
        return any;
    }

    const StudyInput& input_;
    const Topology topology_;
    const MeshProver prover_;
    std::vector<Tree> trees_;
};

}  // namespace

StudyMesh make_quadtree(const StudyInput& input) { return Forest(input).run(); }

}  // namespace isoparm
