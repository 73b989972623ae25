#include "beamtree/pencils/light_patch.h"

#include <cmath>

#include "core/geometry/exact_shape.h"
#include "core/math/frame.h"
#include "core/math/lattice.h"

namespace caustics::beamtree {
namespace {

// The least cosine of a spot's half angle with which its rays go through one rectangle.
constexpr double widest_cosine_of_spot = 0.4;
// Rounding of floats, over the patch.
constexpr double slack = 1e-5;
// Along each side of a patch, where its light is looked at.
constexpr int places = 8;
// Places of an area light, for the same.
constexpr std::uint64_t lamp_places = 64;
// The least light of a patch of an area light, over what its rectangles would have along the normal: no patch is left out.
constexpr double least_of_lamp = 1e-3;

const AreaLight* lamp_of(const Scene& scene, const LightSample& light) {
    return light.kind == LightSample::Kind::area ? &std::get<AreaLight>(scene.lights()[light.light])
                                                 : nullptr;
}

class Patches {
public:
    Patches(const Scene& scene, std::span<const LightSample> lights)
        : scene_(scene), lights_(lights) {}

    std::vector<LightPatch> find() {
        for (std::uint32_t light = 0; light < lights_.size(); ++light)
            for (const std::uint32_t caster : scene_.casters()) add(light, caster);
        return std::move(patches_);
    }

private:
    void add(std::uint32_t light, std::uint32_t caster) {
        const LightSample& sample = lights_[light];
        const CasterBounds round = caster_bounds(scene_.shapes()[caster]);
        const BoxCorners& corners = round.corners;
        if (sample.kind == LightSample::Kind::area) return add_lamp(light, caster, round);
        if (sample.kind == LightSample::Kind::directional) {
            const Vec3d along = sample.travel.cast<double>().normalized();
            const PlaneRectangle across =
                rectangle_round(corners, along, best_turn(corners, along));
            return push(light, caster, in_space(across, along.dot(corners[0]) * along));
        }
        const Vec3d from = sample.position.cast<double>();
        if (sample.spot &&
            std::cos(static_cast<double>(sample.spot->cutoff)) > widest_cosine_of_spot)
            return add_spot(light, caster, from, corners);
        const CasterView view = caster_view(from, round);
        for (std::size_t i = 0; i < view.count; ++i) push(light, caster, view.rectangles[i]);
    }

    // Takes the part of the rectangle round the caster that a spot's cone reaches.
    void add_spot(std::uint32_t light, std::uint32_t caster, const Vec3d& from,
                  const BoxCorners& corners) {
        const SpotCone& spot = *lights_[light].spot;
        const Vec3d axis = spot.axis.cast<double>().normalized();
        const double reach = (1 + slack) * std::tan(static_cast<double>(spot.cutoff));
        const Frame frame(axis.cast<float>());
        const Vec3d s =
            (frame.s.cast<double>() - axis.dot(frame.s.cast<double>()) * axis).normalized();
        PlaneRectangle rectangle{
            {s, axis.cross(s)}, Vec2d::Constant(-reach), Vec2d::Constant(reach)};
        if (const auto seen = seen_round(from, axis, corners)) {
            PlaneRectangle round{rectangle.axes};
            for (const Vec3d& point : *seen)
                round.add({round.axes[0].dot(point), round.axes[1].dot(point)});
            const Vec2d margin = Vec2d::Constant(slack * round.size().maxCoeff());
            rectangle.low = rectangle.low.cwiseMax(round.low - margin);
            rectangle.high = rectangle.high.cwiseMin(round.high + margin);
            if (!(rectangle.size().array() > 0).all()) return;
        }
        push(light, caster, in_space(rectangle, from + axis));
    }

    void push(std::uint32_t light, std::uint32_t caster, const ViewRectangle& rectangle) {
        LightPatch patch{.light = light, .caster = caster, .rectangle = rectangle};
        const LightSample& sample = lights_[light];
        for (int i = 0; i < places; ++i)
            for (int j = 0; j < places; ++j) {
                const PatchRay ray = ray_through(
                    sample, rectangle, rectangle.at((i + 0.5) / places, (j + 0.5) / places));
                const Spectrum strength = strength_along(sample, -ray.direction.cast<float>());
                patch.watts += static_cast<double>(strength.mean()) * ray.measure *
                               rectangle.area() / (places * places);
            }
        if (patch.watts > 0) patches_.push_back(patch);
    }

    void add_lamp(std::uint32_t light, std::uint32_t caster, const CasterBounds& round) {
        const Box box = bounds(scene_.shapes()[lamp_of(scene_, lights_[light])->shape]);
        const Vec3d middle = box.center().cast<double>();
        const Vec3d axis = (round.middle() - middle).normalized();
        const auto seen = seen_round(middle, axis, round.corners);
        LightPatch patch{.light = light,
                         .caster = caster,
                         .bounds = round,
                         .turn = seen ? best_turn(*seen, axis) : 0};
        for (std::uint64_t i = 0; i < lamp_places; ++i) {
            const auto number = [&](std::size_t k) { return on_lattice(0, i + 1, r4_steps[k]); };
            const LightSample place = place_on_lamp(scene_, lights_[light], number(2), number(3));
            const CasterView view = caster_view(place.position.cast<double>(), round, patch.turn);
            for (std::size_t k = 0; k < view.count; ++k) {
                const ViewRectangle& rectangle = view.rectangles[k];
                const PatchRay ray =
                    ray_through(place, rectangle, rectangle.at(number(0), number(1)));
                const double along = static_cast<double>(place.strength.mean());
                const double towards =
                    static_cast<double>(strength_along(place, -ray.direction.cast<float>()).mean());
                patch.watts += (towards + least_of_lamp * along) * ray.measure * rectangle.area() /
                               static_cast<double>(lamp_places);
            }
        }
        if (patch.watts > 0) patches_.push_back(patch);
    }

    const Scene& scene_;
    std::span<const LightSample> lights_;
    std::vector<LightPatch> patches_;
};

}  // namespace

PatchRay ray_through(const LightSample& light, const ViewRectangle& rectangle, const Vec3d& point) {
    if (light.kind == LightSample::Kind::directional)
        return {light.travel.cast<double>().normalized(), 1};
    const Vec3d way = point - light.position.cast<double>();
    const double distance = way.norm();
    const Vec3d across = rectangle.sides[0].cross(rectangle.sides[1]).normalized();
    return {way / distance, std::abs(across.dot(way)) / (distance * distance * distance)};
}

LightSample place_on_lamp(const Scene& scene, const LightSample& light, double u, double v) {
    const AreaLight& lamp = *lamp_of(scene, light);
    const AreaSampler::Sample at = lamp.sampler.sample(
        scene.shapes()[lamp.shape], static_cast<float>(u), static_cast<float>(v));
    LightSample place = light;
    place.position = at.position;
    place.normal = at.normal;
    place.offset = at.offset;
    return place;
}

std::vector<LightSample> whole_lamps(const Scene& scene, std::vector<LightSample> lights) {
    for (LightSample& light : lights)
        if (const AreaLight* const lamp = lamp_of(scene, light)) {
            const double area = lamp->sampler.area();
            light.strength *= static_cast<float>(area / light.area);
            light.area = area;
        }
    return lights;
}

std::vector<LightPatch> light_patches(const Scene& scene, std::span<const LightSample> lights) {
    return Patches(scene, lights).find();
}

}  // namespace caustics::beamtree
