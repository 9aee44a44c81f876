#include "io/atomic_file.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <vector>

#include "error.h"

namespace isoparm {

namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const std::string& path, const std::string& what, int error) {
    throw Error(ErrorKind::io, path + ": " + what + ": " + std::strerror(error));
}

// ---- temporaries are removed when a signal ends the program ---------------------------------------------------------
// The handler reads names from fixed slots, because a signal may come at any instruction; unlink() is safe in a handler.
constexpr int kSlots = 16;
constexpr std::size_t kNameLength = 4096;
struct Slot {
    std::atomic<bool> used{false}, ready{false};
    pid_t owner;  // a child that was forked meanwhile leaves it alone
    char name[kNameLength];
};
Slot slots[kSlots];
constexpr int kSignals[] = {SIGINT, SIGTERM, SIGHUP};
std::mutex handlers_mutex;
int handlers_users = 0;
bool exit_is_watched = false;  // libjpeg ends the program when it cannot write
struct sigaction handlers_before[std::size(kSignals)];

extern "C" void isoparm_remove_temporaries(int signal) {
    remove_temporaries();
    ::signal(signal, SIG_DFL);
    ::raise(signal);
}

// Only while a temporary exists, and only where the program has no handler of its own.
void install_handlers() {
    const std::lock_guard lock(handlers_mutex);
    if (handlers_users++ > 0) return;
    if (!exit_is_watched) exit_is_watched = std::atexit(remove_temporaries) == 0;
    for (std::size_t i = 0; i < std::size(kSignals); ++i) {
        ::sigaction(kSignals[i], nullptr, &handlers_before[i]);
        if (handlers_before[i].sa_handler != SIG_DFL) continue;
        struct sigaction ours {};
        ours.sa_handler = isoparm_remove_temporaries;
        ::sigemptyset(&ours.sa_mask);
        ::sigaction(kSignals[i], &ours, nullptr);
    }
}
void restore_handlers() {
    const std::lock_guard lock(handlers_mutex);
    if (--handlers_users > 0) return;
    for (std::size_t i = 0; i < std::size(kSignals); ++i)
        if (handlers_before[i].sa_handler == SIG_DFL) ::sigaction(kSignals[i], &handlers_before[i], nullptr);
}

class RemovedOnSignal {
public:
    RemovedOnSignal() { install_handlers(); }
    ~RemovedOnSignal() {
        disarm();
        restore_handlers();
    }
    RemovedOnSignal(const RemovedOnSignal&) = delete;
    RemovedOnSignal& operator=(const RemovedOnSignal&) = delete;
    /// From here on a signal removes `name`, which this process made.
    void arm(const std::string& name) {
        if (name.size() >= kNameLength) return;
        for (Slot& s : slots) {
            if (s.used.exchange(true)) continue;
            std::memcpy(s.name, name.c_str(), name.size() + 1);
            s.owner = ::getpid();
            s.ready = true;
            slot_ = &s;
            return;
        }
    }
    void disarm() {
        if (!slot_) return;
        slot_->ready = false;
        slot_->used = false;
        slot_ = nullptr;
    }

private:
    Slot* slot_ = nullptr;
};

// ---- the temporary --------------------------------------------------------------------------------------------------

std::string random_word() {
    unsigned char bytes[8];
    if (::getrandom(bytes, sizeof bytes, 0) != sizeof bytes) {  // a kernel without it; the name is taken only where it is free
        static std::atomic<std::uint64_t> count{0};
        const std::uint64_t other = static_cast<std::uint64_t>(std::chrono::steady_clock::now().time_since_epoch().count()) * 0x9e3779b97f4a7c15u + ((count++ << 32) ^ static_cast<std::uint64_t>(::getpid()));
        std::memcpy(bytes, &other, sizeof bytes);
    }
    std::string word;
    for (const unsigned char b : bytes) word += "0123456789abcdef"[b >> 4], word += "0123456789abcdef"[b & 15];
    return word;
}

