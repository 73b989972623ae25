#include "beamtree/tracing/kept_beams.h"

#include <numeric>

#include "core/base/parallel.h"

namespace caustics::beamtree {

std::uint64_t leave_out_unreceived(std::vector<bool>& kept, const BeamSet& set,
                                   const SceneBoxes& boxes, const TraceSettings& settings) {
    if (!settings.receiver_margin) return 0;
    constexpr std::size_t together = 1024;
    static_assert(together % 64 == 0);  // so that chunks share no word of the flags
    std::vector<std::uint64_t> counts(chunk_count(kept.size(), together));
    parallel_chunks(settings.threads, kept.size(), together, [&](const Chunk& chunk) {
        for (std::size_t i = chunk.first; i < chunk.end; ++i) {
            if (!kept[i] || may_meet_receiver(boxes, set, set.beams[i], *settings.receiver_margin,
                                              settings.intensity == Intensity::refined))
                continue;
            kept[i] = false;
            ++counts[chunk.index];
        }
    });
    return std::accumulate(counts.begin(), counts.end(), std::uint64_t{0});
}

void keep_only(BeamSet& set, const std::vector<bool>& kept) {
    std::vector<std::uint32_t> number(set.beams.size(), Beam::none);
    std::uint32_t count = 0;
    for (std::uint32_t i = 0; i < set.beams.size(); ++i) {
        if (!kept[i]) continue;
        number[i] = count;
        set.beams[count] = set.beams[i];
        if (!set.partners.empty()) set.partners[count] = set.partners[i];
        ++count;
    }
    set.beams.resize(count);
    if (set.partners.empty()) return;
    set.partners.resize(count);
    for (std::uint32_t& partner : set.partners)
        if (partner != Beam::none) partner = number[partner];
}

}  // namespace caustics::beamtree
