#include "beamtree/pencils/pencil_paths.h"

#include <algorithm>
#include <cmath>
#include <Eigen/Eigenvalues>
#include <optional>

#include "beamtree/beams/trace_progress.h"
#include "beamtree/light/specular_surface.h"
#include "beamtree/pencils/light_patch.h"
#include "core/base/parallel.h"
#include "core/geometry/exact_shape.h"
#include "core/light_path/flight.h"
#include "core/light_path/ray_change.h"
#include "core/math/frame.h"
#include "core/math/lattice.h"

namespace caustics::beamtree {
namespace {

// Strata that a thread takes at a time.
constexpr std::uint64_t strata_together = 2048;
// A branch with less of its pencil's light goes on by chance.
constexpr float faint = 0.125F;
// The longest side of a print over the scene's diameter, and the smallest side over that.
constexpr double longest_side = 0.1;
constexpr double smallest_side = 1e-5;

// The sides of a lamp's print over those of its cell. Hundreds lie over each point: smaller ones are as even, and blur less.
constexpr double print_over_cell = 0.8;

/// A patch in equal strata: a grid of its rectangle, of which those at the edges reach beyond it, or the cells of a lattice over all places
/// of an area light and all directions from them.
struct Strata {
    LightPatch patch;
    bool of_lamp = false;
    std::array<std::uint64_t, 2> counts = {1,
                                           1};   ///< along a grid's sides; of a lattice, the first
    std::array<double, 4> shift = {0, 0, 0, 0};  ///< of a grid over one of its strata; of a lattice
    double chance = 1;                           ///< that its pencils are traced
    std::uint64_t first = 0;                     ///< number of its first stratum

    std::uint64_t size() const { return of_lamp ? counts[0] : (counts[0] + 1) * (counts[1] + 1); }
    Vec3d side(std::size_t i) const {
        return patch.rectangle.sides[i] / static_cast<double>(counts[i]);
    }
    Vec3d middle(std::uint64_t stratum) const {
        const std::array<std::uint64_t, 2> at = {stratum % (counts[0] + 1),
                                                 stratum / (counts[0] + 1)};
        const auto place = [&](std::size_t i) {
            return (static_cast<double>(at[i]) - shift[i] + 0.5) / static_cast<double>(counts[i]);
        };
        return patch.rectangle.at(place(0), place(1));
    }
    /// A number of a lattice's point, from 0 to 1.
    double number(std::uint64_t stratum, std::size_t k) const {
        return on_lattice(shift[k], stratum, r4_steps[k]);
    }
    /// A side of a lattice's cell along each number.
    double side_of_cell() const { return std::pow(static_cast<double>(counts[0]), -0.25); }
};

Strata strata_of(const LightPatch& patch, bool of_lamp, double wanted) {
    Strata strata{.patch = patch, .of_lamp = of_lamp, .chance = std::min(1.0, wanted)};
    const double most = std::max(1.0, wanted);
    if (of_lamp) {
        strata.counts = {static_cast<std::uint64_t>(std::ceil(most - 0.5)), 1};
        return strata;
    }
    const auto& sides = patch.rectangle.sides;
    const double ratio = sides[0].norm() / sides[1].norm();
    const double along = std::clamp(std::sqrt(most * ratio), 1.0, most);
    strata.counts = {static_cast<std::uint64_t>(std::ceil(along - 0.5)),
                     static_cast<std::uint64_t>(std::ceil(most / along - 0.5))};
    return strata;
}

// Strata are shared out by the light that goes through the patches, so that pencils have about as much each.
std::vector<Strata> shared_strata(const std::vector<LightPatch>& patches,
                                  std::span<const LightSample> lights, std::uint64_t count,
                                  std::uint64_t seed) {
    double watts = 0;
    for (const LightPatch& patch : patches) watts += patch.watts;
    Rng rng(seed, Stage::pencils, ~std::uint64_t{0});
    std::array<double, 4> shift;
    for (double& one : shift) one = rng.next_fine();
    std::vector<Strata> all;
    std::uint64_t first = 0;
    for (std::size_t i = 0; i < patches.size(); ++i) {
        const bool of_lamp = lights[patches[i].light].kind == LightSample::Kind::area;
        all.push_back(
            strata_of(patches[i], of_lamp, static_cast<double>(count) * patches[i].watts / watts));
        Strata& strata = all.back();
        // The steps in another order: else a lamp's patches would share points.
        for (std::size_t k = 0; k < 4; ++k)
            strata.shift[k] = on_lattice(shift[k], i, of_lamp ? r4_steps[3 - k] : r2_steps[k % 2]);
        strata.first = first;
        first += strata.size();
    }
    return all;
}

/// A pencil on its way.
struct Branch {
    Flight flight;
    /// By the sides of its stratum of directions, and by those of its part of an area light.
    std::array<RayChange, 4> change;
    std::size_t changes = 2;  ///< how many of them

