// exact_quick_test.cpp -- what float32 says of rays and leaves is what double precision proves, or nothing.
#include "rays/exact_quick.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <functional>
#include <random>

#include "expect_program.h"
#include "rays/traced_scene.h"
#include "scene/scene.h"

namespace isoparm {
namespace {

Scene shipped(const std::string& name) { return load_scene(test::source_folder() + "/scenes/" + name + ".json"); }

class Random {
public:
    explicit Random(unsigned seed) : random_(seed) {}
    double number(double low, double high) { return std::uniform_real_distribution<>(low, high)(random_); }
    Point direction() {
        for (;;) {
            const Point p{number(-1, 1), number(-1, 1), number(-1, 1)};
            if (const double l = length(p); l > 0.1 && l < 1) return p / l;
        }
    }

private:
    std::mt19937_64 random_;
};

/// A place of a leaf, mostly beside its border; sometimes beyond it.
Point beside(const LeafMap& leaf, Random& random) {
    double x = random.number(-1.1, 1.1), y = random.number(-1.1, 1.1);
    if (random.number(0, 1) < 0.5) (random.number(0, 1) < 0.5 ? x : y) = (random.number(0, 1) < 0.5 ? 1 : -1) * (1 + random.number(-1, 1) * std::pow(10, random.number(-8, -2)));
    return leaf.s + x * leaf.a + y * leaf.b + 0.5 * x * x * leaf.second[0] + x * y * leaf.second[1] + 0.5 * y * y * leaf.second[2];
}

/// Sixteen rays about a leaf, one half of them grazing, in double and in float32, as the renderer makes them.
struct Packet {
    Ray rays[RayPacket::lanes];
    RayPacket exact;
    QuickRays quick;
    double farthest[RayPacket::lanes];
    alignas(64) float single[7][RayPacket::lanes];
    alignas(64) int valid[RayPacket::lanes];

