// aov.h -- what a picture may carry beside its colours (arbitrary output variables): normals, depth, ids ...
//
// All but what is told of the samples belong to one ray through the middle of the pixel and the nearest thing that it meets, whatever
// that thing's opacity: nothing is filtered, so ids, parameters and positions of a pixel belong together. Labels and flat
// lines, which are painted over the picture, are not in them. No value is NaN or infinite.
#pragma once
#include <string>
#include <vector>

#include "picture/camera.h"
#include "rays/traced_scene.h"

namespace isoparm {

enum class Aov { n, ng, p, uv, albedo, z, patch, triangle, curvature, error, variance, sample_variance, samples };

/// What is told of the samples of a pixel.
struct PixelSamples {
    Color variance;          // of each
    Color sample_variance;   // of their mean
    int count = 0;
};

struct AovKind {
    Aov aov;
    const char* name;                   // on the command line
    std::vector<const char*> channels;  // as Mitsuba and Blender name them
};
/// All, in the order of the file's channels.
const std::vector<AovKind>& all_aovs();

inline constexpr float kAovFar = 1e10f;   // Z where nothing is, as Blender has it
inline constexpr float kAovNone = -1;     // patch and triangle where there is none

/// Fills the channels of a pixel. Safe from every thread.
class AovReader {
public:
    /// In the order of all_aovs(), each once. Patches are numbered as patch_numbers() has it. Throws Error(usage) when a patch has more
    /// triangles than a float32 can number.
    AovReader(const Scene& scene, const TracedScene& traced, const Camera& camera, std::vector<Aov> aovs);
    std::size_t channels() const { return channels_; }
    void read(int x, int y, const PixelSamples& samples, float* out) const;

private:
    const TracedScene& traced_;
    const Camera& camera_;
    std::vector<Aov> aovs_;
    std::vector<float> patch_;  // by the number of the geometry
    std::size_t channels_ = 0;
};

/// Do any of them need the variance of samples?
bool uses_statistics(const std::vector<Aov>& aovs);
/// Their channels, one after the other.
std::vector<std::string> channels_of(const std::vector<Aov>& aovs);
/// What each pixel has where nothing is.
std::vector<float> empty_pixel(const std::vector<Aov>& aovs);

/// Patches are numbered through all surfaces of the scene, drawn or not, in the order of the file: "body 0-3, lid 4".
std::string patch_numbers(const Scene& scene);

}  // namespace isoparm
