// Preloaded into a program: makes its nth call of a kind fail, or writes down what its calls change
// on the disk. Calls are counted from main() on, over all processes that are forked or executed.
//
// With CALL_FAULTS_SERVER set, main() does not run: each line of standard input is a run, in a fork of
// the process as it stands when all libraries are loaded. A line holds, between tabs,
//   kind nth errno sticky root trace output folder argument...
// kind: none, memory, io, or room (calls that need room on the disk); errno -1: half of what is asked
// for; sticky 1: all from the nth on; root: only calls on files below it (empty: all); trace: file of the changes (empty: none); output: where
// OUTPUT.out and OUTPUT.err go. Answers are lines: "run PID", then "end STATUS COUNT FIRED CALL PATH".
// With CALL_FAULTS_STACK set, the callers of a call that fails are printed.
#include <dirent.h>
#include <dlfcn.h>
#include <execinfo.h>
#include <fcntl.h>
#include <sched.h>
#include <sys/file.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/uio.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <climits>
#include <cstdarg>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>

// A hook has another name in C++ than in the linker, so that it need not repeat the system's own
// declaration with all its attributes.
#define HOOK(result, name, ...)                            \
    extern "C" result hook_##name(__VA_ARGS__) asm(#name); \
    extern "C" __attribute__((visibility("default"))) result hook_##name(__VA_ARGS__)
#define REAL(name) static const auto real = next<decltype(&hook_##name)>(#name)

extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* old, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);
}

namespace {

enum class Kind : std::int32_t { none, memory, io, room };

constexpr int half = -1;  // instead of an errno

/// Of all processes of a run.
struct Run {
    std::atomic<Kind> kind;
    std::int64_t nth;
    std::int32_t error;
    std::int32_t sticky;
    std::atomic<std::int64_t> count;
    std::atomic<std::int64_t> fired;
    std::atomic_flag busy;  // writing the trace
    char call[32];
    char path[PATH_MAX];
    char root[PATH_MAX];
    char trace[PATH_MAX];
};

constexpr const char* shared_name = "CALL_FAULTS_SHARED";

Run* run = nullptr;
bool in_main = false;
__attribute__((tls_model("initial-exec"))) thread_local bool inside = false;  // a hook

/// What hooks call themselves is neither counted nor made to fail.
class Inside {
public:
    Inside() : before_(inside) { inside = true; }
    ~Inside() { inside = before_; }
    Inside(const Inside&) = delete;
    Inside& operator=(const Inside&) = delete;

private:
    bool before_;
};

template <typename Function>
Function next(const char* name) {
    const Inside guard;
    return reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
}

/// The file's whole name in `to`; of a descriptor, where no path is given.
void full_name(int folder, const char* path, char* to) {
    const Inside guard;
    to[0] = '\0';
    std::size_t length = 0;
    const bool relative = path == nullptr || path[0] != '/';
    if (relative && folder == AT_FDCWD) {
        if (getcwd(to, PATH_MAX) == nullptr) to[0] = '\0';
        length = std::strlen(to);
    } else if (relative) {
        char entry[64];
        std::snprintf(entry, sizeof entry, "/proc/self/fd/%d", folder);
        length = static_cast<std::size_t>(std::max<ssize_t>(0, readlink(entry, to, PATH_MAX - 1)));
        to[length] = '\0';
    }
    if (path != nullptr)
        std::snprintf(to + length, PATH_MAX - length, "%s%s", relative ? "/" : "", path);
}

bool below(const char* path, const char* root) {
    const std::size_t length = std::strlen(root);
    return std::strncmp(path, root, length) == 0 && (path[length] == '/' || path[length] == '\0');
}

/// Counts a call; true, and errno set, where it is the one to fail.
bool hit(Kind kind, const char* name, int folder, const char* path, bool needs_room = false) {
    if (run == nullptr || !in_main || inside) return false;
    if (run->kind != kind && !(needs_room && run->kind == Kind::room)) return false;
    char file[PATH_MAX];
    file[0] = '\0';
    if (kind != Kind::memory) {
        if (run->root[0] != '\0' || run->count + 1 >= run->nth) full_name(folder, path, file);
        if (run->root[0] != '\0' && !below(file, run->root)) return false;
    }
    const std::int64_t number = ++run->count;
    if (run->nth <= 0 || number < run->nth || (number > run->nth && run->sticky == 0)) return false;
    if (run->fired++ == 0) {
        std::snprintf(run->call, sizeof run->call, "%s", name);
        std::snprintf(run->path, sizeof run->path, "%s", file);
    }
    if (std::getenv("CALL_FAULTS_STACK") != nullptr) {
        const Inside guard;
        void* callers[64];
        backtrace_symbols_fd(callers, backtrace(callers, 64), STDERR_FILENO);
    }
    if (run->error != half) errno = run->error;
    return true;
}

bool fails(const char* name, int folder, const char* path = nullptr, bool needs_room = false) {
    return hit(Kind::io, name, folder, path, needs_room) && run->error != half;
}

/// The size to hand on: 0 for one that fails.
std::size_t allowed(const char* name, int file, std::size_t size, bool needs_room = false) {
    if (!hit(Kind::io, name, file, nullptr, needs_room)) return size;
    return run->error == half ? (size + 1) / 2 : 0;
}

bool starves(const char* name) { return hit(Kind::memory, name, AT_FDCWD, nullptr); }

/// Holds up the other processes of the run while something changes and is written down.
class Change {
public:
    explicit Change(int folder = AT_FDCWD, const char* path = nullptr) {
        if (run == nullptr || !in_main || inside || run->trace[0] == '\0') return;
        full_name(folder, path, name_);
        if (!below(name_, run->root)) return;
        kept_ = true;
        while (run->busy.test_and_set()) sched_yield();
    }
    ~Change() {
        if (kept_) run->busy.clear();
    }
    Change(const Change&) = delete;
    Change& operator=(const Change&) = delete;

