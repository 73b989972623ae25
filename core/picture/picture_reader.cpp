#include "core/picture/picture_reader.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <ctime>
#include <fstream>
#include <memory>
#include <system_error>
#include <vector>

#include "core/base/interrupt.h"
#include "core/picture/picture_limits.h"

namespace caustics {
namespace {

constexpr std::uint64_t megabyte = 1'000'000;
constexpr std::uint64_t most_film_memory = 1000 * megabyte;
constexpr std::uint64_t texel_bytes = 3 * sizeof(float);
constexpr int inherited = 3;  // standard streams

std::filesystem::path beside_this_program(const char* program) {
    std::error_code none;
    const std::filesystem::path own = std::filesystem::read_symlink("/proc/self/exe", none);
    if (own.empty()) throw PictureError("/proc/self/exe does not tell where this program is");
    return (own.parent_path() / CAUSTICS_PICTURE_PROGRAMS / program).lexically_normal();
}

/// A child with a group of its own, so that it is not asked to end with this program, and with nothing open but its
/// socket. Returns an error of the system, or 0.
int spawn(const std::filesystem::path& program, int socket, pid_t& process) {
    posix_spawn_file_actions_t files;
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_adddup2(&files, socket, STDIN_FILENO);
    for (const int stream : {STDOUT_FILENO, STDERR_FILENO})
        posix_spawn_file_actions_addopen(&files, stream, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_addclosefrom_np(&files, inherited);
    sigset_t none;
    sigset_t usual;
    sigemptyset(&none);
    sigfillset(&usual);
    posix_spawnattr_t attributes;
    posix_spawnattr_init(&attributes);
    posix_spawnattr_setflags(
        &attributes, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
    posix_spawnattr_setsigmask(&attributes, &none);
    posix_spawnattr_setsigdefault(&attributes, &usual);
    std::string name = program.string();
    char* const words[] = {name.data(), nullptr};
    const int error = posix_spawn(&process, name.c_str(), &files, &attributes, words, environ);
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&files);
    return error;
}

void set_soft_limit(pid_t process, __rlimit_resource resource, std::uint64_t most) {
    rlimit both{};
    if (prlimit(process, resource, nullptr, &both) != 0) return;
    both.rlim_cur = std::min<rlim_t>(most, both.rlim_max);
    prlimit(process, resource, &both, nullptr);
}

/// Memory for data that a process has, as RLIMIT_DATA counts it.
std::uint64_t data_of(pid_t process) {
    // proc(5): the sixth number is data and stack, in pages.
    std::uint64_t pages = 0;
    std::ifstream in("/proc/" + std::to_string(process) + "/statm");
    for (int number = 0; number < 6; ++number) in >> pages;
    return pages * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

std::string memory_reason(std::uint64_t bytes) {
    return "it needs more than the " + std::to_string(bytes / megabyte) +
           " MB of memory that a file of its size may take";
}

}  // namespace

PictureReader::PictureReader(std::chrono::seconds patience) : patience_(patience) {}

PictureReader::~PictureReader() { stop(); }

PictureShape PictureReader::open(const std::string& bytes, const std::string& format,
                                 PictureUse use) {
    constexpr std::uint64_t usual_seconds = 60;
    const bool is_own = format == "png" || use == PictureUse::film;
    const char* const program = is_own ? "read_pictures" : "read_foreign_pictures";
    if (is_answering_ || program != program_) stop();
    if (process_ < 0) start(program);
    use_ = use;
    memory_ = use == PictureUse::film ? most_film_memory : most_texture_memory(bytes.size());
    before_ = data_of(process_) + bytes.size();
    limit_memory(memory_);
    limit_time(usual_seconds + bytes.size() / megabyte);
    ask(use == PictureUse::film ? PictureMessage::open_film : PictureMessage::open_texture, bytes);
    const PictureShape shape = decode_shape(receive_text(expect(PictureMessage::shape)));
    is_answering_ = false;
    return shape;
}

void PictureReader::read_rows(
    const PictureShape& shape,
    const std::function<void(int first, int last, const float* values)>& take) {
    const std::size_t row = row_values(shape);
    const int rows = rows_at_once(shape);
    const std::uint64_t at_once = row * static_cast<std::uint64_t>(rows) * sizeof(float);
    if (use_ == PictureUse::film) {
        limit_memory(memory_ + at_once);
    } else {
        const std::uint64_t here = at_once + texel_bytes * static_cast<std::uint64_t>(shape.width) *
                                                 static_cast<std::uint64_t>(shape.height);
        if (here >= memory_) throw PictureError(memory_reason(memory_));
        limit_memory(memory_ - here);
    }
    ask(PictureMessage::read_rows);
    std::unique_ptr<float[]> values;
    for (int first = 0; first < shape.height; first += rows) {
        const int last = std::min(first + rows, shape.height);
        const std::uint64_t length = row * static_cast<std::size_t>(last - first) * sizeof(float);
        if (expect(PictureMessage::rows) != length) {
            stop();
            throw PictureError("its rows have another length than its header says");
        }
        if (!values) values = std::make_unique_for_overwrite<float[]>(at_once / sizeof(float));
        require_done(receive_bytes(socket_, values.get(), length));
        take(first, last, values.get());
        throw_if_interrupted();
    }
    is_answering_ = false;
}

void PictureReader::start(const char* program) {
    const std::filesystem::path file = beside_this_program(program);
    int ends[2];
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0)
        throw std::system_error(errno, std::generic_category(), "socketpair");
    socket_ = ends[0];
    const int error = spawn(file, ends[1], process_);
    close(ends[1]);
    if (error != 0) {
        process_ = -1;
        stop();
        throw PictureError("pictures are decoded by " + file.string() +
                           ", which cannot be started: " + std::generic_category().message(error));
    }
    program_ = program;
    const timeval wait = {patience_.count(), 0};
    for (const int option : {SO_RCVTIMEO, SO_SNDTIMEO})
        setsockopt(socket_, SOL_SOCKET, option, &wait, sizeof wait);
    expect(PictureMessage::ready);
}

void PictureReader::stop() {
    if (process_ > 0) {
        kill(process_, SIGKILL);
        while (waitpid(process_, nullptr, 0) < 0 && errno == EINTR) {}
    }
    if (socket_ >= 0) close(socket_);
    process_ = -1;
    socket_ = -1;
    program_ = nullptr;
    is_answering_ = false;
}

void PictureReader::limit_memory(std::uint64_t more) const {
    set_soft_limit(process_, RLIMIT_DATA, before_ + more);
}

void PictureReader::limit_time(std::uint64_t seconds) {
    clockid_t clock{};
    timespec used{};
    if (clock_getcpuclockid(process_, &clock) != 0 || clock_gettime(clock, &used) != 0) return;
    seconds_ = seconds;
    set_soft_limit(process_, RLIMIT_CPU, static_cast<std::uint64_t>(used.tv_sec) + seconds + 1);
}

void PictureReader::ask(PictureMessage kind, const std::string& bytes) {
    is_answering_ = true;
    require_done(send_message(socket_, kind, bytes));
}

std::uint64_t PictureReader::expect(PictureMessage kind) {
    PictureMessageHead head;
    require_done(receive_head(socket_, head));
    if (head.kind == kind) return head.length;
    if (head.kind == PictureMessage::no_memory) {
        is_answering_ = false;
        throw PictureError(memory_reason(memory_));
    }
    if (head.kind == PictureMessage::error) {
        const std::string reason = receive_text(head.length);
        is_answering_ = false;
        throw PictureError(reason);
    }
    stop();
    throw PictureError("the process that decodes it gave another answer than was asked for");
}

std::string PictureReader::receive_text(std::uint64_t length) {
    constexpr std::uint64_t most = 256 * megabyte;
    if (length > most) {
        stop();
        throw PictureError("its description is longer than " + std::to_string(most) + " bytes");
    }
    std::string text(length, '\0');
    require_done(receive_bytes(socket_, text.data(), length));
    return text;
}

void PictureReader::require_done(Transfer transfer) {
    if (transfer == Transfer::done) return;
    if (transfer == Transfer::gone) fail_by_its_end();
    stop();
    throw PictureError("decoding it did not go on for " + std::to_string(patience_.count()) + " s");
}

void PictureReader::fail_by_its_end() {
    int status = 0;
    kill(process_, SIGKILL);
    while (waitpid(process_, &status, 0) < 0 && errno == EINTR) {}
    process_ = -1;
    stop();
    if (!WIFSIGNALED(status))
        throw PictureError("decoding it ended with exit code " +
                           std::to_string(WEXITSTATUS(status)));
    if (WTERMSIG(status) == SIGXCPU)
        throw PictureError("decoding it takes more than " + std::to_string(seconds_) +
                           " s of the processor's time");
    throw PictureError("decoding it ended by signal " + std::to_string(WTERMSIG(status)) + ", " +
                       strsignal(WTERMSIG(status)));
}

}  // namespace caustics
