#include "subdivision/subdivision_face.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <utility>

#include "error.h"
#include "exact_parts.h"
#include "subdivision/subdivision_cell.h"
#include "subdivision/subdivision_vertex.h"

namespace isoparm {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr int kDeepest = 52;       // parameters of sub-faces stay exact
constexpr int kAllSmooth = 11;     // by then semi-sharp creases are smooth
constexpr int kMostMoves = 20;     // of the origin; each may add one unit in the last place of positions

/// What is left around a vertex.
struct Core {
    int node;
    double u, v;     // of the vertex
    Box3 vertex;     // its limit position
    std::optional<Point> normal;
};

class SubdivisionFace final : public Patch::Concept {
public:
    SubdivisionFace(const Ring<Interval>& ring, Scheme scheme, FaceLimits& limits) : scheme_(scheme) {
        nodes_.emplace_back();
        nodes_[0].at = {0, 0, 1};
        build(0, ring, {}, 0, limits);
        for (Core& c : cores_) {  // from the whole face: rings as small as cores have lost their digits
            const int k = c.u == 0 ? (c.v == 0 ? 0 : triangle() ? 2 : 3) : c.v == 0 ? 1 : 2;
            if ((c.u == 0 || c.u == 1) && (c.v == 0 || c.v == 1)) c.normal = limit_normal(ring, k, scheme);
        }
    }

    Domain domain() const override { return triangle() ? Domain::triangle : Domain::quad; }
    Rect rect() const override { return {}; }
    std::vector<double> breaks_u() const override { return {}; }
    std::vector<double> breaks_v() const override { return {}; }
    Point point(double u, double v) const override { return value(run<0>(u, v)); }
    PointJet jet(double u, double v) const override { return run<2>(u, v); }
    PointFrame frame(double u, double v) const override { return run<1>(u, v); }
    void points(std::size_t n, const double* u, const double* v, Point* out) const override {
        for (std::size_t k = 0; k < n; ++k) out[k] = point(u[k], v[k]);
    }
    void frames(std::size_t n, const double* u, const double* v, PointFrame* out) const override {
        for (std::size_t k = 0; k < n; ++k) out[k] = frame(u[k], v[k]);
    }
    void frame_arrays(Isa, std::span<const double> u, std::span<const double> v, const FrameArrays& out) const override {
        for (std::size_t k = 0; k < u.size(); ++k) {
            const PointFrame f = frame(u[k], v.size() == 1 ? v[0] : v[k]);
            for (int axis = 0; axis < 3; ++axis) out.position[axis][k] = f[axis].c[0], out.du[axis][k] = f[axis].c[1], out.dv[axis][k] = f[axis].c[2];
        }
    }
    std::vector<Polynomial> exact_cell(std::size_t i, std::size_t j) const override {
        const int level = dyadic_level(i);
        if (dyadic_level(j) != level) return {};
        const Node* n = &nodes_[0];
        for (int bit = level - 1; bit >= 0; --bit) {
            const bool right = ((i + 1) >> bit) & 1, up = ((j + 1) >> bit) & 1;
            if (n->children < 0 || (triangle() && right && up)) return {};
            n = &nodes_[n->children + (triangle() ? (right ? 1 : up ? 2 : 0) : right ? (up ? 2 : 1) : up ? 3 : 0)];
        }
        if (n->children >= 0) return {Polynomial(0)};
        if (n->cell < 0) return {};
        const auto& x = cells_[n->cell].exact;
        return {x.x, x.y, x.z};
    }
    std::optional<Point> singular_normal(double u, double v) const override {
        const Node& n = leaf(u, v);
        return n.core < 0 ? std::nullopt : cores_[n.core].normal;
    }

    // Second derivatives are continuous but at cores, so those of all cells that the box meets bound their change, though third ones jump.
    Enclosure enclose(const Box& box) const override {
        Enclosure e;
        e.u = mid(box.u), e.v = mid(box.v);
        if (std::any_of(cores_.begin(), cores_.end(), [&](const Core& c) { return meets(box, nodes_[c.node].at); })) {
            const Box3 positions = enclose_points(box), at = enclose_points({e.u, e.v});
            for (int axis = 0; axis < 3; ++axis) {
                std::fill(std::begin(e.over[axis].c), std::end(e.over[axis].c), Interval::all());
                std::fill(std::begin(e.centre[axis].c), std::end(e.centre[axis].c), Interval::all());
                e.over[axis].c[0] = positions[axis], e.centre[axis].c[0] = at[axis];
            }
            return e;
        }
        bool first = true;
        visit(0, box, [&](const Node& n) {
            if (n.over >= 0 && inside(n.at, box)) return add(e.over, overs_[n.over], first), false;
            if (n.cell >= 0) add(e.over, derivatives(cells_[n.cell], clipped(box, n.at)), first);
            return true;
        });
        const SubdivisionCell& c = cells_[leaf(e.u, e.v).cell];
        for (int axis = 0; axis < 3; ++axis) c.exact[axis].template jets<0>(c.u, c.v, e.u, e.v, &e.centre[axis], nullptr);
        return e;
    }
    Vec3<Interval> enclose_points(const Box& box) const override {
        Box3 all;
        bool first = true;
        const auto add = [&](const Box3& b) {
            all = first ? b : hull(all, b);
            first = false;
        };
        visit(0, box, [&](const Node& n) {
            const bool whole = inside(n.at, box);
            if (n.core >= 0 && box.u.lo == box.u.hi && box.v.lo == box.v.hi && box.u.lo == cores_[n.core].u && box.v.lo == cores_[n.core].v) add(cores_[n.core].vertex);
            else if (whole || n.core >= 0) add(n.hull);
            else if (n.cell >= 0) add(positions(cells_[n.cell], clipped(box, n.at)));
            return !whole;
        });
        return all;
    }

private:
    struct Node {
        FacePlace at{};
        int children = -1, cell = -1, core = -1;  // the first of four, or what it is
        int over = -1;                            // where there is no core inside
        Box3 hull;
    };
    bool triangle() const { return scheme_ == Scheme::loop; }

