#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>

namespace caustics::experiments {

/// Whether a method brings the same light as a reference.
enum class Agreement { holds, converges, fails, unsure };

/// "holds", "converges", "fails", "unsure".
const char* word(Agreement agreement);

/// A method's difference from the reference, as a share of the reference, with its standard error.
struct Difference {
    double value = 0;
    double error = 0;
};

/// The largest difference that counts as agreement, as a share of the reference.
struct Limit {
    double share = 0.02;

    static constexpr double errors = 5;  ///< Allowed difference in standard errors.

    /// The largest standard error with which the limit can be judged.
    double largest_error() const { return share / errors; }
    bool can_judge(const Difference& d) const { return d.error <= largest_error(); }
    /// The difference is beyond the limit by more than its error explains.
    bool is_exceeded(const Difference& d) const;
    /// The difference is known well enough to see how it changes: it can be judged, or is five standard errors large.
    bool is_known(const Difference& d) const;
};

/// The limit of a part of a picture that is divided into `parts`. With the same samples the standard error of one
/// part is sqrt(parts) times that of the whole, so the limit is too.
Limit limit_of_part(Limit whole, std::size_t parts);

/// Differences at 1, 4 and 16 times the work.
inline constexpr std::size_t work_steps = 3;
inline constexpr int work_factor = 4;

/// How a difference changes with the work: |difference| ~ work^-order, fitted to the three differences.
struct Convergence {
    double order = 0;
    /// The difference that remains with infinite work, by Aitken's extrapolation. Empty where the differences do
    /// not fall ever more slowly.
    std::optional<Difference> remaining;
    bool shrinks = false;

    std::string text() const;
};

/// The difference shrinks if its order is at least 1/4 (16 times the work halve it), no step makes it larger than
/// its error explains, and the extrapolated rest is no more than the limit and five standard errors.
Convergence convergence(std::span<const Difference, work_steps> differences, const Limit& limit);

}  // namespace caustics::experiments
