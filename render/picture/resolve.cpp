#include "picture/resolve.h"

#include <tbb/parallel_for.h>

#include <algorithm>

#include "picture/tracer.h"

namespace isoparm {
namespace {

constexpr int kCoarse = 4;  // pixels a side that share a ray

PixelSamples samples_of(const Film& film, int x, int y) {
    const PixelSum& sum = film.at(x, y);
    const Spread* spread = film.spread(x, y);
    const Color each = spread ? spread->variance() : Color{};
    return {each, each / double(std::max(1, sum.used)), sum.used};
}

}  // namespace

void resolve(const Tracer& tracer, const Film& film, const AovReader& aovs, const Area& area, Image& image, Layers& layers) {
    const int first = area.y0 / kCoarse, last = (area.y1 + kCoarse - 1) / kCoarse;
    tbb::parallel_for(first, last, [&](int row) {
        Rgba coarse;
        int coarse_of = -1;
        for (int x = area.x0; x < area.x1; ++x)
            for (int y = std::max(area.y0, kCoarse * row); y < std::min(area.y1, kCoarse * (row + 1)); ++y) {
                const PixelSum& sum = film.at(x, y);
                if (sum.used == 0 && coarse_of != x / kCoarse) {
                    coarse_of = x / kCoarse;
                    coarse = tracer.glance(kCoarse * (coarse_of + 0.5), kCoarse * (row + 0.5));
                }
                const Rgba seen = sum.used > 0 ? tracer.resolved(sum) : coarse;
                float* out = image.at(x - area.x0, y - area.y0);
                for (int k = 0; k < 3; ++k) out[k] = static_cast<float>(seen.color[k]);
                out[3] = static_cast<float>(seen.alpha);
                const std::size_t pixel = static_cast<std::size_t>(y - area.y0) * static_cast<std::size_t>(area.width()) + static_cast<std::size_t>(x - area.x0);
                if (aovs.channels() > 0) aovs.read(x, y, samples_of(film, x, y), &layers.values[pixel * aovs.channels()]);
            }
    });
}

void count_samples(const Film& film, const Area& area, SampleCount& count) {
    double sum = count.mean * static_cast<double>(count.pixels);
    for (int y = area.y0; y < area.y1; ++y)
        for (int x = area.x0; x < area.x1; ++x) {
            const int n = film.at(x, y).used;
            count.least = count.pixels == 0 ? n : std::min(count.least, n);
            count.most = std::max(count.most, n);
            ++count.pixels;
            sum += n;
        }
    count.mean = sum / static_cast<double>(std::max<std::size_t>(1, count.pixels));
}

}  // namespace isoparm