    std::span<RayChange> all() { return {change.data(), changes}; }
    std::span<const RayChange> all() const { return {change.data(), changes}; }
};

// The sides of a rectangle that lies as widely as light does which is spread along all of several vectors of a plane.
std::array<Vec3d, 2> rectangle_of(std::span<const Vec3d> ways, const Vec3d& normal) {
    const Frame frame(normal.cast<float>());
    const Vec3d s = frame.s.cast<double>(), t = frame.t.cast<double>();
    Eigen::Matrix2d scatter = Eigen::Matrix2d::Zero();
    for (const Vec3d& way : ways) {
        const Vec2d on_plane(s.dot(way), t.dot(way));
        scatter += on_plane * on_plane.transpose();
    }
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes;
    axes.computeDirect(scatter);
    std::array<Vec3d, 2> sides;
    for (Eigen::Index i = 0; i < 2; ++i) {
        const Vec2d axis =
            std::sqrt(std::max(axes.eigenvalues()[i], 0.0)) * axes.eigenvectors().col(i);
        sides[static_cast<std::size_t>(i)] = axis.x() * s + axis.y() * t;
    }
    return sides;
}

void scale(Branch& branch, double factor) {
    for (RayChange& one : branch.all()) {
        one.place *= factor;
        one.direction *= factor;
    }
}

class PencilTracer {
public:
    PencilTracer(const Scene& scene, std::span<const LightSample> lights,
                 const PencilSettings& settings, std::uint64_t seed)
        : scene_(scene),
          lights_(lights),
          settings_(settings),
          seed_(seed),
          longest_(longest_side * static_cast<double>(scene.diameter())) {
        for (const Shape& shape : scene.shapes()) {
            exact_.emplace_back();
            if (is_caster(shape.bsdf) && shape.primitive != Primitive::mesh)
                exact_.back().emplace(shape);
        }
    }

    void trace(const Strata& strata, std::uint64_t stratum, TracedPencils& traced) const {
        Rng rng(seed_, Stage::pencils, strata.first + stratum);
        if (strata.chance < 1 && rng.next_fine() >= strata.chance) return;
        const LightSample& light = lights_[strata.patch.light];
        const auto start = strata.of_lamp ? start_on_lamp(light, strata, stratum)
                                          : start_in_grid(light, strata, stratum);
        if (!start) return;
        ++traced.traced;
        follow(*start, strata.patch, rng, traced);
    }

private:
    // A branch along a ray with the light of an area of its rectangle; none where no light goes that way.
    std::optional<Branch> start_along(const LightSample& light, const PatchRay& through,
                                      double area, double chance) const {
        const Vec3 along = through.direction.cast<float>();
        const Spectrum strength = strength_along(light, -along);
        if (is_black(strength)) return {};
        Branch start;
        if (light.kind != LightSample::Kind::directional)
            start.flight.ray = spawn_ray({light.position, light.normal, light.offset}, along);
        start.flight.flux = strength * static_cast<float>(through.measure * area / chance);
        start.flight.start_flux = start.flight.flux.sum();
        start.flight.start_medium = light.medium;
        start.flight.wavelength.nm = light.bin.nm;
        return start;
    }

