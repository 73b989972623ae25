#include "core/base/shared_library.h"

#include <dlfcn.h>

#include <atomic>
#include <filesystem>
#include <iterator>
#include <stdexcept>
#include <system_error>

namespace caustics {
namespace {

namespace fs = std::filesystem;

std::atomic<std::size_t> begun_by_libraries{0};

void* open_library(const fs::path& library) {
    std::error_code none;
    const fs::path program = fs::read_symlink("/proc/self/exe", none);
    if (program.empty())
        throw std::runtime_error("/proc/self/exe does not tell where this program is");
    return dlopen((program.parent_path() / library).c_str(), RTLD_NOW | RTLD_LOCAL);
}

[[noreturn]] void fail_to_load() {
    const char* const why = dlerror();
    throw std::runtime_error(why != nullptr ? why : "it has no such function");
}

}  // namespace

std::size_t thread_count() {
    std::error_code none;
    const fs::directory_iterator threads("/proc/self/task", none);
    return static_cast<std::size_t>(std::distance(begin(threads), end(threads)));
}

std::size_t library_threads() { return begun_by_libraries; }

void* load_function(const std::string& library, const char* function) {
    const std::size_t before = thread_count();
    void* const opened = open_library(library);
    if (opened == nullptr) fail_to_load();
    const std::size_t after = thread_count();
    if (after > before) begun_by_libraries += after - before;
    void* const found = dlsym(opened, function);
    if (found == nullptr) fail_to_load();
    return found;
}

}  // namespace caustics
