// sample_points.h -- points of many samples and rays through them, side by side: the same bits as one by one, for every instruction set.
#pragma once
#include "light/sampler.h"
#include "rays/ray_lanes.h"

namespace isoparm {

/// A sample of a picture: which one of which pixel.
struct SampleOf {
    const PixelSampler* sampler = nullptr;
    int number = 0;
};

inline constexpr int kSamplePacket = 16;

/// out[i] = (*of[i].sampler)(of[i].number, dimension[i]) for n <= kSamplePacket samples, all of pictures with the same number of samples.
void sample_points(const SampleOf* of, const int* dimension, int n, Vec2* out);

/// Lane i: camera.ray(at[i].x, at[i].y), 0 < n <= kSamplePacket; others get some of these.
void camera_rays(const Camera& camera, const Vec2* at, int n, RayLanes& out);

}  // namespace isoparm