    std::optional<Branch> start_in_grid(const LightSample& light, const Strata& strata,
                                        std::uint64_t stratum) const {
        const Vec3d point = strata.middle(stratum);
        const PatchRay through = ray_through(light, strata.patch.rectangle, point);
        const double area = strata.side(0).cross(strata.side(1)).norm();
        auto start = start_along(light, through, area, strata.chance);
        if (!start) return {};
        const std::array<Vec3d, 2> sides = {strata.side(0), strata.side(1)};
        if (light.kind == LightSample::Kind::directional) {
            const Vec3 along = through.direction.cast<float>();
            const Vec3 at = point.cast<float>();
            start->flight.ray = {at + distance_to_entry(light.bounds, at, along) * along, along};
            for (std::size_t i = 0; i < 2; ++i)
                start->change[i].place = sides[i] / std::sqrt(strata.chance);
        } else {
            turn_through(sides, (point - light.position.cast<double>()).norm(), through.direction,
                         std::sqrt(strata.chance), *start);
        }
        return start;
    }

    // Directions through the sides of a stratum at a distance from the start.
    static void turn_through(const std::array<Vec3d, 2>& sides, double distance,
                             const Vec3d& direction, double over, Branch& start) {
        for (std::size_t i = 0; i < 2; ++i) {
            const Vec3d side = sides[i] / over;
            start.change[i].direction = (side - direction.dot(side) * direction) / distance;
        }
    }

    std::optional<Branch> start_on_lamp(const LightSample& light, const Strata& strata,
                                        std::uint64_t stratum) const {
        const LightSample place =
            place_on_lamp(scene_, light, strata.number(stratum, 2), strata.number(stratum, 3));
        const Vec3d from = place.position.cast<double>();
        const CasterView view = caster_view(from, strata.patch.bounds, strata.patch.turn);
        if (view.count == 0) return {};
        // The first number chooses among the faces of a near caster's view.
        const auto faces = static_cast<double>(view.count);
        const double x = strata.number(stratum, 0) * faces;
        const auto face = std::min(static_cast<std::size_t>(x), view.count - 1);
        const ViewRectangle& rectangle = view.rectangles[face];
        const Vec3d point = rectangle.at(x - static_cast<double>(face), strata.number(stratum, 1));
        const PatchRay through = ray_through(place, rectangle, point);
        const double area = rectangle.area() * faces / static_cast<double>(strata.size());
        auto start = start_along(place, through, area, strata.chance);
        if (!start) return {};
        const double cell = print_over_cell * strata.side_of_cell() / std::pow(strata.chance, 0.25);
        turn_through({cell * faces * rectangle.sides[0], cell * rectangle.sides[1]},
                     (point - from).norm(), through.direction, 1, *start);
        spread_over_lamp(place, cell * std::sqrt(light.area), strata.patch, through, *start);
        return start;
    }

    // Rays from beside the lamp's place to where the ray passes its caster.
    void spread_over_lamp(const LightSample& place, double side, const LightPatch& patch,
                          const PatchRay& through, Branch& start) const {
        const Vec3d from = place.position.cast<double>();
        const Vec3d middle = patch.bounds.middle();
        const double distance = through.direction.dot(middle - from);
        if (!(distance > side)) return;
        const Frame frame(place.normal);
        start.changes = 4;
        for (std::size_t i = 0; i < 2; ++i) {
            const Vec3d way = side * (i == 0 ? frame.s : frame.t).cast<double>();
            start.change[2 + i].place = way;
            start.change[2 + i].direction =
                (through.direction.dot(way) * through.direction - way) / distance;
        }
    }

