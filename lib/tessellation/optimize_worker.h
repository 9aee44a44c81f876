// optimize_worker.h -- the steps of optimize() on one patch, or on two with the rim between them; internal to optimize*.cpp.
#pragma once
#include "tessellation/optimize_rims.h"

namespace isoparm {

/// A corner of a patch; on a rim it stands for the corners of all uses.
struct Site {
    std::uint32_t patch = 0, corner = 0;
};

/// Each step keeps the certificate, or changes nothing. Workers on different patches may run at the same time.
class Worker {
public:
    /// Changes these patches only, and rims all of whose uses are among them.
    Worker(FreeComposite& all, std::vector<std::uint32_t> patches) : all_(all), members_(std::move(patches)) {}

    /// Moves a corner to where the energy around it is less.
    void improve(Site site);
    /// Flips edges of the triangles around a corner.
    void flip_around(Site site);
    /// Removes a corner; where that asks too much of the triangles around it, their corners move and edges flip to make room, if `relax`.
    bool remove(Site site, bool relax);
    /// The largest error that removing it leaves without that.
    double cost_of_removal(Site site) const;

private:
    bool mine(std::uint32_t rim_point) const;
    std::vector<Site> sites_of(Site site) const;
    std::vector<Site> around(const std::vector<Site>& links) const;
    bool move_once(Site site);
    bool move_rim(std::uint32_t rim_point);
    bool flip_once(Site site);
    void take_off_rim(std::uint32_t rim_point);
    double relax(const std::vector<Site>& around, double enough, int& sweeps);
    bool certify();
    void begin();
    bool finish(bool good);
    double worst() const;

    FreeComposite& all_;
    std::vector<std::uint32_t> members_;
    std::vector<std::pair<std::uint32_t, RimPoint>> old_points_;
};

}  // namespace isoparm
