#include "drawing/labels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "drawing/flat_lines.h"
#include "drawing/text_cairo.h"

namespace isoparm {
namespace {

// What a place costs. Nothing may lie outside or on another label if there is any other place.
constexpr double kOutside = 1000, kOnLabel = 300, kOnLine = 1.3, kMarkOnLine = 5, kWrongSide = 2, kFar = 1.0, kNextAnchor = 0.5,
                 kHidden = 6, kLeader = 6;
constexpr double kLeaderFrom = 1.5 * 0.66;  // from what a label names, in ems; a letter is 0.66 high
constexpr double kNear[] = {0.0, 1.0, 2.2}, kAway[] = {4.0, 6.0, 9.0};  // distances; at the latter always with leaders

struct Box {
    double left, top, right, bottom;
    double area() const { return std::max(0.0, right - left) * std::max(0.0, bottom - top); }
};
Box common(const Box& a, const Box& b) {
    return {std::max(a.left, b.left), std::max(a.top, b.top), std::min(a.right, b.right), std::min(a.bottom, b.bottom)};
}
Box grown(const TextPlace& t, double by) { return {t.left - by, t.top - by, t.right + by, t.bottom + by}; }

double distance_to(const Box& b, const Vec2& p) {
    return std::hypot(std::max({b.left - p.x, 0.0, p.x - b.right}), std::max({b.top - p.y, 0.0, p.y - b.bottom}));
}

class Placer {
public:
    Placer(const std::vector<Obstacle>& obstacles, int width, int height)
        : obstacles_(obstacles), picture_{0, 0, double(width), double(height)} {}

    struct Placed {
        TextPlace place{};
        const Anchor* anchor = nullptr;
        bool far = false;
    };
    Placed place(const LabelRequest& request) {
        const std::optional<bool> leader = request.side == 8 ? false : request.label->leader;
        Placed best;
        double least = INFINITY;
        const auto consider = [&](const Anchor& anchor, int side, double distance, bool far, double extra) {
            const TextPlace there = candidate(request, anchor, side, distance);
            far = far || (leader.value_or(true) && apart(there, request) > kLeaderFrom * request.size);
            const double cost = cost_of(there, request, anchor, side, distance) + extra + (far ? crossed(there, anchor, request.size) : 0);
            if (cost < least) least = cost, best = {there, &anchor, far};
        };
        for (std::size_t k = 0; k < request.anchors.size(); ++k)
            for (int side = 0; side < 9; ++side) {
                if (request.side < 0 ? side == 8 : request.side != side) continue;
                const double extra = kNextAnchor * static_cast<double>(k);
                if (!leader.value_or(false))
                    for (const double distance : kNear) consider(request.anchors[k], side, distance, false, extra);
                if (leader.value_or(true))
                    for (const double distance : kAway) consider(request.anchors[k], side, distance, true, extra + kLeader);
            }
        best.place.text.anchor = best.anchor->at;
        taken_.push_back(grown(best.place, 0.12 * request.size));
        if (best.far)
            for (const Vec2& p : along_leader(best.place, *best.anchor, request.size)) taken_.push_back({p.x - 1, p.y - 1, p.x + 1, p.y + 1});
        return best;
    }

    TextPlace place(const MarkRequest& request) {
        const MarkRequest::Place* best = nullptr;
        double least = INFINITY;
        for (const MarkRequest::Place& p : request.places)
            if (const double cost = p.cost + cost_of(p.at, p.at.text.size, kMarkOnLine); cost < least) least = cost, best = &p;
        taken_.push_back(grown(best->at, 0.12 * best->at.text.size));
        return best->at;
    }

private:
    /// From a label to the nearest place that it names.
    static double apart(const TextPlace& t, const LabelRequest& request) {
        double least = INFINITY;
        for (const Anchor& a : request.anchors) least = std::min(least, distance_to(grown(t, 0), a.at) - a.gap);
        return least;
    }
    static std::vector<Vec2> along_leader(const TextPlace& t, const Anchor& anchor, double size) {
        const auto line = leader_of(t.left, t.top, t.right, t.bottom, anchor, size);
        std::vector<Vec2> points;
        constexpr int n = 16;
        for (int i = 0; !line.empty() && i <= n; ++i)
            points.push_back({line[0].x + (line[1].x - line[0].x) * i / n, line[0].y + (line[1].y - line[0].y) * i / n});
        return points;
    }
    /// What a leader costs that goes over other labels.
    double crossed(const TextPlace& t, const Anchor& anchor, double size) const {
        for (const Vec2& p : along_leader(t, anchor, size))
            for (const Box& other : taken_)
                if (p.x > other.left && p.x < other.right && p.y > other.top && p.y < other.bottom) return kOnLabel * 0.2;
        return 0;
    }
    static std::array<double, 2> direction(int side) {
        const double angle = side * std::numbers::pi / 4;
        return {std::cos(angle), -std::sin(angle)};
    }
    static TextPlace candidate(const LabelRequest& request, const Anchor& anchor, int side, double far) {
        if (side == 8) return centred_text(request.label->text, request.size, anchor.at);
        const auto [x, y] = direction(side);
        return text_beside(request.label->text, request.size, anchor.at, x, y,
                           anchor.gap + (0.22 + 0.45 * far) * request.size);
    }
    double cost_of(const TextPlace& t, const LabelRequest& request, const Anchor& anchor, int side, double far) const {
        double cost = cost_of(t, request.size, kOnLine) + kFar * far + kHidden * (1 - anchor.seen);
        const double away = std::hypot(anchor.away.x, anchor.away.y);
        if (side < 8 && away > 0) {
            const auto [x, y] = direction(side);
            cost += kWrongSide * (1 - (x * anchor.away.x + y * anchor.away.y) / away);
        }
        return cost;
    }
    /// Of what a text covers.
    double cost_of(const TextPlace& t, double size, double on_line) const {
        const Box box = grown(t, 0.1 * size);
        double cost = kOutside * (1 - common(box, picture_).area() / box.area());
        for (const Box& other : taken_)
            if (const double both = common(box, other).area(); both > 0) cost += kOnLabel * (0.2 + both / box.area());
        double covered = 0;
        for (const Obstacle& o : obstacles_) {
            const double in = 0.1 * size + o.radius - distance_to(box, o.at);
            if (in > 0) covered += std::min(1.0, in / (0.1 * size));
        }
        return cost + on_line * covered;
    }

