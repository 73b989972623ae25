#include "tests/cruel/cruel_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace caustics::cruel {

namespace {

/// A ball that a caster keeps to, in units of the scene.
struct Room {
    Vec3d centre;
    double radius;

    bool is_clear_of(const Room& other) const {
        return (centre - other.centre).norm() > radius + other.radius;
    }
};

class SceneMaker {
public:
    SceneMaker(Purpose purpose, std::uint64_t seed, const std::filesystem::path& folder)
        : parts_(purpose, seed, folder), dice_(parts_.dice()) {
        choose_world();
    }

    Json make() {
        scene_ = {{"type", "scene"}};
        if (dice_.chance(0.5)) scene_["version"] = 1;
        add_sensor();
        add_receivers();
        // Most scenes are small, so that many can be tried.
        const bool many = dice_.chance(0.15);
        for (int i = dice_.whole(1, !many ? 2 : parts_.measured() ? 3 : 6); i > 0; --i)
            add_caster();
        for (int i = dice_.whole(1, many ? 3 : 1); i > 0; --i) add_light();
        return scene_;
    }

private:
    /// From the scene's units, in which its floor is 3 wide, to metres.
    void choose_world() {
        world_ = Json::array();
        if (dice_.chance(0.3)) world_.push_back(parts_.turn());
        if (dice_.chance(0.3)) {
            unit_ = dice_.pick({1e-4, 0.01, 100.0, 1e4});
            world_.push_back(scale_by(unit_));
        }
        if (dice_.chance(0.2)) {
            const double far = unit_ * dice_.pick({10.0, 1e3, 1e5});
            world_.push_back(move_to({far, -far / 3, far / 7}));
        }
    }

    /// Puts an object into the scene: its own transform, then these steps, then the world's.
    void place(const std::string& name, Json object, const std::vector<Json>& steps) {
        Json all = object.value("to_world", Json::array());
        for (const Json& step : steps) all.push_back(step);
        for (const Json& step : world_) all.push_back(step);
        if (all.empty()) all.push_back(scale_by(1));
        object["to_world"] = all;
        scene_[name + std::to_string(scene_.size())] = std::move(object);
    }

    void add_sensor() {
        Json film = {{"type", "hdrfilm"}, {"width", 12}, {"height", 8}};
        // Several tiles for several threads, the last of them a pixel high.
        if (dice_.chance(0.3)) film = {{"type", "hdrfilm"}, {"width", 18}, {"height", 17}};
        if (dice_.chance(0.2)) film["filter"] = {{"type", "box"}};
        Json sampler = {{"type", dice_.pick({"independent", "stratified", "adaptive"})}};
        sampler["sample_count"] = sampler["type"] == "adaptive" ? 2 : dice_.pick({1, 4});
        if (sampler["type"] == "adaptive") {
            sampler["max_sample_count"] = 4;
            if (dice_.chance(0.5)) sampler["max_error"] = dice_.number(0.01, 0.5);
        }
        if (sampler["type"] == "stratified") sampler["jitter"] = dice_.chance(0.7);
        if (dice_.chance(0.3)) sampler["split_depth"] = dice_.whole(0, 4);
        Json sensor = {{"type", "perspective"},
                       {"fov", dice_.number(20, 100)},
                       {"film", film},
                       {"sampler", sampler}};
        if (dice_.chance(0.3))
            sensor["fov_axis"] = dice_.pick({"x", "y", "diagonal", "smaller", "larger"});
        const Json look = {{"origin", {dice_.number(-2, 2), -2.5, dice_.number(0.2, 3)}},
                           {"target", {0, 0, 0.3}},
                           {"up", {0, 0, 1}}};
        place("sensor", sensor, {Json::object({{"look_at", look}})});
    }

    void add_receivers() {
        Json floor = {{"type", "rectangle"}, {"bsdf", parts_.receiver_bsdf()}};
        if (parts_.measured()) floor["bsdf"] = {{"type", "diffuse"}};
        place("floor", floor, {scale_by(1.5)});
        for (int i = dice_.whole(0, 2); i > 0; --i) {
            Json shape = dice_.chance(0.5) ? parts_.sheet() : parts_.solid();
            if (!parts_.measured() && dice_.chance(0.2)) shape["flip_normals"] = true;
            shape["bsdf"] = parts_.receiver_bsdf();
            place("thing", shape, steps_to(free_room(0.3, true)));
        }
    }

