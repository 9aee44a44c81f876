// picture.h -- a ray-traced picture of a scene.
#pragma once
#include <functional>
#include <string>

#include "drawing/drawing.h"
#include "image/image.h"
#include "picture/aov.h"
#include "picture/checkpoint.h"
#include "picture/resolve.h"
#include "scene/scene.h"

namespace isoparm {

struct Picture;

struct RenderOptions {
    int width = 0, height = 0, samples = 0;  // 0: as the scene says
    std::optional<Tolerance> tolerance;      // none: as the scene says
    std::optional<std::array<int, 4>> crop;  // x0,y0,x1,y1 in pixels; the picture is then only that part
    bool exact = false;                      // rays meet the surfaces themselves; the tolerance is for tubes only
    double most_halved = 3e7;                // boxes that exact rays may look at; and 20 a ray, if that is more. Beyond it Error(budget)
    int grid = 0;                            // not 0: patches are meshed by grids of so many cells each way; nothing is proved then
    std::vector<Aov> aovs;                   // what to put in `layers`
    std::vector<Point> also_fit;             // cameras that fit have these in the picture too: other frames of a film
    double pixels_per_point = 300.0 / 72;    // of the printed picture: what a scene says in points
    std::optional<double> letter_points;     // size of letters that say nothing else
    bool printed = false;                    // on a page of a given width: letters are not too small for it
    bool vectors = false;                    // lines and texts are not painted, but given back in `drawn`
    std::function<void(double)> progress;    // fraction done; called from the calling thread
    std::optional<double> noise;             // the target, as Film has it; 0: none; not given: as the scene says
    std::function<void(double)> tell_noise;  // the noise so far, now and then, where there is progress; from the calling thread
    std::function<bool()> stop;              // true: to end with what there is. Asked often, from every thread
    std::function<void(const Picture&)> preview;  // gets the picture as it is, at once and then now and then, from the calling thread
    Checkpoint checkpoint;                   // where to go on, and to put by what there is
    int tile = 16;                           // pixels a side that one thread works on; the picture does not depend on it

    /// Samples of a pixel; with a noise target at most.
    int most_samples(const ImageSettings& image) const { return samples ? samples : image.samples ? image.samples : noise.value_or(image.noise) > 0 ? 4096 : 64; }
};

struct Picture {
    Image image;
    std::vector<DrawnPart> drawn;  // RenderOptions::vectors, over the image
    Layers layers;               // RenderOptions::aovs, as many pixels as the image
    double tolerance = 0;        // absolute, scene units
    double certified_error = 0;  // of the meshes that were traced, float rounding included; infinite of grids
    std::size_t triangles = 0;
    bool exact = false;
    EmbreeScene::Count rays;     // of an exact picture
    std::size_t leaves = 0;      // likewise
    double seconds_mesh = 0, seconds_trace = 0;
    SampleCount samples;
    bool whole = true;           // not ended before by RenderOptions::stop
};

/// Deterministic: the same pixels for every number of threads, every tile, and however often it was stopped and resumed. Throws what
/// read_checkpoint() does, before there is anything to trace.
Picture render(const Scene& scene, const RenderOptions& options);

}  // namespace isoparm
