// bare_embree.h -- Embree and nothing else: float rays that were made before, hits that nobody reads. bare_embree.cpp
// is the only file here that includes Embree.
#pragma once
#include <cstddef>
#include <memory>
#include <vector>

#include "mesh.h"
#include "picture/camera.h"

namespace isoparm::bench {

class BareEmbree {
public:
    /// One triangle mesh relative to `centre`, and the rays of all later calls, from outside of the scene.
    BareEmbree(const Mesh& mesh, const Point& centre, const std::vector<Ray>& rays, bool robust);
    ~BareEmbree();

    /// Traces all rays; the number of them that hit.
    std::size_t intersect_1() const;
    std::size_t intersect_16() const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace isoparm::bench
