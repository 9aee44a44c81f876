// io/cage_obj.h -- subdivision cages as Wavefront OBJ with the tag lines of OpenSubdiv's regression shapes.
//
// Read: v, f (v, v/vt, v//vn, v/vt/vn; negative indices count back from the last vertex) and, with vertices and faces
// counted from 0,
//     t crease 2/1/0 V0 V1 SHARPNESS              several pairs: 4/1/0 or 4/2/0 ...
//     t corner 1/1/0 V SHARPNESS
//     t hole 1/0/0 FACE
//     t interpolateboundary 1/0/0 N               0: none, 1: edge and corner (the default), 2: edge only
// Texture, normals, groups, materials, points and lines carry no shape of the surface and are passed over.
#pragma once
#include <string>

#include "cage.h"

namespace isoparm {
/// `text` is the whole file, `path` is for messages only: they give path:line:column, what was found and what was
/// expected. Coordinates are finite and at most 1e100 in size; a face has 3 to 65535 vertices, all different; a crease
/// lies on an edge of a face. Throws Error(input). Safe to call from every thread.
Cage read_cage_obj(const std::string& text, const std::string& path);
}  // namespace isoparm
