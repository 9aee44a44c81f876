#include "image/image_decoder.h"

#include <fcntl.h>
#include <malloc.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <thread>

#include "commands/guard.h"
#include "error.h"
#include "image/image_header.h"
#include "image/image_loader.h"

namespace isoparm {
namespace {

constexpr std::size_t kSlot = std::size_t{64} << 20;  // bytes of one block of rows, at most; there are two
constexpr int kFinished = 17;                         // the child's exit code when nothing went wrong

// ---- the child ------------------------------------------------------------------------------------------------------

void send_all(int socket, const void* data, std::size_t size) {
    for (const char* at = static_cast<const char*>(data); size > 0;) {
        const ssize_t n = ::send(socket, at, size, MSG_NOSIGNAL);
        if (n < 0 && errno == EINTR) continue;
        if (n <= 0) ::_exit(kFinished);  // the parent has gone
        at += n, size -= static_cast<std::size_t>(n);
    }
}
void send_number(int socket, std::int32_t x) { send_all(socket, &x, sizeof x); }
void send_text(int socket, const char* text) {
    const auto length = static_cast<std::int32_t>(std::min<std::size_t>(std::strlen(text), 65535));
    send_number(socket, length);
    send_all(socket, text, static_cast<std::size_t>(length));
}

template <class Resource>
void limit(Resource what, rlim_t most) {
    rlimit now{};
    ::getrlimit(what, &now);
    const rlimit lower{std::min(most, now.rlim_max), now.rlim_max};
    ::setrlimit(what, &lower);
}

/// Bytes of address space that are in use.
std::size_t address_space() {
    unsigned long pages = 0;
    if (std::FILE* f = std::fopen("/proc/self/statm", "r")) {
        if (std::fscanf(f, "%lu", &pages) != 1) pages = 0;
        std::fclose(f);
    }
    return pages * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
}

void give_up_rights(const ImageLimits& limits) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    ::prctl(PR_SET_DUMPABLE, 0);
    limit(RLIMIT_CORE, 0);
    limit(RLIMIT_FSIZE, 0);
    limit(RLIMIT_CPU, static_cast<rlim_t>(limits.seconds));
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // which reserve terabytes of addresses
    if (const std::size_t used = address_space()) limit(RLIMIT_AS, used + limits.memory);
#endif
    leave_crashes();
    for (const int s : {SIGINT, SIGTERM, SIGHUP, SIGXCPU}) ::signal(s, SIG_DFL);
    if (const int nowhere = ::open("/dev/null", O_RDWR | O_CLOEXEC); nowhere >= 0) ::dup2(nowhere, 1), ::dup2(nowhere, 2);  // decoders talk
}

/// Stacks and arenas of threads take addresses too: many processors must not use up the limit on memory.
int decoder_threads(const ImageLimits& limits) {
#ifdef M_ARENA_MAX
    ::mallopt(M_ARENA_MAX, 2);
#endif
    const int here = static_cast<int>(std::max(std::thread::hardware_concurrency(), 1u));
    return std::min(limits.threads > 0 ? limits.threads : here, 8);
}

struct Request {
    std::int32_t part, first, rows, kind, slot;
};

void send_fact(void* user, const char* what, const char* value) {
    const int socket = *static_cast<int*>(user);
    send_text(socket, what);
    send_text(socket, value);
}

/// 0, or 1 and why not.
void answer(int socket, int failed, const IsoparmImageError& error) {
    send_number(socket, failed ? 1 : 0);
    if (failed) send_text(socket, error.text);
}

[[noreturn]] void decode(const std::string& path, const std::string& format, const ImageLimits& limits, int socket, char* slots) {
    give_up_rights(limits);
    const ImageModule& module = image_module();  // loaded before
    module.threads(decoder_threads(limits));
    IsoparmImageError error{};
    IsoparmImageFile* file = module.open(path.c_str(), format.c_str(), &error);
    answer(socket, !file, error);
    if (!file) ::_exit(kFinished);
    for (int number = 0;; ++number) {
        IsoparmImagePart part{};
        int whom = socket;
        send_text(socket, "part");
        const int state = module.part(file, number, &part, &send_fact, &whom, &error);
        send_text(socket, "end");
        send_number(socket, state);
        if (state < 0) send_text(socket, error.text);
        if (state != 0) break;
        send_all(socket, &part, sizeof part);
    }
    for (Request r; ::recv(socket, &r, sizeof r, MSG_WAITALL) == sizeof r;)
        answer(socket, module.rows(file, r.part, r.first, r.rows, r.kind, slots + static_cast<std::size_t>(r.slot) * kSlot, &error), error);
    ::_exit(kFinished);
}

ImageHeader checked_header(const std::string& path, const ImageLimits& limits) {
    const auto fail = [&](const std::string& what) { throw Error(ErrorKind::io, path + ": " + what); };
    const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (file < 0) fail(errno == ENOENT ? "there is no such file" : std::string("cannot be read: ") + std::strerror(errno));
    struct stat found {};
    std::string bytes;
    const bool regular = ::fstat(file, &found) == 0 && S_ISREG(found.st_mode);
    if (regular) {
        bytes.resize(static_cast<std::size_t>(std::min<std::int64_t>(found.st_size, kHeaderBytes)));
        std::size_t have = 0;
        for (ssize_t n; have < bytes.size() && (n = ::read(file, &bytes[have], bytes.size() - have)) > 0;) have += static_cast<std::size_t>(n);
        bytes.resize(have);
    }
    struct Closed {
        int file;
        ~Closed() { ::close(file); }
    } const closed{file};
    if (!regular) fail(S_ISDIR(found.st_mode) ? "found a folder, expected an image" : "found a device or pipe, expected an image");
    const ImageHeader h = read_image_header(bytes, static_cast<std::uint64_t>(found.st_size), path);
    if (h.pixels > limits.pixels) fail("found " + std::to_string(h.pixels) + " pixels in the header, expected at most " + std::to_string(limits.pixels) + " (--max-pixels)");
    check_image_end(h.format, static_cast<std::uint64_t>(found.st_size), [&](std::uint64_t at, std::size_t n) {
        std::string part(n, '\0');
        const ssize_t got = ::pread(file, part.data(), n, static_cast<off_t>(at));
        part.resize(got > 0 ? static_cast<std::size_t>(got) : 0);
        return part;
    }, path);
    if (h.row > kSlot / sizeof(double)) fail("found rows of " + std::to_string(h.row) + " numbers in the header, expected at most " + std::to_string(kSlot / sizeof(double)));
    return h;
}

}  // namespace

