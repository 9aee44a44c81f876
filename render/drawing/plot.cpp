#include "drawing/plot.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "drawing/text_cairo.h"
#include "picture/palette.h"

namespace isoparm {
namespace {

constexpr double kLetter = 11, kSmall = 10, kTitle = 13;
constexpr double kMarker = 3.4;  // radius

MathText prose(const std::string& text) { return parse_math_text(text, true); }

/// Its middle at x, on this base line.
Text on_line(const MathText& text, double size, double x, double base) {
    return {{x - 0.5 * text_box(text, size).advance, base}, size, text};
}

struct Axis {
    double low = 1, high = 10;  // powers of the data, with room
    double from = 0, to = 1;    // where they are drawn
    double operator()(double x) const { return from + (to - from) * std::log(x / low) / std::log(high / low); }
};

Axis axis_of(const std::vector<PlotSeries>& series, double Vec2::*coordinate) {
    double low = INFINITY, high = 0;
    for (const PlotSeries& s : series)
        for (const Vec2& p : s.points) low = std::min(low, p.*coordinate), high = std::max(high, p.*coordinate);
    const double room = std::max(1.25, std::pow(high / low, 0.05));
    return {low / room, high * room};
}

Filled polygon(const Vec2& at, double radius, int corners, double turn) {
    Filled area;
    for (int i = 0; i < corners; ++i) {
        const double a = turn + 2 * std::numbers::pi * i / corners;
        area.outline.push_back({at.x + radius * std::sin(a), at.y - radius * std::cos(a)});
    }
    return area;
}
Filled marker(int kind, const Vec2& at) {
    const double pi = std::numbers::pi;
    switch (kind % kPlotMarkers) {
        case 0:
            return polygon(at, kMarker, 24, 0);
        case 1:
            return polygon(at, 1.25 * kMarker, 4, pi / 4);
        case 2:
            return polygon(at, 1.35 * kMarker, 3, 0);
        case 3:
            return polygon(at, 1.35 * kMarker, 4, 0);
        case 4:
            return polygon(at, 1.35 * kMarker, 3, pi);
        case 5:
            return polygon(at, 1.2 * kMarker, 6, 0);
        default:
            return polygon(at, 1.25 * kMarker, 5, 0);
    }
}

class Painter {
public:
    Painter(const Plot& plot, double width, double height) : plot_(plot), width_(width), height_(height) {
        for (const PlotSeries& s : plot.series)
            if (!s.points.empty()) series_.push_back(s);
    }

    Drawing run() {
        put(on_line(prose(plot_.title), kTitle, width_ / 2, 18), ink_color());
        if (series_.empty()) {
            put(on_line(prose("nothing to show: no run reached its tolerance"), kLetter, width_ / 2, height_ / 2), ink_color());
            return std::move(drawing_);
        }
        const double top = legend(32) - 4;
        x_ = axis_of(series_, &Vec2::x), y_ = axis_of(series_, &Vec2::y);
        x_.from = 62, x_.to = width_ - 16;
        y_.from = height_ - 43, y_.to = top;
        axes();
        for (const PlotSeries& s : series_) {
            std::vector<Vec2> points;
            for (const Vec2& p : s.points) points.push_back({x_(p.x), y_(p.y)});
            add_series(s, points);
        }
        return std::move(drawing_);
    }

private:
    void put(const std::variant<Polyline, Filled, Text>& shape, const Color& color, double opacity = 1) {
        drawing_.push_back({shape, color, opacity});
    }
    void line(const Vec2& a, const Vec2& b, double width, double grey) { put(Polyline{{a, b}, width, {}, false}, Color{grey, grey, grey}); }
    void add_series(const PlotSeries& s, const std::vector<Vec2>& points) {
        if (points.size() > 1) put(Polyline{points, 1.4, s.dash, false}, s.color);
        if (s.marker < 0) return;
        for (const Vec2& p : points) {
            put(marker(s.marker, p), Color{1, 1, 1});
            put(marker(s.marker, p), s.color);
        }
    }

    /// Rows of names under the title; returns where they end.
    double legend(double y) {
        constexpr double kSample = 34, kGap = 18;
        std::vector<double> widths;
        for (const PlotSeries& s : series_) widths.push_back(kSample + 6 + text_box(prose(s.name), kSmall).advance);
        for (std::size_t first = 0; first < series_.size(); y += 16) {
            double all = 0;
            std::size_t last = first;
            while (last < series_.size() && (last == first || all + kGap + widths[last] < width_ - 24))
                all += (last > first ? kGap : 0) + widths[last], ++last;
            double x = (width_ - all) / 2;
            for (std::size_t i = first; i < last; ++i) {
                Drawing before;
                std::swap(before, drawing_);
                add_series(series_[i], {{x, y}, {x + kSample, y}});
                if (series_[i].marker >= 0) {  // one marker, in the middle of the sample
                    drawing_.resize(1);
                    put(marker(series_[i].marker, {x + kSample / 2, y}), series_[i].color);
                }
                before.insert(before.end(), drawing_.begin(), drawing_.end());
                drawing_ = std::move(before);
                put(Text{{x + kSample + 6, y + 0.32 * kSmall}, kSmall, prose(series_[i].name)}, ink_color());
                x += widths[i] + kGap;
            }
            first = last;
        }
        return y;
    }

