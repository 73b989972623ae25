#pragma once

#include <cstdint>
#include <limits>
#include <map>

namespace caustics::beamtree {

/// Counts beams of several events by their light, and says what the brightest of them have at least: a queue by
/// light that keeps numbers instead of beams. The answer does not depend on the order in which beams come.
class BeamBudget {
public:
    static constexpr std::uint64_t no_limit = std::numeric_limits<std::uint64_t>::max();
    /// At most `most` beams, of `least` [W] or more.
    explicit BeamBudget(std::uint64_t most = no_limit, double least = 0);

    /// Another beam; one with less than least() is left out.
    void count(double light);
    /// All that another budget has counted.
    void add(const BeamBudget& other);
    /// Beams with less light [W] are too many. Rises with their number.
    double least() const { return least_; }
    /// Whether so many more beams could be counted and all be kept.
    bool has_room_for(std::uint64_t beams) const { return beams <= most_ - total_; }
    /// How many are kept.
    std::uint64_t count() const { return total_; }
    /// Whether beams that were counted are too many.
    bool is_over() const { return is_over_; }
    /// Whether all that was counted has so much light.
    bool all_have(double light) const;

private:
    void leave_out_weakest();

    std::uint64_t most_;
    double least_;
    bool is_over_ = false;
    std::uint64_t total_ = 0;
    std::map<int, std::uint64_t> counts_;  ///< by steps of light
};

}  // namespace caustics::beamtree
