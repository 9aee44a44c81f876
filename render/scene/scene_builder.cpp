#include "scene/scene_builder.h"

#include <algorithm>

#include "scene/registry.h"
#include "scene/suggest.h"

namespace isoparm {

namespace {

constexpr std::size_t kMaxChain = 100;

/// The definitions under "curves" or "surfaces", each an object with a usable name.
std::vector<Json> definitions(const Json& root, const char* key) {
    const auto found = root.find(key);
    if (!found) return {};
    if (!found->is(Json::Kind::object)) found->expected(std::string("an object of named ") + key);
    for (const Json& d : found->children()) {
        const std::string& name = d.key();
        const bool usable = !name.empty() && name.size() <= 200 && name.find('/') == std::string::npos &&
                            std::none_of(name.begin(), name.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; });
        if (!usable) d.fail_at_key("found the name " + quoted(name) + ", expected 1 to 200 characters without \"/\" and control characters");
        if (!d.is(Json::Kind::object)) d.expected("an object with a \"type\"");
    }
    return found->children();
}

std::vector<std::string> names_of(const std::vector<Json>& definitions) {
    std::vector<std::string> names;
    for (const Json& d : definitions) names.push_back(d.key());
    return names;
}

/// Looks the type up, checks the keys, builds; what the library finds wrong gets the place of the definition.
template <class Built> Built build_typed(const char* what, std::span<const SceneType<Built>> types, const Json& j, SceneBuilder& scene) {
    std::vector<std::string> names;
    for (const auto& t : types) names.push_back(t.name);
    const std::string expected = std::string("the type of a ") + what + " (" + listed(names) + ")";
    const Json type = j.at("type", expected);
    if (!type.is(Json::Kind::string)) type.expected(expected);
    for (const auto& t : types) {
        if (type.string() != t.name) continue;
        std::vector<std::string> keys{"type"};
        keys.insert(keys.end(), t.keys.begin(), t.keys.end());
        j.allow_keys(keys);
        try {
            return t.build(j, scene);
        } catch (const LocatedError&) {
            throw;
        } catch (const IncompatibleError& e) {
            j.fail(e.condition() + ": found a gap of " + to_text(e.gap()) + ", expected at most " + to_text(e.tolerance()) +
                   (e.advice().empty() ? "" : "; " + e.advice()));
        } catch (const Error& e) {
            const std::string message = e.what();
            const bool complete = message.find("found ") != std::string::npos;
            j.fail(std::string(t.name) + ": " + (complete ? "" : "found data that do not make one, expected others: ") + message);
        }
    }
    type.expected(expected + did_you_mean(type.string(), names));
}

}  // namespace

SceneBuilder::SceneBuilder(const Json& root, SceneValues values)
    : values_(std::move(values)), curves_(definitions(root, "curves")), surfaces_(definitions(root, "surfaces")) {
    for (const Json& s : surfaces_)
        for (const Json& c : curves_)
            if (s.key() == c.key()) s.fail_at_key("found " + quoted(s.key()) + ", which is the name of a curve too, expected different names");
}

void SceneBuilder::note(const Json& definition, const std::string& text) {
    const std::string note = definition.place() + ": " + text;
    if (std::find(notes_.begin(), notes_.end(), note) == notes_.end()) notes_.push_back(note);
}

std::vector<std::string> SceneBuilder::curve_names() const { return names_of(curves_); }
std::vector<std::string> SceneBuilder::surface_names() const { return names_of(surfaces_); }

template <class Built, class Build>
Built SceneBuilder::by_name(const char* what, const std::string& name, const Json& reference, const std::vector<Json>& definitions,
                            std::map<std::string, Built>& built, Build build) {
    if (const auto done = built.find(name); done != built.end()) return done->second;
    const auto definition = std::find_if(definitions.begin(), definitions.end(), [&](const Json& d) { return d.key() == name; });
    if (definition == definitions.end()) {
        const auto names = names_of(definitions);
        reference.expected(std::string("the name of a ") + what + " (have: " + listed(names) + ")" + did_you_mean(name, names));
    }
    const std::string self = std::string(what) + " " + quoted(name);
    if (const auto first = std::find(in_progress_.begin(), in_progress_.end(), self); first != in_progress_.end()) {
        std::string cycle;
        for (auto k = first; k != in_progress_.end(); ++k) cycle += *k + " -> ";
        reference.fail("found a cycle: " + cycle + self + ", expected definitions that do not need themselves");
    }
    if (in_progress_.size() >= kMaxChain) reference.fail("found a chain of more than " + std::to_string(kMaxChain) + " definitions that need each other, expected fewer");
    in_progress_.push_back(self);
    Built result = build(*definition);
    in_progress_.pop_back();
    built.emplace(name, result);
    return result;
}

