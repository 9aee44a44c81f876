// commands/limit_view.h -- the image-space form of `isoparm limit`: the limit surface and the composite built on it, traced with one camera, and how far the pictures differ.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "image/image.h"
#include "subdivision/limit_faces.h"

namespace isoparm {

class LimitSurface;

/// Both pictures, on white; and for each pixel what differs.
struct LimitPictures {
    Image limit, composite;
    std::vector<float> color, degrees;  // the largest difference of R, G and B; the angle of the normals, NaN where not both pictures have one
    std::vector<char> inside;           // of the silhouettes: 1 the limit's, 2 the composite's, 3 both
};

/// Colours in linear light, 0 to 1. Normals and silhouettes belong to the ray through the middle of a pixel.
struct LimitView {
    int width = 0, height = 0;
    int patches = 0, left_out = 0;       // that are drawn; of the limit, without a patch of the composite
    double color_max = 0, color_rms = 0; // over all pixels
    int both = 0;                        // pixels that both surfaces cover
    double normal_max_degrees = 0, normal_mean_degrees = 0;  // over these
    int silhouette_differing = 0;        // pixels that one of the two covers
    double silhouette_distance = 0;      // the largest distance, in pixels, of one of them from the silhouette that it is not in
    LimitPictures pictures;
};

/// `faces`: of the cage of `limit`. Nothing where the composite has no patch at all, and where rays meet neither surface. Does not depend on the number of threads. Throws what render() throws.
std::optional<LimitView> view_limit(const LimitSurface& limit, const LimitFaces& faces, int width, int height);

/// Names of the files.
const std::vector<std::string>& limit_view_files();
void write_limit_view(const std::string& folder, const LimitView& view);

}  // namespace isoparm
