#include "picture/film.h"

#include <algorithm>
#include <cmath>
#include <istream>
#include <ostream>

#include "picture/palette.h"

namespace isoparm {
namespace {

template <class T> void put(std::ostream& out, const T& x) { out.write(reinterpret_cast<const char*>(&x), sizeof x); }
template <class T> void get(std::istream& in, T& x) { in.read(reinterpret_cast<char*>(&x), sizeof x); }
void put(std::ostream& out, const Color& c) { put(out, c.x), put(out, c.y), put(out, c.z); }
void get(std::istream& in, Color& c) { get(in, c.x), get(in, c.y), get(in, c.z); }

Area whole_blocks(const Area& a) {
    const auto down = [](int x) { return x - x % Film::block; };
    return {down(a.x0), down(a.y0), down(a.x1 + Film::block - 1), down(a.y1 + Film::block - 1)};
}

/// How fast the shown value grows with the linear one; beyond white as the curve goes on.
double shown_slope(double linear) { return linear <= 0.0031308 ? 12.92 : 1.055 / 2.4 * std::pow(linear, 1 / 2.4 - 1); }

/// The squares of the standard errors of n samples' mean as shown, summed over the colours.
double shown_error(const Spread& s, int n) {
    const Color mean = s.mean(), variance = s.variance();
    double sum = 0;
    for (int c = 0; c < 3; ++c) {
        const double slope = shown_slope(mean[c]);
        sum += slope * slope * variance[c] / n;
    }
    return sum;
}

}  // namespace

void Spread::add(const Color& c) {
    if (n_++ == 0) first_ = c;
    const Color d = c - first_;
    sum_ += d;
    squares_ += Color{d.x * d.x, d.y * d.y, d.z * d.z};
}
Color Spread::variance() const {
    const auto one = [&](double sum, double squares) { return n_ < 2 ? 0 : std::max(0.0, (squares - sum * sum / n_) / (n_ - 1)); };
    return {one(sum_.x, squares_.x), one(sum_.y, squares_.y), one(sum_.z, squares_.z)};
}
void Spread::write(std::ostream& out) const { put(out, first_), put(out, sum_), put(out, squares_), put(out, n_); }
bool Spread::read(std::istream& in) {
    get(in, first_), get(in, sum_), get(in, squares_), get(in, n_);
    return finite(first_) && finite(sum_) && finite(squares_);
}

Film::Film(const Area& area, int samples, double noise, Keeps keeps)
    : area_(noise > 0 ? whole_blocks(area) : area), samples_(samples), round_(std::min(samples, kFirstRound)), target_(noise), pixels_(area_.pixels()) {
    if (noise > 0 || keeps.spreads) spreads_.resize(pixels_.size());
    if (keeps.brightest) brightest_.resize(pixels_.size());
    if (noise > 0) ended_.resize(pixels_.size() / (block * block));
}

double Film::noise_of_side(std::size_t b, int s) const {
    const int across = area_.width() / block, x0 = area_.x0 + block * static_cast<int>(b % static_cast<std::size_t>(across)),
              y0 = area_.y0 + block * static_cast<int>(b / static_cast<std::size_t>(across));
    double sum = 0;
    for (int y = y0; y < y0 + block; ++y)
        for (int x = x0; x < x0 + block; ++x)
            if (side(x, y) == s) sum += shown_error(spreads_[index(x, y)], pixels_[index(x, y)].seen);
    return std::sqrt(sum / (3 * block * block / 2));
}

bool Film::next_round() {
    bool all = true;
    for (std::size_t b = 0; b < ended_.size(); ++b) {
        if (ended_[b] == 3) continue;
        std::uint8_t now = ended_[b];
        for (const int s : {0, 1})
            if (noise_of_side(b, 1 - s) <= target_) now = static_cast<std::uint8_t>(now | 1 << s);
        ended_[b] = now;
        all = all && now == 3;
    }
    done_ = round_ >= samples_ || (!ended_.empty() && all);
    if (!done_) round_ = std::min(samples_, 2 * round_);
    return !done_;
}

double Film::traced() const {
    double sum = 0;
    for (const PixelSum& p : pixels_) sum += p.seen;
    return sum;
}

double Film::expected() const {
    if (ended_.empty()) return static_cast<double>(pixels_.size()) * samples_;
    double sum = 0;
    for (int y = area_.y0; y < area_.y1; y += block)
        for (int x = area_.x0; x < area_.x1; x += block) {
            const std::size_t b = block_of(x, y);
            const double n = pixels_[index(x, y)].seen, ratio = ended_[b] == 3 || n == 0 ? 1 : std::max(noise_of_side(b, 0), noise_of_side(b, 1)) / target_;
            sum += block * block * std::min(double(samples_), n > 0 ? n * std::max(1.0, std::exp2(std::ceil(2 * std::log2(std::max(ratio, 1e-9))))) : kFirstRound);
        }
    return sum;
}

double Film::noise(const Area& seen) const {
    double sum = 0;
    for (int y = seen.y0; y < seen.y1; ++y)
        for (int x = seen.x0; x < seen.x1; ++x)
            if (const Spread* s = spread(x, y); s && at(x, y).used > 0) sum += shown_error(*s, at(x, y).used);
    return std::sqrt(sum / (3.0 * static_cast<double>(seen.pixels())));
}

double Film::missed() const {
    std::size_t sides = 0;
    for (const std::uint8_t e : ended_) sides += static_cast<std::size_t>(!(e & 1)) + static_cast<std::size_t>(!(e & 2));
    return ended_.empty() ? 0 : static_cast<double>(sides) / (2 * static_cast<double>(ended_.size()));
}

void Film::write(std::ostream& out) const {
    put(out, round_), put(out, done_), put(out, rays.rays), put(out, rays.undecided);
    for (const PixelSum& p : pixels_) put(out, p.color), put(out, p.alpha), put(out, p.used), put(out, p.seen);
    for (const Spread& s : spreads_) s.write(out);
    for (const Color& c : brightest_) put(out, c);
    out.write(reinterpret_cast<const char*>(ended_.data()), static_cast<std::streamsize>(ended_.size()));
}

bool Film::read(std::istream& in) {
    char done = 0;
    get(in, round_), get(in, done), get(in, rays.rays), get(in, rays.undecided);
    done_ = done != 0;
    bool good = in && (done == 0 || done == 1) && rays.undecided <= rays.rays;
    for (PixelSum& p : pixels_) {
        get(in, p.color), get(in, p.alpha), get(in, p.used), get(in, p.seen);
        good = good && finite(p.color) && std::isfinite(p.alpha);
    }
    for (Spread& s : spreads_) good = s.read(in) && good;
    for (Color& c : brightest_) get(in, c), good = good && finite(c);
    in.read(reinterpret_cast<char*>(ended_.data()), static_cast<std::streamsize>(ended_.size()));
    return good && in && sound();
}

/// Could this have been written in the midst of its round?
bool Film::sound() const {
    const auto whole = [&](int n) { return n >= 0 && n <= round_ && (n % kFirstRound == 0 || n == samples_); };
    const auto a_round = [&] {
        int n = std::min(samples_, kFirstRound);
        while (n < round_) n = std::min(samples_, 2 * n);
        return n == round_;
    };
    if (round_ < 1 || round_ > samples_ || !a_round()) return false;
    for (std::size_t i = 0; i < pixels_.size(); ++i) {
        const PixelSum& p = pixels_[i];
        if (!whole(p.used) || !whole(p.seen) || p.used > p.seen || (ended_.empty() && p.used != p.seen) || (!spreads_.empty() && spreads_[i].count() != p.seen)) return false;
    }
    return std::all_of(ended_.begin(), ended_.end(), [](std::uint8_t e) { return e <= 3; });
}

}  // namespace isoparm