    // Follows a pencil and all its branches: of two the reflected one first, with all that comes of it.
    void follow(const Branch& start, const LightPatch& patch, Rng& rng,
                TracedPencils& traced) const {
        std::vector<Branch> waiting = {start};
        while (!waiting.empty()) {
            Branch branch = waiting.back();
            waiting.pop_back();
            while (moves_on(branch, patch, waiting, rng, traced)) {}
        }
    }

    // Along one segment and through the event at its end.
    bool moves_on(Branch& branch, const LightPatch& patch, std::vector<Branch>& waiting, Rng& rng,
                  TracedPencils& traced) const {
        Flight& flight = branch.flight;
        const std::optional<SurfacePoint> hit = scene_.intersect(flight.ray);
        if (!hit || (flight.bounces == 0 && hit->shape != patch.caster)) return false;
        const Bsdf& bsdf = scene_.shape_at(*hit).bsdf;
        flight.flux *= segment_transmittance(
            flight.start_medium,
            medium_absorption(bsdf, hit->geometric_normal, -flight.ray.direction), hit->distance);
        if (is_black(flight.flux)) return false;
        for (RayChange& one : branch.all())
            one = at_surface(one, flight.ray.direction.cast<double>(),
                             static_cast<double>(hit->distance),
                             hit->geometric_normal.cast<double>());
        if (is_receiver(bsdf) && flight.bounces > 0) land(branch, *hit, patch, traced);
        return is_caster(bsdf) && flight.bounces < settings_.max_bounces &&
               goes_on_from(*hit, branch, waiting, rng);
    }

    void land(const Branch& branch, const SurfacePoint& hit, const LightPatch& patch,
              TracedPencils& traced) const {
        const std::optional<Deposit> deposit = deposit_of(scene_, hit, branch.flight);
        if (!deposit) return;
        PencilPrint print{.position = deposit->position,
                          .normal = deposit->geometric_normal,
                          .wi = deposit->wi,
                          .sides = {},
                          .flux = deposit->flux,
                          .light = patch.light,
                          .events = static_cast<std::uint32_t>(branch.flight.bounces),
                          .flat = exact_is_flat(scene_.shape_at(hit))};
        const auto [a, b] = sides_of(branch, deposit->geometric_normal.cast<double>());
        print.sides = {a.cast<float>(), b.cast<float>()};
        traced.prints.push_back(print);
    }

    // Finds the sides of a branch's print on a plane. The print of a perfect focus is small, and so is one whose derivatives are infinite.
    std::array<Vec3d, 2> sides_of(const Branch& branch, const Vec3d& normal) const {
        std::array<Vec3d, 4> ways;
        double size = 0;
        for (std::size_t i = 0; i < branch.changes; ++i) {
            const double length = branch.change[i].place.norm();
            ways[i] = (length > longest_ ? longest_ / length : 1) * branch.change[i].place;
            size += ways[i].squaredNorm();
        }
        const double smallest = smallest_side * longest_;
        if (!(size > smallest * smallest && std::isfinite(size))) {
            const Frame frame(normal.cast<float>());
            return {smallest * frame.s.cast<double>(), smallest * frame.t.cast<double>()};
        }
        if (branch.changes == 2) return {ways[0], ways[1]};
        return rectangle_of(std::span(ways).first(branch.changes), normal);
    }

    bool goes_on_from(const SurfacePoint& hit, Branch& branch, std::vector<Branch>& waiting,
                      Rng& rng) const {
        const float before = branch.flight.flux.sum();
        if (!survives(branch.flight, rng)) return false;
        scale(branch, std::sqrt(static_cast<double>(branch.flight.flux.sum() / before)));
        const SpecularSplit split = split_at(scene_, hit, branch.flight, rng);
        Branch refracted = branch;
        const bool reflects = bend(hit, split, false, branch, rng);
        const bool refracts = bend(hit, split, true, refracted, rng);
        if (reflects && refracts) waiting.push_back(refracted);
        if (!reflects && refracts) branch = refracted;
        return reflects || refracts;
    }

