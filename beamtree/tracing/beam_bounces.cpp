#include "beamtree/tracing/beam_bounces.h"

#include <algorithm>

#include "beamtree/beams/ray_spread.h"
#include "beamtree/tracing/next_bounce.h"

namespace caustics::beamtree {
namespace {

// Of the flux of all first events, and of one of their beams on average: less is not followed.
constexpr double least_set_share = 1e-4;
constexpr double least_beam_share = 1e-3;
// Of the work on a level and all after it, that on the level itself.
constexpr double own = 0.3;

double flux_of(const BeamSet& set) {
    double sum = 0;
    for (const Beam& beam : set.beams) sum += static_cast<double>(beam.flux.mean());
    return sum;
}

double count_of(const std::vector<Level>& levels) {
    double sum = 0;
    for (const Level& level : levels) sum += static_cast<double>(level.traced.set.beams.size());
    return sum;
}

/// Leaves out beams for queries.
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

/// Follows one level after the other, as far as it is worth it.
class Follower {
public:
    Follower(const Scene& scene, const SceneBoxes& boxes, const LitCaster& surface,
             const BeamExtras& extras, std::size_t max_bounces, TracedBeams& traced)
        : scene_(scene),
          boxes_(boxes),
          surface_(surface),
          extras_(extras),
          max_bounces_(max_bounces),
          traced_(traced) {}

    void follow(Level& level, double first_flux, double mean_flux, const ProgressPart& part) {
        BeamSet& set = level.traced.set;
        const std::size_t place = traced_.sets.size();
        traced_.sets.emplace_back();
        if (level.bounces() < max_bounces_) {
            NextSets next = next_sets(scene_, boxes_, surface_, level, least_beam_share * mean_flux,
                                      traced_.balance, part.of(own));
            const double beams = count_of(next.sets);
            for (Level& one : next.sets) {
                const double flux = flux_of(one.traced.set);
                if (one.worth < least_set_share * first_flux) {
                    traced_.balance.lost += flux;
                    traced_.balance.pruned += flux;
                } else {
                    follow(one, first_flux, mean_flux,
                           part.of((1 - own) * static_cast<double>(one.traced.set.beams.size()) /
                                   beams));
                }
            }
            if (extras_.neighbours != nullptr)
                refine(set, level.traced.origins, *extras_.neighbours, part.of(0));
            std::vector<bool> kept = std::move(next.stays);
            for (std::size_t i = 0; i < kept.size(); ++i)
                kept[i] = kept[i] || comes_near_a_receiver(level, set.beams[i]);
            add_drifts(level, kept);
            keep_only(set, kept);
        } else {
            if (extras_.neighbours != nullptr)
                refine(set, level.traced.origins, *extras_.neighbours, part.of(1));
            add_drifts(level, std::vector<bool>(set.beams.size(), true));
        }
        traced_.sets[place] = std::move(set);
    }

private:
    void add_drifts(Level& level, const std::vector<bool>& kept) {
        if (extras_.drift != nullptr) traced_.drift.add(extras_.drift->add_to(level, kept));
    }

    bool comes_near_a_receiver(const Level& level, const Beam& beam) const {
        Box box;
        for (const std::uint32_t corner : beam.corners) {
            if (corner == Beam::none) continue;
            box.extend(level.traced.set.rays[corner].position);
            box.extend(level.arrivals[corner].position);
        }
        // Surfaces bulge from the beam's triangles by about its own width.
        const Vec3 margin = Vec3::Constant(0.05F * box.diagonal().norm() + beam.offset);
        const Box wide(box.min() - margin, box.max() + margin);
        return std::ranges::any_of(boxes_.receivers,
                                   [&](const Box& receiver) { return wide.intersects(receiver); });
    }

    const Scene& scene_;
    const SceneBoxes& boxes_;
    const LitCaster& surface_;
    BeamExtras extras_;
    std::size_t max_bounces_;
    TracedBeams& traced_;
};

}  // namespace

BeamBounces::BeamBounces(const Scene& scene, const SceneBoxes& boxes, const LitCaster& surface,
                         const BeamExtras& extras, int max_bounces)
    : scene_(scene), boxes_(boxes), surface_(surface), extras_(extras), max_bounces_(max_bounces) {}

void BeamBounces::follow(std::array<TracedSet, 2> first, const ProgressPart& part) {
    double flux = 0;
    std::size_t beams = 0;
    for (const TracedSet& one : first) {
        flux += flux_of(one.set);
        beams += one.set.beams.size();
    }
    for (const Event event : events) {
        if (first[event].set.beams.empty()) continue;
        Level level;
        level.event = event;
        level.traced = std::move(first[event]);
        level.departures = first_departures(level.traced);
        Follower(scene_, boxes_, surface_, extras_, static_cast<std::size_t>(max_bounces_), traced_)
            .follow(level, flux, flux / static_cast<double>(beams),
                    part.of(static_cast<double>(level.traced.set.beams.size()) /
                            static_cast<double>(beams)));
    }
}

std::vector<Departure> BeamBounces::first_departures(const TracedSet& first) const {
    const std::uint32_t shape = surface_.caster().shape;
    std::vector<Departure> departures;
    for (const RayOrigin& origin : first.origins) departures.push_back({shape, origin.normal, 0});
    // Points between vertices lie below an exact shape's surface.
    for (const Beam& beam : first.set.beams) {
        const float at_vertices = surface_.corner_offset(beam.triangle);
        for (const std::uint32_t corner : beam.corners) {
            if (corner == Beam::none) continue;
            const bool between = first.origins[corner].vertex == RayOrigin::no_vertex;
            float& offset = departures[corner].offset;
            offset = std::max(offset, between ? beam.offset : at_vertices);
        }
    }
    return departures;
}

}  // namespace caustics::beamtree