    std::vector<Json> steps_to(const Room& room) {
        std::vector<Json> steps;
        if (dice_.chance(0.7)) steps.push_back(parts_.turn());
        steps.push_back(scale_by(parts_.measured() ? room.radius / 1.3 : room.radius));
        steps.push_back(move_to(room.centre));
        return steps;
    }

    /// Where a caster may be; of measured ones none meets another, or the floor, and no receiver is so near
    /// that a disc on the floor would hold what falls on it.
    Room free_room(double most, bool is_receiver = false) {
        for (int attempt = 0;; ++attempt) {
            const double radius = dice_.number(0.1, most) / (1 + attempt / 20);
            const Room room{
                {dice_.number(-0.9, 0.9), dice_.number(-0.9, 0.9), dice_.number(0.05, 1.5)},
                radius};
            bool clear = room.centre.z() > radius + (is_receiver ? 0.55 : 0.02);
            for (const Room& other : rooms_) clear = clear && room.is_clear_of(other);
            if (!clear && parts_.measured()) continue;
            rooms_.push_back(room);
            return room;
        }
    }

    void add_caster() {
        if (dice_.chance(0.12)) return add_water();
        const Room room = free_room(0.6);
        const bool is_solid = dice_.chance(0.6);
        Json shape = is_solid ? parts_.solid() : parts_.sheet();
        const bool is_glass =
            is_solid ? dice_.chance(0.75) : dice_.chance(parts_.measured() ? 0.1 : 0.3);
        Json bsdf = is_glass ? parts_.glass_bsdf() : parts_.mirror_bsdf();
        const bool is_high = room.centre.z() > room.radius + 0.55;
        if (!is_glass && dice_.chance(0.15) && (is_high || !parts_.measured())) bsdf = blend();
        shape["bsdf"] = bsdf;
        if (dice_.chance(parts_.measured() ? 0.05 : 0.15)) shape["flip_normals"] = true;
        const auto steps = steps_to(room);
        place("caster", shape, steps);
        if (is_glass && is_solid && dice_.chance(0.3)) add_inside(bsdf, room);
        if (!parts_.measured() && dice_.chance(0.1)) place("twin", shape, steps);
    }

    Json blend() {
        return {{"type", "blendbsdf"},
                {"weight", dice_.number(0, 1)},
                {"a", {{"type", "diffuse"}, {"reflectance", parts_.colour(0, 1)}}},
                {"b", {{"type", "conductor"}, {"specular_reflectance", parts_.colour(0, 1)}}}};
    }

    /// Waves from edge to edge of the floor.
    void add_water() {
        if (has_water_ || (parts_.measured() && !rooms_.empty())) return;
        has_water_ = true;
        const double height = dice_.number(0.3, 1.2);
        const Json wave = parts_.measured() && dice_.chance(0.5)
                              ? folding_wave(height)
                              : Json{{"amplitude", dice_.number(0, 0.04)},
                                     {"wave_vector", {dice_.number(-8, 8), dice_.number(-8, 8)}}};
        Json water = {{"type", "heightfield"}, {"half_size", {1.6, 1.6}}};
        water["waves"] = Json::array({wave});
        water["bsdf"] = {{"type", "dielectric"}, {"int_ior", "water"}, {"ext_ior", "air"}};
        place("water", water, {move_to({0, 0, height})});
        // What else there is would cross the surface; below it there is always room for something small.
        if (parts_.measured()) rooms_.push_back({{0, 0, 100}, 100 - std::max(height - 0.3, 0.12)});
    }

    /// A wave of wave number k whose light folds before the floor: its curvature, amplitude * k^2, times depth *
    /// (1 - 1 / n) is 1.2 to 4.
    Json folding_wave(double depth) {
        constexpr double bends = 1 - 1 / 1.333;
        const double number = dice_.number(10, 25), angle = dice_.number(0, 3.14);
        const double folds = dice_.number(1.2, 4);
        return {{"amplitude", folds / (number * number * depth * bends)},
                {"wave_vector", {number * std::cos(angle), number * std::sin(angle)}}};
    }

