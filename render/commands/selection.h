// commands/selection.h -- the patches of a scene that a command turns into meshes.
#pragma once
#include "commands/options.h"

namespace isoparm {

/// The patches to mesh, and the surface of the scene that each of them belongs to.
struct Selection {
    Composite patches;
    std::vector<std::string> surface;  // one a patch
};

/// Those of --surface; otherwise all that the scene draws. Throws Error(usage) or Error(input) when there are none.
Selection select_patches(const Scene& scene, const Options& options);

/// In scene units; `diagonal` is that of the box. Pixels are an Error(usage).
double absolute_tolerance(const Tolerance& t, double diagonal, const Options& options);

}  // namespace isoparm
