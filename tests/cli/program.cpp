#include "tests/cli/program.h"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <thread>

#include "experiments/base/file_io.h"

namespace caustics::support {

namespace {

std::string file_base() {
    static int runs = 0;
    return std::filesystem::temp_directory_path() /
           ("causticbench-" + std::to_string(getpid()) + "-" + std::to_string(++runs));
}

}  // namespace

Program::Program(const std::vector<std::string>& arguments, const std::filesystem::path& input)
    : Program(CAUSTICBENCH, arguments, input) {}

Program::Program(const std::string& executable, const std::vector<std::string>& arguments,
                 const std::filesystem::path& input) {
    const std::string base = file_base();
    out_ = base + ".out";
    err_ = base + ".err";
    std::vector<std::string> words = {executable};
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);

    child_ = fork();
    if (child_ == 0) {
        constexpr mode_t mode = 0600;
        dup2(open(input.c_str(), O_RDONLY), STDIN_FILENO);
        dup2(open(out_.c_str(), O_WRONLY | O_CREAT | O_TRUNC, mode), STDOUT_FILENO);
        dup2(open(err_.c_str(), O_WRONLY | O_CREAT | O_TRUNC, mode), STDERR_FILENO);
        execv(argv[0], argv.data());
        _exit(127);
    }
}

bool Program::reap(bool wait) {
    has_ended_ = waitpid(child_, &status_, wait ? 0 : WNOHANG) == child_;
    return has_ended_;
}

void Program::signal(int number) const { kill(child_, number); }

ProgramResult Program::wait() {
    if (!has_ended_) reap(true);
    ProgramResult result;
    if (WIFEXITED(status_)) result.exit_code = WEXITSTATUS(status_);
    result.out = read_whole_file(out_);
    result.err = read_whole_file(err_);
    std::filesystem::remove(out_);
    std::filesystem::remove(err_);
    return result;
}

ProgramResult causticbench(const std::vector<std::string>& arguments) {
    return Program(arguments).wait();
}

ProgramResult causticbench_reading(const std::filesystem::path& input,
                                   const std::vector<std::string>& arguments) {
    return Program(arguments, input).wait();
}

ProgramResult shell(const std::string& line) {
    return Program("/bin/sh", {"-c", "P='" CAUSTICBENCH "'; " + line}).wait();
}

ProgramResult interrupted_causticbench(const std::vector<std::string>& arguments,
                                       const std::filesystem::path& file) {
    Program program(arguments);
    while (!std::filesystem::exists(file)) {
        if (program.has_ended()) return program.wait();
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    program.signal(SIGINT);
    return program.wait();
}

std::string scene_of_picture(const std::string& name) {
    return R"({
        "sensor": {"type": "perspective", "film": {"type": "hdrfilm", "width": 4, "height": 3},
                   "to_world": [{"look_at": {"origin": [0, 0, 3], "target": [0, 0, 0],
                                             "up": [0, 1, 0]}}]},
        "light": {"type": "point", "position": [0, 0, 2], "intensity": 1},
        "floor": {"type": "rectangle",
                  "bsdf": {"type": "diffuse",
                           "reflectance": {"type": "bitmap", "filename": ")" +
           name + R"("}}}})";
}

}  // namespace caustics::support
