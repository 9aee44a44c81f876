#include "io/atomic_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
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
    explicit RemovedOnSignal(const std::string& name) {
        install_handlers();
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
    ~RemovedOnSignal() {
        if (slot_) {
            slot_->ready = false;
            slot_->used = false;
        }
        restore_handlers();
    }
    RemovedOnSignal(const RemovedOnSignal&) = delete;
    RemovedOnSignal& operator=(const RemovedOnSignal&) = delete;

private:
    Slot* slot_ = nullptr;
};

// ---- the temporary --------------------------------------------------------------------------------------------------

/// Created empty, with the permissions of the file that it will replace. It has no name until it is whole, so that not even SIGKILL
/// leaves it; on file systems that know no files without names (O_TMPFILE) it has one from the start, and is removed unless it was renamed.
class Temporary {
public:
    explicit Temporary(const std::string& path) : path_(path), name_(unused_name(path)), guard_(name_) {
        file_ = ::open(folder().c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0666);
        unnamed_ = file_ >= 0 && ::access(descriptor().c_str(), W_OK) == 0;  // is /proc there?
        if (!unnamed_) {
            if (file_ >= 0) ::close(file_);
            file_ = ::open(name_.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        }
        if (file_ < 0) fail(path, "cannot create a file in its folder", errno);
        struct stat old {};
        if (::stat(path.c_str(), &old) == 0 && ::fchmod(file_, old.st_mode & 07777) != 0) { /* another's file: keeps the usual permissions */ }
    }
    ~Temporary() {
        ::close(file_);
        if (!renamed_) ::unlink(name_.c_str());
    }
    Temporary(const Temporary&) = delete;
    Temporary& operator=(const Temporary&) = delete;
    /// To be opened and written.
    std::string name() const { return unnamed_ ? descriptor() : name_; }

    void sync_and_rename() {
        const int error = ::fsync(file_) == 0 ? 0 : errno;
        if (error != 0 && error != EINVAL && error != ENOTSUP) fail(path_, "writing failed", error);
        if (unnamed_ && ::linkat(AT_FDCWD, descriptor().c_str(), AT_FDCWD, name_.c_str(), AT_SYMLINK_FOLLOW) != 0) fail(path_, "cannot be made in its folder", errno);
        if (::rename(name_.c_str(), path_.c_str()) != 0) fail(path_, "cannot be replaced", errno);
        renamed_ = true;
        const int directory = ::open(folder().c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
        if (directory < 0) return;  // a folder that may be written but not read: the rename itself has succeeded
        const int failed = ::fsync(directory) == 0 ? 0 : errno;
        ::close(directory);
        if (failed != 0 && failed != EINVAL && failed != ENOTSUP) fail(path_, "was written, but its folder cannot be synced", failed);
    }

private:
    std::string folder() const { return fs::path(path_).has_parent_path() ? fs::path(path_).parent_path().string() : "."; }
    std::string descriptor() const { return "/proc/self/fd/" + std::to_string(file_); }
    static std::string unused_name(const std::string& path) {
        static std::atomic<unsigned> count{0};
        for (;;) {
            const std::string name = path + ".tmp-" + std::to_string(::getpid()) + "-" + std::to_string(count++);
            struct stat found {};
            if (::lstat(name.c_str(), &found) != 0) return name;
        }
    }
    std::string path_, name_;
    int file_ = -1;
    bool unnamed_ = false, renamed_ = false;
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

/// Where the file really lies: a link is followed, so that it stays a link. Throws for a directory.
std::string target_of(const std::string& path) {
    if (path.empty()) throw Error(ErrorKind::io, "the name of the file to write is empty");
    std::error_code code;
    if (fs::is_directory(path, code)) fail(path, "cannot be written", EISDIR);
    if (!fs::is_symlink(path, code)) return path;
    const fs::path real = fs::weakly_canonical(path, code);
    return code ? path : real.string();
}
/// Devices and pipes (/dev/stdout) are written as they are.
bool is_device(const std::string& path) {
    struct stat found {};
    return ::stat(path.c_str(), &found) == 0 && !S_ISREG(found.st_mode) && !S_ISDIR(found.st_mode);
}

}  // namespace

void remove_temporaries() {
    for (Slot& s : slots)
        if (s.ready.load() && s.owner == ::getpid()) ::unlink(s.name);
}

void write_atomically(const std::string& path, const std::function<void(std::ostream&)>& write) {
    const std::string target = target_of(path);
    if (is_device(path)) return write_stream(path, path, write);
    Temporary temporary(target);
    write_stream(path, temporary.name(), write);
    temporary.sync_and_rename();
}

void write_atomically_by_name(const std::string& path, const std::function<void(const std::string&)>& write) {
    const std::string target = target_of(path);
    if (is_device(path)) return write(path);
    Temporary temporary(target);
    write(temporary.name());
    temporary.sync_and_rename();
}

}  // namespace isoparm
