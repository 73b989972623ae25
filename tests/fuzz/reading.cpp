#include "tests/fuzz/reading.h"

#include <fcntl.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>

#include "core/base/error.h"
#include "core/base/hash.h"

namespace caustics::fuzz {
namespace {

struct Folder {
    std::filesystem::path path =
        std::filesystem::temp_directory_path() / ("causticbench_fuzz_" + std::to_string(getpid()));

    Folder() { std::filesystem::create_directories(path); }
    ~Folder() {
        std::error_code ignored;
        std::filesystem::remove_all(path, ignored);
    }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;
};

void require_fit(const std::string& message, Naming naming) {
    if (message.empty() || message.find('\n') != std::string::npos)
        fail("the message is not one line: \"" + message + "\"");
    if (naming == Naming::file && message.find(scratch().string()) == std::string::npos)
        fail("the message names no file: " + message);
}

}  // namespace

const std::filesystem::path& scratch() {
    static const Folder folder;
    return folder.path;
}

std::filesystem::path named(const std::filesystem::path& name) { return scratch() / name; }

std::filesystem::path put(const std::filesystem::path& name, std::string_view bytes) {
    std::filesystem::path file = named(name);
    // Not by a stream, whose buffer takes longer than most inputs.
    const auto opened = [&] { return open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644); };
    int out = opened();
    if (out < 0) {
        std::filesystem::create_directories(file.parent_path());
        out = opened();
    }
    const auto written = write(out, bytes.data(), bytes.size());
    if (close(out) != 0 || written != static_cast<ssize_t>(bytes.size()))
        fail(file.string() + ": cannot be written");
    return file;
}

bool one_in(unsigned share, std::string_view bytes) { return fnv1a(bytes) % share == 0; }

void fail(const std::string& reason) {
    std::fprintf(stderr, "FOUND: %s\n", reason.c_str());
    std::abort();
}

bool taken(Naming naming, const std::function<void()>& read) {
    try {
        read();
        return true;
    } catch (const InputError& error) {
        require_fit(error.what(), naming);
    } catch (const UnsupportedScene& error) {
        require_fit(error.what(), Naming::nothing);
    } catch (const std::filesystem::filesystem_error& error) {  // exit code 2 as well
        require_fit(error.path1().string(), naming);
    }
    return false;
}

}  // namespace caustics::fuzz
