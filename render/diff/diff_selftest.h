// diff_selftest.h -- does diff see what it claims to see? An image is changed in every way, and each change must be found.
#pragma once
#include <string>
#include <vector>

namespace isoparm {

struct DiffTrial {
    std::string what;      // was done to the image
    std::string expected;  // "fail", "not_comparable", "error", "pass"
    std::string found;
    bool caught() const { return expected == found; }
};

/// Writes images into `folder`, which exists, and compares them. The same on every run.
std::vector<DiffTrial> diff_selftest(const std::string& folder);

}  // namespace isoparm
