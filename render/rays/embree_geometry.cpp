// What an EmbreeScene is made of.
#include <cstdlib>

#include "rays/embree_state.h"

namespace isoparm {

EmbreeScene::EmbreeScene(const Point& centre) : state_(std::make_unique<State>()) {
    State& s = *state_;
    s.centre = centre;
    const char* config =
        std::getenv("ISOPARM_EMBREE");  // e.g. "isa=sse4.2", for pictures that are equal on all machines
    s.device = rtcNewDevice(config ? config : "");
    if (!s.device)
        throw std::runtime_error("Embree cannot start (error " + std::to_string(rtcGetDeviceError(nullptr)) + ")");
    s.scene = rtcNewScene(s.device);
    rtcSetSceneFlags(s.scene, RTC_SCENE_FLAG_ROBUST);
    s.check("starting");
}
EmbreeScene::~EmbreeScene() = default;

std::uint32_t EmbreeScene::add_mesh(const Mesh& mesh, const Sheet& sheet, const std::vector<Plane>& planes) {
    State& s = *state_;
    FloatVertices& vertices = s.shared.emplace_back(mesh.positions.size(), s.centre);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) vertices.set(i, mesh.positions[i]);
    s.extent.add(vertices.extent());
    ++s.meshes;
    std::uint32_t first = Hit::none;
    for (const MeshPart& part : mesh.parts) {
        RTCGeometry g = rtcNewGeometry(s.device, RTC_GEOMETRY_TYPE_TRIANGLE);
        rtcSetSharedGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, vertices.data(), 0,
                                   3 * sizeof(float), vertices.size());
        auto* index = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
            g, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t), part.triangles.size()));
        if (!index && !part.triangles.empty()) s.check("taking over a mesh");
        for (const auto& triangle : part.triangles)
            for (const std::uint32_t corner : triangle) *index++ = part.vertex[corner];
        const std::uint32_t id = s.attach(g, sheet, false, false, planes.empty() ? Plane{} : planes[std::size_t(&part - mesh.parts.data())]);
        if (first == Hit::none) first = id;
    }
    return first;
}

std::uint32_t EmbreeScene::add_quads(const std::vector<QuadPart>& parts, const Sheet& sheet, const std::vector<Plane>& planes) {
    State& s = *state_;
    s.quads = true;
    // Hierarchies that hold no vertices, but look them up, are a third smaller.
    rtcSetSceneFlags(s.scene, static_cast<RTCSceneFlags>(RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_COMPACT));
    ++s.meshes;
    std::uint32_t first = Hit::none;
    for (const QuadPart& part : parts) {
        RTCGeometry g = rtcNewGeometry(s.device, RTC_GEOMETRY_TYPE_QUAD);
        rtcSetSharedGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, part.vertices().data(), 0, 3 * sizeof(float), part.vertices().size());
        rtcSetSharedGeometryBuffer(g, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT4, part.quads().data(), 0, 4 * sizeof(std::uint32_t), part.quads().size());
        s.extent.add(part.vertices().extent());
        const std::uint32_t id = s.attach(g, sheet, false, true, planes.empty() ? Plane{} : planes[std::size_t(&part - parts.data())]);
        if (first == Hit::none) first = id;
    }
    return first;
}

std::uint32_t EmbreeScene::add_patch(const ExactPatch& patch, std::uint32_t group, const Sheet& sheet, const Plane& plane) {
    State& s = *state_;
    for (std::size_t i = 0; i < patch.leaves(); ++i)
        for (const Point& p : {patch.box(i).low, patch.box(i).high}) s.extent.radius = std::max(s.extent.radius, length(p - s.centre));
    s.patches = true;
    RTCGeometry g = rtcNewGeometry(s.device, RTC_GEOMETRY_TYPE_USER);
    Geometry& data = s.geometries.emplace_back(Geometry{0, group, sheet, plane, false, false, &patch, &s.quick.emplace_back(patch, s.centre), &s.centre, &s.extent.radius});
    s.translucent = s.translucent || !data.ends_rays();
    rtcSetGeometryUserPrimitiveCount(g, static_cast<unsigned>(patch.leaves()));
    rtcSetGeometryUserData(g, &data);
    set_patch_callbacks(g);
    rtcCommitGeometry(g);
    data.id = rtcAttachGeometry(s.scene, g);
    rtcReleaseGeometry(g);
    s.check("taking over a patch");
    return data.id;
}

EmbreeScene::Count EmbreeScene::count() const { return {state_->rays, state_->undecided}; }

std::uint32_t EmbreeScene::add_tubes(const std::vector<std::array<Point, 4>>& pieces, double radius, double opacity) {
    State& s = *state_;
    RTCGeometry g = rtcNewGeometry(s.device, RTC_GEOMETRY_TYPE_ROUND_BEZIER_CURVE);
    auto* vertex = static_cast<float*>(
        rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, 4 * sizeof(float), 4 * pieces.size()));
    auto* index = static_cast<std::uint32_t*>(
        rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT, sizeof(std::uint32_t), pieces.size()));
    if (!vertex || !index) s.check("taking over a curve");
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        index[i] = static_cast<std::uint32_t>(4 * i);
        for (const Point& p : pieces[i]) {
            s.extent.store(p, radius, s.centre, vertex);
            vertex[3] = static_cast<float>(radius);
            vertex += 4;
        }
    }
    return s.attach(g, opacity, true);
}

std::uint32_t EmbreeScene::add_balls(const std::vector<Point>& centres, double radius, double opacity) {
    State& s = *state_;
    RTCGeometry g = rtcNewGeometry(s.device, RTC_GEOMETRY_TYPE_SPHERE_POINT);
    auto* vertex = static_cast<float*>(
        rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, 4 * sizeof(float), centres.size()));
    if (!vertex) s.check("taking over points");
    for (const Point& p : centres) {
        s.extent.store(p, radius, s.centre, vertex);
        vertex[3] = static_cast<float>(radius);
        vertex += 4;
    }
    return s.attach(g, opacity, true);
}

void EmbreeScene::commit() {
    rtcCommitScene(state_->scene);
    state_->check("building its hierarchy");
}

}  // namespace isoparm
