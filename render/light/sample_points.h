// sample_points.h -- points of many samples and rays through them, side by side: the same bits as one by one, for every instruction set.
#pragma once
#include "light/sampler.h"
#include "picture/camera.h"

namespace isoparm {

/// A sample of a picture: which one of which pixel.
struct SampleOf {
    const PixelSampler* sampler = nullptr;
    int number = 0;
};

inline constexpr int kSamplePacket = 16;

/// out[i] = (*of[i].sampler)(of[i].number, dimension[i]) for n <= kSamplePacket samples, all of pictures with the same number of samples.
void sample_points(const SampleOf* of, const int* dimension, int n, Vec2* out);

/// out[i] = camera.ray(at[i].x, at[i].y), n <= kSamplePacket.
void camera_rays(const Camera& camera, const Vec2* at, int n, Ray* out);

}  // namespace isoparm
