#pragma once

#include <cstdint>
#include <vector>

#include "photonmap/estimate/brdf_lobe.h"

namespace caustics::photonmap {

/// f_r of one receiver point seen from one direction, over the 65,536 directions that a stored
/// photon can have: the lookup table that [J96 sec. 5] proposes. Photons near one point come
/// from few directions, so an entry is worked out when it is first asked for, and forgetting all
/// entries costs nothing. A thread's scratch of 1 MB.
class BrdfLobeTable {
public:
    BrdfLobeTable() : entries_(65'536) {}

    /// Turns to a point; `reflection` is that of `point`. Entries are kept where it is that of
    /// the point before but for `scale`, as on a flat floor seen from very far away.
    void turn_to(const ReceiverPoint& point, const BrdfLobe& reflection);
    /// f_r / `scale`, per channel, for a direction code: theta + 256 phi.
    const float* factor(std::uint16_t direction) {
        Entry& entry = entries_[direction];
        ++lookups_;
        if (entry.filling != filling_) fill(entry, direction);
        return entry.rgb;
    }
    /// Forgets all entries.
    void clear();

    std::uint64_t lookups() const { return lookups_; }    ///< entries asked for
    std::uint64_t fillings() const { return fillings_; }  ///< entries worked out

private:
    struct Entry {
        float rgb[3];
        std::uint32_t filling;  ///< the number of the filling that the entry belongs to
    };
    void fill(Entry& entry, std::uint16_t direction);

    std::vector<Entry> entries_;
    std::uint32_t filling_ = 1;
    std::uint64_t lookups_ = 0;
    std::uint64_t fillings_ = 0;
    ReceiverPoint point_{};
    BrdfLobe reflection_;
};

}  // namespace caustics::photonmap