    // Sends a branch through an event; false where no light goes that way.
    bool bend(const SurfacePoint& hit, const SpecularSplit& split, bool refracts, Branch& branch,
              Rng& rng) const {
        Flight& flight = branch.flight;
        flight.flux *= refracts ? split.refracted_weight : split.reflected_weight;
        const float left = flight.flux.sum();
        if (!(left > 0)) return false;
        const float least = faint * flight.start_flux;
        if (left < least) {
            if (rng.next() * least >= left) return false;
            flight.flux *= least / left;
            scale(branch, std::sqrt(static_cast<double>(least / left)));
        }
        const Vec3d direction = (refracts ? split.refracted : split.reflected).cast<double>();
        SpecularBend bend{.w = -flight.ray.direction.cast<double>(),
                          .n = hit.shading_normal.cast<double>(),
                          .cosine = 0,
                          .refracts = refracts};
        const double side = bend.n.dot(bend.w) < 0 ? -1 : 1;
        bend.n *= side;
        bend.cosine = bend.n.dot(bend.w);
        bend.eta = static_cast<double>(split.eta);
        bend.inner = refracts ? std::max(-direction.dot(bend.n), 1e-6) : 1;
        turn(hit, bend, side, branch);
        leave(scene_, hit, direction.cast<float>(), flight);
        return true;
    }

    // Changes a branch's directions at an event; `side` is -1 where the light comes to the back of the surface.
    void turn(const SurfacePoint& hit, const SpecularBend& bend, double side,
              Branch& branch) const {
        const Shape& shape = scene_.shape_at(hit);
        std::optional<SpecularSurface> facet;
        if (!exact_[hit.shape]) facet.emplace(shape.mesh, hit.triangle);
        const SpecularSurface& surface = facet ? *facet : *exact_[hit.shape];
        SpecularSurface::Place place;
        if (!surface.is_flat_facet())
            place = surface.beside(surface.local(hit.position.cast<double>()));
        for (RayChange& one : branch.all()) {
            Vec3d by_normal = Vec3d::Zero();
            if (!surface.is_flat_facet())
                by_normal = side * surface.normal_change(place, one.place);
            one.direction = bend.direction_change(-one.direction, by_normal);
        }
    }

    const Scene& scene_;
    std::span<const LightSample> lights_;
    const PencilSettings& settings_;
    std::uint64_t seed_;
    double longest_;
    std::vector<std::optional<SpecularSurface>> exact_;  ///< one a shape, of exact casters
};

// The strata that one of all is among.
const Strata& strata_with(const std::vector<Strata>& all, std::uint64_t stratum) {
    return *std::prev(std::ranges::upper_bound(all, stratum, {}, &Strata::first));
}

}  // namespace

TracedPencils trace_pencils(const Scene& scene, std::span<const LightSample> lights,
                            const PencilSettings& settings, const RunOptions& options) {
    const std::vector<LightPatch> patches = light_patches(scene, lights);
    TracedPencils all;
    if (patches.empty() || settings.count == 0) return all;
    const std::vector<Strata> shared = shared_strata(patches, lights, settings.count, options.seed);
    const PencilTracer tracer(scene, lights, settings, options.seed);
    const std::uint64_t strata = shared.back().first + shared.back().size();
    std::vector<TracedPencils> parts(chunk_count(strata, strata_together));
    TraceProgress progress(options);
    parallel_chunks(options.threads, strata, strata_together, [&](const Chunk& chunk) {
        for (std::uint64_t i = chunk.first; i < chunk.end; ++i) {
            const Strata& own = strata_with(shared, i);
            tracer.trace(own, i - own.first, parts[chunk.index]);
        }
        progress.add(static_cast<double>(chunk.end - chunk.first) / static_cast<double>(strata));
    });
    for (TracedPencils& part : parts) {
        all.prints.insert(all.prints.end(), part.prints.begin(), part.prints.end());
        all.traced += part.traced;
        part = {};
    }
    return all;
}

}  // namespace caustics::beamtree
