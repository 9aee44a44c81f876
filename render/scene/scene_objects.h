// scene_objects.h -- the list "objects" of a scene file: what is drawn and how it looks.
#pragma once
#include "scene/scene_builder.h"

namespace isoparm {

/// Throws LocatedError: where, what was found, what was expected.
void must_be_object(const Json& j, const std::string& what);
SceneObject read_object(const Json& j, SceneBuilder& builder);
/// A number of pixels from 0.01 to `most`, or a text such as "0.5pt": points of the printed picture.
Extent read_pixels(const Json& j, const SceneValues& values, double most, const std::string& what);
/// A text as labels have it; `prose` as in math_text.h.
MathText read_math_text(const Json& j, const SceneValues& values, bool prose);

}  // namespace isoparm
