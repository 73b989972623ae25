#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

#include "core/base/interrupt.h"
#include "core/base/isa.h"

namespace caustics {

/// How a build and a render are run. Both callbacks may be empty and are called from any thread;
/// `progress` gets the done share of the current phase and may throw.
struct RunOptions {
    std::uint64_t seed = 1;
    int threads = 1;
    int samples_per_pixel = 1;  ///< of the eye pass; 1 in `probe`
    bool adaptive = true;       ///< whether an adaptive sampler may take more (references: no)
    Isa isa = widest_isa();     ///< of the methods' hot loops
    std::string origin;         ///< the command that asks, for files that a method writes
    std::function<void(std::string_view)> begin_phase;
    std::function<void(double)> progress;

    void phase(std::string_view name) const {
        if (begin_phase) begin_phase(name);
    }
    void report(double share) const {
        throw_if_interrupted();
        if (progress) progress(share);
    }
};

}  // namespace caustics
