#include "core/light_path/light_path.h"

#include <algorithm>
#include <array>

#include "core/light_path/flight.h"
#include "core/material/optics.h"
#include "core/math/sampling.h"

namespace caustics {

namespace {

// Names of the counters beside the counts.
template <typename Counts, typename Visit>
void for_each_count(Counts& counts, const Visit& visit) {
    visit("photons_emitted", counts.emitted);
    visit("photons_aimed", counts.aimed);
    visit("photons_branched", counts.branched);
    visit("photons_reflected", counts.reflected);
    visit("photons_refracted", counts.refracted);
    visit("photons_missed", counts.missed);
    visit("photons_escaped", counts.escaped);
    visit("photons_absorbed", counts.absorbed);
    visit("photons_misdirected", counts.misdirected);
    visit("photons_on_black_side", counts.on_black_side);
    visit("photons_depth_limited", counts.depth_limited);
    visit("photons_stored", counts.stored);
    visit("photons_dropped", counts.dropped);
}

}  // namespace

void LightPathCounts::add(const LightPathCounts& other) {
    emitted += other.emitted;
    aimed += other.aimed;
    branched += other.branched;
    reflected += other.reflected;
    refracted += other.refracted;
    missed += other.missed;
    escaped += other.escaped;
    absorbed += other.absorbed;
    misdirected += other.misdirected;
    on_black_side += other.on_black_side;
    depth_limited += other.depth_limited;
    stored += other.stored;
    dropped += other.dropped;
    light.add(other.light);
}

LightLedger LightPathCounts::watts() const {
    return emitted > 0 ? light.scaled(1 / static_cast<double>(emitted)) : LightLedger{};
}

void LightPathCounts::add_to(Counters& counters) const {
    for_each_count(*this, [&](const char* name, std::uint64_t count) { counters[name] += count; });
}

LightPathCounts light_path_counts(const Counters& counters) {
    LightPathCounts counts;
    for_each_count(counts, [&](const char* name, std::uint64_t& count) {
        const auto found = counters.find(name);
        if (found != counters.end()) count = found->second;
    });
    return counts;
}

namespace {

Flight start_of(const LightParticle& particle) {
    return {.ray = particle.ray,
            .flux = particle.flux,
            .start_medium = particle.medium,
            .start_flux = particle.flux.sum()};
}

double watts(const Spectrum& flux) { return static_cast<double>(flux.mean()); }

// What a flight finds at the end of a segment.
struct Stop {
    std::optional<Deposit> deposit;
    bool at_caster = false;  ///< from which it may go on
};

// Light that would go on from a caster. A deposit there has counted all of it, so that what a mirror would send on is
// sent again.
void count_cut(const Bsdf& bsdf, const SurfacePoint& hit, const Flight& flight, bool has_deposit,
               LightLedger& light) {
    if (!has_deposit) {
        light.cut += watts(flight.flux);
        return;
    }
    const SpecularSplit split = split_specular(bsdf, hit.geometric_normal, hit.shading_normal,
                                               -flight.ray.direction, flight.wavelength.nm);
    const double more = watts((split.reflected_weight + split.refracted_weight) * flight.flux);
    light.cut += more;
    light.sent += more;
}

Stop stop_at(const Scene& scene, const LightPathSettings& settings,
             const std::optional<SurfacePoint>& hit, Flight& flight, LightPathCounts& counts) {
    Stop stop;
    if (!hit) {
        ++(flight.bounces == 0 ? counts.missed : counts.escaped);
        if (flight.bounces > 0) counts.light.escaped += watts(flight.flux);
        return stop;
    }
    const Bsdf& bsdf = scene.shape_at(*hit).bsdf;
    stop.at_caster = is_caster(bsdf);
    if (flight.bounces == 0 && !stop.at_caster) {
        ++counts.missed;
        return stop;
    }
    const double before = watts(flight.flux);
    flight.flux *= segment_transmittance(
        flight.start_medium, medium_absorption(bsdf, hit->geometric_normal, -flight.ray.direction),
        hit->distance);
    const double left = watts(flight.flux);
    if (flight.bounces == 0)
        counts.light.sent += left;
    else
        counts.light.absorbed += before - left;
    if (is_receiver(bsdf) && flight.bounces > 0) {
        if (is_black(flight.flux)) {
            ++counts.absorbed;
            return {};
        }
        stop.deposit = deposit_of(scene, *hit, flight);
        ++(stop.deposit ? counts.stored : counts.on_black_side);
        (stop.deposit ? counts.light.arrived : counts.light.absorbed) += left;
        // A mirror that is black on that side as well sends nothing on.
        stop.at_caster = stop.at_caster && stop.deposit;
    }
    if (stop.at_caster && flight.bounces == settings.max_bounces) {
        if (!stop.deposit) ++counts.depth_limited;
        count_cut(bsdf, *hit, flight, stop.deposit.has_value(), counts.light);
        stop.at_caster = false;
    }
    return stop;
}

void record(const LightPathSettings& settings, const Ray& ray) {
    if (settings.traced != nullptr) settings.traced->push_back(ray);
}

// The light of a flight that ends at a caster with `arrived` [W], or goes on from there with `left`. What chance has
// added or taken is absorbed light, whose mean it does not change. What goes on from a deposit, which has counted all
// light there, is sent again.
void count_light(bool has_deposit, double arrived, double left, LightLedger& light) {
    if (has_deposit)
        light.sent += left;
    else
        light.absorbed += arrived - left;
}

// The event at a caster; false when it ends the flight, whose end a deposit there has counted already.
bool goes_on_from(const Scene& scene, const SurfacePoint& hit, bool has_deposit, Flight& flight,
                  Rng& rng, LightPathCounts& counts) {
    const double arrived = watts(flight.flux);
    if (!survives(flight, rng)) {
        if (!has_deposit) ++counts.absorbed;
        count_light(has_deposit, arrived, 0, counts.light);
        return false;
    }
    const SpecularSplit split = split_at(scene, hit, flight, rng);
    const Fate fate = roulette(split, rng, flight.flux);
    if (fate == Fate::absorbed || fate == Fate::misdirected) {
        if (!has_deposit) {
            const bool is_lost = fate == Fate::misdirected;
            ++(is_lost ? counts.misdirected : counts.absorbed);
            (is_lost ? counts.light.misdirected : counts.light.absorbed) += arrived;
        }
        return false;
    }
    count_light(has_deposit, arrived, watts(flight.flux), counts.light);
    const bool reflects = fate == Fate::reflected;
    counts.branched += has_deposit ? 1 : 0;
    ++(reflects ? counts.reflected : counts.refracted);
    leave(scene, hit, reflects ? split.reflected : split.refracted, flight);
    return true;
}

}  // namespace

void trace_light_path(const Scene& scene, const LightParticle& particle,
                      const LightPathSettings& settings, Rng& rng, LightPathCounts& counts,
                      std::vector<Deposit>& deposits) {
    Flight flight = start_of(particle);
    for (;;) {
        record(settings, flight.ray);
        const std::optional<SurfacePoint> hit = scene.intersect(flight.ray);
        const Stop stop = stop_at(scene, settings, hit, flight, counts);
        if (stop.deposit) deposits.push_back(*stop.deposit);
        if (!stop.at_caster ||
            !goes_on_from(scene, *hit, stop.deposit.has_value(), flight, rng, counts))
            return;
    }
}

namespace {

// A flight of many.
struct OneOfMany : Flight {
    std::size_t number;  // of its start
};

// Moves up to Scene::most_together flights along one segment; those that go on are kept in front.
std::size_t advance(const Scene& scene, std::span<OneOfMany> flights,
                    std::span<LightPathStart> starts, const LightPathSettings& settings,
                    LightPathCounts& counts, std::vector<DepositOfMany>& deposits) {
    std::array<Ray, Scene::most_together> rays;
    std::array<std::optional<SurfacePoint>, Scene::most_together> hits;
    for (std::size_t i = 0; i < flights.size(); ++i) {
        rays[i] = flights[i].ray;
        record(settings, rays[i]);
    }
    scene.intersect_together(std::span(rays).first(flights.size()), hits);
    std::size_t kept = 0;
    for (std::size_t i = 0; i < flights.size(); ++i) {
        OneOfMany& flight = flights[i];
        const Stop stop = stop_at(scene, settings, hits[i], flight, counts);
        if (stop.deposit) deposits.push_back({flight.number, *stop.deposit});
        if (stop.at_caster && goes_on_from(scene, *hits[i], stop.deposit.has_value(), flight,
                                           starts[flight.number].rng, counts))
            flights[kept++] = flight;
    }
    return kept;
}

}  // namespace

void trace_light_paths(const Scene& scene, std::span<LightPathStart> starts,
                       const LightPathSettings& settings, LightPathCounts& counts,
                       std::vector<DepositOfMany>& deposits) {
    const std::size_t before = deposits.size();
    std::vector<OneOfMany> flights;
    flights.reserve(starts.size());
    for (std::size_t i = 0; i < starts.size(); ++i) {
        flights.push_back({start_of(starts[i].particle), i});
        // Neighbours in the order of paths, which are neighbours in the light, have wavelengths far apart.
        if (settings.wavelength_shift)
            flights.back().wavelength.choice =
                radical_inverse<3>(starts[i].path, *settings.wavelength_shift);
    }
    while (!flights.empty()) {
        std::size_t kept = 0;
        for (std::size_t first = 0; first < flights.size(); first += Scene::most_together) {
            const auto some = std::span(flights).subspan(
                first, std::min(Scene::most_together, flights.size() - first));
            const std::size_t left = advance(scene, some, starts, settings, counts, deposits);
            std::copy_n(some.begin(), left, flights.begin() + static_cast<std::ptrdiff_t>(kept));
            kept += left;
        }
        flights.resize(kept);
    }
    std::ranges::stable_sort(deposits.begin() + static_cast<std::ptrdiff_t>(before), deposits.end(),
                             {}, &DepositOfMany::start);
}

namespace {

class SplitPath {
public:
    SplitPath(const Scene& scene, const LightPathSettings& settings, const Spectrum& flux, Rng& rng,
              LightPathCounts& counts, std::vector<Deposit>& deposits)
        : scene_(scene),
          settings_(settings),
          lightest_(lightest_branch * flux.sum()),
          rng_(rng),
          counts_(counts),
          deposits_(deposits) {}

