#include "beamtree/tracing/beam_bounces.h"

#include <algorithm>

#include "beamtree/beams/ray_spread.h"
#include "beamtree/light/first_polygon.h"
#include "beamtree/light/root_beams.h"
#include "beamtree/tracing/kept_beams.h"
#include "beamtree/tracing/next_bounce.h"
#include "beamtree/tracing/path_spread.h"
#include "beamtree/tracing/rest_photons.h"
#include "core/base/parallel.h"

namespace caustics::beamtree {
namespace {

// What a set must have of the light of all first events, over what a beam must have of their mean.
constexpr double set_over_beam = 0.1;
// Of the work on a level and all after it, that on the level itself.
constexpr double work_on_level = 0.3;
// What threads take at a time.
constexpr std::size_t beams_together = 1024;

double count_of(const std::vector<Level>& levels) {
    double sum = 0;
    for (const Level& level : levels) sum += static_cast<double>(level.traced.set.beams.size());
    return sum;
}

void append(const std::vector<RestPhoton>& some, std::vector<RestPhoton>& all) {
    all.insert(all.end(), some.begin(), some.end());
}

/// Follows one level after the other, as far as it is worth it.
class Follower {
public:
    Follower(const Scene& scene, const SceneBoxes& boxes, const LitCaster& surface,
             const BeamExtras& extras, const TraceSettings& settings, BeamBudget& budget,
             const RestPhotons& rest, TracedBeams& traced)
        : scene_(scene),
          boxes_(boxes),
          surface_(surface),
          extras_(extras),
          settings_(settings),
          budget_(budget),
          rest_(rest),
          traced_(traced) {}

    void follow(Level& level, double first_flux, double mean_flux, const ProgressPart& part) {
        BeamSet& set = level.traced.set;
        const std::size_t place = traced_.sets.size();
        traced_.sets.emplace_back();
        std::vector<bool> kept(set.beams.size(), true);
        const bool goes_on = level.bounces() < static_cast<std::size_t>(settings_.max_bounces);
        if (goes_on) {
            NextSets next =
                next_sets(scene_, boxes_, surface_, level,
                          {mean_flux, settings_.prune * mean_flux,
                           settings_.least_divided * mean_flux, budget_},
                          rest_, traced_.balance, settings_.threads, part.of(work_on_level));
            append(next.rest, traced_.rest);
            const double beams = count_of(next.sets);
            for (Level& one : next.sets) {
                const double flux = flux_of(one.traced.set);
                if (one.worth < set_over_beam * settings_.prune * first_flux) {
                    traced_.balance.lost += flux;
                    traced_.balance.pruned += flux;
                    complete(one);
                } else {
                    follow(one, first_flux, mean_flux,
                           part.of((1 - work_on_level) *
                                   static_cast<double>(one.traced.set.beams.size()) / beams));
                }
            }
            kept = std::move(next.stays);
            keep_near_receivers(level, kept);
        }
        if (budget_.is_over()) {
            forget();
            return;
        }
        add_drifts(level, kept);
        traced_.unreceived += leave_out_unreceived(kept, set, boxes_, settings_);
        if (extras_.neighbours != nullptr) {
            refine(set, level.traced.origins, *extras_.neighbours, kept, settings_.threads,
                   part.of(goes_on ? 0 : 1));
            spread_along_paths(scene_, surface_, level, kept, settings_.threads);
        }
        keep_only(set, kept);
        if (settings_.intensity == Intensity::refined && !set.drifts() &&
            std::cmp_less_equal(set.path.size(), settings_.root_events))
            prepare_roots(scene_, surface_.caster().mesh, level.traced.origins, settings_.threads,
                          set);
        traced_.sets[place] = std::move(set);
    }

private:
    void forget() {
        for (BeamSet& set : traced_.sets) set = {};
        traced_.rest.clear();
    }

    // By photons, all light of a level that is left out.
    void complete(const Level& level) {
        const BeamSet& set = level.traced.set;
        if (budget_.is_over()) return;
        std::vector<std::vector<RestPhoton>> photons(chunk_count(set.beams.size(), beams_together));
        parallel_chunks(
            settings_.threads, set.beams.size(), beams_together, [&](const Chunk& chunk) {
                for (std::size_t i = chunk.first; i < chunk.end; ++i) {
                    const Beam& beam = set.beams[i];
                    LeftOut part{
                        level.parents[i], {}, level.event, static_cast<double>(beam.flux.mean())};
                    for (std::size_t k = 0; k < 3; ++k)
                        part.corners[k] = &level.traced.origins[beam.corners[k]];
                    rest_.trace(*level.parent, part, photons[chunk.index]);
                }
            });
        for (const std::vector<RestPhoton>& some : photons) append(some, traced_.rest);
    }

