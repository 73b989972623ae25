#pragma once

#include <fcntl.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <string>

namespace caustics::experiments {

/// While it lives, stderr is a terminal of so many columns.
class Terminal {
public:
    explicit Terminal(unsigned short columns) : master_(posix_openpt(O_RDWR | O_NOCTTY)) {
        grantpt(master_);
        unlockpt(master_);
        const int end = open(ptsname(master_), O_RDWR | O_NOCTTY);
        const winsize size{24, columns, 0, 0};
        ioctl(end, TIOCSWINSZ, &size);
        std::fflush(stderr);
        dup2(end, STDERR_FILENO);
        close(end);
    }
    ~Terminal() { text(); }
    /// All that was written; stderr is what it was.
    std::string text() {
        if (kept_ < 0) return {};
        std::fflush(stderr);
        // A terminal hands over what was written when the system finds time.
        constexpr int patience = 300;  // [ms]
        std::string all;
        std::array<char, 4096> part;
        pollfd waiting{master_, POLLIN, 0};
        while (poll(&waiting, 1, patience) > 0) {
            const ssize_t count = read(master_, part.data(), part.size());
            if (count <= 0) break;
            all.append(part.data(), static_cast<std::size_t>(count));
        }
        dup2(kept_, STDERR_FILENO);
        close(kept_);
        close(master_);
        kept_ = -1;
        return all;
    }

private:
    int kept_ = dup(STDERR_FILENO);
    int master_;
};

}  // namespace caustics::experiments