BuiltCurve SceneBuilder::build_curve(const Json& definition) { return build_typed("curve", curve_types(), definition, *this); }
BuiltSurface SceneBuilder::build_surface(const Json& definition) { return build_typed("surface", surface_types(), definition, *this); }

BuiltCurve SceneBuilder::curve(const Json& reference) {
    if (reference.is(Json::Kind::object)) return build_curve(reference);
    if (!reference.is(Json::Kind::string)) reference.expected("a curve: the name of one (have: " + listed(curve_names()) + ") or {\"type\": ...}");
    return by_name<BuiltCurve>("curve", reference.string(), reference, curves_, built_curves_, [&](const Json& d) { return build_curve(d); });
}
BuiltCurve SceneBuilder::named_curve(const Json& definition) {
    return by_name<BuiltCurve>("curve", definition.key(), definition, curves_, built_curves_, [&](const Json& d) { return build_curve(d); });
}

BuiltSurface SceneBuilder::surface(const Json& reference) {
    if (reference.is(Json::Kind::object)) return build_surface(reference);
    if (!reference.is(Json::Kind::string)) reference.expected("a surface: the name of one (have: " + listed(surface_names()) + ") or {\"type\": ...}");
    if (!in_progress_.empty()) used_.insert(reference.string());
    return by_name<BuiltSurface>("surface", reference.string(), reference, surfaces_, built_surfaces_, [&](const Json& d) { return build_surface(d); });
}
BuiltSurface SceneBuilder::named_surface(const Json& definition) {
    return by_name<BuiltSurface>("surface", definition.key(), definition, surfaces_, built_surfaces_, [&](const Json& d) { return build_surface(d); });
}

Patch SceneBuilder::patch(const Json& reference) {
    const BuiltSurface s = surface(reference);
    if (s.patches.size() != 1) reference.fail("found a surface of " + std::to_string(s.patches.size()) + " patches, expected one patch");
    return s.patches.front().patch;
}

const std::vector<FileCurve>& SceneBuilder::curves_of_file(const Json& definition) {
    const Json path = definition.at("path", expected_curve_file);
    const std::string& name = values_.text(path, std::string(expected_curve_file) + ", relative to the scene");
    if (const auto done = curve_files_.find(name); done != curve_files_.end()) return done->second;
    const IncludedFile file = included(path, expected_curve_file);
    return curve_files_.emplace(name, read_curve_file(file.text, file.path)).first->second;
}

IncludedFile SceneBuilder::included(const Json& name, const std::string& what) {
    const std::string path = included_file(name, values_.text(name, "the name of " + what + ", relative to the scene"));
    try {
        IncludedFile file{read_text_file(path), path};
        included_.insert(path);
        return file;
    } catch (const Error& e) {
        name.fail("found a file that cannot be used, expected " + what + ": " + e.what());
    }
}

std::vector<Curve> SceneBuilder::curves(const Json& list, std::size_t least, std::size_t most) {
    std::vector<Curve> r;
    if (list.is(Json::Kind::object)) {
        list.allow_keys({"type", "path"});
        const Json type = list.at("type", "\"file\"");
        if (!type.is(Json::Kind::string) || type.string() != "file") type.expected("\"file\", or a list of curves");
        for (const FileCurve& c : curves_of_file(list)) {
            if (!c.curve) list.fail("curve " + std::to_string(r.size()) + " of the file is " + c.unusable + "; expected a list of those that can be used, each with its \"index\"");
            r.push_back(*c.curve);
        }
        if (r.size() < least || (most > 0 && r.size() > most)) list.fail("found a file of " + std::to_string(r.size()) + " curves, expected " + (most == least ? "" : "at least ") + std::to_string(least) + (most > least ? ", at most " + std::to_string(most) : ""));
        return r;
    }
    for (const Json& c : values_.list(list, least, most, "curves")) r.push_back(curve(c).curve);
    return r;
}

}  // namespace isoparm
