// repair.h -- surfaces whose curves were listed in another order or drawn in another direction: the message says what would repair
// them, and "repair": true on the surface has it done and noted (curve_doctor.h).
#pragma once
#include <optional>
#include <string>

#include "curve_doctor.h"
#include "patches/control_net.h"
#include "patches/gordon.h"
#include "patches/network.h"
#include "scene/scene_builder.h"

namespace isoparm {

/// What the doctor says of the data of a surface, and the data repaired, where an exact repair exists.
template <class Data> struct Cure {
    bool fits = false;
    std::string misfit, changes;
    std::optional<Data> data;
};

/// The edges of a triangle with what is given along them: cross derivatives or normals.
struct TriangleCurves {
    std::array<Curve, 3> edges, along;
};
struct CommonStart {
    Curve c, d;
};
struct HermiteCurves {
    HermiteData data;
    Twist twist;
};
Cure<CoonsCurves> cure(const CoonsCurves& given);
Cure<std::array<Curve, 3>> cure(const std::array<Curve, 3>& edges);
Cure<TriangleCurves> cure(const TriangleCurves& given);
Cure<CommonStart> cure(const CommonStart& given);
Cure<HermiteCurves> cure(const HermiteCurves& given);
Cure<Network> cure(const Network& given);
Cure<GordonNetwork> cure(const GordonNetwork& given);
/// A reversed spline has its knots mirrored.
Cure<ControlFrame> cure(const ControlFrame& given);

/// The value of "repair"; false when missing, true for a "loop".
bool repair_wanted(const Json& surface, const SceneBuilder& scene);
/// Throws the error again, with advice.
[[noreturn]] void throw_advised(const Error& error, const std::string& advice);

/// make(data); when the curves do not fit and "repair" is true, make(the data repaired), and a note.
template <class Data, class Make> BuiltSurface fitted(const Data& data, const Json& surface, SceneBuilder& scene, Make make) {
    const bool wanted = repair_wanted(surface, scene);
    try {
        return make(data);
    } catch (const LocatedError&) {
        throw;
    } catch (const Error& error) {
        if (error.kind() != ErrorKind::input) throw;
        const Cure<Data> c = cure(data);
        if (c.fits || (!c.data && c.misfit.empty())) throw;  // it is not the curves
        if (!c.data) throw_advised(error, c.misfit);
        if (!wanted) throw_advised(error, c.misfit + ", but the curves fit with " + c.changes + ": change that, or add \"repair\": true");
        try {
            BuiltSurface built = make(*c.data);
            scene.note(surface, "curves repaired: " + c.changes);
            return built;
        } catch (const LocatedError&) {
            throw;
        } catch (const Error& still) {
            throw_advised(still, "this is after the repair " + c.changes);
        }
    }
}

}  // namespace isoparm