    // Follows a flight; of two branches the reflected one with all that comes of it first.
    void follow(const Flight& start) {
        waiting_.push_back(start);
        while (!waiting_.empty()) {
            Flight flight = waiting_.back();
            waiting_.pop_back();
            while (moves_on(flight)) {}
        }
    }

private:
    // Along one segment and through the event at its end.
    bool moves_on(Flight& flight) {
        record(settings_, flight.ray);
        const std::optional<SurfacePoint> hit = scene_.intersect(flight.ray);
        const Stop stop = stop_at(scene_, settings_, hit, flight, counts_);
        const bool has_deposit = stop.deposit.has_value();
        if (has_deposit) deposits_.push_back(*stop.deposit);
        if (!stop.at_caster) return false;
        const double arrived = watts(flight.flux);
        if (!survives(flight, rng_)) {
            if (!has_deposit) ++counts_.absorbed;
            count_light(has_deposit, arrived, 0, counts_.light);
            return false;
        }
        const SpecularSplit split = split_at(scene_, *hit, flight, rng_);
        const double lost = has_deposit ? 0 : watts(split.lost_weight * flight.flux);
        Flight refracted = flight;
        const bool reflects = goes_on(split.reflected_weight, flight);
        const bool refracts = goes_on(split.refracted_weight, refracted);
        counts_.reflected += reflects ? 1 : 0;
        counts_.refracted += refracts ? 1 : 0;
        if (reflects) counts_.branched += refracts || has_deposit ? 1 : 0;
        const double left =
            (reflects ? watts(flight.flux) : 0) + (refracts ? watts(refracted.flux) : 0);
        count_light(has_deposit, arrived - lost, left, counts_.light);
        counts_.light.misdirected += lost;
        if (refracts) leave(scene_, *hit, split.refracted, refracted);
        if (reflects) {
            leave(scene_, *hit, split.reflected, flight);
            if (refracts) waiting_.push_back(refracted);
        } else if (refracts) {
            flight = refracted;
        } else if (!has_deposit) {
            ++(is_black(split.lost_weight) ? counts_.absorbed : counts_.misdirected);
        }
        return reflects || refracts;
    }

    // Weighs a branch; a light one goes on only sometimes, and then heavier.
    bool goes_on(const Spectrum& weight, Flight& flight) {
        flight.flux *= weight;
        const float left = flight.flux.sum();
        if (left >= lightest_) return left > 0;
        if (rng_.next() * lightest_ >= left) return false;
        flight.flux *= lightest_ / left;
        return true;
    }

    const Scene& scene_;
    const LightPathSettings& settings_;
    float lightest_;
    Rng& rng_;
    LightPathCounts& counts_;
    std::vector<Deposit>& deposits_;
    std::vector<Flight> waiting_;
};

}  // namespace

void trace_split_path(const Scene& scene, const LightParticle& particle,
                      const LightPathSettings& settings, Rng& rng, LightPathCounts& counts,
                      std::vector<Deposit>& deposits) {
    SplitPath(scene, settings, particle.flux, rng, counts, deposits).follow(start_of(particle));
}

}  // namespace caustics