// ---- the parent -----------------------------------------------------------------------------------------------------

struct ImageDecoder::Child {
    int socket = -1;
    pid_t id = -1;
    char* slots = nullptr;
    Child() {
        void* all = ::mmap(nullptr, 2 * kSlot, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
        if (all == MAP_FAILED) throw Error(ErrorKind::io, std::string("no memory to read images: ") + std::strerror(errno));
        slots = static_cast<char*>(all);
    }
    ~Child() {
        if (socket >= 0) ::close(socket);
        if (id > 0) ::kill(id, SIGKILL);
        end();
        ::munmap(slots, 2 * kSlot);
    }
    int end() {
        int status = 0;
        if (id > 0)
            while (::waitpid(id, &status, 0) < 0 && errno == EINTR) {}
        id = -1;
        return status;
    }
};

ImageDecoder::ImageDecoder(const std::string& path, const ImageLimits& limits) : path_(path), limits_(limits) {
    const ImageHeader header = checked_header(path, limits);
    image_module().threads(1);  // here, so that the children of a process without other threads are forked
    child_ = std::make_unique<Child>();
    int ends[2];
    if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) fail(std::string("no process to read it: ") + std::strerror(errno));
    child_->id = ::fork();
    if (child_->id == 0) {
        ::close(ends[0]);
        decode(path, header.format, limits, ends[1], child_->slots);
    }
    ::close(ends[1]);
    child_->socket = ends[0];
    if (child_->id < 0) fail(std::string("no process to read it: ") + std::strerror(errno));
}

ImageDecoder::~ImageDecoder() = default;

void ImageDecoder::fail(const std::string& what) const { throw Error(ErrorKind::io, path_ + ": " + what); }

void ImageDecoder::child_is_gone() {
    const int status = child_->end();
    const std::string memory = std::to_string(limits_.memory >> 20) + " MiB (--max-memory)";
    if (WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU) fail("decoding took more than " + std::to_string(limits_.seconds) + " seconds of processor time (--max-seconds)");
    if (WIFSIGNALED(status)) fail("its decoder crashed (" + std::string(::strsignal(WTERMSIG(status))) + "): the file is damaged, or needs more memory than " + memory);
    fail("its decoder ended: the file is damaged, or needs more memory than " + memory);
}

void ImageDecoder::receive(void* to, std::size_t size) {
    for (char* at = static_cast<char*>(to); size > 0;) {
        pollfd wait{child_->socket, POLLIN, 0};
        const int ready = ::poll(&wait, 1, limits_.seconds * 1000);
        if (ready < 0 && errno == EINTR) continue;
        if (ready == 0) fail("decoding stood still for " + std::to_string(limits_.seconds) + " seconds (--max-seconds)");
        const ssize_t n = ::recv(child_->socket, at, size, 0);
        if (n < 0 && errno == EINTR) continue;
        if (n <= 0) child_is_gone();
        at += n, size -= static_cast<std::size_t>(n);
    }
}

