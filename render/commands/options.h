// commands/options.h -- the command line of one command, read the way users of Unix programs expect.
//
// --name value, --name=value, -o value, flags, and -- before words that begin with a dash. Every command knows --quiet and
// --threads N (or ISOPARM_THREADS); main.cpp answers --help. All errors are Error(usage).
#pragma once
#include <array>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "commands/command.h"

namespace isoparm {

class Options {
public:
    struct Known {
        const char* name;  // "--tolerance", "-o"
        bool takes_value;
        const char* instead = nullptr;  // of other programs, refused with this advice
    };
    Options(const char* command, const std::vector<std::string>& arguments, std::vector<Known> known);

    bool has(const std::string& name) const { return given_.count(name) > 0; }
    /// The last one given.
    std::optional<std::string> value(const std::string& name) const;
    /// The same; missing is an error that says what for.
    std::string required(const std::string& name, const std::string& what) const;
    std::vector<std::string> values(const std::string& name) const;
    std::optional<double> number(const std::string& name) const;
    std::optional<int> integer(const std::string& name, int least, int most) const;
    std::optional<Tolerance> tolerance() const;  // --tolerance
    /// One of the words; the first one when not given.
    std::string word(const std::string& name, const std::vector<std::string>& words) const;

    const std::vector<std::string>& words() const { return words_; }
    /// The scene named by the one word of the command line, with its --set parameters; those in `more` count instead. Its notes go
    /// to stderr, the first time.
    Scene scene(const std::map<std::string, double>& more = {}) const { return scene_at(scene_path(), more); }
    /// The same for another path.
    Scene scene_at(const std::string& path, const std::map<std::string, double>& more = {}) const;
    /// Its path; not one word is an error.
    const std::string& scene_path() const;
    bool quiet() const { return has("--quiet"); }
    [[noreturn]] void fail(const std::string& message) const;

private:
    double parse_number(const std::string& option, const std::string& text) const;
    void limit_threads();
    std::string command_;
    std::map<std::string, std::vector<std::string>> given_;
    std::vector<std::string> words_;
    std::shared_ptr<void> thread_limit_;
    mutable std::set<std::string> noted_;  // scenes whose notes were told
};

/// "1e-3" scene units, "1e-4rel" of the bounding-box diagonal, "0.25px" of the picture. Throws Error(usage).
Tolerance parse_tolerance(const std::string& text);

/// Notes of a scene, on stderr.
void print_notes(const Scene& scene);

/// The patches of one surface ("S"), or one of them ("S/member"). Throws Error(usage) that lists what there is.
Composite find_patches(const Scene& scene, const std::string& name);

/// The diagonal of a box about what will be meshed: 0, or between 1e-70 and 1e70. Throws Error(input) that names the scene when it is another.
double finite_diagonal(const Scene& scene, const Bounds& box);

}  // namespace isoparm
