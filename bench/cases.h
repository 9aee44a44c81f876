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
    std::vector<std::pair<std::string, double>> facts{};  // about the result; the same every round
    double seconds = 0;                                   // for Clock::own
};

/// Processor time of one thread (TBB gets no other), which other work on the machine hardly disturbs; wall time of all
/// cores; or wall time of a part, which the round measures itself.
enum class Clock { processor, wall, own };

struct Case {
    std::string table, name, unit;
    std::function<Work()> round;
    bool reference = false;           // the ratios of a table are to the fastest of these in it
    Clock clock = Clock::processor;
    int threads = 1;                  // 0: all cores
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
