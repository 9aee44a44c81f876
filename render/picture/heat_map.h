// heat_map.h -- a mesh whose triangles are coloured by a number of each: where the error is.
#pragma once
#include <string>

#include "image/image.h"
#include "meshes/mesh_error.h"
#include "scene/scene.h"

namespace isoparm {

struct HeatMap {
    const Mesh& mesh;
    const TriangleNumbers& values;  // of each triangle, >= 0
    double top = 1;                 // the number of the brightest colour; the darkest is a hundredth of it, and less
    std::string title, bar;         // prose; what the colours mean
};

/// Seen by that camera, which is moved until all of the mesh is in the picture, with edges where triangles are large enough, a title
/// and a bar of the colours with numbers. Opaque, on white. The same for every number of threads.
Image draw_heat_map(const HeatMap& map, const CameraSettings& camera, int width, int height);

}  // namespace isoparm
