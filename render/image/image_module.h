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
    int x, y, whole_width, whole_height;  // where they lie in the whole picture: with half floats data window and display window
};

/// Writes `file` in the format of that extension ("png") and reads it back; `lossy` formats need only come back in the same
/// size. Returns 0 or fills `error`.
int isoparm_image_write(const char* file, const char* format, const IsoparmImagePixels* pixels, int lossy, const char* const* names,
                        const char* const* values, int metadata, IsoparmImageError* error);

/// Calls `sink` with all channels as floats (of more than four: R, G, B and A only), unassociated alpha where the format has that, and the bytes flag when the
/// file holds integers. Returns 0 or fills `error`.
typedef void (*IsoparmImageSink)(void* user, int width, int height, int channels, int integers, const float* data);
int isoparm_image_read(const char* file, IsoparmImageSink sink, void* user, IsoparmImageError* error);

// ---- by rows, with all parts and channels as they are stored

/// One part: a subimage, or a smaller level of it. Rows count from the top of the data window.
struct IsoparmImagePart {
    int x, y, width, height;                          // data window
    int full_x, full_y, full_width, full_height;      // display window
    int channels;
    int tile_height;                                  // 0: scanlines
    int exact;                                        // holds 32-bit integers or doubles, which floats would round
    int deep, depth;                                  // several samples a pixel; more than one plane
};
struct IsoparmImageFile;
/// Told once for each channel ("channel", name), its type ("type", "half"), the part's name ("name"), and whatever says how its numbers
/// are meant ("space", "oiio:ColorSpace=sRGB").
typedef void (*IsoparmImageFact)(void* user, const char* what, const char* value);

/// `format` is OpenImageIO's name of the format: no other reader is tried. Null, and `error` is filled, on failure.
IsoparmImageFile* isoparm_image_open(const char* file, const char* format, IsoparmImageError* error);
/// 0: `part` and the facts are filled; 1: there is no part of that number; -1: an error.
int isoparm_image_part(IsoparmImageFile* file, int number, IsoparmImagePart* part, IsoparmImageFact fact, void* user, IsoparmImageError* error);
/// Interleaved channels: kind 0, floats (whole numbers as fractions of their largest); 1, doubles, where 32-bit integers are themselves;
/// 2, half floats.
int isoparm_image_rows(IsoparmImageFile* file, int number, int first, int rows, int kind, void* to, IsoparmImageError* error);
void isoparm_image_close(IsoparmImageFile* file);

/// What to write: `types` of the channels, one letter each: f float, h half, b byte, s 16 bits, u 32 bits. 'b' and 's' take fractions.
struct IsoparmImageLayer {
    IsoparmImagePart part;
    const char* name;
    const char* const* channels;
    const char* types;
    const char* space;                                // of colours: "Linear", "sRGB"
};
struct IsoparmImageWriter;
/// The parts follow each other, from the top; `format` is an extension. Null, and `error` is filled, on failure.
IsoparmImageWriter* isoparm_image_create(const char* file, const char* format, const IsoparmImageLayer* layers, int count, IsoparmImageError* error);
int isoparm_image_put(IsoparmImageWriter* file, int layer, int first, int rows, const float* data, IsoparmImageError* error);
/// Closes and reads back; frees the writer in any case.
int isoparm_image_finish(IsoparmImageWriter* file, IsoparmImageError* error);

/// At most so many threads in OpenImageIO and OpenEXR. With 1, those that were started have ended when it returns (it waits 5 seconds at most),
/// and none is started later, so that the process may fork.
void isoparm_image_threads(int threads);
}
