#include "experiments/base/status_line.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <cstdio>

#include "experiments/base/file_io.h"

namespace caustics::experiments {

namespace {

constexpr std::chrono::milliseconds terminal_interval{200};
constexpr std::chrono::seconds plain_interval{15};

/// Columns of the terminal on stderr now; a window may change while the job is at work.
std::size_t terminal_columns() {
    constexpr std::size_t usual = 80;
    winsize window{};
    const bool known = ioctl(fileno(stderr), TIOCGWINSZ, &window) == 0 && window.ws_col > 0;
    return known ? window.ws_col : usual;
}

}  // namespace

std::string first_characters(const std::string& text, std::size_t count) {
    std::size_t end = 0;
    for (; end < text.size(); ++end) {
        const bool begins = (static_cast<unsigned char>(text[end]) & 0xC0U) != 0x80U;
        if (begins && count-- == 0) break;
    }
    return text.substr(0, end);
}

StatusLine::StatusLine()
    : terminal_(isatty(fileno(stderr)) == 1),
      last_shown_(terminal_ ? 0 : Clock::now().time_since_epoch().count()) {}

StatusLine::~StatusLine() { clear(); }

void StatusLine::clear() const {
    if (terminal_) write_stderr("\r\033[K");
}

bool StatusLine::is_due() const {
    const Clock::duration age = Clock::now().time_since_epoch() - Clock::duration(last_shown_);
    return age >=
           (terminal_ ? Clock::duration(terminal_interval) : Clock::duration(plain_interval));
}

void StatusLine::show(const std::string& line) {
    clear();
    // A character in the last column would make some terminals wrap.
    if (terminal_)
        write_stderr(first_characters(line, terminal_columns() - 1));
    else
        write_stderr(line + "\n");
    last_shown_ = Clock::now().time_since_epoch().count();
}

void StatusLine::note(const std::string& line) {
    clear();
    write_stderr(line + "\n");
}

}  // namespace caustics::experiments
