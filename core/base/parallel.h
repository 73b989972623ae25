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

/// Some of the numbers below a count, side by side.
struct Chunk {
    std::size_t index;  ///< of all chunks
    std::size_t first;
    std::size_t end;
};

/// How many chunks of `size` there are in `count`; the last may be smaller.
std::size_t chunk_count(std::size_t count, std::size_t size);
/// parallel_for over the chunks of `size` numbers that `count` is cut into: what a chunk holds does not depend on
/// threads. With one thread or chunk in the caller's.
void parallel_chunks(int threads, std::size_t count, std::size_t size,
                     const std::function<void(const Chunk&)>& body);

/// Runs `work` while oneTBB, and with it Embree, may use one thread only, in the whole process.
/// (Embree's own setting "threads=1" would stay in force for every later loop.)
void run_single_threaded(const std::function<void()>& work);

/// The number of threads to use by default: those the process may run on.
int available_threads();

}  // namespace caustics
