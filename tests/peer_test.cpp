// The peer of studies, OpenCASCADE, where it was found: its meshes are those of the surface, and what it cannot do is said.
#include <gtest/gtest.h>

#include "drawing/drawn.h"
#include "run_program.h"
#include "study/peer.h"
#include "tessellate.h"

namespace isoparm {
namespace {

Composite drawn(const std::string& name) {
    const Scene scene = load_scene(test::source_folder() + "/scenes/" + name + ".json");
    Composite all;
    for (const SceneObject& o : drawn_objects(scene))
        if (o.kind == SceneObject::Kind::surface)
            for (const Member& m : surface_of(scene, o).patches) all.push_back(m);
    return all;
}

class PeerTest : public ::testing::Test {
protected:
    void SetUp() override {
        if (!has_peer()) GTEST_SKIP() << "built without OpenCASCADE";
    }
};

TEST_F(PeerTest, ItsMeshesLieOnTheSurfaceAndAreSewn) {
    for (const char* name : {"sphere", "teapot", "coons"}) {
        SCOPED_TRACE(name);
        const Composite surface = drawn(name);
        const double tolerance = 1e-3 * bounding_box(surface).diagonal();
        Peer peer(surface);
        peer.mesh(tolerance);
        const StudyMesh made = peer.result();
        ASSERT_GT(made.mesh.triangle_count(), 100u);
        EXPECT_EQ(made.topology.t_junctions, 0u);
        EXPECT_EQ(made.topology.non_manifold_edges, 0u);
        EXPECT_EQ(made.topology.boundary_edges == 0, std::string(name) == "sphere");
        for (const MeshPart& part : made.mesh.parts)
            for (std::size_t i = 0; i < part.uv.size(); ++i)
                ASSERT_LT(distance(surface[part.member].patch.point(part.uv[i].x, part.uv[i].y), made.mesh.positions[part.vertex[i]]), 1e-6 * tolerance);
        double seen = 0;
        for (const auto& part : sampled_errors(surface, made.mesh))
            for (const double x : part) seen = std::max(seen, x);
        EXPECT_LT(seen, 2 * tolerance);
        EXPECT_GT(seen, 0.2 * tolerance);
    }
}

TEST_F(PeerTest, InAStudyItKeepsTheToleranceByProofAndIsDoneAnewWhenFiner) {
    const Composite surface = drawn("sphere");
    const StudyRun coarse = run_study(peer_study_method, {surface, 3e-2}).run, fine = run_study(peer_study_method, {surface, 3e-3}).run;
    for (const StudyRun* r : {&coarse, &fine}) {
        ASSERT_TRUE(r->reached) << r->reason;
        EXPECT_LE(r->certified_error, r->tolerance);
        EXPECT_LE(r->sampled_error, r->certified_error);
    }
    EXPECT_GT(fine.triangles, 5 * coarse.triangles);
}

TEST_F(PeerTest, WhatItHasNoSurfaceForIsRecorded) {
    for (const auto& [name, reason] : {std::pair{"side_vertex", "no triangular patches"}, {"s004_gregory", "polynomial and rational patches only"}}) {
        const Composite surface = drawn(name);
        const StudyRun r = run_study(peer_study_method, {surface, 1e-2 * bounding_box(surface).diagonal()}).run;
        EXPECT_FALSE(r.reached);
        EXPECT_NE(r.reason.find(reason), std::string::npos) << r.reason;
    }
}

}  // namespace
}  // namespace isoparm
