#pragma once

#include <cstddef>
#include <functional>

namespace caustics {

/// The most threads that may be asked for.
inline constexpr int most_threads = 4096;

/// Runs body(index, worker) for every index below `count` on up to `threads` threads; `worker` is
/// below `threads` and no two bodies run with the same one at a time. The first exception is
/// rethrown after all have stopped; it may be Interrupted. oneTBB, or std::thread where built with CAUSTICS_STD_THREADS
/// (ThreadSanitizer cannot see into the distribution's TBB).
void parallel_for(int threads, std::size_t count,
                  const std::function<void(std::size_t index, std::size_t worker)>& body);

/// Runs `work` while oneTBB, and with it Embree, may use one thread only, in the whole process.
/// (Embree's own setting "threads=1" would stay in force for every later loop.)
void run_single_threaded(const std::function<void()>& work);

/// The number of threads to use by default: those the process may run on.
int available_threads();

}  // namespace caustics
