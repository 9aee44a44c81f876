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
    void cut_peaks();

    Box box_;
    bool exist_ = true;
    std::array<Bend, samples * samples> bend_;
};

/// A stack of rows of vertices over a box: lines across one parameter, and on each of them its own positions along the other one.
struct DiceGrid {
    bool columns = false;                   // lines are u = const, and rows run along v; else the other way round
    std::vector<double> lines;              // the box's ends included
    std::vector<std::vector<double>> rows;  // positions on each line, the box's ends included
    bool too_many = false;                  // a single cell because of that

    static DiceGrid single(const Box& box);
    double triangles() const;
    /// Positions along edge k of the box (0 v low, 1 u high, 2 v high, 3 u low), ends included.
    const std::vector<double>& side(int k) const { return (k == 0 || k == 2) == columns ? lines : k == 0 || k == 3 ? rows.front() : rows.back(); }
};

/// The grid whose cells are as large as the tolerance allows almost everywhere: the density of lines, and of vertices on each of
/// them, comes from second derivatives at samples, so that the fewest triangles are expected once those that fail are
/// bisected. An estimate, no proof; a single cell where more than `most` triangles would be needed.
DiceGrid dice(const Bends& bends, const Box& box, double tolerance, Measure measure, double most);

/// About how many triangles that grid would end with, whatever their number is; 1 where bends do not exist.
double dice_triangles(const Bends& bends, double tolerance, Measure measure);

/// The same for the triangular domain, whose box is the unit square: into how many parts each side is cut.
int dice_triangle(const Bends& bends, double tolerance, Measure measure, double most);
/// About how many triangles that would end with, whatever their number is.
double dice_triangle_triangles(const Bends& bends, double tolerance, Measure measure);

}  // namespace isoparm
