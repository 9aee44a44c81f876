#include "labels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "flat_lines.h"
#include "text_cairo.h"

namespace isoparm {
namespace {

// What a place costs. Nothing may lie outside or on another label if there is any other place.
constexpr double kOutside = 1000, kOnLabel = 300, kOnLine = 9, kWrongSide = 2, kFar = 1.0, kNextAnchor = 0.5,
                 kHidden = 6;

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

    TextPlace place(const LabelRequest& request, double& seen) {
        TextPlace best{};
        double least = INFINITY;
        for (std::size_t k = 0; k < request.anchors.size(); ++k)
            for (int side = 0; side < 9; ++side)
                for (const double far : {0.0, 1.0, 2.2}) {
                    if (request.side < 0 ? side == 8 : request.side != side) continue;
                    const Anchor& anchor = request.anchors[k];
                    const TextPlace there = candidate(request, anchor, side, far);
                    const double cost =
                        cost_of(there, request, anchor, side, far) + kNextAnchor * static_cast<double>(k);
                    if (cost < least) least = cost, best = there, best.text.anchor = anchor.at, seen = anchor.seen;
                }
        taken_.push_back(grown(best, 0.12 * request.size));
        return best;
    }

private:
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
        const Box box = grown(t, 0.1 * request.size);
        double cost =
            kOutside * (1 - common(box, picture_).area() / box.area()) + kFar * far + kHidden * (1 - anchor.seen);
        for (const Box& other : taken_)
            if (const double both = common(box, other).area(); both > 0) cost += kOnLabel * (0.2 + both / box.area());
        double covered = 0;
        for (const Obstacle& o : obstacles_) {
            const double in = 0.1 * request.size + o.radius - distance_to(box, o.at);
            if (in > 0) covered += std::min(1.0, in / (0.1 * request.size));
        }
        cost += kOnLine * covered / request.size * 4;
        const double away = std::hypot(anchor.away.x, anchor.away.y);
        if (side < 8 && away > 0) {
            const auto [x, y] = direction(side);
            cost += kWrongSide * (1 - (x * anchor.away.x + y * anchor.away.y) / away);
        }
        return cost;
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
    TextPlace t = centred_text(text, size, at);
    // To the side until the box clears a disc of radius `gap`: along x or y its edge, diagonally its corner.
    const double half_width = 0.5 * (t.right - t.left), half_height = 0.5 * (t.bottom - t.top);
    const auto shift = [&](double d, double half) {
        return std::fabs(d) < 1e-9
                   ? 0.0
                   : d * gap + std::copysign(half * std::min(1.0, std::fabs(d) / std::numbers::sqrt2 * 2), d);
    };
    const double dx = shift(x, half_width), dy = shift(y, half_height);
    t.text.at.x += dx, t.left += dx, t.right += dx;
    t.text.at.y += dy, t.top += dy, t.bottom += dy;
    return t;
}

void place_labels(const std::vector<LabelRequest>& requests, const std::vector<Obstacle>& obstacles, int width,
                  int height, Drawing& drawing) {
    Placer placer(obstacles, width, height);
    for (const LabelRequest& r : requests) {
        if (r.anchors.empty() || r.label->text.empty()) continue;
        double seen = 1;
        const TextPlace t = placer.place(r, seen);
        const double opacity = opacity_of(r.label->hidden, seen);
        if (opacity >= 0.02) drawing.push_back({t.text, r.color, opacity});
    }
}

}  // namespace isoparm