    Packet(const LeafMap& leaf, const Point& centre, double size, Random& random) {
        const Point n = normalized(cross(leaf.a, leaf.b));
        for (int i = 0; i < RayPacket::lanes; ++i) {
            Point d = random.direction();
            if (i % 2 == 1) d = normalized(d - dot(d, n) * n) + std::pow(10, random.number(-4, 0)) * n;
            rays[i].direction = normalized(d);
            rays[i].origin = beside(leaf, random) - random.number(0.01, 2) * size * rays[i].direction;
            valid[i] = i % 7 == 6 ? 0 : -1;
        }
        double start[RayPacket::lanes];
        const ExactKernel& kernel = exact_kernel(chosen_isa());
        kernel.enter(rays, 0xffff, RayPacket::lanes, centre, size, start, {single[0], single[1], single[2], single[3], single[4], single[5], single[6]}, &exact);
        kernel.planes(RayPacket::lanes, exact);
        for (int k = 0; k < 3; ++k) quick.origin[k] = single[k], quick.direction[k] = single[3 + k];
        quick.set_planes(exact);
        for (int i = 0; i < RayPacket::lanes; ++i) single[6][i] = i % 3 == 0 ? static_cast<float>(0.3 * size) : 1e30f, farthest[i] = single[6][i];
    }
};

struct Told {
    int met = 0, missed = 0, open = 0, wrong = 0;
};
/// What float32 says of rays about the leaves of a scene, against double precision; after `change`.
Told compare(const std::string& name, int packets, const std::function<void(QuickLeaf&)>& change = [](QuickLeaf&) {}) {
    const Scene scene = shipped(name);
    const Bounds box = bounding_box(scene);
    const double size = box.diagonal();
    const Point centre = 0.5 * (box.low + box.high);
    Random random(11);
    Told told;
    std::vector<const Patch*> patches;
    for (const auto& surface : scene.surfaces)
        for (const Member& m : surface.patches) patches.push_back(&m.patch);
    const std::size_t step = 1 + patches.size() / 4;
    for (std::size_t which = 0; which < patches.size(); which += step) {
        const ExactPatch exact(*patches[which], size);
        const QuickPatch quick(exact, centre);
        for (int k = 0; k < packets; ++k) {
            const auto leaf = static_cast<std::size_t>(random.number(0, double(exact.leaves()) - 1e-9));
            if (quick.leaf(leaf).kind == QuickLeaf::none) continue;
            const Packet p(exact.map(leaf), centre, size, random);
            QuickLeaf changed = quick.leaf(leaf);
            change(changed);
            QuickHits hits;
            quick_kernels(chosen_isa())[changed.kind](changed, quick.coefficients(leaf), p.quick, p.single[6], p.valid, hits);
            Roots roots[RayPacket::lanes];
            exact.meet(leaf, p.exact, p.farthest, RayPacket::lanes, 0xffff, roots);
            for (int i = 0; i < RayPacket::lanes; ++i) {
                const bool met = hits.met >> i & 1, open = hits.open >> i & 1;
                if (!p.valid[i]) { EXPECT_FALSE(met || open); continue; }
                const Roots& r = roots[i];
                told.open += open, told.met += met, told.missed += !met && !open;
                if (open || (r.undecided && r.count == 0)) continue;
                if (!met) told.wrong += r.count > 0;
                else if (r.count == 0) told.wrong += hits.far[i] <= p.single[6][i];
                else told.wrong += r.count > 1 || !(hits.near[i] <= r.root[0].distance && r.root[0].distance <= hits.far[i]);
            }
        }
    }
    return told;
}

TEST(ExactQuick, SaysNothingThatDoublePrecisionDenies) {
    for (const char* name : {"teapot", "coons", "sphere", "side_vertex", "s003_planar_triangle"}) {
        const Told told = compare(name, name == std::string("sphere") ? 30 : 80);
        EXPECT_EQ(told.wrong, 0) << name;
        EXPECT_GT(told.met, 100) << name;
        EXPECT_GT(told.missed, 100) << name;
        EXPECT_GE(told.open, name == std::string("s003_planar_triangle") ? 0 : 1) << name;
    }
}

// Each bound is needed: what would be said if it were too small is denied.
TEST(ExactQuick, BoundsThatAreTooSmallAreCaught) {
    EXPECT_GT(compare("coons", 150, [](QuickLeaf& l) { l.bend = 0; }).wrong, 0) << "bend";
    EXPECT_GT(compare("coons", 300, [](QuickLeaf& l) { l.error *= -4; }).wrong, 0) << "error";
    EXPECT_GT(compare("coons", 150, [](QuickLeaf& l) { l.turn_u = l.turn_v = 0; l.size_a = l.size_b = 0; }).wrong, 0) << "turn";
    EXPECT_GT(compare("side_vertex", 150, [](QuickLeaf& l) { l.error = -l.error; }).wrong, 0) << "error of a model";
}

TEST(ExactQuick, EveryInstructionSetGivesTheSameBits) {
    const Scene scene = shipped("teapot"), rational = shipped("sphere");
    Random random(12);
    for (const Scene* of : {&scene, &rational}) {
        const Bounds box = bounding_box(*of);
        const Point centre = 0.5 * (box.low + box.high);
        const ExactPatch exact(of->surfaces.back().patches.back().patch, box.diagonal());
        const QuickPatch quick(exact, centre);
        for (int k = 0; k < 200; ++k) {
            const auto leaf = static_cast<std::size_t>(random.number(0, double(exact.leaves()) - 1e-9));
            if (quick.leaf(leaf).kind == QuickLeaf::none) continue;
            const Packet p(exact.map(leaf), centre, box.diagonal(), random);
            std::vector<float> expected;
            for (const Isa isa : all_isas) {
                if (!runs(isa)) continue;
                QuickHits h{};
                quick_kernels(isa)[quick.leaf(leaf).kind](quick.leaf(leaf), quick.coefficients(leaf), p.quick, p.single[6], p.valid, h);
                std::vector<float> all{float(h.met), float(h.open)};
                for (int i = 0; i < RayPacket::lanes; ++i)
                    if (h.met >> i & 1) all.insert(all.end(), {h.x[i], h.y[i], h.near[i], h.far[i]});
                if (expected.empty()) expected = all;
                ASSERT_EQ(all.size(), expected.size());
                EXPECT_EQ(std::memcmp(all.data(), expected.data(), all.size() * sizeof(float)), 0) << to_text(isa) << ", packet " << k;
            }
        }
    }
}

// Single rays are met in double precision alone (EmbreeScene::layers).
TEST(ExactQuick, PacketsMeetWhatSingleRaysMeet) {
    for (const char* name : {"teapot", "sphere", "side_vertex"}) {
        Scene scene = shipped(name);
        std::erase_if(scene.objects, [](const SceneObject& o) { return o.kind != SceneObject::Kind::surface; });
        for (SceneObject& o : scene.objects) o.boundary = false, o.isolines = {}, o.opacity = 1;
        const TracedScene traced = build_traced_scene(scene, 1e-2, {}, true);
        const Bounds box = bounding_box(scene);
        const double size = box.diagonal();
        Random random(13);
        std::vector<Hit> one;
        int hits = 0;
        for (int k = 0; k < 60; ++k) {
            Ray rays[EmbreeScene::packet];
            Hit met[EmbreeScene::packet];
            const Point from = 0.5 * (box.low + box.high) + size * random.direction(), to = 0.5 * (box.low + box.high) + 0.25 * size * random.direction();
            for (Ray& r : rays) r = {from, normalized(to + std::pow(10, random.number(-9, -1)) * size * random.direction() - from)};
            traced.embree->intersect(rays, EmbreeScene::packet, met);
            for (int i = 0; i < EmbreeScene::packet; ++i) {
                traced.embree->layers(rays[i], one);
                ASSERT_EQ(met[i].found(), !one.empty()) << name << " " << k << " " << i;
                if (one.empty()) continue;
                ++hits;
                EXPECT_LE(std::fabs(met[i].distance - one[0].distance), 1e-11 * size) << name << " " << k << " " << i;
                EXPECT_LE(met[i].error, 1e-11 * size);
            }
        }
        EXPECT_GT(hits, 100) << name;
    }
}

}  // namespace
}  // namespace isoparm
