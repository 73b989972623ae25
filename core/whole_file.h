#pragma once

#include <cstdio>
#include <filesystem>
#include <string_view>

namespace caustics {

/// A file that is whole or absent: written under a temporary name beside it, and renamed by commit().
/// Without commit() nothing is left behind. Every failure throws InputError naming the file and the
/// system's reason (a full disk, a missing folder).
class WholeFile {
public:
    explicit WholeFile(const std::filesystem::path& file);
    ~WholeFile();
    WholeFile(const WholeFile&) = delete;
    WholeFile& operator=(const WholeFile&) = delete;

    void write(std::string_view bytes);
    void commit();

private:
    [[noreturn]] void fail(int error) const;

    std::filesystem::path file_;
    std::filesystem::path temporary_;
    std::FILE* out_ = nullptr;
};

/// Writes a file in one go.
void write_whole_file(const std::filesystem::path& file, std::string_view bytes);

}  // namespace caustics