    explicit operator bool() const { return kept_; }
    const char* name() const { return name_; }
    bool is_there() const {
        const Inside guard;
        struct stat found{};
        return lstat(name_, &found) == 0;
    }
    /// "what number names", and bytes in hexadecimal digits.
    void note(const char* what, std::uint64_t inode, const char* names, const char* bytes = nullptr,
              std::size_t size = 0) const {
        const Inside guard;
        const int error = errno;
        const std::size_t room = std::strlen(names) + 2 * size + 128;
        char* const line = static_cast<char*>(__libc_malloc(room));
        int length = std::snprintf(line, room, "%s\t%lu\t%s\t", what,
                                   static_cast<unsigned long>(inode), names);
        for (std::size_t i = 0; i < size; ++i)
            length += std::snprintf(line + length, 3, "%02x",
                                    static_cast<unsigned>(static_cast<unsigned char>(bytes[i])));
        line[length++] = '\n';
        const int out = open(run->trace, O_WRONLY | O_APPEND | O_CREAT | O_CLOEXEC, 0666);
        if (write(out, line, static_cast<std::size_t>(length)) != length) std::abort();
        close(out);
        std::free(line);
        errno = error;
    }
    static std::uint64_t inode_of(int file) {
        const Inside guard;
        struct stat found{};
        return fstat(file, &found) == 0 ? found.st_ino : 0;
    }
    std::uint64_t inode() const {
        const Inside guard;
        struct stat found{};
        return lstat(name_, &found) == 0 ? found.st_ino : 0;
    }

private:
    bool kept_ = false;
    char name_[PATH_MAX];
};

/// What opening a file has changed.
void note_opened(const Change& change, int file, int flags, bool was_there) {
    if (!change || file < 0) return;
    const std::uint64_t inode = Change::inode_of(file);
    if ((flags & O_TMPFILE) == O_TMPFILE)
        change.note("nameless", inode, "");
    else if (!was_there)
        change.note("create", inode, change.name());
    else if ((flags & O_TRUNC) != 0)
        change.note("truncate", inode, "0");
}

void note_written(const Change& change, int file, const char* bytes, ssize_t size, off_t offset) {
    if (!change || size <= 0) return;
    const Inside guard;
    struct stat found{};
    if (fstat(file, &found) != 0 || !S_ISREG(found.st_mode)) return;
    if (offset < 0) offset = lseek(file, 0, SEEK_CUR) - size;
    char place[32];
    std::snprintf(place, sizeof place, "%ld", static_cast<long>(offset));
    change.note("write", found.st_ino, place, bytes, static_cast<std::size_t>(size));
}

template <typename Open>
int open_hooked(const char* name, int folder, const char* path, int flags, const Open& real) {
    const bool makes = (flags & O_CREAT) != 0 || (flags & O_TMPFILE) == O_TMPFILE;
    if (fails(name, folder, path, makes)) return -1;
    const Change change(folder, path);
    const bool was_there = !change || change.is_there();
    const int file = real();
    note_opened(change, file, flags, was_there);
    return file;
}

mode_t mode_of(int flags, va_list more) {
    const bool makes = (flags & O_CREAT) != 0 || (flags & O_TMPFILE) == O_TMPFILE;
    return makes ? va_arg(more, mode_t) : 0;
}

/// As fopen() would.
int flags_of(const char* mode) {
    int flags = mode[0] == 'r' ? 0 : O_CREAT;
    if (mode[0] == 'w') flags |= O_TRUNC;
    return flags;
}

}  // namespace

