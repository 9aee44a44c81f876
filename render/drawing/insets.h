// insets.h -- enlarged parts of a picture in frames that lie over it.
#pragma once
#include "picture/panels.h"

namespace isoparm {

/// The view of an inset of a view.
View view_of(const Inset& inset, const View& parent);
/// The frames, what they enlarge, and lines between the two, of the picture whose views these are. `pixel`: pixels of the picture to
/// one of the scene's.
Drawing frames_of(const std::vector<View>& views, double pixel);

}  // namespace isoparm
