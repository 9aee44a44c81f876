// faults.cpp -- a library for LD_PRELOAD: the calls of one kind fail from the N-th on, as on a full disk or without memory.
//   ISOPARM_FAULT     write, fsync, rename, open (of files to be written), read (opening of files to be read), malloc, random (always 0)
//   ISOPARM_FAULT_AT  N, from 1;  ISOPARM_FAULT_ONCE=1  only the N-th fails
//   ISOPARM_FAULT_LOG a file that gets a line once a call was made to fail: where N is beyond all calls there is none
// Only the process that was started is counted, not its children. fopen and fwrite have entries of their own, as the C
// library's calls within itself do not come here.
#include <dlfcn.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdlib>

extern "C" {
void* __libc_malloc(size_t);
void* __libc_calloc(size_t, size_t);
void* __libc_realloc(void*, size_t);
void* __libc_memalign(size_t, size_t);
}

namespace {

enum class Kind { none, write, fsync, rename, open, read, malloc, random };
Kind kind = Kind::none;
long fails_at = 0, owner = 0;
bool once = false;
char log_path[4096];
std::atomic<long> calls{0};
std::atomic<bool> told{false};

__attribute__((constructor)) void configure() {
    const char *what = getenv("ISOPARM_FAULT"), *at = getenv("ISOPARM_FAULT_AT"), *log = getenv("ISOPARM_FAULT_LOG");
    if (!what || !at) return;
    if (log) strncpy(log_path, log, sizeof log_path - 1);
    once = getenv("ISOPARM_FAULT_ONCE") != nullptr;
    fails_at = atol(at);
    owner = syscall(SYS_getpid);
    static const char* const names[] = {"", "write", "fsync", "rename", "open", "read", "malloc", "random"};
    for (int i = 1; i < 8; ++i)
        if (!strcmp(what, names[i])) kind = static_cast<Kind>(i);
}

bool fails(Kind of) {
    if (kind != of || syscall(SYS_getpid) != owner) return false;
    const long n = ++calls;
    if (once ? n != fails_at : n < fails_at) return false;
    if (!told.exchange(true) && log_path[0]) {
        const long file = syscall(SYS_openat, AT_FDCWD, log_path, O_WRONLY | O_CREAT | O_APPEND, 0666);
        if (file >= 0) {
            syscall(SYS_write, file, "failed\n", 7);
            syscall(SYS_close, file);
        }
    }
    return true;
}
template <class F>
F* next(const char* name) {
    return reinterpret_cast<F*>(dlsym(RTLD_NEXT, name));
}
bool writes(int flags) { return (flags & O_ACCMODE) != O_RDONLY; }
/// Devices, pipes and what the C library reads for itself are none of the files that a command is given.
bool counted(const char* path) { return path && strncmp(path, "/proc/", 6) != 0 && strncmp(path, "/dev/", 5) != 0 && strncmp(path, "/sys/", 5) != 0; }
bool open_fails(const char* path, bool to_write) {
    if (!counted(path) || !fails(to_write ? Kind::open : Kind::read)) return false;
    errno = to_write ? EROFS : EMFILE;
    return true;
}
/// Standard output and error are left alone: a full disk is about files.
bool write_fails(int file) {
    if (file <= 2 || !fails(Kind::write)) return false;
    errno = ENOSPC;
    return true;
}

}  // namespace

extern "C" {

ssize_t write(int file, const void* data, size_t size) { return write_fails(file) ? -1 : syscall(SYS_write, file, data, size); }
ssize_t writev(int file, const iovec* parts, int count) { return write_fails(file) ? -1 : syscall(SYS_writev, file, parts, count); }
size_t fwrite(const void* data, size_t size, size_t count, FILE* file) {
    static auto* const real = next<size_t(const void*, size_t, size_t, FILE*)>("fwrite");
    return write_fails(fileno(file)) ? 0 : real(data, size, count, file);
}
int fsync(int file) {
    if (!fails(Kind::fsync)) return static_cast<int>(syscall(SYS_fsync, file));
    errno = EIO;
    return -1;
}
int rename(const char* from, const char* to) {
    if (!fails(Kind::rename)) return static_cast<int>(syscall(SYS_rename, from, to));
    errno = EIO;
    return -1;
}
ssize_t getrandom(void* bytes, size_t size, unsigned flags) {
    if (!fails(Kind::random)) return syscall(SYS_getrandom, bytes, size, flags);
    memset(bytes, 0, size);
    return static_cast<ssize_t>(size);
}
int open(const char* path, int flags, ...) {
    va_list rest;
    va_start(rest, flags);
    const unsigned mode = va_arg(rest, unsigned);
    va_end(rest);
    return open_fails(path, writes(flags)) ? -1 : static_cast<int>(syscall(SYS_openat, AT_FDCWD, path, flags, mode));
}
int open64(const char* path, int flags, ...) {
    va_list rest;
    va_start(rest, flags);
    const unsigned mode = va_arg(rest, unsigned);
    va_end(rest);
    return open_fails(path, writes(flags)) ? -1 : static_cast<int>(syscall(SYS_openat, AT_FDCWD, path, flags, mode));
}
FILE* fopen(const char* path, const char* mode) {
    static auto* const real = next<FILE*(const char*, const char*)>("fopen");
    return open_fails(path, mode && strpbrk(mode, "wa+")) ? nullptr : real(path, mode);
}
FILE* fopen64(const char* path, const char* mode) {
    static auto* const real = next<FILE*(const char*, const char*)>("fopen64");
    return open_fails(path, mode && strpbrk(mode, "wa+")) ? nullptr : real(path, mode);
}

void* malloc(size_t size) {
    if (!fails(Kind::malloc)) return __libc_malloc(size);
    errno = ENOMEM;
    return nullptr;
}
void* calloc(size_t count, size_t size) {
    if (!fails(Kind::malloc)) return __libc_calloc(count, size);
    errno = ENOMEM;
    return nullptr;
}
void* realloc(void* old, size_t size) {
    if (!fails(Kind::malloc)) return __libc_realloc(old, size);
    errno = ENOMEM;
    return nullptr;
}
void* aligned_alloc(size_t alignment, size_t size) {
    if (!fails(Kind::malloc)) return __libc_memalign(alignment, size);
    errno = ENOMEM;
    return nullptr;
}
int posix_memalign(void** to, size_t alignment, size_t size) {
    if (fails(Kind::malloc)) return ENOMEM;
    void* const p = __libc_memalign(alignment, size);
    if (!p) return ENOMEM;
    *to = p;
    return 0;
}

}  // extern "C"