/// Created empty. It has no name until it is whole, so that not even SIGKILL leaves it; on file systems that know no files without names
/// (O_TMPFILE) it has one from the start. Only a name that this process made is removed: it is random, as process numbers are the same in
/// other containers and on other hosts, and short, whatever the length of the file's own.
class Temporary {
public:
    explicit Temporary(const std::string& path) : path_(path) {
        struct stat old {};
        const bool replaces = ::stat(path.c_str(), &old) == 0;
        const mode_t first = replaces ? 0600 : 0666;  // who may not read the old file shall not open the new one while it is empty
        file_ = ::open(folder().c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, first);
        open_to_me();
        unnamed_ = file_ >= 0 && ::access(descriptor().c_str(), W_OK) == 0;  // is /proc there?
        if (!unnamed_) {
            if (file_ >= 0) ::close(file_);
            if (!with_free_name([&](const char* name) { return (file_ = ::open(name, O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, first)) >= 0; })) fail(path, "cannot create a file in its folder", errno);
            open_to_me();
        }
        if (replaces) mode_ = old.st_mode & 0777;  // not setuid and setgid, which were given to another text
    }
    ~Temporary() {
        ::close(file_);
        if (named_) ::unlink(name_.c_str());
    }
    Temporary(const Temporary&) = delete;
    Temporary& operator=(const Temporary&) = delete;
    /// To be opened and written.
    std::string name() const { return unnamed_ ? descriptor() : name_; }