    /// Something in the middle of a glass: glass, a bubble, a mirror, or a lamp.
    void add_inside(const Json& outer, const Room& room) {
        const std::vector<Json> steps = {scale_by(0.3 * room.radius), move_to(room.centre)};
        if (dice_.chance(0.3)) {
            const Json lamp = {{"type", "point"}, {"intensity", strength(unit_ * unit_)}};
            return place("lamp", lamp, {steps.back()});
        }
        Json inner = {{"type", "sphere"}};
        inner["bsdf"] = dice_.chance(0.7) ? parts_.glass_bsdf(outer) : parts_.mirror_bsdf();
        place("inner", inner, steps);
    }

    Json strength(double factor) {
        const double value = factor * dice_.number(0.5, 5);
        if (dice_.chance(0.6)) return value;
        return {value, value * dice_.number(0, 1), value * dice_.number(0, 1)};
    }

    void add_light() {
        const bool low = dice_.chance(0.15);
        const Vec3d at{dice_.number(-1.5, 1.5), dice_.number(-1.5, 1.5),
                       low ? dice_.number(0.01, 0.2) : dice_.number(1.8, 4)};
        const Json look = {{"origin", {at.x(), at.y(), at.z()}},
                           {"target", {dice_.number(-0.5, 0.5), 0.1, dice_.number(0.2, 0.8)}},
                           {"up", {0.1, 1, 0.2}}};
        const Json aimed = Json::object({{"look_at", look}});
        switch (dice_.whole(0, 9)) {
            case 0: return add_sky();
            case 1: return add_spot(aimed);
            case 2: return add_sun(aimed);
            case 3:
            case 4:
            case 5:
                if (parts_.measured() && (low || dice_.chance(0.3))) break;
                return add_area(aimed);
            default: break;
        }
        add_lamp(at);
    }

    // Keys that the world's transform would not turn are given where there is none.
    void add_lamp(const Vec3d& at) {
        Json lamp = {{"type", "point"}, {"intensity", strength(unit_ * unit_)}};
        if (!world_.empty() || dice_.chance(0.5)) return place("lamp", lamp, {move_to(at)});
        lamp["position"] = {at.x(), at.y(), at.z()};
        scene_["lamp"] = lamp;
    }

    void add_sun(const Json& aimed) {
        Json sun = {{"type", "directional"}, {"irradiance", strength(1)}};
        if (!world_.empty() || dice_.chance(0.5)) return place("sun", sun, {aimed});
        sun["direction"] = {dice_.number(-0.5, 0.5), 0.1, -1};
        scene_["sun"] = sun;
    }

    void add_sky() {
        if (dice_.chance(0.3)) {
            scene_["ambient"] = {{"type", "ambient"}, {"radiance", strength(0.1)}};
            return;
        }
        scene_["sky"] = {{"type", "constant"}, {"radiance", strength(0.3)}};
    }

    void add_spot(const Json& aimed) {
        Json spot = {{"type", "spot"}, {"intensity", strength(unit_ * unit_)}};
        const double cutoff = dice_.number(5, 60);
        if (dice_.chance(0.7)) spot["cutoff_angle"] = cutoff;
        if (spot.contains("cutoff_angle") && dice_.chance(0.5))
            spot["beam_width"] = std::floor(cutoff * dice_.number(0, 1));
        place("spot", spot, {aimed});
    }

    void add_area(const Json& aimed) {
        Json shape = {{"type", dice_.pick({"rectangle", "disk", "sphere", "cube"})}};
        if (!parts_.measured() && dice_.chance(0.3)) shape = parts_.solid();
        shape["emitter"] = {{"type", "area"}, {"radiance", strength(5)}};
        if (!parts_.measured() && dice_.chance(0.3)) shape["bsdf"] = parts_.receiver_bsdf();
        place("light", shape,
              {scale_by(parts_.measured() ? dice_.number(0.2, 0.6) : dice_.number(0.02, 0.2)),
               aimed});
    }

    Parts parts_;
    Dice& dice_;
    Json scene_;
    Json world_;
    double unit_ = 1;
    std::vector<Room> rooms_;
    bool has_water_ = false;
};

}  // namespace

Json cruel_scene(Purpose purpose, std::uint64_t seed, const std::filesystem::path& folder) {
    return SceneMaker(purpose, seed, folder).make();
}

}  // namespace caustics::cruel