// Memory.

HOOK(void*, malloc, std::size_t size) { return starves("malloc") ? nullptr : __libc_malloc(size); }
HOOK(void*, calloc, std::size_t count, std::size_t size) {
    return starves("calloc") ? nullptr : __libc_calloc(count, size);
}
HOOK(void*, realloc, void* old, std::size_t size) {
    return size > 0 && starves("realloc") ? nullptr : __libc_realloc(old, size);
}
HOOK(void*, memalign, std::size_t alignment, std::size_t size) {
    return starves("memalign") ? nullptr : __libc_memalign(alignment, size);
}
HOOK(void*, aligned_alloc, std::size_t alignment, std::size_t size) {
    return starves("aligned_alloc") ? nullptr : __libc_memalign(alignment, size);
}
HOOK(int, posix_memalign, void** to, std::size_t alignment, std::size_t size) {
    if (starves("posix_memalign")) return ENOMEM;
    void* const made = __libc_memalign(alignment, size);
    if (made == nullptr) return ENOMEM;
    *to = made;
    return 0;
}
HOOK(void*, mmap, void* place, std::size_t size, int protection, int flags, int file,
     off_t offset) {
    REAL(mmap);
    if ((flags & MAP_ANONYMOUS) != 0 && starves("mmap")) return MAP_FAILED;
    return real(place, size, protection, flags, file, offset);
}
HOOK(void*, mmap64, void* place, std::size_t size, int protection, int flags, int file,
     off_t offset) {
    return hook_mmap(place, size, protection, flags, file, offset);
}

// Files.

