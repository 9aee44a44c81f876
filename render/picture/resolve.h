// resolve.h -- from the sums of a film to pixels and channels.
#pragma once
#include "image/image.h"
#include "picture/aov.h"
#include "picture/film.h"

namespace isoparm {

class Tracer;

/// How many samples the pixels of a picture have.
struct SampleCount {
    int least = 0, most = 0, most_asked = 0;
    double mean = 0;
    double noise = 0;             // as Film has it; 0 where nobody asked
    double target = 0;            // likewise
    double missed = 0;            // part of the pixels that ended above the target
    std::size_t pixels = 0;
};

/// Fills `image` and `layers` with the pixels of `area`, which is inside the film's. Pixels without samples get those of a single ray through the
/// middle of 4 x 4 pixels.
void resolve(const Tracer& tracer, const Film& film, const AovReader& aovs, const Area& area, Image& image, Layers& layers);

/// Adds the pixels of `area` to the count.
void count_samples(const Film& film, const Area& area, SampleCount& count);

}  // namespace isoparm
