#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/resource.h>

#include <atomic>
#include <clocale>
#include <csignal>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <new>
#include <string>
#include <system_error>
#include <thread>

#include "core/base/error.h"
#include "experiments/base/file_io.h"
#include "experiments/base/signals.h"
#include "experiments/cli/command_line.h"

namespace caustics::experiments {

namespace {

enum ExitCode { failed = 1, bad_input = 2, unsupported = 3, interrupted = 130 };

int report(const std::string& message, ExitCode code) {
    write_stderr(fmt::format("causticbench: error: {}\n", one_line(message)));
    return code;
}

int run_and_report(int argc, char** argv) {
    try {
        return parse_command_line(argc, argv)();
    } catch (const InputError& error) {
        return report(error.what(), bad_input);
    } catch (const UnsupportedScene& error) {
        return report(error.what(), unsupported);
    } catch (const Interrupted& error) {
        end_in_own_time();
        return report(error.what(), interrupted);
    } catch (const std::filesystem::filesystem_error& error) {
        return report(reason_of(error), bad_input);
    } catch (const std::bad_alloc&) {
        return report(fmt::format("out of memory: {}", fmt::join(argv + 1, argv + argc, " ")),
                      failed);
    } catch (const std::exception& error) {
        return report(error.what(), failed);
    }
}

/// Four times what serves most commands; a stack that is too small ends a process by SIGSEGV, which leaves no word.
constexpr rlim_t least_stack = 512 * 1024;

/// The stack that the system gives each thread, where that is too small; else 0.
rlim_t small_stack() {
    struct rlimit stack{};
    if (getrlimit(RLIMIT_STACK, &stack) != 0 || stack.rlim_cur == RLIM_INFINITY) return 0;
    return stack.rlim_cur < least_stack ? stack.rlim_cur : 0;
}

/// What no function caught; memory and threads that the system refuses by the limits that refuse them.
std::string uncaught_reason() {
    const std::string limits = " (threads or memory may be limited: ulimit -u, -v)";
    try {
        if (const std::exception_ptr uncaught = std::current_exception())
            std::rethrow_exception(uncaught);
    } catch (const std::system_error& error) {
        return error.what() + limits;
    } catch (const std::bad_alloc& error) {
        return error.what() + limits;
    } catch (const std::exception& error) {
        return fmt::format("internal error: {}", error.what());
    } catch (...) {
        return "a library gave up by an unknown exception" + limits;
    }
    return "a library gave up without a reason" + limits;
}

// Libraries that start threads end the program where the system has none left. Several threads may come here at once.
[[noreturn]] void report_uncaught() {
    static std::atomic_flag is_reported;
    if (is_reported.test_and_set())
        while (true) std::this_thread::yield();
    report(uncaught_reason(), failed);
    std::_Exit(failed);
}

}  // namespace

}  // namespace caustics::experiments

int main(int argc, char** argv) {
    using namespace caustics;
    using namespace caustics::experiments;
    std::setlocale(LC_ALL, "C");
    hold_standard_streams();
    catch_interrupts();
    std::set_terminate(report_uncaught);
    std::signal(SIGXFSZ, SIG_IGN);  // a file that grows too large is a failed write like others
    try {
        if (const rlim_t stack = small_stack(); stack > 0)
            return report(fmt::format("the stack is limited to {} KiB, and {} KiB are needed "
                                      "(ulimit -s {})",
                                      stack / 1024, least_stack / 1024, least_stack / 1024),
                          failed);
        return run_and_report(argc, argv);
    } catch (const std::bad_alloc&) {  // not even for the message
        write_stderr("causticbench: error: out of memory\n");
        return failed;
    }
}
