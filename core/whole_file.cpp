#include "core/whole_file.h"

#include <unistd.h>

#include <cerrno>
#include <string>
#include <system_error>
#include <utility>

#include "core/error.h"

namespace caustics {

WholeFile::WholeFile(const std::filesystem::path& file) : file_(file), temporary_(file) {
    temporary_ += ".tmp-" + std::to_string(getpid());
    out_ = std::fopen(temporary_.c_str(), "wb");
    if (out_ == nullptr) fail(errno);
}

WholeFile::~WholeFile() {
    if (out_ != nullptr) std::fclose(out_);
    std::error_code ignored;
    if (!temporary_.empty()) std::filesystem::remove(temporary_, ignored);
}

void WholeFile::fail(int error) const {
    throw InputError(file_.string() + ": cannot be written (" +
                     std::generic_category().message(error) + ")");
}

void WholeFile::write(std::string_view bytes) {
    if (std::fwrite(bytes.data(), 1, bytes.size(), out_) != bytes.size()) fail(errno);
}

void WholeFile::commit() {
    if (std::fclose(std::exchange(out_, nullptr)) != 0) fail(errno);
    std::error_code error;
    std::filesystem::rename(temporary_, file_, error);
    if (error) fail(error.value());
    temporary_.clear();
}

void write_whole_file(const std::filesystem::path& file, std::string_view bytes) {
    WholeFile out(file);
    out.write(bytes);
    out.commit();
}

}  // namespace caustics
