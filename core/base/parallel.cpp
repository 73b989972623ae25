#include "core/base/parallel.h"

#include <sched.h>

#include <tbb/global_control.h>

#include <algorithm>
#include <optional>

#ifdef CAUSTICS_STD_THREADS
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>
#else
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#endif

#include "core/base/interrupt.h"

namespace caustics {

int available_threads() {
    cpu_set_t set;
    if (sched_getaffinity(0, sizeof(set), &set) != 0) return 1;
    return std::max(1, CPU_COUNT(&set));
}

void run_single_threaded(const std::function<void()>& work) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 1);
    work();
}

std::size_t chunk_count(std::size_t count, std::size_t size) { return (count + size - 1) / size; }

void parallel_chunks(int threads, std::size_t count, std::size_t size,
                     const std::function<void(const Chunk&)>& body) {
    const std::size_t chunks = chunk_count(count, size);
    const auto run = [&](std::size_t i) { body({i, i * size, std::min(count, (i + 1) * size)}); };
    if (threads > 1 && chunks > 1) {
        parallel_for(threads, chunks, [&](std::size_t i, std::size_t) { run(i); });
        return;
    }
    for (std::size_t i = 0; i < chunks; ++i) {
        throw_if_interrupted();
        run(i);
    }
}

#ifdef CAUSTICS_STD_THREADS

void parallel_for(int threads, std::size_t count,
                  const std::function<void(std::size_t, std::size_t)>& body) {
    std::atomic<std::size_t> next{0};
    std::exception_ptr first;
    std::mutex first_mutex;
    const auto work = [&](std::size_t worker) {
        try {
            for (std::size_t i = next++; i < count; i = next++) {
                throw_if_interrupted();
                body(i, worker);
            }
        } catch (...) {
            next = count;
            const std::lock_guard lock(first_mutex);
            if (!first) first = std::current_exception();
        }
    };
    std::vector<std::thread> pool;
    const auto workers = static_cast<std::size_t>(std::max(1, threads));
    for (std::size_t worker = 1; worker < std::min(workers, count); ++worker)
        pool.emplace_back(work, worker);
    work(0);
    for (std::thread& thread : pool) thread.join();
    if (first) std::rethrow_exception(first);
}

#else

void parallel_for(int threads, std::size_t count,
                  const std::function<void(std::size_t, std::size_t)>& body) {
    // oneTBB starts no more threads than there are processors, and warns on standard error, unless told to.
    std::optional<tbb::global_control> more;
    if (threads > available_threads())
        more.emplace(tbb::global_control::max_allowed_parallelism,
                     static_cast<std::size_t>(threads));
    tbb::task_arena arena(std::max(1, threads));
    arena.execute([&] {
        tbb::parallel_for(
            tbb::blocked_range<std::size_t>(0, count, 1),
            [&](const tbb::blocked_range<std::size_t>& range) {
                const auto worker =
                    static_cast<std::size_t>(tbb::this_task_arena::current_thread_index());
                for (std::size_t i = range.begin(); i != range.end(); ++i) {
                    throw_if_interrupted();
                    body(i, worker);
                }
            },
            tbb::simple_partitioner());
    });
}

#endif

}  // namespace caustics
