#include "tests/cli/program.h"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>

#include "experiments/files.h"

namespace caustics::support {

ProgramResult causticbench(const std::vector<std::string>& arguments) {
    static int runs = 0;
    const std::string base =
        std::filesystem::temp_directory_path() /
        ("causticbench-" + std::to_string(getpid()) + "-" + std::to_string(++runs));
    const std::string out = base + ".out";
    const std::string err = base + ".err";
    std::vector<std::string> words = {CAUSTICBENCH};
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);

    const pid_t child = fork();
    if (child == 0) {
        constexpr mode_t mode = 0600;
        dup2(open(out.c_str(), O_WRONLY | O_CREAT | O_TRUNC, mode), STDOUT_FILENO);
        dup2(open(err.c_str(), O_WRONLY | O_CREAT | O_TRUNC, mode), STDERR_FILENO);
        execv(argv[0], argv.data());
        _exit(127);
    }
    int status = 0;
    waitpid(child, &status, 0);
    ProgramResult result;
    if (WIFEXITED(status)) result.exit_code = WEXITSTATUS(status);
    result.out = read_whole_file(out);
    result.err = read_whole_file(err);
    std::filesystem::remove(out);
    std::filesystem::remove(err);
    return result;
}

}  // namespace caustics::support
