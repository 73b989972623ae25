#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

#include "core/picture/picture_messages.h"
#include "core/picture/picture_source.h"

namespace caustics {

/// Has pictures decoded by another process, one after another: a crash, a hang and too much memory of a library are
/// a reason there, not the end of this program. The process is a program of its own beside this one, so that any program may
/// ask it, whatever threads it has. It is started for the first picture and ends with this object. One object serves
/// one thread.
class PictureReader {
public:
    explicit PictureReader(std::chrono::seconds patience = std::chrono::seconds(120));
    ~PictureReader();
    PictureReader(const PictureReader&) = delete;
    PictureReader& operator=(const PictureReader&) = delete;

    /// Reads the header of a picture. `format` is that of picture_format(). Throws PictureError.
    PictureShape open(const std::string& bytes, const std::string& format, PictureUse use);
    /// Hands over the rows of the picture that was opened last: some at a time, rows_at_once() of them. Throws
    /// PictureError.
    void read_rows(const PictureShape& shape,
                   const std::function<void(int first, int last, const float* values)>& take);

private:
    void start(const char* program);
    void stop();
    void limit_memory(std::uint64_t more) const;
    void limit_time(std::uint64_t seconds);
    void ask(PictureMessage kind, const std::string& bytes = {});
    /// The length of the answer, which must be of that kind.
    std::uint64_t expect(PictureMessage kind);
    std::string receive_text(std::uint64_t length);
    void require_done(Transfer transfer);
    [[noreturn]] void fail_by_its_end();

    std::chrono::seconds patience_;  ///< with a process that says nothing
    const char* program_ = nullptr;  ///< that runs
    pid_t process_ = -1;
    int socket_ = -1;
    bool is_answering_ = false;
    std::uint64_t before_ = 0;   ///< memory of the process with the file's bytes [bytes]
    std::uint64_t memory_ = 0;   ///< that the picture may take, here and there [bytes]
    std::uint64_t seconds_ = 0;  ///< of the processor that it may take
    PictureUse use_ = PictureUse::texture;
};

}  // namespace caustics
