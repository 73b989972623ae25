#pragma once

#include <algorithm>
#include <cstddef>
#include <mutex>

#include "core/caustic_estimator.h"

namespace caustics::beamtree {

/// Adds up the done shares of a phase that many threads work on, and reports their sum.
class TraceProgress {
public:
    explicit TraceProgress(const RunOptions& options) : options_(options) {}

    /// From any thread; throws what RunOptions::report does.
    void add(double share) {
        const std::lock_guard lock(mutex_);
        done_ = std::min(1.0, done_ + share);
        options_.report(done_);
    }

private:
    const RunOptions& options_;
    std::mutex mutex_;
    double done_ = 0;
};

/// A part of a phase, and its share of the whole.
struct ProgressPart {
    TraceProgress& progress;
    double share = 1;

    ProgressPart of(double part) const { return {progress, share * part}; }
};

/// Steps that make up a part, of which every `together`th is reported.
class ProgressSteps {
public:
    ProgressSteps(const ProgressPart& part, std::size_t count, std::size_t together = 64)
        : part_(part), count_(count), together_(together) {}

    /// Another one is done. Throws what RunOptions::report does.
    void step() {
        if (++done_ % together_ != 0 && done_ != count_) return;
        part_.progress.add(part_.share * static_cast<double>(done_ - told_) /
                           static_cast<double>(count_));
        told_ = done_;
    }

private:
    ProgressPart part_;
    std::size_t count_;
    std::size_t together_;
    std::size_t done_ = 0;
    std::size_t told_ = 0;
};

}  // namespace caustics::beamtree
