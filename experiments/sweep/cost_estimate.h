#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>

#include "experiments/plan/sweep_plan.h"

namespace caustics::experiments {

/// What a trial costs.
struct Cost {
    double seconds = 0;  ///< on the wall, from its start until its files are there
    double bytes = 0;    ///< of its picture
};

/// Guesses what trials will cost from those that ran: the mean over the same cell, or else the same
/// scene and method, the same method, all. In a scene time follows a method's work (WorkParameter) where
/// trials of different work ran: the line through them by least squares.
class CostEstimate {
public:
    void add(const Trial& trial, const Cost& cost);
    /// Empty before anything was added.
    std::optional<Cost> of(const Trial& trial) const;

private:
    struct Mean {
        Cost sum;
        std::size_t count = 0;
    };
    /// Seconds against work.
    struct Line {
        double count = 0;
        double work = 0;
        double square = 0;
        double seconds = 0;
        double product = 0;

        void add(double of_work, double of_seconds);
        /// Empty where all had the same work, or more of it took no longer.
        std::optional<double> at(double of_work) const;
    };
    std::map<std::string, Mean> means_;
    std::map<std::string, Line> lines_;  ///< by scene and method
};

}  // namespace caustics::experiments
