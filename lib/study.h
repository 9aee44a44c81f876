// study.h -- how well methods tessellate: triangles, proved and sampled error, time and shape at many tolerances.
//
// Every mesh gets the same certificate (mesh_error.h), whatever made it. No drawing here, and no files.
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "composite.h"
#include "mesh.h"
#include "meshes/mesh_error.h"

namespace isoparm {

struct StudyInput {
    const Composite& surface;
    double tolerance = 0;                    // scene units, > 0
    std::size_t max_triangles = 4'000'000;   // budget
    std::function<void(double)> progress{};  // from the calling thread, with a fraction in [0,1]; may be empty
};

/// What a method ends with: a watertight mesh, and its own certificate where it has one (the study proves every mesh anew, and takes the
/// better of the two).
struct StudyMesh {
    Mesh mesh;
    MeshTopology topology;
    double certified_error = TriangleBound::none, certified_parametric = TriangleBound::none;
};

/// One row of the table of methods, lib/study/study_methods.cpp.
struct StudyMethod {
    const char* name;
    const char* summary;                         // what it does, for people
    StudyMesh (*make)(const StudyInput& input);  // throws Error(budget) when the tolerance is not reached
    bool slow = false;                           // left out unless it is asked for
};
const std::vector<StudyMethod>& study_methods();
/// nullptr when there is none of that name.
const StudyMethod* find_study_method(const std::string& name);

/// The quantiles of the smallest angles of the triangles, degrees.
struct AngleQuantiles {
    double least = 0, percent_1 = 0, percent_5 = 0, median = 0;
};
AngleQuantiles smallest_angles(const Mesh& mesh);

/// One row of the result. Numbers of runs that did not reach the tolerance are 0.
struct StudyRun {
    std::string method;
    double tolerance = 0;
    bool reached = false;
    std::string reason;  // when not reached
    std::size_t triangles = 0, vertices = 0;
    double certified_error = 0;       // proved distance of the two sets, both ways
    double certified_parametric = 0;  // proved distance at equal parameters
    double sampled_error = 0;         // largest distance seen from points of the surface to the mesh
    double optimal = 0;               // asymptotic optimum of triangles at the tolerance, vertices on the surface
    double seconds = 0, processor_seconds = 0;
    AngleQuantiles angles;

    double ratio() const { return optimal > 0 ? double(triangles) / optimal : 0; }
};

struct StudyResult {
    StudyRun run;
    Mesh mesh;                           // empty when the tolerance was not reached
    TriangleNumbers certified, sampled;  // of each triangle
};

/// Runs one method at one tolerance. Times are those of the method until its mesh is proved, without the study's own certificate and
/// samples. What is not reached is told in the run; other errors are thrown.
StudyResult run_study(const StudyMethod& method, const StudyInput& input);

/// Makes `certified` as sharp as it gets, also far below the tolerance, where run_study() does not care.
void sharpen_bounds(const Composite& surface, StudyResult& result);

/// Error ~ h^order with h = triangles^(-1/2): -2 times the least-squares slope of log(error) over log(triangles).
struct FittedOrder {
    double order = 0;
    std::size_t points = 0;  // that it was fitted to
};
/// Nothing when there are less than two points with different numbers of triangles; points that are not positive are left out.
std::optional<FittedOrder> fit_order(const std::vector<double>& triangles, const std::vector<double>& errors);

/// Tolerances from 10^-1.5 to 10^-5 of the diagonal, in half decades.
std::vector<double> default_tolerances(double diagonal);

}  // namespace isoparm
