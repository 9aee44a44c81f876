#include "study/study_store.h"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <ostream>
#include <sstream>

#include "error.h"
#include "io/atomic_file.h"
#include "scene/json.h"
#include "sha256.h"
#include "text/json_text.h"

namespace isoparm {
namespace {

namespace fs = std::filesystem;

double number(const Json& object, const char* key) {
    const Json value = object.at(key, "a number");
    if (!value.is(Json::Kind::number)) value.expected("a number");
    return value.number();
}
std::string text(const Json& object, const char* key) {
    const Json value = object.at(key, "a string");
    if (!value.is(Json::Kind::string)) value.expected("a string");
    return value.string();
}

/// Width and height, from the header chunk.
std::array<int, 2> png_size(const std::string& bytes) {
    const auto at = [&](std::size_t i) {
        int n = 0;
        for (std::size_t k = i; k < i + 4; ++k) n = n << 8 | (k < bytes.size() ? static_cast<unsigned char>(bytes[k]) : 0);
        return n;
    };
    return {at(16), at(20)};
}

/// Members of the file and of a run, in one place for reading and writing.
template <class Run, class F> void each_number(Run& r, F f) {
    f("tolerance", r.tolerance), f("certified_error", r.certified_error), f("certified_parametric", r.certified_parametric),
        f("sampled_error", r.sampled_error);
    f("n_opt", r.optimal), f("seconds_wall", r.seconds), f("seconds_processor", r.processor_seconds);
    f("min_angle_least", r.angles.least), f("min_angle_1_percent", r.angles.percent_1), f("min_angle_5_percent", r.angles.percent_5),
        f("min_angle_median", r.angles.median);
}

StudyRow read_row(const Json& file) {
    StudyRow row;
    StudyRun& run = row.run;
    row.key = text(file, "key");
    row.threads = int(number(file, "threads"));
    run.method = text(file, "method");
    run.reason = text(file, "reason");
    run.reached = run.reason.empty();
    run.triangles = std::size_t(number(file, "triangles")), run.vertices = std::size_t(number(file, "vertices"));
    each_number(run, [&](const char* key, double& x) {
        const Json value = file.at(key, "a number");
        x = value.is(Json::Kind::null) ? TriangleBound::none : number(file, key);  // as json_text() writes what is infinite
    });
    if (row.threads < 1 || (run.reached && (run.triangles == 0 || !(run.certified_error <= run.tolerance))))
        file.fail("found numbers that do not fit together, expected those of a run");
    return row;
}

/// A JSON object, from behind its brace, with its digest as the first member.
std::string sealed(const std::string& rest) { return "{\"sha256\": \"" + sha256(rest) + "\",\n " + rest; }

}  // namespace

StudyStore::StudyStore(std::string folder) : folder_(std::move(folder)) {
    for (const std::string& f : {folder_, path("runs"), path("heat")}) {
        std::error_code failed;
        fs::create_directories(f, failed);
        if (failed) throw Error(ErrorKind::io, f + ": cannot make this folder: " + failed.message());
        if (!fs::is_directory(f)) throw Error(ErrorKind::io, f + ": found a file, expected a folder to write to");
        if (::access(f.c_str(), W_OK | X_OK) != 0) throw Error(ErrorKind::io, f + ": cannot be written: " + std::strerror(errno));
    }
}

std::string StudyStore::run_file(const std::string& method, double tolerance) {
    return "runs/" + method + "-" + to_text(tolerance) + ".json";
}

std::optional<StudyRow> StudyStore::find(const std::string& method, double tolerance, const std::string& key,
                                         const std::array<int, 2>& pictures, std::string& note) const {
    const std::string file = path(run_file(method, tolerance));
    note.clear();
    if (!fs::exists(file)) return {};
    try {
        const std::string text = read_text_file(file);
        const Json json = Json::parse(text, file);
        if (text != sealed(text.substr(std::min(text.size(), sealed("").size())))) json.fail("found other contents than were written");
        StudyRow row = read_row(json);
        if (row.key != key || row.run.method != method || row.run.tolerance != tolerance) {
            note = file + ": of another scene, other options or another version of the program; its run is made again";
            return {};
        }
        const Json heat = json.at("heat", "an object of pictures");
        for (const Json& picture : heat.children()) {
            const std::string name = picture.key();
            row.heat.push_back(name);
            const std::string bytes = fs::exists(path(name)) ? read_text_file(path(name)) : "";
            if (sha256(bytes) != picture.string() || (pictures[0] > 0 && png_size(bytes) != pictures)) {
                note = path(name) + ": missing, changed, or of another size; its run is made again";
                return {};
            }
        }
        if (pictures[0] > 0 && row.run.reached && row.heat.empty()) {
            note = file + ": has no pictures of the error, which are wanted now; its run is made again";
            return {};
        }
        return row;
    } catch (const Error& e) {
        note = std::string(e.what()) + "; the file is damaged, its run is made again";
        return {};
    }
}

void StudyStore::save(const StudyRow& row) const {
    const StudyRun& r = row.run;
    std::string heat;
    for (const std::string& name : row.heat)
        heat += (heat.empty() ? "" : ", ") + json_text(name) + ": " + json_text(sha256(read_text_file(path(name))));
    std::ostringstream out;
    out << "\"key\": " << json_text(row.key) << ",\n \"method\": " << json_text(r.method) << ", \"threads\": " << row.threads
        << ",\n \"triangles\": " << r.triangles << ", \"vertices\": " << r.vertices;
    each_number(r, [&](const char* key, const double& x) { out << ",\n \"" << key << "\": " << json_text(x); });
    out << ",\n \"reason\": " << json_text(r.reason) << ",\n \"heat\": {" << heat << "}}\n";
    write_atomically(path(run_file(r.method, r.tolerance)), [&](std::ostream& file) { file << sealed(out.str()); });
}

}  // namespace isoparm
