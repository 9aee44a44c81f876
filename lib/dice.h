// dice.h -- into how many cells a piece of a patch is cut to begin with.
#pragma once
#include <vector>

#include "bound.h"

namespace isoparm {

/// Second derivatives along u and v, per width of the box: along the normal, or of the vectors when parameters count.
struct Bend {
    Point uu, uv, vv;

    /// The square of that along the direction d.
    double along(const Vec2& d) const {
        const Point x = d.x * d.x * uu + 2 * d.x * d.y * uv + d.y * d.y * vv;
        return dot(x, x);
    }
};

/// Samples of the second derivatives over a box of a patch.
class Bends {
public:
    static constexpr int samples = 6;  // along each direction

    Bends(const Patch& patch, const Box& box, Measure measure);
    bool exist() const { return exist_; }
    const Bend& operator()(int i, int j) const { return bend_[i * samples + j]; }
    /// Does the surface bend less along the diagonal p to q than along the other one, r to s? By lengths in the domain where bends do not exist.
    bool less(const Vec2& p, const Vec2& q, const Vec2& r, const Vec2& s) const;

private:
    Box box_;
    bool exist_ = true;
    std::array<Bend, samples * samples> bend_;
};

/// Lines u = const and v = const of a grid over a box, the box's ends included. Two triangles a cell.
struct DiceGrid {
    std::vector<double> us, vs;
    double triangles() const { return 2.0 * double(us.size() - 1) * double(vs.size() - 1); }
};

/// The grid whose cells are as large as the tolerance allows almost everywhere: its number of lines and their density along
/// u and v come from second derivatives at samples, so that the fewest triangles are expected once those that fail are
/// bisected. An estimate, no proof; at most `most` triangles.
DiceGrid dice(const Bends& bends, const Box& box, double tolerance, Measure measure, double most);

/// The same for the triangular domain, whose box is the unit square: into how many parts each side is cut.
int dice_triangle(const Bends& bends, double tolerance, Measure measure, double most);

}  // namespace isoparm