    const std::vector<Obstacle>& obstacles_;
    Box picture_;
    std::vector<Box> taken_;
};

}  // namespace

double halo_of(double size) { return 0.09 * size; }

TextPlace centred_text(const MathText& text, double size, const Vec2& middle) {
    const TextBox box = text_box(text, size);
    const double x = middle.x - 0.5 * (box.left + box.right), y = middle.y - 0.5 * (box.top + box.bottom);
    return {{{x, y}, size, text, halo_of(size)}, x + box.left, y + box.top, x + box.right, y + box.bottom};
}

TextPlace text_beside(const MathText& text, double size, const Vec2& at, double x, double y, double gap) {
    return beside(centred_text(text, size, at), x, y, gap);
}

TextPlace shifted(TextPlace t, const Vec2& by) {
    t.text.at.x += by.x, t.left += by.x, t.right += by.x;
    t.text.at.y += by.y, t.top += by.y, t.bottom += by.y;
    return t;
}

TextPlace beside(TextPlace t, double x, double y, double gap) {
    // To the side until the box clears a disc of radius `gap`: along x or y its edge, diagonally its corner.
    const double half_width = 0.5 * (t.right - t.left), half_height = 0.5 * (t.bottom - t.top);
    const auto shift = [&](double d, double half) {
        return std::fabs(d) < 1e-9
                   ? 0.0
                   : d * gap + std::copysign(half * std::min(1.0, std::fabs(d) / std::numbers::sqrt2 * 2), d);
    };
    return shifted(std::move(t), {shift(x, half_width), shift(y, half_height)});
}

std::vector<Vec2> leader_of(double left, double top, double right, double bottom, const Anchor& anchor, double size) {
    // From the point of the box that is nearest to the anchor, a little off the letters.
    const double rim = 0.12 * size;
    const Vec2 from{std::clamp(anchor.at.x, left - rim, right + rim), std::clamp(anchor.at.y, top - rim, bottom + rim)};
    const double x = anchor.at.x - from.x, y = anchor.at.y - from.y, pixels = std::hypot(x, y), stop = anchor.gap + 0.08 * size;
    if (!(pixels > stop + 0.3 * size)) return {};
    return {from, {anchor.at.x - x / pixels * stop, anchor.at.y - y / pixels * stop}};
}

void place_labels(const std::vector<LabelRequest>& requests, const std::vector<Obstacle>& obstacles, int width,
                  int height, Drawing& drawing, const std::vector<MarkRequest>& marks) {
    Placer placer(obstacles, width, height);
    for (const MarkRequest& m : marks) drawing.push_back({placer.place(m).text, m.color, m.opacity});
    for (const LabelRequest& r : requests) {
        if (r.anchors.empty() || r.label->text.empty()) continue;
        const auto [t, anchor, far] = placer.place(r);
        // A leader says that what it names is behind something: it is faint and dashed itself.
        const double opacity = opacity_of(r.label->hidden, far ? 1 : anchor->seen);
        if (opacity < 0.02) continue;
        if (const auto line = leader_of(t.left, t.top, t.right, t.bottom, *anchor, r.size); far && !line.empty()) {
            const double width = 0.045 * r.size;
            const bool behind = anchor->seen < 0.5;
            drawing.push_back({Polyline{line, width, behind ? std::vector<double>{4 * width, 3 * width} : std::vector<double>{}, !behind}, r.color, 0.75 * opacity});
        }
        drawing.push_back({t.text, r.color, opacity});
    }
}

}  // namespace isoparm
