#include "experiments/files.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <sstream>

#include "core/error.h"

namespace caustics {

void write_whole_file(const std::filesystem::path& file, const std::string& text) {
    std::filesystem::path temporary = file;
    temporary += fmt::format(".tmp-{}", getpid());
    {
        std::ofstream out(temporary, std::ios::binary);
        out << text;
        out.close();
        if (!out) {
            std::error_code ignored;
            std::filesystem::remove(temporary, ignored);
            throw InputError(fmt::format("{}: cannot be written", file.string()));
        }
    }
    std::error_code error;
    std::filesystem::rename(temporary, file, error);
    if (!error) return;
    std::error_code ignored;
    std::filesystem::remove(temporary, ignored);
    throw InputError(fmt::format("{}: cannot be written ({})", file.string(), error.message()));
}

std::string read_whole_file(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    std::ostringstream text;
    text << in.rdbuf();
    if (!in) throw InputError(fmt::format("{}: cannot be read", file.string()));
    return text.str();
}

void write_stdout(const std::string& text) {
    const bool written =
        std::fwrite(text.data(), 1, text.size(), stdout) == text.size() && std::fflush(stdout) == 0;
    if (!written) throw InputError("standard output: cannot be written");
}

}  // namespace caustics
