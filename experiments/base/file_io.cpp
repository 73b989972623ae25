#include "experiments/base/file_io.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <system_error>
#include <vector>

#include "core/base/error.h"
#include "core/base/interrupt.h"

namespace caustics::experiments {

namespace {

/// A file's descriptor.
class Descriptor {
public:
    /// Not blocking: a pipe without a writer would hold up the opening, which no signal ends.
    explicit Descriptor(const std::filesystem::path& file)
        : number_(file == "-" ? dup(STDIN_FILENO)
                              : open(file.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC)) {}
    ~Descriptor() {
        if (number_ >= 0) close(number_);
    }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;

    int number() const { return number_; }
    /// Devices may have no end, but a terminal has one.
    bool may_be_read() const {
        struct stat found{};
        if (fstat(number_, &found) != 0) return false;
        return S_ISREG(found.st_mode) || S_ISFIFO(found.st_mode) || S_ISSOCK(found.st_mode) ||
               isatty(number_) == 1;
    }

private:
    int number_;
};

}  // namespace

std::string read_input(const std::filesystem::path& file) {
    const std::string name = file == "-" ? "standard input" : file.string();
    const auto fail = [&](const std::string& why) {
        throw InputError(fmt::format("{}: cannot be read ({})", name, why));
    };
    const Descriptor in(file);
    if (in.number() < 0) fail(std::generic_category().message(errno));
    if (!in.may_be_read()) fail("neither a file nor a pipe");
    std::string text;
    std::vector<char> block(1 << 16);
    while (true) {
        pollfd ready{in.number(), POLLIN, 0};
        poll(&ready, 1, -1);
        throw_if_interrupted();
        const ssize_t count = read(in.number(), block.data(), block.size());
        if (count == 0) return text;
        if (count > 0)
            text.append(block.data(), static_cast<std::size_t>(count));
        else if (errno != EINTR && errno != EAGAIN)
            fail(std::generic_category().message(errno));
    }
}

std::string file_stamp(const std::filesystem::path& file) {
    struct stat found{};
    if (stat(file.c_str(), &found) != 0) return {};
    return fmt::format("{} {} {}.{:09} {}.{:09}", found.st_ino, found.st_size, found.st_mtim.tv_sec,
                       found.st_mtim.tv_nsec, found.st_ctim.tv_sec, found.st_ctim.tv_nsec);
}

std::string reason_of(const std::filesystem::filesystem_error& error) {
    // Only a question for the working folder names no path.
    const std::string place = error.path1().empty() ? "the working folder" : error.path1().string();
    return fmt::format("{}: {}", place, error.code().message());
}

void hold_standard_streams() {
    for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
        if (fcntl(stream, F_GETFD) < 0)
            open("/dev/null", stream == STDIN_FILENO ? O_WRONLY : O_RDONLY);
}

void write_stderr(std::string_view text) {
    std::fwrite(text.data(), 1, text.size(), stderr);
    std::fflush(stderr);
}

void write_stdout(const std::string& text) {
    const bool written =
        std::fwrite(text.data(), 1, text.size(), stdout) == text.size() && std::fflush(stdout) == 0;
    if (!written) throw InputError("standard output: cannot be written");
}

}  // namespace caustics::experiments
