#include "subdivision/limit_composite.h"

#include <tbb/parallel_for.h>

#include <string>

#include "patches/transformed.h"
#include "subdivision/limit_compare.h"

namespace isoparm {
namespace {

/// The face of the cage, when the patch is all of it: "#12", but not "#12.0".
int whole_face(const std::string& name) { return name.find('.') == std::string::npos ? std::stoi(name.substr(1)) : -1; }

std::optional<Patch> composite_patch(const LimitSurface& limit, const LimitFaces& faces, const std::string& name, const Patch& patch) {
    const int face = whole_face(name);
    const bool triangle = patch.domain() == Domain::triangle;
    if (!triangle && face >= 0 && limit.kind(face) == LimitFace::regular) return make_coons_hermite(limit_network(limit, face), Twist::average);
    const auto cell = faces.cell({face, name, 0, 0}, 0);
    if (!cell) return {};
    const auto local = (triangle ? triangle_methods() : quad_methods()).back().on(*cell);
    if (!local) return {};
    return transformed(*local, Transform::translate(cell->base()));
}

}  // namespace

LimitComposite make_limit_composite(const LimitSurface& limit, const LimitFaces& faces) {
    const std::vector<std::pair<std::string, Patch>> patches(faces.patches.begin(), faces.patches.end());
    std::vector<std::optional<Patch>> made(patches.size());
    tbb::parallel_for(std::size_t(0), patches.size(), [&](std::size_t k) { made[k] = composite_patch(limit, faces, patches[k].first, patches[k].second); });
    LimitComposite r;
    for (std::size_t k = 0; k < patches.size(); ++k) {
        if (!made[k]) {
            ++r.left_out;
            continue;
        }
        r.limit.push_back({patches[k].first, patches[k].second});
        r.composite.push_back({patches[k].first, *made[k]});
    }
    return r;
}

}  // namespace isoparm
