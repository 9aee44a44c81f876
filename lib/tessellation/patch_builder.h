// patch_builder.h -- the first triangles of a patch: rows of corners, strips between them; internal to refine_start.cpp.
#pragma once
#include <array>
#include <vector>

#include "tessellation/dice.h"
#include "tessellation/refine.h"

namespace isoparm {

using Chain = std::vector<std::uint32_t>;  // corners along a line

/// Makes the corners, edges and triangles of one patch.
class PatchBuilder {
public:
    /// About as many triangles are to come.
    PatchBuilder(PatchMesh& mesh, double triangles) : mesh_(mesh) {
        const auto most = std::size_t(1.2 * triangles + 64);  // with those that bisection adds
        mesh_.uv.reserve(most / 2), mesh_.vertex.reserve(most / 2), mesh_.slack.reserve(most / 2), first_.reserve(most / 2);
        mesh_.triangles.reserve(most), mesh_.settled.reserve(most), mesh_.fresh.reserve(most), mesh_.edges.reserve(most / 2 * 3), next_.reserve(most / 2 * 3);
    }

    std::uint32_t corner(const Vec2& p, std::uint32_t vertex = kNone) {
        mesh_.uv.push_back(p);
        mesh_.vertex.push_back(vertex);
        first_.push_back(kNone);
        return std::uint32_t(mesh_.uv.size() - 1);
    }
    /// The edge between two corners.
    std::uint32_t edge(std::uint32_t a, std::uint32_t b) {
        const auto [low, high] = std::minmax(a, b);
        for (auto e = first_[low]; e != kNone; e = next_[e])
            if (std::max(mesh_.edges[e].a, mesh_.edges[e].b) == high) return e;
        mesh_.edges.emplace_back();
        mesh_.edges.back().a = a, mesh_.edges.back().b = b;
        next_.push_back(first_[low]);
        return first_[low] = std::uint32_t(mesh_.edges.size() - 1);
    }
    void triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        if (mirrored_) std::swap(b, c);
        add({a, b, c}, {edge(a, b), edge(b, c), edge(c, a)});
    }
    /// Turns all triangles over: for chains in exchanged parameters.
    void mirror(bool mirrored) { mirrored_ = mirrored; }
    /// The strip between two chains that run the same way, the inner one to the left. Both are straight.
    void strip(const Chain& outer, const Chain& inner, const Bends& bends);
    /// The same where only the outer one is straight, and the inner one lies between its ends: what goes in step may then turn over.
    void ragged_strip(const Chain& outer, const Chain& inner, const Bends& bends);

private:
    using Corners = std::array<std::uint32_t, 3>;

    void add(const Corners& corner, const std::array<std::uint32_t, 3>& edge) {
        PatchTriangle t;
        t.corner = corner, t.edge = edge;
        t.cell = mesh_.cells.back().get();
        const auto index = std::uint32_t(mesh_.triangles.size());
        for (const auto e : t.edge) mesh_.edges[e].side[mesh_.edges[e].side[0] != kNone] = index;
        mesh_.fresh.push_back(index);
        mesh_.triangles.push_back(t);
        mesh_.settled.push_back(kUnsettled);
    }
    /// An edge that nothing else will ask for, and that is not there yet.
    std::uint32_t edge_within(std::uint32_t a, std::uint32_t b) {
        mesh_.edges.emplace_back();
        mesh_.edges.back().a = a, mesh_.edges.back().b = b;
        next_.push_back(kNone);
        return std::uint32_t(mesh_.edges.size() - 1);
    }
    /// Triangles in step between two chains: each begins with the side that it shares with the one before.
    void in_step(const std::vector<Corners>& triangles);
    /// Do three corners turn to the left, by more than rounding?
    bool left(std::uint32_t a, std::uint32_t b, std::uint32_t c) const;
    /// Each triangle has a piece of one chain and a corner of the other.
    std::vector<Corners> steps(const Chain& outer, const Chain& inner, const Bends& bends) const;
    /// The polygon between the chains, which are monotone along the outer one (Garey, Johnson, Preparata and Tarjan 1978).
    std::vector<Corners> monotone(const Chain& outer, const Chain& inner) const;

    PatchMesh& mesh_;
    bool mirrored_ = false;
    Chain first_, next_;  // edges by their smaller corner
};

/// A cell whose sides, in the direction of growing parameters, are given.
void fill_cell(PatchBuilder& build, const Bends& bends, DiceGrid grid, const std::array<Chain, 4>& side);
/// The triangular domain whose sides, counter-clockwise from u = v = 0, are given.
void fill_triangle(PatchBuilder& build, const Bends& bends, int n, const std::array<Chain, 3>& sides);

}  // namespace isoparm
