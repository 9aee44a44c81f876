#include "drawing/axes.h"

#include <algorithm>
#include <cmath>

#include "drawing/flat_lines.h"

namespace isoparm {
namespace {

// Lengths in the size of the letters, those of the first line times 27.648: what letters of a picture of 768 rows have.
constexpr double kMark = 1 / 27.648, kArrow = 13 * kMark, kArrowHalf = 4 * kMark, kTick = 6 * kMark, kBeyond = 34 * kMark;
constexpr double kNumber = 0.85, kGap = 0.22, kApart = 3.4;

Vec2 operator+(const Vec2& a, const Vec2& b) { return {a.x + b.x, a.y + b.y}; }
Vec2 operator-(const Vec2& a, const Vec2& b) { return {a.x - b.x, a.y - b.y}; }
Vec2 operator*(double s, const Vec2& a) { return {s * a.x, s * a.y}; }
double length(const Vec2& a) { return std::hypot(a.x, a.y); }

/// Digits behind the point that tell all numbers apart.
int digits_of(const std::vector<double>& ticks) {
    for (int digits = 0; digits < 9; ++digits) {
        const double unit = std::pow(10, -digits);
        if (std::all_of(ticks.begin(), ticks.end(), [&](double t) {
                return std::fabs(t - std::round(t / unit) * unit) <= 1e-6 * std::max(unit, std::fabs(t));
            }))
            return digits;
    }
    return 9;
}

class Drawer {
public:
    Drawer(const SceneObject& o, const Color& color, const Sight& sight, double pixel, double letter,
           std::vector<Obstacle>& obstacles, std::vector<MarkRequest>& marks, Drawing& drawing)
        : o_(o),
          axes_(o.axes),
          color_(color),
          sight_(sight),
          camera_(sight.camera()),
          pixel_(pixel),
          letter_(letter),
          obstacles_(obstacles),
          marks_(marks),
          drawing_(drawing) {}

    void run() {
        const auto ends = ends_of(axes_);
        for (const Point& p : ends) clear_ = std::max(clear_, 0.04 * distance(p, ends.front()));
        for (int k = 0; k < 3; ++k)
            if (axes_.axis[k]) add(k, *axes_.axis[k]);
    }

private:
    Point at(int k, double value) const {
        Point p = axes_.origin;
        p[k] = value;
        return p;
    }
    bool visible(const Point& p) const { return camera_.depth(p) > 0; }

    void add(int k, const Axes::Axis& axis) {
        const Point a = at(k, axis.low), b = at(k, axis.high);
        if (!visible(a) || !visible(b)) return;
        const Vec2 low = camera_.project(a), high = camera_.project(b);
        const double pixels = length(high - low);
        if (!(pixels > 2)) return;  // along the view
        const Vec2 along = (1 / pixels) * (high - low), out = outward(k, along);
        const double unit = (axis.high - axis.low) / pixels;  // scene units a pixel, about

        const Point tip = at(k, beyond(k, axis.high, kBeyond * letter_, unit)), neck = at(k, beyond(k, axis.high, (kBeyond - 0.8 * kArrow) * letter_, unit));
        line({a, neck});
        if (visible(tip)) arrow(tip, along);
        const auto ticks = axis.ticks ? *axis.ticks : round_ticks(axis.low, axis.high, kApart * letter_ * unit);
        for (const double t : ticks) tick(k, t, out);
        numbers(k, axis, ticks, out, unit);
        if (!axis.name.empty() && visible(tip))
            text(axis.name, letter_, camera_.project(tip) - (0.3 * kArrow * letter_) * along, 0, out,
                 kGap * letter_ + kArrowHalf * letter_, tip);
    }

