#include "meshes/certificate_cover.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "error.h"

namespace isoparm {
namespace {

std::string text_of(const Vec2& p) {
    std::string text = "(";
    return text += to_text(p.x) + ", " + to_text(p.y) + ")";
}

/// The sign of u + v - 1, without rounding.
int beyond_third(const Vec2& p) {
    const double sum = p.x + p.y, part = sum - p.x, rest = (p.x - (sum - part)) + (p.y - part);
    const double over = sum != 1 ? sum - 1 : rest;
    return (over > 0) - (over < 0);
}
bool on_third(const Vec2& p) { return beyond_third(p) == 0; }

bool inside(const Interval& x, const Interval& of) { return x.lo >= of.lo && x.hi <= of.hi; }

/// The coordinate of the control point of an edge that is nearer to a; exact where the edge lies along a line of the domain.
Interval control(double a, double b, double slide) { return a == b && slide == 0 ? Interval(a) : (Interval(2) * Interval(a) + Interval(b)) / Interval(3) + Interval(slide); }

/// Where in a cubic the control points of edge k stand, from corner k to k + 1; and the corners.
constexpr int kEdge[3][2] = {{1, 3}, {7, 8}, {5, 2}}, kCorner[3] = {0, 6, 9}, kMiddle = 4;

}  // namespace

bool Cover::Side::holds(const Vec2& p) const { return third ? on_third(p) : (vertical ? p.x : p.y) == level; }

Cover::Cover(const Patch& patch, const CertifiedPatch& claim) : patch_(patch), claim_(claim), us_(patch.lines_u()), vs_(patch.lines_v()) {
    const Rect r = patch.rect();
    if (patch.domain() == Domain::triangle) sides_ = {{false, false, 0, 1, 0, 1}, {false, true, 1, 1, 0, 1}, {true, false, 0, -1, -1, 0}};
    else sides_ = {{false, false, r.v0, 1, r.u0, r.u1}, {true, false, r.u1, 1, r.v0, r.v1}, {false, false, r.v1, -1, -r.u1, -r.u0}, {true, false, r.u0, -1, -r.v1, -r.v0}};
}

std::string Cover::fault() const {
    for (std::size_t t = 0; t < claim_.triangles.size(); ++t)
        if (const std::string f = triangle_fault(claim_.triangles[t]); !f.empty()) return "triangle " + std::to_string(t) + " " + f;
    return edge_fault();
}

Box Cover::cell_of(const CertifiedTriangle& t) const {
    const Vec2 &a = claim_.uv[t.corner[0]], &b = claim_.uv[t.corner[1]], &c = claim_.uv[t.corner[2]];
    const auto between = [](const std::vector<double>& lines, double low) {
        const auto above = std::upper_bound(lines.begin() + 1, lines.end() - 1, low);
        return Interval(*(above - 1), *above);
    };
    return {between(us_, std::min({a.x, b.x, c.x})), between(vs_, std::min({a.y, b.y, c.y}))};
}

CertifiedNet Cover::net_of(const CertifiedTriangle& t) const {
    CertifiedNet n;
    for (int k = 0; k < 3; ++k) {
        const Vec2 &a = claim_.uv[t.corner[k]], &b = claim_.uv[t.corner[(k + 1) % 3]];
        const auto& [w, z] = t.slide[k];
        n.u[kCorner[k]] = a.x, n.u[kEdge[k][0]] = control(a.x, b.x, w.x), n.u[kEdge[k][1]] = control(b.x, a.x, z.x);
        n.v[kCorner[k]] = a.y, n.v[kEdge[k][0]] = control(a.y, b.y, w.y), n.v[kEdge[k][1]] = control(b.y, a.y, z.y);
    }
    // The one inside reproduces quadratics, or where that leaves the cell, is the middle of the corners.
    const Box cell = cell_of(t);
    const auto middle = [](const std::array<Interval, 10>& c) { return (c[0] + c[6] + c[9]) / Interval(3); };
    const auto inner = [](const std::array<Interval, 10>& c) { return (c[1] + c[2] + c[3] + c[5] + c[7] + c[8]) / Interval(4) - (c[0] + c[6] + c[9]) / Interval(6); };
    n.u[kMiddle] = inner(n.u), n.v[kMiddle] = inner(n.v);
    if (!inside(n.u[kMiddle], cell.u) || !inside(n.v[kMiddle], cell.v) || (patch_.domain() == Domain::triangle && (n.u[kMiddle] + n.v[kMiddle]).hi > 1))
        n.u[kMiddle] = middle(n.u), n.v[kMiddle] = middle(n.v);
    return n;
}

std::string Cover::triangle_fault(const CertifiedTriangle& t) const {
    for (const auto c : t.corner)
        if (c >= claim_.uv.size()) return "names corner " + std::to_string(c) + " of " + std::to_string(claim_.uv.size());
    const Box cell = cell_of(t);
    const bool triangle = patch_.domain() == Domain::triangle;
    const Vec2 *p[3];
    for (int k = 0; k < 3; ++k) {
        p[k] = &claim_.uv[t.corner[k]];
        if (!inside(p[k]->x, cell.u) || !inside(p[k]->y, cell.v) || (triangle && beyond_third(*p[k]) > 0)) return "leaves the domain, or crosses a break, at " + text_of(*p[k]);
    }
    const CertifiedNet net = net_of(t);
    for (int k = 0; k < 3; ++k)
        for (int half = 0; half < 2; ++half) {
            const Vec2& w = t.slide[k][half];
            const Interval &u = net.u[kEdge[k][half]], &v = net.v[kEdge[k][half]];
            const bool below = !triangle || (on_third(*p[k]) && on_third(*p[(k + 1) % 3]) && w.x == -w.y) || (u + v).hi <= 1;
            if (!inside(u, cell.u) || !inside(v, cell.v) || !below) return "slides out of the domain, or over a break, from edge " + std::to_string(k);
        }
    const Interval ax = Interval(p[1]->x) - p[0]->x, ay = Interval(p[1]->y) - p[0]->y, bx = Interval(p[2]->x) - p[0]->x, by = Interval(p[2]->y) - p[0]->y;
    return (ax * by - ay * bx).lo > 0 ? "" : "is not counter-clockwise in the domain";
}

/// Every edge is there twice, once each way and with the same slide, or is a piece of the border; these pieces are the border, once.
std::string Cover::edge_fault() const {
    struct Edge {
        std::uint32_t low, high;
        bool up;
        const std::array<Vec2, 2>* slide;
    };
    std::vector<Edge> edges;
    for (const CertifiedTriangle& t : claim_.triangles)
        for (int k = 0; k < 3; ++k) {
            const auto a = t.corner[k], b = t.corner[(k + 1) % 3];
            edges.push_back({std::min(a, b), std::max(a, b), a < b, &t.slide[k]});
        }
    std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) { return a.low != b.low ? a.low < b.low : a.high != b.high ? a.high < b.high : a.up < b.up; });
    std::vector<std::vector<std::array<double, 2>>> border(sides_.size());
    for (std::size_t i = 0, n = 0; i < edges.size(); i += n) {
        const Edge& e = edges[i];
        for (n = 1; i + n < edges.size() && edges[i + n].low == e.low && edges[i + n].high == e.high;) ++n;
        const std::string name = "edge " + text_of(claim_.uv[e.low]) + " - " + text_of(claim_.uv[e.high]);
        if (n > 2 || (n == 2 && edges[i + 1].up == e.up)) return name + " belongs to triangles that overlap";
        const auto same = [](const Vec2& a, const Vec2& b) { return a.x == b.x && a.y == b.y; };
        if (n == 2 && !(same((*e.slide)[0], (*edges[i + 1].slide)[1]) && same((*e.slide)[1], (*edges[i + 1].slide)[0]))) return name + " slides differently in its two triangles";
        if (n == 2) continue;
        const Vec2 &from = claim_.uv[e.up ? e.low : e.high], &to = claim_.uv[e.up ? e.high : e.low];
        const auto side = std::find_if(sides_.begin(), sides_.end(), [&](const Side& s) { return s.holds(from) && s.holds(to) && s.at(from) < s.at(to) && s.along((*e.slide)[0]) && s.along((*e.slide)[1]); });
        if (side == sides_.end()) return name + " has one triangle only and is no piece of the domain's border, or slides off it";
        border[std::size_t(side - sides_.begin())].push_back({side->at(from), side->at(to)});
    }
    return border_fault(border);
}

