#pragma once

#include <cstddef>
#include <string>

namespace caustics {

/// Loads a shared library for good and returns the address of a function of it. `library` is a path from the folder
/// of the running program ("../lib/x.so"); where there is no such file, the loader looks for its name. Throws
/// std::runtime_error with what the loader says.
void* load_function(const std::string& library, const char* function);

/// Threads of this process; 0 where there is no /proc to count them by.
std::size_t thread_count();

/// Threads that libraries began while they were loaded. They sleep and hold nothing that a forked child needs.
std::size_t library_threads();

}  // namespace caustics