    static Box3 positions(const SubdivisionCell& c, const Box& box) {
        Box3 b;
        for (int axis = 0; axis < 3; ++axis) {
            JetUV<Interval, 0> x;
            c.exact[axis].template jets<0>(c.u, c.v, box.u, box.v, nullptr, &x);
            b[axis] = x.c[0];
        }
        return b;
    }
    using Derivatives = Vec3<JetUV<Interval, 3>>;
    static Derivatives derivatives(const SubdivisionCell& c, const Box& box) {
        Derivatives d;
        for (int axis = 0; axis < 3; ++axis) c.exact[axis].template jets<3>(c.u, c.v, box.u, box.v, nullptr, &d[axis]);
        return d;
    }
    static void add(Derivatives& all, const Derivatives& more, bool& first) {
        if (std::exchange(first, false)) all = more;
        else
            for (int axis = 0; axis < 3; ++axis)
                for (int k = 0; k < all.x.size; ++k) all[axis].c[k] = isoparm::hull(all[axis].c[k], more[axis].c[k]);
    }
    static bool inside(const FacePlace& at, const Box& box) {
        const Interval u = at.across_u(), v = at.across_v();
        return u.lo >= box.u.lo && u.hi <= box.u.hi && v.lo >= box.v.lo && v.hi <= box.v.hi;
    }
    static Box clipped(const Box& box, const FacePlace& at) { return {clip(box.u, at.across_u()), clip(box.v, at.across_v())}; }

    // Points are kept less an origin near them, so that what rounding adds shrinks with the pieces; `origin` is that of `given`.
    void build(int node, const Ring<Interval>& given, Box3 origin, int depth, FaceLimits& limits) {
        Ring<Interval> ring = given;
        if (depth <= kMostMoves) {
            const Point at = middle(ring.points[ring.faces[0][0]]);
            const Box3 by{at.x, at.y, at.z};
            for (Box3& p : ring.points) p = p - by;
            origin = origin + by;
        }
        const Subdivider<Interval> s(ring, scheme_);
        const FacePlace at = nodes_[node].at;
        if (++limits.pieces > limits.most_pieces)  // those that are refined count too: they can be all there is
            throw Error(ErrorKind::budget, "the limit surface takes more than " + std::to_string(limits.most_pieces) +
                                               " pieces, refined ones included; give semi-sharp creases less sharpness, or 10 for infinite, or split the cage");
        if (const auto control = s.regular()) {
            nodes_[node].cell = static_cast<int>(cells_.size());
            cells_.push_back(moved(make_subdivision_cell(*control, at, scheme_), origin));
            nodes_[node].hull = positions(cells_.back(), {at.across_u(), at.across_v()});
            nodes_[node].over = static_cast<int>(overs_.size());
            overs_.push_back(derivatives(cells_.back(), {at.across_u(), at.across_v()}));
            return;
        }
        const Box3 all = hull_of(ring);
        if (depth == kDeepest || (depth >= kAllSmooth && size_of(all) <= limits.core)) {
            nodes_[node].core = static_cast<int>(cores_.size());
            nodes_[node].hull = all + origin;
            int k = 0;  // the extraordinary corner
            while (k + 1 < static_cast<int>(ring.faces[0].size()) && s.regular_at(k)) ++k;
            cores_.push_back({node, k == 1 || (k == 2 && !triangle()) ? at.u + at.h : at.u, k >= 2 ? at.v + at.h : at.v, limit_position(ring, k, scheme_) + origin, {}});
            return;
        }
        const int first = static_cast<int>(nodes_.size());
        nodes_.resize(first + 4);
        nodes_[node].children = first;
        for (int k = 0; k < 4; ++k) {
            nodes_[first + k].at = at.child(k, triangle());
            build(first + k, s.child(k), origin, depth + 1, limits);
            nodes_[node].hull = k == 0 ? nodes_[first].hull : hull(nodes_[node].hull, nodes_[first + k].hull);
        }
        if (std::any_of(nodes_.begin() + first, nodes_.begin() + first + 4, [](const Node& n) { return n.over < 0; })) return;
        Derivatives together;
        bool none = true;
        for (int k = 0; k < 4; ++k) add(together, overs_[nodes_[first + k].over], none);
        nodes_[node].over = static_cast<int>(overs_.size());
        overs_.push_back(together);
    }