/// The pieces of each side are the side, once.
std::string Cover::border_fault(std::vector<std::vector<std::array<double, 2>>>& border) const {
    for (std::size_t k = 0; k < sides_.size(); ++k) {
        std::sort(border[k].begin(), border[k].end());
        double reached = sides_[k].from;
        for (const auto& piece : border[k]) {
            if (piece[0] != reached) break;
            reached = piece[1];
        }
        if (border[k].empty() || reached != sides_[k].to || border[k].back()[1] != reached) return "side " + std::to_string(k) + " of the domain is not covered once";
    }
    return "";
}

std::string lost_fault(const Certificate& all) {
    std::vector<std::uint32_t> place(all.points.size()), order(all.points.size());
    for (std::uint32_t i = 0; i < order.size(); ++i) order[i] = i;
    const auto before = [&](std::uint32_t a, std::uint32_t b) {
        const Point &p = all.points[a], &q = all.points[b];
        return p.x != q.x ? p.x < q.x : p.y != q.y ? p.y < q.y : p.z < q.z;
    };
    std::sort(order.begin(), order.end(), before);
    for (std::size_t i = 0; i < order.size(); ++i) place[order[i]] = i > 0 && !before(order[i - 1], order[i]) ? place[order[i - 1]] : order[i];
    std::set<std::array<std::uint32_t, 2>> lost;  // a point is an edge with equal ends
    const auto each = [&](bool flat, auto use) {
        for (const CertifiedPatch& p : all.patches)
            for (const CertifiedTriangle& t : p.triangles) {
                std::array<std::uint32_t, 3> x{};
                for (int k = 0; k < 3; ++k) x[k] = place[p.vertex[t.corner[k]]];
                std::sort(x.begin(), x.end());
                if ((x[0] == x[1] || x[1] == x[2]) == flat) use(x);
            }
    };
    each(true, [&](const auto& x) { lost.insert({x[0], x[2]}); });
    if (!lost.empty())
        each(false, [&](const auto& x) {
            for (int i = 0; i < 3; ++i)
                for (int j = i; j < 3; ++j) lost.erase({x[i], x[j]});
        });
    if (lost.empty()) return "";
    const Point& p = all.points[(*lost.begin())[0]];
    return "a part of the surface at (" + to_text(p.x) + ", " + to_text(p.y) + ", " + to_text(p.z) + ") has triangles without area only, which no other triangle has as an edge";
}

}  // namespace isoparm