HOOK(int, open, const char* path, int flags, ...) {
    REAL(open);
    va_list more;
    va_start(more, flags);
    const mode_t mode = mode_of(flags, more);
    va_end(more);
    return open_hooked("open", AT_FDCWD, path, flags, [&] { return real(path, flags, mode); });
}
HOOK(int, open64, const char* path, int flags, ...) {
    va_list more;
    va_start(more, flags);
    const mode_t mode = mode_of(flags, more);
    va_end(more);
    return hook_open(path, flags, mode);
}
HOOK(int, openat, int folder, const char* path, int flags, ...) {
    REAL(openat);
    va_list more;
    va_start(more, flags);
    const mode_t mode = mode_of(flags, more);
    va_end(more);
    return open_hooked("openat", folder, path, flags,
                       [&] { return real(folder, path, flags, mode); });
}
HOOK(int, openat64, int folder, const char* path, int flags, ...) {
    va_list more;
    va_start(more, flags);
    const mode_t mode = mode_of(flags, more);
    va_end(more);
    return hook_openat(folder, path, flags, mode);
}
HOOK(std::FILE*, fopen, const char* path, const char* mode) {
    REAL(fopen);
    if (fails("fopen", AT_FDCWD, path, mode[0] != 'r')) return nullptr;
    const Change change(AT_FDCWD, path);
    const bool was_there = !change || change.is_there();
    std::FILE* const file = real(path, mode);
    if (file != nullptr) note_opened(change, fileno(file), flags_of(mode), was_there);
    return file;
}
HOOK(std::FILE*, fopen64, const char* path, const char* mode) { return hook_fopen(path, mode); }
HOOK(std::FILE*, fdopen, int file, const char* mode) {
    REAL(fdopen);
    return fails("fdopen", file) ? nullptr : real(file, mode);
}
HOOK(ssize_t, read, int file, void* to, std::size_t size) {
    REAL(read);
    const std::size_t most = allowed("read", file, size);
    return most == 0 && size > 0 ? -1 : real(file, to, most);
}
HOOK(ssize_t, pread, int file, void* to, std::size_t size, off_t offset) {
    REAL(pread);
    const std::size_t most = allowed("pread", file, size);
    return most == 0 && size > 0 ? -1 : real(file, to, most, offset);
}
HOOK(ssize_t, pread64, int file, void* to, std::size_t size, off_t offset) {
    return hook_pread(file, to, size, offset);
}
HOOK(ssize_t, write, int file, const void* from, std::size_t size) {
    REAL(write);
    const std::size_t most = allowed("write", file, size, true);
    if (most == 0 && size > 0) return -1;
    const Change change(file);
    const ssize_t written = real(file, from, most);
    note_written(change, file, static_cast<const char*>(from), written, -1);
    return written;
}
HOOK(ssize_t, pwrite, int file, const void* from, std::size_t size, off_t offset) {
    REAL(pwrite);
    const std::size_t most = allowed("pwrite", file, size, true);
    if (most == 0 && size > 0) return -1;
    const Change change(file);
    const ssize_t written = real(file, from, most, offset);
    note_written(change, file, static_cast<const char*>(from), written, offset);
    return written;
}
HOOK(ssize_t, pwrite64, int file, const void* from, std::size_t size, off_t offset) {
    return hook_pwrite(file, from, size, offset);
}
HOOK(ssize_t, writev, int file, const iovec* parts, int count) {
    // One by one: a caller must take fewer bytes than it asked for anyway.
    ssize_t all = 0;
    for (int i = 0; i < count; ++i) {
        const ssize_t written = hook_write(file, parts[i].iov_base, parts[i].iov_len);
        if (written < 0) return all > 0 ? all : -1;
        all += written;
        if (static_cast<std::size_t>(written) < parts[i].iov_len) break;
    }
    return all;
}
HOOK(std::size_t, fwrite, const void* from, std::size_t size, std::size_t count, std::FILE* file) {
    REAL(fwrite);
    if (fails("fwrite", fileno(file))) return 0;
    const Change change(fileno(file));
    const std::size_t written = real(from, size, count, file);
    if (change) {
        // Of a stream with a buffer, the place where it will be.
        const auto length = static_cast<ssize_t>(written * size);
        const off_t place = file == stderr ? -1 : ftello(file) - length;
        note_written(change, fileno(file), static_cast<const char*>(from), length, place);
    }
    return written;
}
HOOK(int, fflush, std::FILE* file) {
    REAL(fflush);
    if (file != nullptr && fails("fflush", fileno(file))) return EOF;
    return real(file);
}
HOOK(int, fclose, std::FILE* file) {
    REAL(fclose);
    const bool failed = fails("fclose", fileno(file));
    const int error = errno;
    const int result = real(file);
    if (failed) errno = error;
    return failed ? EOF : result;
}
HOOK(int, close, int file) {
    REAL(close);
    const bool failed = fails("close", file);
    const int error = errno;
    const int result = real(file);
    if (failed) errno = error;
    return failed ? -1 : result;
}
HOOK(int, fsync, int file) {
    REAL(fsync);
    if (fails("fsync", file, nullptr, true)) return -1;
    const Change change(file);
    // What is written down as brought to the disk need not wait for this one.
    const int result = change ? 0 : real(file);
    if (change) change.note("sync", Change::inode_of(file), change.name());
    return result;
}
HOOK(int, fdatasync, int file) { return hook_fsync(file); }
HOOK(int, ftruncate, int file, off_t size) {
    REAL(ftruncate);
    if (fails("ftruncate", file, nullptr, true)) return -1;
    const Change change(file);
    const int result = real(file, size);
    char place[32];
    std::snprintf(place, sizeof place, "%ld", static_cast<long>(size));
    if (change && result == 0) change.note("truncate", Change::inode_of(file), place);
    return result;
}
HOOK(int, ftruncate64, int file, off_t size) { return hook_ftruncate(file, size); }
HOOK(ssize_t, sendfile, int to, int from, off_t* offset, std::size_t size) {
    REAL(sendfile);
    if (fails("sendfile", to, nullptr, true)) return -1;
    if (run != nullptr && run->trace[0] != '\0') {
        errno = EINVAL;  // so that it is written where it can be written down
        return -1;
    }
    return real(to, from, offset, size);
}
HOOK(ssize_t, sendfile64, int to, int from, off_t* offset, std::size_t size) {
    return hook_sendfile(to, from, offset, size);
}
HOOK(ssize_t, copy_file_range, int from, off_t* at, int to, off_t* offset, std::size_t size,
     unsigned flags) {
    REAL(copy_file_range);
    if (fails("copy_file_range", to, nullptr, true)) return -1;
    if (run != nullptr && run->trace[0] != '\0') {
        errno = ENOSYS;
        return -1;
    }
    return real(from, at, to, offset, size, flags);
}
HOOK(int, flock, int file, int what) {
    REAL(flock);
    return fails("flock", file) ? -1 : real(file, what);
}
HOOK(int, fcntl, int file, int what, ...) {
    REAL(fcntl);
    va_list more;
    va_start(more, what);
    void* const argument = va_arg(more, void*);
    va_end(more);
    const bool counts = what == F_SETLK || what == F_SETLKW || what == F_GETLK ||
                        what == F_DUPFD_CLOEXEC || what == F_SETFL;
    return counts && fails("fcntl", file) ? -1 : real(file, what, argument);
}
HOOK(int, fcntl64, int file, int what, ...) {
    va_list more;
    va_start(more, what);
    void* const argument = va_arg(more, void*);
    va_end(more);
    return hook_fcntl(file, what, argument);
}

