#include "experiments/verify/light_audit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/light_path/aimed_emission.h"
#include "core/light_path/empty_caustic.h"
#include "core/light_path/light_path.h"

namespace caustics::experiments {

namespace {

constexpr std::uint64_t paths = 100'000;

/// A scene with one of its lights.
struct OneLight {
    std::string name;
    SceneDesc scene;
};

std::vector<OneLight> one_by_one(const SceneDesc& scene) {
    SceneDesc dark = scene;
    dark.lights.clear();
    for (Shape& shape : dark.shapes) shape.radiance.reset();
    std::vector<OneLight> lights;
    for (const Light& light : scene.lights) {
        lights.push_back({fmt::format("{} light {}", type_of(light), lights.size() + 1), dark});
        lights.back().scene.lights = {light};
    }
    for (std::size_t i = 0; i < scene.shapes.size(); ++i) {
        if (!scene.shapes[i].radiance) continue;
        lights.push_back({"area light " + scene.shapes[i].name, dark});
        lights.back().scene.shapes[i].radiance = scene.shapes[i].radiance;
    }
    return lights;
}

double watts(const Spectrum& flux) { return static_cast<double>(flux.mean()); }

/// Sum and error of what paths bring, divided by their number.
class MeanOfPaths {
public:
    void add(double x) {
        sum_ += x;
        squares_ += x * x;
    }
    double mean() const { return sum_ / static_cast<double>(paths); }
    double error() const {
        return std::sqrt(std::max(0.0, squares_ / static_cast<double>(paths) - mean() * mean()) /
                         static_cast<double>(paths));
    }

private:
    double sum_ = 0;
    double squares_ = 0;
};

class Auditor {
public:
    Auditor(const Scene& scene, int max_bounces)
        : scene_(scene), emission_(scene), max_bounces_(max_bounces) {}

    void follow_by_chance(LightAccount& account) const {
        MeanOfPaths arrived;
        std::vector<Deposit> deposits;
        const double share = 1.0 / static_cast<double>(paths);
        for (std::uint64_t path = 0; path < paths; ++path) {
            Rng rng(1, Stage::survey, path);
            const auto particle = emission_.emit(rng);
            if (!particle) continue;
            LightPathCounts end;
            deposits.clear();
            trace_light_path(scene_, *particle, {max_bounces_}, rng, end, deposits);
            const double sent = watts(particle->flux) * share;
            account.sent += sent;
            if (end.missed > 0) account.missed += sent;
            if (end.escaped > 0) account.escaped += sent;
            if (end.on_black_side > 0) account.on_black_side += sent;
            if (end.depth_limited > 0) account.depth_limited += sent;
            double sum = 0;
            for (const Deposit& deposit : deposits) sum += watts(deposit.flux);
            arrived.add(sum);
        }
        account.arrived = arrived.mean();
        account.arrived_error = arrived.error();
        account.absorbed = account.sent - account.missed - account.escaped - account.on_black_side -
                           account.depth_limited - account.arrived;
    }

    void follow_branches(LightAccount& account) const {
        MeanOfPaths arrived;
        LightPathCounts counts;
        std::vector<Deposit> deposits;
        const LightPathSettings settings{max_bounces_, Interaction::split};
        for (std::uint64_t path = paths; path < 2 * paths; ++path) {
            Rng rng(1, Stage::survey, path);
            const auto particle = emission_.emit(rng);
            if (!particle) continue;
            deposits.clear();
            trace_split_path(scene_, *particle, settings, rng, counts, deposits);
            double sum = 0;
            for (const Deposit& deposit : deposits) sum += watts(deposit.flux);
            arrived.add(sum);
        }
        account.arrived_by_branches = arrived.mean();
        account.branches_error = arrived.error();
    }

private:
    const Scene& scene_;
    AimedEmission emission_;
    int max_bounces_;
};

}  // namespace

bool LightAccount::holds() const {
    const double room = 5 * std::hypot(arrived_error, branches_error) + 1e-6 * sent;
    return std::abs(arrived - arrived_by_branches) <= room && arrived <= sent + room &&
           absorbed >= -room;
}

std::vector<LightAccount> audit_lights(const SceneDesc& scene, int max_bounces) {
    std::vector<LightAccount> accounts;
    for (OneLight& light : one_by_one(scene)) {
        LightAccount& account = accounts.emplace_back();
        account.light = light.name;
        const Scene alone(std::move(light.scene));
        if (const auto reason = why_nothing_is_aimed(alone)) {
            account.nothing_aimed = *reason;
            continue;
        }
        const Auditor auditor(alone, max_bounces);
        auditor.follow_by_chance(account);
        auditor.follow_branches(account);
    }
    return accounts;
}

}  // namespace caustics::experiments