    void sync_and_rename() {
        if (::fchmod(file_, mode_) != 0) { /* a file system without permissions */ }
        const int error = ::fsync(file_) == 0 ? 0 : errno;
        if (error != 0 && error != EINVAL && error != ENOTSUP) fail(path_, "writing failed", error);
        if (unnamed_ && !with_free_name([&](const char* name) { return ::linkat(AT_FDCWD, descriptor().c_str(), AT_FDCWD, name, AT_SYMLINK_FOLLOW) == 0; })) fail(path_, "cannot be made in its folder", errno);
        if (::rename(name_.c_str(), path_.c_str()) != 0) fail(path_, "cannot be replaced", errno);
        named_ = false;
        guard_.disarm();
        const int directory = ::open(folder().c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
        if (directory < 0) return;  // a folder that may be written but not read: the rename itself has succeeded
        const int failed = ::fsync(directory) == 0 ? 0 : errno;
        ::close(directory);
        if (failed != 0 && failed != EINVAL && failed != ENOTSUP) fail(path_, "was written, but its folder cannot be synced", failed);
    }

private:
    std::string folder() const { return fs::path(path_).has_parent_path() ? fs::path(path_).parent_path().string() : "."; }
    std::string descriptor() const { return "/proc/self/fd/" + std::to_string(file_); }
    /// It is opened a second time, by name, which the umask may forbid; the permissions that the umask leaves are given at the end.
    void open_to_me() {
        struct stat made {};
        if (file_ < 0 || ::fstat(file_, &made) != 0) return;
        mode_ = made.st_mode & 0777;
        if (::fchmod(file_, 0600) != 0) { /* a file system without permissions */ }
    }
    /// `make` makes a file of that name unless there is one. False: errno says why not.
    bool with_free_name(const std::function<bool(const char*)>& make) {
        for (int tries = 0; tries < 100; ++tries) {
            name_ = (fs::path(folder()) / ("isoparm.tmp-" + random_word())).string();
            if ((named_ = make(name_.c_str()))) return guard_.arm(name_), true;
            if (errno != EEXIST) return false;
        }
        return false;
    }
    std::string path_, name_;
    int file_ = -1;
    mode_t mode_ = 0600;
    bool unnamed_ = false, named_ = false;  // named_: there is a file name_, and it is ours
    RemovedOnSignal guard_;
};

void write_stream(const std::string& path, const std::string& name, const std::function<void(std::ostream&)>& write) {
    std::vector<char> buffer(1 << 20);
    std::ofstream out;
    out.rdbuf()->pubsetbuf(buffer.data(), static_cast<std::streamsize>(buffer.size()));
    errno = 0;
    out.open(name, std::ios::binary | std::ios::trunc);
    if (!out) fail(path, "cannot be written", errno ? errno : EIO);
    write(out);
    out.flush();
    if (!out) fail(path, "writing failed", errno ? errno : EIO);
    out.close();
    if (!out) fail(path, "writing failed", errno ? errno : EIO);
}

/// A link is followed, so that it stays a link. Throws for a directory.
std::string target_of(const std::string& path) {
    if (path.empty()) throw Error(ErrorKind::io, "the name of the file to write is empty");
    std::error_code code;
    if (fs::is_directory(path, code)) fail(path, "cannot be written", EISDIR);
    const std::string target = behind_links(path);
    if (target.empty()) fail(path, "cannot be written", errno);
    return target;
}
std::atomic<int> devices{0};  // that are being written
static_assert(std::atomic<int>::is_always_lock_free);

/// Opening a FIFO waits for its reader, and writing for room.
void write_device(const std::string& path, const std::function<void(std::ostream&)>& write) {
    struct Counted {
        Counted() { ++devices; }
        ~Counted() { --devices; }
    } const counted;
    write_stream(path, path, write);
}

/// Devices and pipes (/dev/stdout) are written as they are.
bool is_device(const std::string& path) {
    struct stat found {};
    return ::stat(path.c_str(), &found) == 0 && !S_ISREG(found.st_mode) && !S_ISDIR(found.st_mode);
}

/// Libraries go back in what they write, and read it again, which a pipe does not allow: they get a file in memory.
void write_device_by_name(const std::string& path, const std::function<void(const std::string&)>& write) {
    struct Memory {
        int file = ::memfd_create("isoparm", MFD_CLOEXEC);
        ~Memory() { ::close(file); }
    } const memory;
    if (memory.file < 0) fail(path, "cannot make a file in memory for what goes there", errno);
    const std::string name = "/proc/self/fd/" + std::to_string(memory.file);
    write(name);
    write_device(path, [&](std::ostream& out) {
        std::ifstream in(name, std::ios::binary);
        std::vector<char> bytes(1 << 16);
        while (in.read(bytes.data(), static_cast<std::streamsize>(bytes.size())) || in.gcount() > 0) out.write(bytes.data(), in.gcount());
        if (in.bad()) fail(path, "cannot be read from memory", errno ? errno : EIO);
    });
}

}  // namespace

void remove_temporaries() {
    for (Slot& s : slots)
        if (s.ready.load() && s.owner == ::getpid()) ::unlink(s.name);
}

bool writing_to_device() { return devices.load() > 0; }

std::string behind_links(const std::string& path) {
    constexpr int kMost = 40;  // as the kernel
    struct stat found {};
    if (::stat(path.c_str(), &found) != 0 && errno != ENOENT) return "";  // the kernel's own judgement of loops, and of links that others laid
    fs::path at = path;
    std::error_code code;
    for (int k = 0; fs::is_symlink(at, code); ++k) {
        const fs::path link = fs::read_symlink(at, code);
        if (code || k == kMost) return errno = code ? code.value() : ELOOP, "";
        at = at.parent_path() / link;  // link alone where it is absolute
    }
    return at.string();
}

void write_atomically(const std::string& path, const std::function<void(std::ostream&)>& write) {
    const std::string target = target_of(path);
    if (is_device(path)) return write_device(path, write);
    Temporary temporary(target);
    write_stream(path, temporary.name(), write);
    temporary.sync_and_rename();
}

void write_atomically_by_name(const std::string& path, const std::function<void(const std::string&)>& write) {
    const std::string target = target_of(path);
    if (is_device(path)) return write_device_by_name(path, write);
    Temporary temporary(target);
    write(temporary.name());
    temporary.sync_and_rename();
}

}  // namespace isoparm
