// study_tessellate.cpp -- the program's own tessellation as methods of a study.
#include "study/study_methods.h"
#include "tessellate.h"

namespace isoparm {
namespace {

StudyMesh tessellated(const StudyInput& input, Measure measure, Quality quality = Quality::fast) {
    TessellationOptions options;
    options.tolerance = input.tolerance;
    options.measure = measure;
    options.quality = quality;
    options.max_triangles = input.max_triangles;
    options.progress = input.progress;
    Tessellation t = tessellate(input.surface, options);
    StudyMesh result;
    result.mesh = std::move(t.mesh);
    result.topology = t.topology;
    result.certified_error = t.certified_error;  // the geometric distance is never more than the parametric one
    if (measure == Measure::parametric) result.certified_parametric = t.certified_error;
    return result;
}

}  // namespace

StudyMesh make_fast(const StudyInput& input) { return tessellated(input, Measure::geometric); }
StudyMesh make_optimal(const StudyInput& input) { return tessellated(input, Measure::geometric, Quality::optimal); }
StudyMesh make_parametric(const StudyInput& input) { return tessellated(input, Measure::parametric); }

}  // namespace isoparm
