// commands/selection.h -- which patches of a scene a command is about, and how fine.
#pragma once
#include <string>
#include <vector>

#include "commands/options.h"

namespace isoparm {

/// Patches, and the surface of the scene that each of them belongs to.
struct Selection {
    Composite patches;
    std::vector<std::string> surface;  // one a patch
};

/// Those of --surface; otherwise of all surfaces that the scene draws. Throws Error(input) when there is none.
Selection select_patches(const Scene& scene, const Options& options);
/// The same for a name, or none.
Selection select_patches(const Scene& scene, const std::optional<std::string>& surface);

/// In scene units: of the diagonal of `box`, which holds what it is for; of the finest pixel there, in any view of the picture that the scene describes.
double absolute_tolerance(const Tolerance& t, const Scene& scene, const Bounds& box);
/// In scene units; `diagonal` is what relative ones are relative to. Throws Error(usage) for pixels.
double absolute_tolerance(const Tolerance& t, double diagonal, const Options& options);

}  // namespace isoparm
