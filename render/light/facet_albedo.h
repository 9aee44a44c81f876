// facet_albedo.h -- how much of light single reflections of GGX micro-facets give back, were they perfect mirrors; the rest meets other facets.
#pragma once

namespace isoparm {

/// Of light from a direction with that cosine, in [0,1]. From a table that is made when it is first asked for (some 0.15 s), good to 0.005. Thread-safe.
double facet_albedo(double roughness, double cosine);
/// Over the hemisphere, weighted with the cosine: exactly the mean of the one above.
double mean_facet_albedo(double roughness);

}  // namespace isoparm