// Names.

HOOK(int, rename, const char* from, const char* to) {
    REAL(rename);
    if (fails("rename", AT_FDCWD, to, true)) return -1;
    const Change change(AT_FDCWD, to);
    char names[2 * PATH_MAX];
    full_name(AT_FDCWD, from, names);
    const int result = real(from, to);
    if (change && result == 0) {
        std::strncat(names, "\t", 2);
        std::strncat(names, change.name(), PATH_MAX);
        change.note("rename", change.inode(), names);
    }
    return result;
}
HOOK(int, linkat, int from_folder, const char* from, int folder, const char* to, int flags) {
    REAL(linkat);
    if (fails("linkat", folder, to, true)) return -1;
    const Change change(folder, to);
    const int result = real(from_folder, from, folder, to, flags);
    if (change && result == 0) change.note("link", change.inode(), change.name());
    return result;
}
HOOK(int, unlink, const char* path) {
    REAL(unlink);
    if (fails("unlink", AT_FDCWD, path)) return -1;
    const Change change(AT_FDCWD, path);
    const int result = real(path);
    if (change && result == 0) change.note("unlink", 0, change.name());
    return result;
}
HOOK(int, unlinkat, int folder, const char* path, int flags) {
    REAL(unlinkat);
    if (fails("unlinkat", folder, path)) return -1;
    const Change change(folder, path);
    const int result = real(folder, path, flags);
    if (change && result == 0)
        change.note((flags & AT_REMOVEDIR) != 0 ? "rmdir" : "unlink", 0, change.name());
    return result;
}
HOOK(int, rmdir, const char* path) {
    REAL(rmdir);
    if (fails("rmdir", AT_FDCWD, path)) return -1;
    const Change change(AT_FDCWD, path);
    const int result = real(path);
    if (change && result == 0) change.note("rmdir", 0, change.name());
    return result;
}
HOOK(int, remove, const char* path) {
    REAL(remove);
    if (fails("remove", AT_FDCWD, path)) return -1;
    const Change change(AT_FDCWD, path);
    struct stat found{};
    if (change) lstat(path, &found);
    const int result = real(path);
    if (change && result == 0)
        change.note(S_ISDIR(found.st_mode) ? "rmdir" : "unlink", 0, change.name());
    return result;
}
HOOK(int, mkdir, const char* path, mode_t mode) {
    REAL(mkdir);
    if (fails("mkdir", AT_FDCWD, path, true)) return -1;
    const Change change(AT_FDCWD, path);
    const int result = real(path, mode);
    if (change && result == 0) change.note("mkdir", change.inode(), change.name());
    return result;
}
HOOK(int, stat, const char* path, struct stat* to) {
    REAL(stat);
    return fails("stat", AT_FDCWD, path) ? -1 : real(path, to);
}
HOOK(int, lstat, const char* path, struct stat* to) {
    REAL(lstat);
    return fails("lstat", AT_FDCWD, path) ? -1 : real(path, to);
}
HOOK(int, fstat, int file, struct stat* to) {
    REAL(fstat);
    return fails("fstat", file) ? -1 : real(file, to);
}
HOOK(DIR*, opendir, const char* path) {
    REAL(opendir);
    return fails("opendir", AT_FDCWD, path) ? nullptr : real(path);
}
HOOK(dirent*, readdir, DIR* folder) {
    REAL(readdir);
    return fails("readdir", dirfd(folder)) ? nullptr : real(folder);
}
HOOK(ssize_t, readlink, const char* path, char* to, std::size_t size) {
    REAL(readlink);
    return fails("readlink", AT_FDCWD, path) ? -1 : real(path, to, size);
}

