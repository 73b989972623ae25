#pragma once

#include <functional>
#include <string>
#include <vector>

namespace benchmark {
class State;
}

namespace caustics::bench {

/// Contestants that do the same work, timed in turn: whatever slows the machine for a while slows
/// them all, and ratios of their times stay. Times are CPU time of the calling thread.
class Contest {
public:
    /// `units`: how many pieces of work (queries, photons) a contestant does when it runs once.
    explicit Contest(double units) : units_(units) {}

    /// `prepare` is run before each `run`, and is not timed. Both are called many times. `units`: of
    /// a contestant that does another number of pieces; 0: as many as the others.
    void add(std::string name, std::function<void()> run, std::function<void()> prepare = {},
             double units = 0);
    /// Time by the wall's clock: for contestants that start threads.
    void use_wall_clock() { wall_clock_ = true; }
    /// A figure to be reported beside the times.
    void note(const std::string& name, double value) { notes_.emplace_back(name, value); }

    /// Runs each contestant once, untimed.
    void warm_up();
    /// One iteration is two rounds, there and back. Each contestant's nanoseconds per unit become a
    /// counter of its name.
    void run(benchmark::State& state);

private:
    struct Contestant {
        std::string name;
        std::function<void()> run;
        std::function<void()> prepare;
        double units;
        double seconds = 0;
    };
    void time_once(Contestant& contestant) const;

    double units_;
    bool wall_clock_ = false;
    std::vector<Contestant> contestants_;
    std::vector<std::pair<std::string, double>> notes_;
};

/// Registers the benchmark `name` of `iterations` iterations a repetition. `make` is called when
/// its first repetition begins; the contest is dropped when another benchmark begins. What `make`
/// throws (a wrong answer of a contestant, say) fails the benchmark and the program.
void register_contest(const std::string& name, int iterations, std::function<Contest()> make);

bool any_contest_failed();

}  // namespace caustics::bench
