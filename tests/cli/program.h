#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string>
#include <vector>

namespace caustics::support {

/// What a run of the program gave back.
struct ProgramResult {
    int exit_code = -1;  ///< -1: it did not end by itself
    std::string out;
    std::string err;
};

/// causticbench at work, its output going to files.
class Program {
public:
    /// Its standard input is `input`.
    explicit Program(const std::vector<std::string>& arguments,
                     const std::filesystem::path& input = "/dev/null");
    Program(const std::string& executable, const std::vector<std::string>& arguments,
            const std::filesystem::path& input = "/dev/null");

    pid_t id() const { return child_; }
    bool has_ended() { return has_ended_ || reap(false); }
    void signal(int number) const;
    /// Waits for its end; once only.
    ProgramResult wait();

private:
    bool reap(bool wait);

    std::string out_;
    std::string err_;
    pid_t child_ = -1;
    int status_ = 0;
    bool has_ended_ = false;
};

/// Runs causticbench with these arguments, `input` as its standard input.
ProgramResult causticbench_reading(const std::filesystem::path& input,
                                   const std::vector<std::string>& arguments);

/// Runs causticbench with these arguments.
ProgramResult causticbench(const std::vector<std::string>& arguments);

/// Runs a line of shell, in which $P is causticbench.
ProgramResult shell(const std::string& line);

/// Runs it, and sends SIGINT as soon as `file` exists.
ProgramResult interrupted_causticbench(const std::vector<std::string>& arguments,
                                       const std::filesystem::path& file);

/// A scene file whose floor shows the picture of this name beside it.
std::string scene_of_picture(const std::string& name);

}  // namespace caustics::support