// Processes and descriptors.

HOOK(pid_t, fork) {
    REAL(fork);
    return fails("fork", AT_FDCWD) ? -1 : real();
}
HOOK(int, execv, const char* path, char* const* arguments) {
    REAL(execv);
    return fails("execv", AT_FDCWD, path) ? -1 : real(path, arguments);
}
HOOK(int, pipe2, int* ends, int flags) {
    REAL(pipe2);
    return fails("pipe2", AT_FDCWD) ? -1 : real(ends, flags);
}
HOOK(int, dup, int file) {
    REAL(dup);
    return fails("dup", file) ? -1 : real(file);
}
HOOK(int, dup2, int file, int to) {
    REAL(dup2);
    return fails("dup2", file) ? -1 : real(file, to);
}
HOOK(pid_t, waitpid, pid_t process, int* status, int options) {
    REAL(waitpid);
    // Only an interruption is a failure that a call for an own child can have.
    const bool may = run != nullptr && run->error == EINTR;
    return may && fails("waitpid", AT_FDCWD) ? -1 : real(process, status, options);
}

// Runs.

namespace {

constexpr int first_argument = 8;
constexpr int most_fields = 64;

/// Fields of a line between tabs.
int split(char* line, char** fields) {
    int count = 0;
    for (char* field = line; field != nullptr && count < most_fields - 1;) {
        fields[count++] = field;
        field = std::strchr(field, '\t');
        if (field != nullptr) *field++ = '\0';
    }
    fields[count] = nullptr;
    return count;
}

void prepare(char** fields) {
    run->kind = Kind::none;
    run->nth = std::atoll(fields[1]);
    run->error = std::atoi(fields[2]);
    run->sticky = std::atoi(fields[3]);
    run->count = 0;
    run->fired = 0;
    run->busy.clear();
    run->call[0] = run->path[0] = '\0';
    std::snprintf(run->root, PATH_MAX, "%s", fields[4]);
    std::snprintf(run->trace, PATH_MAX, "%s", fields[5]);
    if (std::strcmp(fields[0], "memory") == 0) run->kind = Kind::memory;
    if (std::strcmp(fields[0], "io") == 0) run->kind = Kind::io;
    if (std::strcmp(fields[0], "room") == 0) run->kind = Kind::room;
}

void redirect(const char* output, const char* ending, int stream) {
    char name[PATH_MAX];
    std::snprintf(name, sizeof name, "%s%s", output, ending);
    const int file = open(name, O_WRONLY | O_CREAT | O_TRUNC, 0666);
    dup2(file, stream);
    close(file);
}

void settle_in(char** fields) {
    const Inside guard;
    setsid();
    const int nothing = open("/dev/null", O_RDONLY);
    dup2(nothing, STDIN_FILENO);
    close(nothing);
    redirect(fields[6], ".out", STDOUT_FILENO);
    redirect(fields[6], ".err", STDERR_FILENO);
    if (chdir(fields[7]) != 0) std::abort();
}

using Main = int (*)(int, char**, char**);
Main main_of_program = nullptr;

int counted_main(int argc, char** argv, char** environment) {
    in_main = true;
    return main_of_program(argc, argv, environment);
}

void answer(pid_t process) {
    std::printf("run %d\n", process);
    std::fflush(stdout);
    int status = 0;
    while (waitpid(process, &status, 0) < 0) {}
    std::printf("end %d %ld %ld %s %s\n", status, static_cast<long>(run->count),
                static_cast<long>(run->fired), run->call[0] == '\0' ? "-" : run->call, run->path);
    std::fflush(stdout);
}

int serve(int, char** argv, char** environment) {
    unsetenv("CALL_FAULTS_SERVER");
    static char line[1 << 16];
    static char* fields[most_fields];
    // Unbuffered, so that no fork sees lines that are not its own.
    std::setvbuf(stdin, nullptr, _IONBF, 0);
    while (std::fgets(line, sizeof line, stdin) != nullptr) {
        line[std::strcspn(line, "\n")] = '\0';
        const int count = split(line, fields);
        prepare(fields);
        const pid_t process = fork();
        if (process == 0) {
            settle_in(fields);
            fields[first_argument - 1] = argv[0];
            const int code =
                counted_main(count - first_argument + 1, fields + first_argument - 1, environment);
            std::fflush(nullptr);
            _exit(code);  // libraries would wait for threads that are the server's
        }
        answer(process);
    }
    return 0;
}

/// The run that this process belongs to; made by the server, and found by programs that it becomes.
Run* shared_run() {
    const Inside guard;
    const char* const known = std::getenv(shared_name);
    int file = known == nullptr ? -1 : std::atoi(known);
    if (file < 0) {
        file = memfd_create("call_faults", 0);
        if (ftruncate(file, sizeof(Run)) != 0) std::abort();
        char number[16];
        std::snprintf(number, sizeof number, "%d", file);
        setenv(shared_name, number, 1);
    }
    void* const place = mmap(nullptr, sizeof(Run), PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
    return place == MAP_FAILED ? nullptr : static_cast<Run*>(place);
}

}  // namespace

HOOK(int, __libc_start_main, Main program, int argc, char** argv, void (*begin)(), void (*end)(),
     void (*unload)(), void* stack) {
    REAL(__libc_start_main);
    main_of_program = program;
    run = shared_run();
    const bool serves = std::getenv("CALL_FAULTS_SERVER") != nullptr;
    return real(serves ? serve : counted_main, argc, argv, begin, end, unload, stack);
}