    void add_drifts(Level& level, const std::vector<bool>& kept) {
        if (extras_.drift != nullptr) traced_.drift.add(extras_.drift->add_to(level, kept));
    }

    void keep_near_receivers(const Level& level, std::vector<bool>& kept) const {
        static_assert(beams_together % 64 == 0);  // so that chunks share no word of the flags
        parallel_chunks(settings_.threads, kept.size(), beams_together, [&](const Chunk& chunk) {
            for (std::size_t i = chunk.first; i < chunk.end; ++i)
                if (!kept[i]) kept[i] = comes_near_a_receiver(level, level.traced.set.beams[i]);
        });
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
    const TraceSettings& settings_;
    BeamBudget& budget_;
    const RestPhotons& rest_;
    TracedBeams& traced_;
};

// Photons of a sample share the light of the first events.
TraceSettings with_sample(TraceSettings settings, double flux) {
    if (settings.sampled_photons > 0)
        settings.watts_per_sample = flux / static_cast<double>(settings.sampled_photons);
    return settings;
}

}  // namespace

double flux_of(const BeamSet& set) {
    double sum = 0;
    for (const Beam& beam : set.beams) sum += static_cast<double>(beam.flux.mean());
    return sum;
}

BeamBounces::BeamBounces(const Scene& scene, const SceneBoxes& boxes, const LitCaster& surface,
                         const BeamExtras& extras, const TraceSettings& settings,
                         BeamBudget& budget)
    : scene_(scene),
      boxes_(boxes),
      surface_(surface),
      extras_(extras),
      settings_(settings),
      budget_(budget) {}

void BeamBounces::follow(std::array<TracedSet, 2> first, const ProgressPart& part) {
    double flux = 0;
    std::size_t beams = 0;
    for (const TracedSet& one : first) {
        flux += flux_of(one.set);
        beams += one.set.beams.size();
    }
    const RestPhotons rest(scene_, surface_, with_sample(settings_, flux));
    for (const Event event : events) {
        if (first[event].set.beams.empty()) continue;
        std::optional<SpecularSurface> exact;
        if (settings_.intensity == Intensity::refined)
            exact = first_exact_surface(scene_, first[event].set);
        Level level;
        level.event = event;
        level.traced = std::move(first[event]);
        level.exact = exact ? &*exact : nullptr;
        level.departures = first_departures(level.traced);
        Follower(scene_, boxes_, surface_, extras_, settings_, budget_, rest, traced_)
            .follow(level, flux, flux / static_cast<double>(beams),
                    part.of(static_cast<double>(level.traced.set.beams.size()) /
                            static_cast<double>(beams)));
    }
}

std::vector<Departure> BeamBounces::first_departures(const TracedSet& first) const {
    std::vector<Departure> departures;
    for (std::size_t i = 0; i < first.origins.size(); ++i) {
        const Vec3& normal = first.origins[i].normal;
        departures.push_back(
            {normal, 0, surface_.bender().medium_after(normal, first.set.rays[i].direction)});
    }
    const std::vector<Beam>& beams = first.set.beams;
    std::vector<float> at_vertices(beams.size());
    parallel_chunks(settings_.threads, beams.size(), beams_together, [&](const Chunk& chunk) {
        for (std::size_t i = chunk.first; i < chunk.end; ++i)
            at_vertices[i] = surface_.corner_offset(beams[i].triangle);
    });
    // Points between vertices lie below an exact shape's surface.
    for (std::size_t i = 0; i < beams.size(); ++i)
        for (const std::uint32_t corner : beams[i].corners) {
            if (corner == Beam::none) continue;
            const bool between = first.origins[corner].vertex == RayOrigin::no_vertex;
            float& offset = departures[corner].offset;
            offset = std::max(offset, between ? beams[i].offset : at_vertices[i]);
        }
    return departures;
}

}  // namespace caustics::beamtree