    /// Where the axis is so many pixels beyond its end; less where that is behind the eye, or so far away that it is never reached. `unit`: scene units a pixel, about.
    double beyond(int k, double end, double pixels, double unit) const {
        const Vec2 from = camera_.project(at(k, end));
        const auto reached = [&](double value) { return !visible(at(k, value)) || length(camera_.project(at(k, value)) - from) >= pixels; };
        double low = end, high = end + pixels * unit;
        for (int i = 0; i < 6 && !reached(high); ++i) low = high, high = end + 2 * (high - end);
        for (int i = 0; i < 60; ++i) {
            const double middle = 0.5 * low + 0.5 * high;
            (reached(middle) ? high : low) = middle;
        }
        return low;
    }

    /// Across the axis, away from the middle of what the axes span; down or to the left when they do not tell.
    Vec2 outward(int k, const Vec2& along) const {
        Vec2 out{-along.y, along.x};
        Point middle = axes_.origin;
        for (int i = 0; i < 3; ++i)
            if (axes_.axis[i]) middle[i] = 0.5 * (axes_.axis[i]->low + axes_.axis[i]->high);
        const Vec2 m = visible(middle) ? camera_.project(middle) - camera_.project(at(k, middle[k])) : Vec2{};
        const double side = m.x * out.x + m.y * out.y;
        const bool turn = std::fabs(side) > 2 ? side > 0 : out.y - out.x < 0;
        return turn ? -1.0 * out : out;
    }

    LineLook look() const { return {color_, o_.opacity, o_.line.width * pixel_, {}, o_.line.hidden}; }
    void line(const std::array<Point, 2>& ends) {
        const auto points = fine_points({straight(ends[0], ends[1])}, camera_);
        add_line(points, look(), sight_, clear_, drawing_);
        for (const Point& p : points) obstacles_.push_back({camera_.project(p), 0.5 * o_.line.width * pixel_});
    }
    double opacity(const Point& p) const {
        const double ball = sight_.ball_about(p), small = letter_ * camera_.pixel_size(camera_.depth(p));
        return o_.opacity * opacity_of(o_.line.hidden, o_.line.hidden == Hidden::show ? 1 : sight_.of(p, ball <= small ? std::max(clear_, 1.01 * ball) : clear_));
    }

    void arrow(const Point& tip, const Vec2& along) {
        const Vec2 p = camera_.project(tip), across{-along.y, along.x};
        const double size = letter_ * std::max(1.0, o_.line.width / 1.5);
        const Vec2 base = p - (kArrow * size) * along, notch = p - (0.75 * kArrow * size) * along;
        drawing_.push_back(
            {Filled{{p, base + (kArrowHalf * size) * across, notch, base - (kArrowHalf * size) * across}}, color_,
             opacity(tip)});
    }
    void tick(int k, double value, const Vec2& out) {
        const Point p = at(k, value);
        if (!visible(p)) return;
        const Vec2 q = camera_.project(p);
        drawing_.push_back(
            {Polyline{{q, q + (kTick * letter_) * out}, 0.8 * o_.line.width * pixel_, {}, false}, color_, opacity(p)});
    }
    void numbers(int k, const Axes::Axis& axis, const std::vector<double>& ticks, const Vec2& out, double unit) {
        const int digits = digits_of(ticks);
        const auto [crossed, same, first] = others(k);
        for (std::size_t i = 0; i < ticks.size(); ++i) {
            const double t = ticks[i];
            const bool named = i < axis.tick_texts.size() && !axis.tick_texts[i].empty();
            const MathText mark = named ? axis.tick_texts[i] : number_text(t, digits);
            const Point p = at(k, t);
            if (!visible(p)) continue;
            const Vec2 q = camera_.project(p);
            const bool crossing = crossed && std::fabs(t - axes_.origin[k]) < 0.5 * kNumber * letter_ * unit;
            if (crossing && same && !named) {  // the number of all axes: once, between them
                if (first)
                    text(mark, kNumber * letter_, q, 0, diagonal(k, out), 0.7 * kGap * letter_, p);
            } else if (crossing && named && !at_its_end(k)) {
                text(mark, kNumber * letter_, q, 0, diagonal(k, out), 0.7 * kGap * letter_, p);
            } else if (!crossing || at_its_end(k)) {
                text(mark, kNumber * letter_, q, kTick * letter_, out, kGap * letter_, p);
            }
        }
    }
    struct Others {
        bool any = false, same = true, first = true;  // they cross at the same number; they come after axis k
    };
    Others others(int k) const {
        Others r;
        for (int i = 0; i < 3; ++i) {
            if (i == k || !axes_.axis[i]) continue;
            r.any = true;
            r.same = r.same && axes_.origin[i] == axes_.origin[k];
            r.first = r.first && i > k;
        }
        return r;
    }
    /// The other axes begin where they cross this one: a number there is in nobody's way.
    bool at_its_end(int k) const {
        for (int i = 0; i < 3; ++i)
            if (i != k && axes_.axis[i] && axes_.axis[i]->low < axes_.origin[i]) return false;
        return true;
    }
    Vec2 diagonal(int k, const Vec2& out) const {
        Vec2 sum = out;
        for (int i = 0; i < 3; ++i) {
            if (i == k || !axes_.axis[i] || !visible(at(i, axes_.axis[i]->low)) || !visible(at(i, axes_.axis[i]->high)))
                continue;
            const Vec2 d = camera_.project(at(i, axes_.axis[i]->high)) - camera_.project(at(i, axes_.axis[i]->low));
            if (length(d) > 2) sum = sum + outward(i, (1 / length(d)) * d);
        }
        return length(sum) > 0.1 ? (1 / length(sum)) * sum : out;
    }

