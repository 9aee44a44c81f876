// limit_refiner.h -- a cage as OpenSubdiv's topology; internal to limit.cpp and limit_samples.cpp: these, and this file, alone include OpenSubdiv.
#pragma once
#include <opensubdiv/far/topologyRefiner.h>

#include <memory>
#include <mutex>

#include "limit.h"

namespace isoparm {

/// Collects what OpenSubdiv would print, as long as it lives; one at a time.
class OsdMessages {
public:
    OsdMessages();
    ~OsdMessages();
    void throw_any() const;

private:
    std::lock_guard<std::mutex> lock_;
};

using Refiner = std::unique_ptr<OpenSubdiv::Far::TopologyRefiner>;
/// Throws Error(input) for what check_cage() and OpenSubdiv refuse.
Refiner make_refiner(const Cage& cage, Scheme scheme, const OsdMessages& messages);

}  // namespace isoparm
