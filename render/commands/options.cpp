#include "commands/options.h"

#include <tbb/global_control.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "error.h"
#include "scene/suggest.h"

namespace isoparm {

Options::Options(const char* command, const std::vector<std::string>& arguments, std::vector<Known> known) : command_(command) {
    known.push_back({"--quiet", false});
    known.push_back({"--threads", true});
    bool only_words = false;
    for (std::size_t i = 0; i < arguments.size(); ++i) {
        const std::string& a = arguments[i];
        if (only_words || a.size() < 2 || a[0] != '-') {
            words_.push_back(a);
            continue;
        }
        if (a == "--") {
            only_words = true;
            continue;
        }
        const std::size_t equals = a.rfind("--", 0) == 0 ? a.find('=') : std::string::npos;
        const std::string name = a.substr(0, equals);
        const auto k = std::find_if(known.begin(), known.end(), [&](const Known& o) { return name == o.name; });
        if (k == known.end()) {
            std::vector<std::string> names{"--help"};
            for (const Known& o : known) names.push_back(o.name);
            fail("unknown option " + quoted(name) + did_you_mean(name, names));
        }
        if (k->instead) fail(name + " is not known here: " + k->instead);
        if (!k->takes_value && equals != std::string::npos) fail(name + " takes no value");
        if (k->takes_value && equals == std::string::npos && i + 1 == arguments.size()) fail(name + " needs a value");
        given_[name].push_back(!k->takes_value ? "" : equals != std::string::npos ? a.substr(equals + 1) : arguments[++i]);
    }
    limit_threads();
}

void Options::fail(const std::string& message) const { throw Error(ErrorKind::usage, message + " (see isoparm " + command_ + " --help)"); }

void Options::limit_threads() {
    std::optional<int> threads = integer("--threads", 1, 4096);
    const char* environment = std::getenv("ISOPARM_THREADS");
    if (!threads && environment && *environment) {
        const double n = parse_number("ISOPARM_THREADS", environment);
        if (!(n >= 1 && n <= 4096 && n == std::floor(n))) fail(std::string("ISOPARM_THREADS: found ") + quoted(environment) + ", expected a whole number from 1 to 4096");
        threads = static_cast<int>(n);
    }
    if (threads) thread_limit_ = std::make_shared<tbb::global_control>(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(*threads));
}

std::vector<std::string> Options::values(const std::string& name) const {
    const auto found = given_.find(name);
    return found == given_.end() ? std::vector<std::string>{} : found->second;
}
std::optional<std::string> Options::value(const std::string& name) const {
    const auto all = values(name);
    if (all.empty()) return {};
    return all.back();
}
std::string Options::required(const std::string& name, const std::string& what) const {
    if (const auto v = value(name)) return *v;
    fail(name + " is missing: " + what);
}
double Options::parse_number(const std::string& option, const std::string& text) const {
    double x = 0;
    const char* end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, x);
    if (text.empty() || error != std::errc() || stop != end || !std::isfinite(x)) fail(option + ": found " + quoted(text) + ", expected a number");
    return x;
}
std::optional<double> Options::number(const std::string& name) const {
    const auto text = value(name);
    if (!text) return {};
    return parse_number(name, *text);
}
std::optional<int> Options::integer(const std::string& name, int least, int most) const {
    const auto x = number(name);
    if (!x) return {};
    if (!(*x >= least && *x <= most && *x == std::floor(*x))) {
        fail(name + ": found " + *value(name) + ", expected a whole number from " + std::to_string(least) + " to " + std::to_string(most));
    }
    return static_cast<int>(*x);
}
std::optional<Tolerance> Options::tolerance() const {
    const auto text = value("--tolerance");
    if (!text) return {};
    return parse_tolerance(*text);
}
std::string Options::word(const std::string& name, const std::vector<std::string>& words) const {
    const auto text = value(name);
    if (!text) return words.front();
    if (std::find(words.begin(), words.end(), *text) == words.end()) fail(name + ": found " + quoted(*text) + ", expected one of: " + listed(words) + did_you_mean(*text, words));
    return *text;
}

const std::string& Options::scene_path() const {
    if (words_.size() != 1) fail("found " + std::to_string(words_.size()) + " file names, expected one scene");
    return words_.front();
}
Scene Options::scene_at(const std::string& path, const std::map<std::string, double>& more) const {
    std::map<std::string, double> parameters;
    for (const std::string& set : values("--set")) {
        const std::size_t equals = set.find('=');
        if (equals == std::string::npos || equals == 0) fail("--set: found " + quoted(set) + ", expected PARAMETER=NUMBER");
        parameters[set.substr(0, equals)] = parse_number("--set " + set.substr(0, equals), set.substr(equals + 1));
    }
    for (const auto& [name, value] : more) parameters[name] = value;
    Scene scene = load_scene(path, parameters);
    if (!quiet() && noted_.insert(path).second) print_notes(scene);
    return scene;
}

void print_notes(const Scene& scene) {
    for (const std::string& note : scene.notes) std::fprintf(stderr, "isoparm: note: %s\n", note.c_str());
}

Tolerance parse_tolerance(const std::string& text) {
    Tolerance t{Tolerance::Unit::absolute, 0};
    const char* end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, t.value);
    const std::string unit(stop, end);
    if (unit == "rel") t.unit = Tolerance::Unit::relative;
    else if (unit == "px") t.unit = Tolerance::Unit::pixels;
    if (error != std::errc() || !(t.value > 0) || !std::isfinite(t.value) || (!unit.empty() && t.unit == Tolerance::Unit::absolute)) {
        throw Error(ErrorKind::usage, "--tolerance: found " + quoted(text) + ", expected a positive number: 1e-3 (scene units), 1e-4rel (of the bounding-box diagonal) or 0.25px (pixels)");
    }
    return t;
}

Composite find_patches(const Scene& scene, const std::string& name) {
    if (const Surface* s = scene.find_surface(name)) return s->patches;
    std::vector<std::string> names;
    for (const Surface& s : scene.surfaces) {
        names.push_back(s.name);
        for (const Member& m : s.patches) {
            if (s.patches.size() == 1) continue;
            names.push_back(s.name + "/" + m.name);
            if (name == names.back()) return {m};
        }
    }
    throw Error(ErrorKind::usage, "--surface: found " + quoted(name) + ", expected one of: " + listed(names) + did_you_mean(name, names));
}

double finite_diagonal(const Scene& scene, const Bounds& box) {
    const double size = box.diagonal();
    if (size == 0 || (size > 1e-70 && size < 1e70)) return size;
    const auto text = [](const Point& p) { return "(" + to_text(p.x) + ", " + to_text(p.y) + ", " + to_text(p.z) + ")"; };
    throw_input(scene.place + ": found surfaces of size " + to_text(size) + ", from " + text(box.low) + " to " + text(box.high) + ", expected a diagonal between 1e-70 and 1e70; scale the data");
}

}  // namespace isoparm