std::string ImageDecoder::receive_text() {
    std::int32_t length = 0;
    receive(&length, sizeof length);
    if (length < 0 || length > 65535) fail("its decoder went astray: the file is damaged");
    std::string text(static_cast<std::size_t>(length), ' ');
    receive(text.data(), text.size());
    return text;
}

void ImageDecoder::wait() {
    std::int32_t state = 0;
    receive(&state, sizeof state);
    if (state == 0) return;
    std::string why = receive_text();
    if (why == "std::bad_alloc") why = "it needs more memory than " + std::to_string(limits_.memory >> 20) + " MiB (--max-memory)";
    fail("cannot be read as an image: " + why);
}

/// What the child says is checked like the file itself: the file may have taken it over.
void ImageDecoder::open() {
    wait();
    std::uint64_t pixels = 0;
    for (;;) {
        ImagePart p;
        for (std::string what; (what = receive_text()) != "end";) {
            if (what == "part") continue;
            const std::string value = receive_text();
            if (what == "channel") p.channels.push_back(value);
            else if (what == "type") p.types.push_back(value);
            else if (what == "space") p.space.push_back(value);
            else p.name = value;
            if (p.channels.size() > 4096 || p.space.size() > 64) fail("its decoder went astray: the file is damaged");
        }
        std::int32_t state = 0;
        receive(&state, sizeof state);
        if (state < 0) fail("cannot be read as an image: " + receive_text());
        if (state > 0) break;
        IsoparmImagePart part{};
        receive(&part, sizeof part);
        p.data = {part.x, part.y, part.width, part.height};
        p.display = {part.full_x, part.full_y, part.full_width, part.full_height};
        p.tile_height = part.tile_height;
        p.exact = part.exact != 0;
        p.integers = std::all_of(p.types.begin(), p.types.end(), [](const std::string& t) { return t.find("int") != std::string::npos; });
        p.halves = std::all_of(p.types.begin(), p.types.end(), [](const std::string& t) { return t == "half"; });
        if (part.deep || part.depth > 1) fail(part.deep ? "found a deep image, which is not compared; flatten both first" : "found a volume of several planes, which is not compared");
        if (part.width < 1 || part.height < 1 || part.channels < 1 || static_cast<std::size_t>(part.channels) != p.channels.size()) fail("found a part without pixels or channels");
        pixels += static_cast<std::uint64_t>(part.width) * static_cast<std::uint64_t>(part.height);
        if (pixels > 2 * limits_.pixels) fail("found more than " + std::to_string(2 * limits_.pixels) + " pixels with all parts and levels (--max-pixels)");
        parts_.push_back(std::move(p));
        if (most_rows(static_cast<int>(parts_.size()) - 1) < 1) fail("found rows that are too long");
        if (parts_.size() > 4096) fail("found more than 4096 parts");
    }
}

int ImageDecoder::most_rows(int part) const {
    const ImagePart& p = parts_[static_cast<std::size_t>(part)];
    return static_cast<int>(std::min<std::size_t>(kSlot / (sizeof(double) * static_cast<std::size_t>(p.data.width) * p.channels.size()), static_cast<std::size_t>(p.data.height)));
}

void ImageDecoder::begin(int part, int rows, RowKind kind) {
    if (pending_ >= 0) wait();
    part_ = part, rows_ = std::min(rows, most_rows(part)), kind_ = kind, pending_ = -1;
    if (rows_ < rows && rows_ < parts_[static_cast<std::size_t>(part)].data.height) fail("its blocks of rows are too large");
    ask(0);
}

void ImageDecoder::ask(int k) {
    const int first = k * rows_, height = parts_[static_cast<std::size_t>(part_)].data.height;
    if (first >= height) return;
    const Request r{part_, first, std::min(rows_, height - first), static_cast<std::int32_t>(kind_), k % 2};
    const char* at = reinterpret_cast<const char*>(&r);
    for (std::size_t left = sizeof r; left > 0;) {
        const ssize_t n = ::send(child_->socket, at, left, MSG_NOSIGNAL);
        if (n < 0 && errno == EINTR) continue;
        if (n <= 0) child_is_gone();
        at += n, left -= static_cast<std::size_t>(n);
    }
    pending_ = k;
}

const void* ImageDecoder::block(int k) {
    if (pending_ != k) fail("block " + std::to_string(k) + " was not begun");
    wait();
    pending_ = -1;
    ask(k + 1);
    return child_->slots + static_cast<std::size_t>(k % 2) * kSlot;
}

}  // namespace isoparm
