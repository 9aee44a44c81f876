// cases.h -- what is measured: rounds of work, in tables, each table beside the thing that it is compared with.
#pragma once
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace isoparm::bench {

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
/// Certified meshes of scenes at relative tolerances 1e-2 ... 1e-5.
std::vector<Case> tessellation_cases();
/// Primary rays beside bare Embree, shaded points, complete pictures.
std::vector<Case> ray_cases();

}  // namespace isoparm::bench