    /// Beside `at`, on the side `out`, beyond a tick that is `tick` long; or, where that covers something, farther out, along the axis, or on
    /// the other side, where no tick is.
    void text(const MathText& what, double size, const Vec2& at, double tick, const Vec2& out, double gap,
              const Point& place) {
        constexpr double kFarther[] = {0, 0.35, 0.8}, kAside[] = {0, 0.6, -0.6, 1.2, -1.2};  // ems
        constexpr double kOtherSide = 1.2;
        MarkRequest mark{{}, color_, opacity(place)};
        const Vec2 along{-out.y, out.x};
        const TextPlace centred = centred_text(what, size, at);
        for (const double side : {1.0, -1.0})
            for (const double farther : kFarther)
                for (const double aside : kAside) {
                    const Vec2 by = (side > 0 ? tick : 0) * out + (aside * size) * along;
                    mark.places.push_back({beside(shifted(centred, by), side * out.x, side * out.y, gap + farther * size), (side > 0 ? 0 : kOtherSide) + farther + std::fabs(aside)});
                }
        marks_.push_back(std::move(mark));
    }

    const SceneObject& o_;
    const Axes& axes_;
    Color color_;
    const Sight& sight_;
    const Camera& camera_;
    double pixel_, letter_;
    double clear_ = 0;  // what is so close to an axis does not hide it; nor does a ball no larger than a letter hide the tick and the number that it is about
    std::vector<Obstacle>& obstacles_;
    std::vector<MarkRequest>& marks_;
    Drawing& drawing_;
};

}  // namespace

std::vector<double> round_ticks(double low, double high, double least) {
    if (!(high > low) || !(least > 0)) return {};
    double step = std::pow(10, std::floor(std::log10(least)));
    for (const double factor : {1.0, 2.0, 5.0, 10.0})
        if (factor * step >= least * (1 - 1e-9)) {
            step *= factor;
            break;
        }
    std::vector<double> ticks;
    const double slack = 1e-9 * (high - low);
    for (double k = std::ceil((low - slack) / step); k * step <= high + slack && ticks.size() < 1000; ++k)
        ticks.push_back(k * step + 0.0);
    return ticks;
}

void add_axes(const SceneObject& o, const Color& color, const Sight& sight, double pixel, double letter,
              std::vector<Obstacle>& obstacles, std::vector<MarkRequest>& marks, Drawing& drawing) {
    Drawer(o, color, sight, pixel, letter, obstacles, marks, drawing).run();
}

}  // namespace isoparm
