#include "tests/bench/contest.h"

#include <benchmark/benchmark.h>

#include <ctime>
#include <exception>
#include <optional>

namespace caustics::bench {

namespace {

double seconds(clockid_t clock) {
    timespec now{};
    clock_gettime(clock, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// The contest whose repetitions are running.
struct Running {
    std::string name;
    std::optional<Contest> contest;
    std::string failure;
};
Running running;
bool failed = false;

void begin(const std::string& name, const std::function<Contest()>& make) {
    if (running.name == name) return;
    running = {};
    running.name = name;
    try {
        running.contest = make();
        running.contest->warm_up();
    } catch (const std::exception& error) {
        running.failure = error.what();
        failed = true;
    }
}

}  // namespace

void Contest::add(std::string name, std::function<void()> run, std::function<void()> prepare,
                  double units) {
    contestants_.push_back(
        {std::move(name), std::move(run), std::move(prepare), units > 0 ? units : units_});
}

void Contest::warm_up() {
    for (Contestant& contestant : contestants_) time_once(contestant);
}

void Contest::time_once(Contestant& contestant) const {
    const clockid_t clock = wall_clock_ ? CLOCK_MONOTONIC : CLOCK_THREAD_CPUTIME_ID;
    if (contestant.prepare) contestant.prepare();
    const double start = seconds(clock);
    contestant.run();
    contestant.seconds += seconds(clock) - start;
}

void Contest::run(benchmark::State& state) {
    for (Contestant& contestant : contestants_) contestant.seconds = 0;
    double before = 0;
    for ([[maybe_unused]] auto iteration : state) {
        for (auto c = contestants_.begin(); c != contestants_.end(); ++c) time_once(*c);
        for (auto c = contestants_.rbegin(); c != contestants_.rend(); ++c) time_once(*c);
        double total = 0;
        for (const Contestant& contestant : contestants_) total += contestant.seconds;
        state.SetIterationTime(total - before);
        before = total;
    }
    const double rounds = 2 * static_cast<double>(state.iterations());
    for (const Contestant& contestant : contestants_)
        state.counters[contestant.name] = 1e9 * contestant.seconds / (rounds * contestant.units);
    for (const auto& [name, value] : notes_) state.counters[name] = value;
}

void register_contest(const std::string& name, int iterations, std::function<Contest()> make) {
    const auto benchmark = [name, make = std::move(make)](benchmark::State& state) {
        begin(name, make);
        if (running.contest)
            running.contest->run(state);
        else
            state.SkipWithError(running.failure.c_str());
    };
    benchmark::RegisterBenchmark(name.c_str(), benchmark)
        ->Iterations(iterations)
        ->UseManualTime()
        ->Unit(benchmark::kMillisecond);
}

bool any_contest_failed() { return failed; }

}  // namespace caustics::bench
