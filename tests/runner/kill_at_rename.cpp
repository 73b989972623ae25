// Preloaded into causticbench by faults_test.py: the process that comes to its rename number
// KILL_AT_RENAME kills itself, just before it or, with KILL_AFTER set, just after.
#include <dlfcn.h>

#include <csignal>
#include <cstdlib>

extern "C" int rename(const char* from, const char* to) {
    using Rename = int (*)(const char*, const char*);
    static const auto original = reinterpret_cast<Rename>(dlsym(RTLD_NEXT, "rename"));
    static int count = 0;
    const char* const wanted = std::getenv("KILL_AT_RENAME");
    const bool is_it = wanted != nullptr && ++count == std::atoi(wanted);
    if (is_it && std::getenv("KILL_AFTER") == nullptr) std::raise(SIGKILL);
    const int result = original(from, to);
    if (is_it) std::raise(SIGKILL);
    return result;
}
