// cases.h -- what is measured: rounds of work, in tables, each table beside the thing that it is compared with.
#pragma once
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "composite.h"

namespace isoparm::bench {

/// All surfaces that a scene draws.
Composite patches_of(const std::string& scene_name);

/// What one round did.
struct Work {
    double amount = 0;                                    // in the unit of the case
    std::vector<std::pair<std::string, double>> facts{};  // about the result
};

/// What a rate is per second of. Processor time is hardly disturbed by other work on the machine, wall time is.
enum class Clock {
    one_thread,    // processor time, while TBB gets one thread
    core_seconds,  // processor time of all threads together
    wall,          // of all cores
};

struct Case {
    std::string table, name, unit;
    std::function<Work()> round;
    bool reference = false;  // the ratios of a table are to the fastest of these in it
    Clock clock = Clock::one_thread;
    int repetitions = 1000;           // at most
    std::function<void()> prepare{};  // before time is taken; throws when a case and its reference do not agree
};

/// Points and derivatives beside loops written by hand for the same surfaces.
std::vector<Case> evaluation_cases();
/// Positions and first derivatives in batches, by instruction set.
std::vector<Case> batch_cases();
/// Certified meshes of scenes at relative tolerances 1e-2 ... 1e-5.
std::vector<Case> tessellation_cases();
/// OpenCASCADE's BRepMesh and certified meshes of the same surfaces at the same tolerances; none where it was not found.
std::vector<Case> peer_cases();
/// What is proved over what is true, for the triangles of a grid.
std::vector<Case> tightness_cases();
/// Primary rays beside bare Embree, shaded points, complete pictures.
std::vector<Case> ray_cases();

}  // namespace isoparm::bench
