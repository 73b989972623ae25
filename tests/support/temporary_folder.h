#pragma once

#include <unistd.h>

#include <filesystem>
#include <string>

#include "tests/support/test_name.h"

namespace caustics::support {

/// A folder of this process alone, removed with all that is in it at the end: tests of one machine
/// run side by side.
class TemporaryFolder {
public:
    /// Named after the running test.
    TemporaryFolder() : TemporaryFolder(test_name()) {}
    explicit TemporaryFolder(const std::string& name)
        : path_(std::filesystem::temp_directory_path() /
                ("causticbench_" + name + "_" + std::to_string(getpid()))) {
        std::filesystem::remove_all(path_);
        std::filesystem::create_directories(path_);
    }
    ~TemporaryFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;

    const std::filesystem::path& path() const { return path_; }
    std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

private:
    std::filesystem::path path_;
};

}  // namespace caustics::support