    void axes() {
        const std::vector<double> xs = log_ticks(x_.low, x_.high), ys = log_ticks(y_.low, y_.high);
        const auto extreme = [](const std::vector<double>& ticks) {
            return !ticks.empty() && (ticks.front() < 0.009 || ticks.back() > 1001);
        };
        const bool x_powers = extreme(xs), y_powers = extreme(ys);
        for (const double x : xs) line({x_(x), y_.from}, {x_(x), y_.to}, 0.5, 0.75);
        for (const double y : ys) line({x_.from, y_(y)}, {x_.to, y_(y)}, 0.5, 0.75);
        const auto small_ticks = [](const Axis& a, auto draw) {
            for (double decade = std::pow(10, std::floor(std::log10(a.low))); decade < a.high; decade *= 10)
                for (int k = 1; k < 10; ++k)
                    if (k * decade >= a.low && k * decade <= a.high) draw(a(k * decade), k == 1 ? 5.0 : 2.5);
        };
        small_ticks(x_, [&](double at, double size) { line({at, y_.from}, {at, y_.from - size}, 0.7, 0.02); });
        small_ticks(y_, [&](double at, double size) { line({x_.from, at}, {x_.from + size, at}, 0.7, 0.02); });
        put(Polyline{{{x_.from, y_.from}, {x_.to, y_.from}, {x_.to, y_.to}, {x_.from, y_.to}, {x_.from, y_.from}}, 0.9, {}, true},
            ink_color());
        for (const double x : xs) put(on_line(tick_text(x, x_powers), kLetter, x_(x), y_.from + 16), ink_color());
        for (const double y : ys) {
            const MathText text = tick_text(y, y_powers);
            put(Text{{x_.from - 7 - text_box(text, kLetter).advance, y_(y) + 0.3 * kLetter}, kLetter, text}, ink_color());
        }
        put(on_line(prose(plot_.x_label), kLetter, (x_.from + x_.to) / 2, height_ - 10), ink_color());
        Text up = on_line(prose(plot_.y_label), kLetter, 0, 0);
        up.turned = true;
        up.at = {17, (y_.from + y_.to) / 2 - up.at.x};
        put(up, ink_color());
    }

    const Plot& plot_;
    const double width_, height_;
    std::vector<PlotSeries> series_;
    Axis x_, y_;
    Drawing drawing_;
};

}  // namespace

PlotSeries plot_style(std::size_t n) {
    // Okabe and Ito's colours, yellow left out, darkened where they are too light for thin lines.
    static const Color colors[] = {linear_from_srgb(0, 0.45, 0.70),    linear_from_srgb(0.84, 0.37, 0),    linear_from_srgb(0, 0.52, 0.39),
                                   linear_from_srgb(0.66, 0.33, 0.53), linear_from_srgb(0.25, 0.25, 0.25), linear_from_srgb(0.78, 0.54, 0),
                                   linear_from_srgb(0.24, 0.58, 0.80)};
    static const std::vector<double> dashes[] = {{}, {6, 3}, {2, 2}, {8, 2.5, 2, 2.5}, {12, 3}, {4, 2, 1, 2, 1, 2}, {1, 2.5}};
    PlotSeries s;
    s.color = colors[n % 7], s.dash = dashes[n % 7], s.marker = int(n % kPlotMarkers);
    return s;
}

MathText tick_text(double x, bool powers) {
    const double power = std::round(std::log10(x));
    if (powers && std::fabs(std::log10(x) - power) < 1e-9) return parse_math_text("$10^{" + std::to_string(int(power)) + "}$");
    if (powers) {
        const double base = std::pow(10, std::floor(std::log10(x) + 1e-9));
        return parse_math_text("$" + std::to_string(int(std::round(x / base))) + "\\cdot 10^{" +
                               std::to_string(int(std::round(std::log10(base)))) + "}$");
    }
    return number_text(x, 4);
}

std::vector<double> log_ticks(double low, double high) {
    std::vector<double> powers, finer;
    for (int k = int(std::floor(std::log10(low))); k <= int(std::ceil(std::log10(high))); ++k)
        for (const int step : {1, 2, 5}) {
            const double x = step * std::pow(10, k);
            if (x < low * (1 - 1e-12) || x > high * (1 + 1e-12)) continue;
            if (step == 1) powers.push_back(x);
            finer.push_back(x);
        }
    return powers.size() >= 3 || finer.empty() ? powers : finer;
}

Drawing draw_plot(const Plot& plot, double width, double height) { return Painter(plot, width, height).run(); }

}  // namespace isoparm