    const Node& leaf(double u, double v) const {
        const Node* n = &nodes_[0];
        while (n->children >= 0) {
            const double s = (u - n->at.u) / n->at.h, t = (v - n->at.v) / n->at.h;
            const int k = triangle() ? (s >= 0.5 ? 1 : t >= 0.5 ? 2 : s + t <= 0.5 ? 0 : 3) : s >= 0.5 ? (t >= 0.5 ? 2 : 1) : t >= 0.5 ? 3 : 0;
            n = &nodes_[n->children + k];
        }
        return *n;
    }

    /// Calls f for every node that the box meets (more than in an edge, where the box has an inside), children only where f says so.
    template <class F> void visit(int node, const Box& box, const F& f) const {
        const Node& n = nodes_[node];
        if (!meets(box, n.at) || !f(n) || n.children < 0) return;
        for (int k = 0; k < 4; ++k) visit(n.children + k, box, f);
    }
    bool meets(const Box& box, const FacePlace& at) const {
        const auto overlap = [](const Interval& x, const Interval& y) {
            return x.lo == x.hi ? x.lo >= y.lo && (x.lo < y.hi || (x.lo == 1 && y.hi == 1)) : x.lo < y.hi && x.hi > y.lo;
        };
        if (!triangle()) return overlap(box.u, at.across_u()) && overlap(box.v, at.across_v());
        // Closed here: lines of three directions bound the triangles.
        const auto touch = [](const Interval& x, const Interval& y) { return x.lo <= y.hi && x.hi >= y.lo; };
        const bool flat = box.u.lo == box.u.hi || box.v.lo == box.v.hi;
        const Interval u = at.across_u(), v = at.across_v();
        if (flat ? !touch(box.u, u) || !touch(box.v, v) : !overlap(box.u, u) || !overlap(box.v, v)) return false;
        const double line = at.u + at.v + at.h, low = box.u.lo + box.v.lo, high = box.u.hi + box.v.hi;  // sums of dyadic numbers; 1e-15 is for the box's
        return at.h > 0 ? low <= line + 1e-15 : high >= line - 1e-15;
    }

    template <int N> Vec3<JetUV<double, N>> run(double u, double v) const {
        const Node& n = leaf(u, v);
        Vec3<JetUV<double, N>> x;
        if (n.core >= 0) {
            const Point p = middle(cores_[n.core].vertex);
            for (int axis = 0; axis < 3; ++axis) {
                std::fill(std::begin(x[axis].c), std::end(x[axis].c), kNaN);
                x[axis].c[0] = p[axis];
            }
            return x;
        }
        const SubdivisionCell& cell = cells_[n.cell];
        const double dx = u - cell.u, dy = v - cell.v;
        const int d = cell.degree;
        for (int axis = 0; axis < 3; ++axis) {
            double rows[5][N + 1];  // Taylor coefficients along v of each row
            for (int i = 0; i <= d; ++i) taylor<N>(d, [&](int j) { return cell.c[(d + 1) * i + j][axis]; }, dy, rows[i]);
            for (int j = 0; j <= N; ++j) {
                double column[N + 1];
                taylor<N>(d, [&](int i) { return rows[i][j]; }, dx, column);
                for (int i = 0; i + j <= N; ++i) x[axis].c[JetUV<double, N>::index(i, j)] = column[i];
            }
        }
        return x;
    }
    /// By Horner's rule, out[k] = sum binomial(i,k) c(i) t^(i-k).
    template <int N, class C> static void taylor(int degree, C c, double t, double* out) {
        std::fill(out, out + N + 1, 0.0);
        for (int i = degree; i >= 0; --i) {
            for (int k = N; k > 0; --k) out[k] = out[k] * t + out[k - 1];
            out[0] = out[0] * t + c(i);
        }
    }
    static Point value(const Vec3<JetUV<double, 0>>& p) { return {p.x.c[0], p.y.c[0], p.z.c[0]}; }

    Scheme scheme_;
    std::vector<Node> nodes_;
    std::vector<SubdivisionCell> cells_;
    std::vector<Core> cores_;
    std::vector<Derivatives> overs_;
};

}  // namespace

Patch make_subdivision_face(const Ring<Interval>& ring, Scheme scheme, FaceLimits& limits) {
    return Patch(std::make_shared<SubdivisionFace>(ring, scheme, limits));
}

}  // namespace isoparm
