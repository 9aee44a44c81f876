// cases.h -- what is measured: rounds of work, in tables, each table beside the thing that it is compared with.
#pragma once
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace isoparm::bench {

/// What one round did.
struct Work {
    double amount = 0;                                  // in the unit of the case
    double seconds = 0;                                 // wall time of the part that counts; 0: processor time of it all
    std::vector<std::pair<std::string, double>> facts;  // about the result; the same every round
};

struct Case {
    std::string table, name, unit;
    std::function<Work()> round;
    std::string beside;               // the case of the same table whose rate is 1; may be empty
    int threads = 1;                  // 0: all cores
    std::function<void()> prepare{};  // once, before time is taken; throws when the two do not compute the same
    int repetitions = 0;              // 0: as many as asked for; otherwise at most this
};

/// Points and derivatives beside loops written by hand for the same surfaces.
std::vector<Case> evaluation_cases();
/// Certified meshes of scenes at relative tolerances 1e-2 ... 1e-5.
std::vector<Case> tessellation_cases();
/// Primary rays beside bare Embree, shaded points, complete pictures.
std::vector<Case> ray_cases();

}  // namespace isoparm::bench
