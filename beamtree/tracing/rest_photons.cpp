#include "beamtree/tracing/rest_photons.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "beamtree/tracing/cut_edge.h"
#include "core/light_path/flight.h"
#include "core/math/lattice.h"
#include "core/math/rng.h"

namespace caustics::beamtree {
namespace {

// Lights draw from the first streams of the stage.
constexpr std::uint64_t own_streams = std::uint64_t{1} << 63U;
// Shares of neighbours in the mesh: multiples of the golden ratio fall evenly.
constexpr double golden = 0.6180339887498949;

/// A number for a thing, equal for equal ones alone but by chance.
class Name {
public:
    void add(std::uint64_t word) {
        name_ = (name_ ^ word) * 0x9E3779B97F4A7C15U;
        name_ ^= name_ >> 29U;
    }
    void add(const Vec3& place) {
        for (const float x : place) add(std::bit_cast<std::uint32_t>(x));
    }
    std::uint64_t of_stream() const { return name_ | own_streams; }

private:
    std::uint64_t name_ = 0;
};

Name name_of_way(const BeamSet& set, const std::optional<Event>& event) {
    Name name;
    name.add(set.light.light);
    name.add(set.light.position);
    name.add(std::bit_cast<std::uint32_t>(set.light.bin.nm));
    name.add(set.caster);
    for (const SpecularEvent& one : set.path)
        name.add(2 * std::uint64_t{one.shape} + (one.refracted ? 1 : 0));
    name.add(event ? std::uint64_t{1} + *event : 0);
    return name;
}

bool is_whole_triangle(const LeftOut& part) {
    return std::ranges::all_of(part.corners, [](const RayOrigin* corner) {
        return corner->vertex != RayOrigin::no_vertex;
    });
}

// Evenly over a triangle.
Vec3 weights_in_triangle(double u, double v) {
    const double root = std::sqrt(u);
    return Eigen::Vector3d(1 - root, root * (1 - v), root * v).cast<float>();
}

// How much closer the light lies at a place of a triangle than on average over it.
double closeness(const LightSample& light, const LeftOut& part, const Vec3& position,
                 double measured) {
    if (light.kind == LightSample::Kind::directional) return 1;
    const Vec3d a = part.corners[0]->position.cast<double>();
    const Vec3d b = part.corners[1]->position.cast<double>();
    const Vec3d c = part.corners[2]->position.cast<double>();
    const Vec3d towards = light.position.cast<double>() - position.cast<double>();
    const double squared = towards.squaredNorm();
    return std::abs((b - a).cross(c - a).dot(towards)) / (2 * squared * std::sqrt(squared)) /
           measured;
}

// Through the event at the caster that a path has come to; false where no light is left.
bool leave_next(const PathPoint& point, const std::optional<Event>& event, Rng& rng,
                Flight& flight) {
    const RayArrival& at = point.next;
    Event next = reflection;
    if (event) {
        next = *event;
        flight.flux *= at.weight[next];
    } else {
        const float reflected = (flight.flux * at.weight[reflection]).sum();
        const float refracted = (flight.flux * at.weight[refraction]).sum();
        if (!(reflected + refracted > 0)) return false;
        const float share = reflected / (reflected + refracted);
        next = rng.next() < share ? reflection : refraction;
        flight.flux *= at.weight[next] / (next == reflection ? share : 1 - share);
    }
    if (is_black(flight.flux)) return false;
    flight.start_medium = at.medium[next];
    flight.ray = spawn_ray({at.position, at.geometric_normal, at.offset}, at.direction[next]);
    return true;
}

// To receivers, as light paths go.
void fly(const Scene& scene, Flight flight, int max_bounces, Rng& rng, const WavelengthBin& bin,
         std::vector<RestPhoton>& photons) {
    for (;;) {
        const std::optional<SurfacePoint> hit = scene.intersect(flight.ray);
        if (!hit) return;
        const Bsdf& bsdf = scene.shape_at(*hit).bsdf;
        flight.flux *= segment_transmittance(
            flight.start_medium,
            medium_absorption(bsdf, hit->geometric_normal, -flight.ray.direction), hit->distance);
        if (is_black(flight.flux)) return;
        if (is_receiver(bsdf)) {
            const std::optional<Deposit> deposit = deposit_of(scene, *hit, flight);
            if (!deposit) return;
            photons.push_back(
                {deposit->position, deposit->geometric_normal, deposit->wi, deposit->flux, bin});
        }
        if (!is_caster(bsdf) || flight.bounces == max_bounces || !survives(flight, rng)) return;
        const SpecularSplit split = split_at(scene, *hit, flight, rng);
        const Fate fate = roulette(split, rng, flight.flux);
        if (fate != Fate::reflected && fate != Fate::refracted) return;
        leave(scene, *hit, fate == Fate::reflected ? split.reflected : split.refracted, flight);
    }
}

}  // namespace

RestPhotons::RestPhotons(const Scene& scene, const LitCaster& surface,
                         const TraceSettings& settings)
    : scene_(scene), surface_(surface), settings_(settings) {}

void RestPhotons::trace(const Level& level, const LeftOut& part,
                        std::vector<RestPhoton>& photons) const {
    const bool is_sample = !completes(part);
    const double watts = is_sample ? settings_.watts_per_sample : settings_.watts_per_photon;
    if (!(watts > 0) || !(part.flux > 0)) return;
    const BeamSet& set = level.traced.set;
    Name name = name_of_way(set, part.event);
    double rounding = 0;
    if (is_whole_triangle(part))
        rounding = golden * set.beams[part.beam].triangle +
                   Rng(settings_.seed, Stage::beams, name.of_stream()).next_fine();
    for (const RayOrigin* corner : part.corners) name.add(corner->position);
    Rng rng(settings_.seed, Stage::beams, name.of_stream());
    const double shift_u = rng.next_fine();
    const double shift_v = rng.next_fine();
    if (!is_whole_triangle(part)) rounding = rng.next_fine();
    const double wanted = part.flux / watts;
    const auto count = static_cast<std::uint64_t>(wanted + fine_fraction(rounding));
    if (count == 0) return;
    const Path path(scene_, surface_, level, part.beam);
    const double measured = measure(set.light, part.corners[0]->position, part.corners[1]->position,
                                    part.corners[2]->position);
    const std::size_t first = photons.size();
    for (std::uint64_t i = 0; i < count; ++i) {
        const PathPoint point =
            path.inside(part.corners, weights_in_triangle(on_lattice(shift_u, i, r2_steps[0]),
                                                          on_lattice(shift_v, i, r2_steps[1])));
        if (!goes_on(point)) continue;
        const double share = closeness(set.light, part, point.origin.position, measured) / wanted;
        Flight flight{{}, point.origin.weight * static_cast<float>(measured * share)};
        flight.bounces = static_cast<int>(level.bounces()) + 1;
        flight.wavelength.nm = set.light.bin.nm;
        flight.start_flux = flight.flux.sum();
        if (leave_next(point, part.event, rng, flight))
            fly(scene_, flight, settings_.max_bounces, rng, set.light.bin, photons);
    }
    for (std::size_t i = first; i < photons.size(); ++i) photons[i].is_sample = is_sample;
}

}  // namespace caustics::beamtree
