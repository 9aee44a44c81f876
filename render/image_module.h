// image_module.h -- what the module isoparm_image.so answers: plain C, so that no type of OpenImageIO's crosses over.
#pragma once

extern "C" {

/// Where an error is told: a text of at most 1023 characters.
struct IsoparmImageError {
    char text[1024];
};

/// Pixels to write. `half`: floats that become half floats, linear; otherwise bytes that are written as they are.
struct IsoparmImagePixels {
    int width, height, channels;
    int half;
    const void* data;
    /// Further channels, with half floats only: float32, interleaved; `layer_names` has one name each.
    int layers;
    const char* const* layer_names;
    const float* layer_data;
};

/// Writes `file` in the format of its extension and reads it back; `lossy` formats need only come back in the same
/// size. Returns 0 or fills `error`.
int isoparm_image_write(const char* file, const IsoparmImagePixels* pixels, int lossy, const char* const* names,
                        const char* const* values, int metadata, IsoparmImageError* error);

/// Calls `sink` with all channels as floats (of more than four: R, G, B and A only), unassociated alpha where the format has that, and the bytes flag when the
/// file holds integers. Returns 0 or fills `error`.
typedef void (*IsoparmImageSink)(void* user, int width, int height, int channels, int integers, const float* data);
int isoparm_image_read(const char* file, IsoparmImageSink sink, void* user, IsoparmImageError* error);
}
