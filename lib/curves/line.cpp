#include "curves/line.h"

#include "curves/bezier.h"

namespace isoparm {
Curve make_line(const Point& p0, const Point& p1) { return make_bezier({p0, p1}); }
}  // namespace isoparm
