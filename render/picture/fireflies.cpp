#include "picture/fireflies.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace isoparm {
namespace {

constexpr int kLeast = 8;           // samples of a pixel that has fireflies: of few, one is always the brightest by far
constexpr int kAround = 2;          // pixels to each side that tell how bright it is there
constexpr double kStandsOut = 0.5;  // part of that brightness that one sample may add
constexpr double kShare = 0.05;     // of that brightness, to be added to a neighbour
constexpr int kLeastRadius = 2, kMostRadius = kFireflyReach / 2;

double positive(const Color& c) { return std::max(0.0, brightness(c)); }

/// How bright a pixel is, by the mean of its samples.
struct Level {
    double all = 0, others = 0;  // than its brightest one
    double alpha = 0;
    bool known = false;
};

class Spreader {
public:
    explicit Spreader(const Film& film) : film_(film), area_(film.area()), levels_(area_.pixels()), result_(film) {
        for (int y = area_.y0; y < area_.y1; ++y)
            for (int x = area_.x0; x < area_.x1; ++x)
                if (const PixelSum& p = film.at(x, y); p.used >= 2) level(x, y) = {positive(p.color / double(p.used)), positive((p.color - *film.brightest(x, y)) / double(p.used - 1)), std::min(1.0, p.alpha / p.used), true};
    }
    Film result() && {
        for (int y = area_.y0; y < area_.y1; ++y)
            for (int x = area_.x0; x < area_.x1; ++x) look_at(x, y);
        return std::move(result_);
    }

private:
    Level& level(int x, int y) { return levels_[static_cast<std::size_t>(y - area_.y0) * static_cast<std::size_t>(area_.width()) + static_cast<std::size_t>(x - area_.x0)]; }

    /// use(x, y, what is known of it) for the pixels within so many of one.
    template <class Use> void around(int x, int y, int radius, Use use) {
        for (int j = std::max(area_.y0, y - radius); j < std::min(area_.y1, y + radius + 1); ++j)
            for (int i = std::max(area_.x0, x - radius); i < std::min(area_.x1, x + radius + 1); ++i)
                if (const Level& r = level(i, j); r.known) use(i, j, r);
    }
    /// The mean of what is covered, without this pixel's brightest sample.
    double level_around(int x, int y) {
        double sum = 0, pixels = 0;
        around(x, y, kAround, [&](int i, int j, const Level& r) { sum += i == x && j == y ? r.others : r.all, pixels += r.alpha; });
        return pixels > 0 ? sum / pixels : 0;
    }
    void look_at(int x, int y) {
        const PixelSum& p = film_.at(x, y);
        if (p.used < kLeast) return;
        const Color all = *film_.brightest(x, y) / double(p.used);
        const double here = level_around(x, y), others = level(x, y).others, bright = brightness(all);
        if (!(bright > std::max(kStandsOut * here, others)) || !std::isfinite(bright)) return;
        const Color surplus = (1 - others / (p.used * bright)) * all;  // what is left of it is as bright as the others
        // (1 - d²/r²)² has the integral π r² / 3.
        const double pixels = here > 0 ? brightness(surplus) / (kShare * here) : kMostRadius * kMostRadius;
        give(x, y, surplus, here, std::clamp(static_cast<int>(std::ceil(std::sqrt(std::min(1e6, 3 * pixels / std::numbers::pi)))), kLeastRadius, kMostRadius));
    }
    void give(int x, int y, const Color& surplus, double here, int radius) {
        const double square = double(radius) * radius;
        const auto weight = [&](int i, int j, const Level& r) {
            const double near = 1 - (double(i - x) * (i - x) + double(j - y) * (j - y)) / square;
            if (near <= 0) return 0.0;
            return near * near * r.alpha * (here > 0 ? std::min(1.0, r.others / here) : 1.0);
        };
        double all = 0;
        around(x, y, radius, [&](int i, int j, const Level& r) { all += weight(i, j, r); });
        if (!(all > 0)) return;  // it is alone
        result_.at(x, y).color += -double(film_.at(x, y).used) * surplus;
        around(x, y, radius, [&](int i, int j, const Level& r) {
            if (const double w = weight(i, j, r); w > 0) result_.at(i, j).color += (w / all * film_.at(i, j).used) * surplus;
        });
    }

    const Film& film_;
    const Area area_;
    std::vector<Level> levels_;
    Film result_;
};

}  // namespace

Film without_fireflies(const Film& film) { return Spreader(film).result(); }

}  // namespace isoparm
