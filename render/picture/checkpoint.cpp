#include "picture/checkpoint.h"

#include <algorithm>
#include <charconv>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include "error.h"
#include "io/atomic_file.h"
#include "scene/suggest.h"
#include "sha256.h"

namespace isoparm {
namespace {

namespace fs = std::filesystem;

constexpr const char* kMagic = "isoparm checkpoint 1\n";
constexpr std::size_t kDigest = 64;

/// Which processors' numbers these are.
std::string byte_order() {
    const double one = 1;
    std::string bytes(sizeof one, 0);
    std::memcpy(bytes.data(), &one, sizeof one);
    return bytes;
}

std::string head_of(const Checkpoint& c) { return kMagic + byte_order() + std::to_string(c.key.size()) + "\n" + c.key; }

std::string body_of(const std::vector<Film*>& films) {
    std::ostringstream out;
    for (const Film* f : films) f->write(out);
    return out.str();
}

[[noreturn]] void fail(const std::string& path, const std::string& what) {
    throw Error(ErrorKind::input, path + ": " + what + "; remove it to begin anew");
}

std::map<std::string, std::string> lines_of(const std::string& key) {
    std::map<std::string, std::string> lines;
    std::istringstream in(key);
    for (std::string line; std::getline(in, line);) {
        const std::size_t space = line.find(' ');
        lines[line.substr(0, space)] = space == std::string::npos ? "" : line.substr(space + 1);
    }
    return lines;
}

/// A text of the file, for a message.
std::string shown(const std::string& text) {
    std::string r = text.substr(0, 80);
    for (char& c : r)
        if (static_cast<unsigned char>(c) < 32 || static_cast<unsigned char>(c) > 126) c = '?';
    return isoparm::quoted(r);
}

[[noreturn]] void tell_difference(const Checkpoint& c, const std::string& found) {
    const auto theirs = lines_of(found), ours = lines_of(c.key);
    for (const auto& [name, value] : ours) {
        const auto other = theirs.find(name);
        if (other == theirs.end()) fail(c.path, "was put by for another picture, found no " + name + ", expected " + shown(value));
        if (other->second != value) fail(c.path, "was put by for another picture, whose " + name + " was " + shown(other->second) + ", expected " + shown(value));
    }
    fail(c.path, "was put by for another picture");
}

}  // namespace

void write_checkpoint(const Checkpoint& c, const std::vector<Film*>& films) {
    const std::string all = head_of(c) + body_of(films);
    const std::string digest = sha256(all);
    write_atomically(c.path, [&](std::ostream& out) { out << all << digest; });
}

bool read_checkpoint(const Checkpoint& c, const std::vector<Film*>& films) {
    std::error_code code;
    const fs::file_status status = fs::status(c.path, code);
    if (status.type() == fs::file_type::not_found) return false;
    if (!fs::is_regular_file(status)) throw Error(ErrorKind::io, c.path + ": found no regular file, expected a checkpoint, or none yet");
    const std::uintmax_t size = fs::file_size(c.path, code);
    std::ifstream in(c.path, std::ios::binary);
    if (code || !in) throw Error(ErrorKind::io, c.path + ": cannot be read: " + std::strerror(code ? code.value() : errno));

    const std::string start = kMagic + byte_order();
    std::string begin(start.size() + 21, 0);
    in.read(begin.data(), static_cast<std::streamsize>(begin.size()));
    begin.resize(static_cast<std::size_t>(in.gcount()));
    if (begin.compare(0, start.size(), start) != 0) fail(c.path, "found no checkpoint that this program wrote");
    std::size_t key_size = 0;
    const char* const digits = begin.data() + start.size();
    const auto [stop, error] = std::from_chars(digits, begin.data() + begin.size(), key_size);
    if (error != std::errc() || stop == begin.data() + begin.size() || *stop != '\n' || key_size > (1 << 20) || key_size > size) fail(c.path, "is damaged in its first lines");
    const std::size_t key_at = static_cast<std::size_t>(stop + 1 - begin.data());
    std::string key(key_size, 0);
    in.clear(), in.seekg(static_cast<std::streamoff>(key_at));
    if (!in.read(key.data(), static_cast<std::streamsize>(key_size))) fail(c.path, "is cut off");
    if (key != c.key) tell_difference(c, key);

    const std::size_t body = body_of(films).size();  // always the same
    if (size != key_at + key_size + body + kDigest)
        fail(c.path, "found " + std::to_string(size) + " bytes, expected " + std::to_string(key_at + key_size + body + kDigest) + ": it is cut off or damaged");
    std::string all(static_cast<std::size_t>(size), 0);
    in.seekg(0);
    if (!in.read(all.data(), static_cast<std::streamsize>(size))) throw Error(ErrorKind::io, c.path + ": cannot be read");
    const std::string digest = all.substr(all.size() - kDigest);
    all.resize(all.size() - kDigest);
    if (sha256(all) != digest) fail(c.path, "is damaged: its SHA-256 is not the one that it was written with");
    std::istringstream films_in(all.substr(key_at + key_size));
    for (Film* f : films)
        if (!f->read(films_in)) fail(c.path, "holds numbers that no picture comes to");
    return true;
}

void PauseTimer::spend(const std::function<void()>& work) {
    const auto start = Clock::now();
    work();
    const auto now = Clock::now();
    next_ = now + std::max(duration(seconds_ > 0 ? seconds_ : 0.5), std::chrono::duration_cast<Clock::duration>(share_ * (now - start)));
}

CheckpointTimer::CheckpointTimer(const Checkpoint& checkpoint, std::vector<Film*> films)
    : checkpoint_(checkpoint), films_(std::move(films)), timer_(checkpoint.seconds, 20) {
    if (!checkpoint_.path.empty()) read_checkpoint(checkpoint_, films_);
}

void CheckpointTimer::save() {
    if (!checkpoint_.path.empty()) timer_.spend([&] { write_checkpoint(checkpoint_, films_); });
}

}  // namespace isoparm
