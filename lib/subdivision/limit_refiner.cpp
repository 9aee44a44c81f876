#include "subdivision/limit_refiner.h"

#include <opensubdiv/far/error.h>
#include <opensubdiv/far/topologyDescriptor.h>
#include <opensubdiv/far/topologyRefinerFactory.h>

#include <algorithm>

#include "error.h"

namespace isoparm {
namespace {

namespace Far = OpenSubdiv::Far;
namespace Sdc = OpenSubdiv::Sdc;
using Factory = Far::TopologyRefinerFactory<Far::TopologyDescriptor>;

std::mutex& mutex() {
    static std::mutex m;
    return m;
}
std::string& text() {
    static std::string t;
    return t;
}
void add(const char* message) {
    if (text().size() > 1000) return;  // it may say the same of every face
    if (!text().empty()) text() += "; ";
    for (const char* c = message; *c; ++c) text() += *c == '\n' ? ' ' : *c;
}

Sdc::SchemeType scheme_type(Scheme scheme) {
    switch (scheme) {
        case Scheme::loop: return Sdc::SCHEME_LOOP;
        case Scheme::bilinear: return Sdc::SCHEME_BILINEAR;
        default: return Sdc::SCHEME_CATMARK;
    }
}

Sdc::Options scheme_options(const Cage& cage) {
    Sdc::Options options;
    options.SetVtxBoundaryInterpolation(cage.boundary == Cage::Boundary::none        ? Sdc::Options::VTX_BOUNDARY_NONE
                                        : cage.boundary == Cage::Boundary::edge_only ? Sdc::Options::VTX_BOUNDARY_EDGE_ONLY
                                                                                     : Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER);
    return options;
}

// From 10 on a crease is infinitely sharp, so nothing is lost by stopping there, and everything fits a float.
float sharpness(double s) { return static_cast<float>(std::min(s, double{Sdc::Crease::SHARPNESS_INFINITE})); }

}  // namespace

OsdMessages::OsdMessages() : lock_(mutex()) {
    text().clear();
    Far::SetErrorCallback([](Far::ErrorType, const char* message) { add(message); });
    Far::SetWarningCallback(add);
}
OsdMessages::~OsdMessages() {
    Far::SetErrorCallback(nullptr);
    Far::SetWarningCallback(nullptr);
}
void OsdMessages::throw_any() const {
    if (!text().empty()) throw_input("OpenSubdiv refuses the cage: " + text());
}

Refiner make_refiner(const Cage& cage, Scheme scheme, const OsdMessages& messages) {
    check_cage(cage, scheme);  // OpenSubdiv reads out of bounds where this does not hold
    std::vector<int> sizes, vertices, crease_ends, corners;
    std::vector<float> creases, corner_weights;
    for (const auto& f : cage.faces) {
        sizes.push_back(static_cast<int>(f.size()));
        vertices.insert(vertices.end(), f.begin(), f.end());
    }
    for (const auto& c : cage.creases) {
        crease_ends.insert(crease_ends.end(), {c.a, c.b});
        creases.push_back(sharpness(c.sharpness));
    }
    for (const auto& c : cage.corners) {
        corners.push_back(c.vertex);
        corner_weights.push_back(sharpness(c.sharpness));
    }
    Far::TopologyDescriptor d;
    d.numVertices = static_cast<int>(cage.positions.size());
    d.numFaces = static_cast<int>(sizes.size());
    d.numVertsPerFace = sizes.data();
    d.vertIndicesPerFace = vertices.data();
    d.numCreases = static_cast<int>(creases.size());
    d.creaseVertexIndexPairs = crease_ends.data();
    d.creaseWeights = creases.data();
    d.numCorners = static_cast<int>(corners.size());
    d.cornerVertexIndices = corners.data();
    d.cornerWeights = corner_weights.data();
    d.numHoles = static_cast<int>(cage.holes.size());
    d.holeIndices = cage.holes.data();

    Factory::Options options(scheme_type(scheme), scheme_options(cage));
    options.validateFullTopology = true;
    Refiner refiner(Factory::Create(d, options));
    messages.throw_any();
    if (!refiner) throw_input("OpenSubdiv refuses the cage without saying why");
    return refiner;
}

}  // namespace isoparm
