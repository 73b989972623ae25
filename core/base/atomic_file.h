#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace caustics {

/// A file that is whole or absent, whatever stops the process or the machine: written without a name,
/// or under a temporary one beside it where the file system has none without; commit() brings it to
/// the disk, then gives it its name, and brings that there. Without commit() nothing is left behind.
/// Every failure throws InputError naming the file and the system's reason (a full disk, a missing
/// folder).
class AtomicFile {
public:
    explicit AtomicFile(const std::filesystem::path& file);
    ~AtomicFile();
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;

    void write(std::string_view bytes);
    void commit();

private:
    [[noreturn]] void fail(int error) const;
    void put(std::string_view bytes) const;
    void name();

    std::filesystem::path file_;
    std::filesystem::path temporary_;
    std::string waiting_;  ///< bytes that are not written yet
    int out_ = -1;
    bool is_nameless_ = false;
};

/// Throws InputError where no file can be put: its folder is missing or not to be written in, its name is too long, or
/// a folder, pipe, device or symbolic link has its name, which renaming would replace. No link is followed: in a folder from
/// elsewhere it may lead to anything.
void require_writable_place(const std::filesystem::path& file);

/// Writes a file in one go.
void write_atomic_file(const std::filesystem::path& file, std::string_view bytes);

/// The content of a regular file. Throws InputError naming the file when it is absent, cannot be
/// read, or does not fit into memory, and as require_regular_file() does.
std::string read_whole_file(const std::filesystem::path& file);

/// Throws InputError unless there is a regular file: reading a pipe or a device may wait for ever or
/// have no end.
void require_regular_file(const std::filesystem::path& file);

}  // namespace caustics
