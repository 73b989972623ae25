#include "experiments/files.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <cstdio>
#include <fstream>
#include <sstream>

#include "core/error.h"

namespace caustics {

std::string read_whole_file(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    std::ostringstream text;
    text << in.rdbuf();
    if (!in) throw InputError(fmt::format("{}: cannot be read", file.string()));
    return text.str();
}

std::string file_stamp(const std::filesystem::path& file) {
    struct stat found{};
    if (stat(file.c_str(), &found) != 0) return {};
    return fmt::format("{} {} {}.{:09} {}.{:09}", found.st_ino, found.st_size, found.st_mtim.tv_sec,
                       found.st_mtim.tv_nsec, found.st_ctim.tv_sec, found.st_ctim.tv_nsec);
}

void write_stdout(const std::string& text) {
    const bool written =
        std::fwrite(text.data(), 1, text.size(), stdout) == text.size() && std::fflush(stdout) == 0;
    if (!written) throw InputError("standard output: cannot be written");
}

}  // namespace caustics
