#include "bare_bfr.h"

#include <opensubdiv/bfr/refinerSurfaceFactory.h>
#include <opensubdiv/bfr/surface.h>
#include <opensubdiv/far/topologyDescriptor.h>
#include <opensubdiv/far/topologyRefinerFactory.h>

#include <stdexcept>
#include <vector>

namespace isoparm::bench {

namespace Bfr = OpenSubdiv::Bfr;
namespace Far = OpenSubdiv::Far;
namespace Sdc = OpenSubdiv::Sdc;

struct BareBfr::State {
    std::unique_ptr<Far::TopologyRefiner> refiner;
    Bfr::Surface<double> surface;
    std::vector<double> points;
};

BareBfr::BareBfr(const Grid<Point>& net) : state_(std::make_unique<State>()) {
    std::vector<double> positions;
    for (const auto& row : net)
        for (const Point& p : row) positions.insert(positions.end(), {p.x, p.y, p.z});
    std::vector<int> vertices;  // of 3 x 3 faces, first edge along u; vertex 4 i + j is net[i][j]
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) vertices.insert(vertices.end(), {4 * i + j, 4 * i + j + 4, 4 * i + j + 5, 4 * i + j + 1});
    const std::vector<int> sizes(9, 4);
    Far::TopologyDescriptor d;
    d.numVertices = 16, d.numFaces = 9;
    d.numVertsPerFace = sizes.data(), d.vertIndicesPerFace = vertices.data();
    using Factory = Far::TopologyRefinerFactory<Far::TopologyDescriptor>;
    state_->refiner.reset(Factory::Create(d, Factory::Options(Sdc::SCHEME_CATMARK, Sdc::Options())));
    const Bfr::RefinerSurfaceFactory<> factory(*state_->refiner, {});
    if (!factory.InitVertexSurface(4, &state_->surface) || !state_->surface.IsRegular()) throw std::logic_error("the middle face is not regular");
    state_->points.resize(3 * static_cast<std::size_t>(state_->surface.GetNumPatchPoints()));
    state_->surface.PreparePatchPoints(positions.data(), 3, state_->points.data(), 3);
}
BareBfr::~BareBfr() = default;

void BareBfr::evaluate(double u, double v, double* p) const {
    const double uv[2] = {u, v};
    state_->surface.Evaluate(uv, state_->points.data(), 3, p, p + 3, p + 6);
}

}  // namespace isoparm::bench
