#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <string>

namespace caustics::experiments {

/// One line on stderr on the state of a long job: kept up to date on a terminal, added to the log
/// now and then elsewhere. Any thread may ask is_due(); the rest is for one thread at a time.
/// What cannot be written is lost without a word.
class StatusLine {
public:
    StatusLine();
    ~StatusLine();
    StatusLine(const StatusLine&) = delete;
    StatusLine& operator=(const StatusLine&) = delete;

    bool is_on_terminal() const { return terminal_; }
    /// Whether it is time for show().
    bool is_due() const;
    /// Replaces the line; on a terminal it is cut so that it does not wrap.
    void show(const std::string& line);
    /// A line that stays.
    void note(const std::string& line);

private:
    using Clock = std::chrono::steady_clock;

    void clear() const;

    bool terminal_;
    std::atomic<Clock::rep> last_shown_;
};

/// The first characters of a UTF-8 text, at most `count`.
std::string first_characters(const std::string& text, std::size_t count);

}  // namespace caustics::experiments
