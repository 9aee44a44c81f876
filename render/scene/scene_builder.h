// scene_builder.h -- curves and surfaces of a scene by name: built once, in any order, cycles refused.
#pragma once
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "io/curve_file.h"
#include "patches/control_net.h"
#include "scene/included_file.h"
#include "scene/json.h"
#include "scene/scene.h"
#include "scene/scene_values.h"

namespace isoparm {

struct BuiltCurve {
    BuiltCurve(Curve c, ControlNet n = {}) : curve(std::move(c)), net(std::move(n)) {}  // NOLINT: a curve without a net
    Curve curve;
    ControlNet net;  // empty where the type has no control points
    std::optional<SplineCurve> spline;  // of a polynomial Bezier curve, B-spline or line
};
struct BuiltSurface {
    BuiltSurface(Patch p, ControlNet n = {}) : patches{{"", std::move(p)}}, net(std::move(n)) {}  // NOLINT
    explicit BuiltSurface(Composite c, ControlNet n = {}) : patches(std::move(c)), net(std::move(n)) {}
    Composite patches;  // one patch has the name "" until its surface gets one
    ControlNet net;
    std::string detail;
    std::function<DataReport()> examine;  // as Surface::examine

    BuiltSurface& examined(std::function<DataReport()> by) { return examine = std::move(by), *this; }
};

class SceneBuilder {
public:
    SceneBuilder(const Json& root, SceneValues values);

    const SceneValues& values() const { return values_; }
    /// A curve or surface given by its name or on the spot.
    BuiltCurve curve(const Json& reference);
    /// The curve under a key of a definition, which must be there; `meaning` for the message when it is not.
    Curve curve(const Json& definition, const char* key, const char* meaning) { return curve(definition.at(key, meaning)).curve; }
    BuiltSurface surface(const Json& reference);
    /// A definition under "curves" or "surfaces".
    BuiltCurve named_curve(const Json& definition);
    BuiltSurface named_surface(const Json& definition);
    /// A surface that must be one patch.
    Patch patch(const Json& reference);
    /// A list, or {"type": "file", "path": ...}: all curves of a file.
    std::vector<Curve> curves(const Json& list, std::size_t least, std::size_t most);
    /// Of the file that the key "path" of a definition names; read once.
    const std::vector<FileCurve>& curves_of_file(const Json& definition);

    /// The whole of the file that `name` names, found by included_file(); `what`: "a BV file". Throws LocatedError.
    IncludedFile included(const Json& name, const std::string& what);
    /// Paths of all of them.
    const std::set<std::string>& included_paths() const { return included_; }

    std::vector<std::string> curve_names() const;
    std::vector<std::string> surface_names() const;
    /// Surfaces that another one was made of.
    const std::set<std::string>& used_surfaces() const { return used_; }

    /// Something that was done to a definition and that its author should know; each is kept once.
    void note(const Json& definition, const std::string& text);
    const std::vector<std::string>& notes() const { return notes_; }

private:
    BuiltCurve build_curve(const Json& definition);
    BuiltSurface build_surface(const Json& definition);
    template <class Built, class Build>
    Built by_name(const char* what, const std::string& name, const Json& reference, const std::vector<Json>& definitions,
                  std::map<std::string, Built>& built, Build build);

    SceneValues values_;
    std::vector<Json> curves_, surfaces_;  // definitions, in the order of the file
    std::map<std::string, BuiltCurve> built_curves_;
    std::map<std::string, BuiltSurface> built_surfaces_;
    std::map<std::string, std::vector<FileCurve>> curve_files_;  // by path
    std::vector<std::string> in_progress_;
    std::set<std::string> used_, included_;
    std::vector<std::string> notes_;
};

}  // namespace isoparm
