#include "tests/support/light_flux.h"

#include <algorithm>
#include <cmath>

#include "core/math/frame.h"
#include "core/math/sampling.h"

namespace caustics::support {
namespace {

std::optional<LightParticle> emit_unaimed(const Scene&, const PointLight& light, Rng& rng) {
    const float u0 = rng.next();
    const float u1 = rng.next();
    const Vec3 direction = uniform_cap(2, u0, u1).normalized();
    return LightParticle{spawn_ray({light.position}, direction), light.intensity * 4 * pi};
}

std::optional<LightParticle> emit_unaimed(const Scene&, const SpotLight& light, Rng& rng) {
    const float u0 = rng.next();
    const float u1 = rng.next();
    const Vec3 direction = uniform_cap(2, u0, u1).normalized();
    return LightParticle{spawn_ray({light.position}, direction),
                         light.intensity * light.cone.falloff(direction) * 4 * pi};
}

std::optional<LightParticle> emit_unaimed(const Scene& scene, const AreaLight& light, Rng& rng) {
    const float u0 = rng.next();
    const float u1 = rng.next();
    const float u2 = rng.next();
    const float u3 = rng.next();
    const auto sample = light.sampler.sample(scene.shapes()[light.shape], u0, u1);
    const Vec3 direction = Frame(sample.normal).to_world(cosine_hemisphere(u2, u3)).normalized();
    const auto area = static_cast<float>(light.sampler.area());
    return LightParticle{spawn_ray({sample.position, sample.normal, sample.offset}, direction),
                         light.radiance * pi * area};
}

// Across a direction, over a disc that holds the whole scene.
LightParticle across(const Scene& scene, const Vec3& direction, const Spectrum& irradiance,
                     Rng& rng) {
    const float radius = scene.diameter() / 2;
    const float u0 = rng.next();
    const float u1 = rng.next();
    const Vec2 local = radius * uniform_disc(u0, u1);
    const Frame frame(direction);
    const Vec3 start = scene.bounds().center() + frame.s * local.x() + frame.t * local.y() -
                       1.01F * radius * direction;
    return {spawn_ray({start}, direction), irradiance * pi * radius * radius};
}

std::optional<LightParticle> emit_unaimed(const Scene& scene, const DirectionalLight& light,
                                          Rng& rng) {
    return across(scene, light.direction, light.irradiance, rng);
}

std::optional<LightParticle> emit_unaimed(const Scene& scene, const ConstantLight& light,
                                          Rng& rng) {
    const float u0 = rng.next();
    const float u1 = rng.next();
    return across(scene, uniform_cap(2, u0, u1).normalized(), light.radiance * 4 * pi, rng);
}

}  // namespace

Emit aimed(const AimedEmission& emission) {
    return [&emission](Rng& rng) { return emission.emit(rng); };
}

Emit unaimed(const Scene& scene, const Light& light) {
    return [&scene, &light](Rng& rng) {
        return std::visit([&](const auto& l) { return emit_unaimed(scene, l, rng); }, light);
    };
}

double ArrivedFlux::total() const {
    double sum = 0;
    for (const double value : mean) sum += value;
    return sum;
}

ArrivedFlux arrived_flux(const Scene& scene, const Emit& emit, std::uint64_t paths,
                         std::size_t cells, const std::function<int(const Deposit&)>& cell_of,
                         std::uint64_t seed, int max_bounces) {
    std::vector<double> sums(cells, 0);
    std::vector<double> squares(cells, 0);
    ArrivedFlux result;
    std::vector<Deposit> deposits;
    for (std::uint64_t path = 0; path < paths; ++path) {
        Rng rng(seed, Stage::test, path);
        ++result.counts.emitted;
        const std::optional<LightParticle> particle = emit(rng);
        if (!particle) continue;
        ++result.counts.aimed;
        deposits.clear();
        trace_light_path(scene, *particle, {max_bounces}, rng, result.counts, deposits);
        for (const Deposit& deposit : deposits) {
            const int cell = cell_of(deposit);
            if (cell < 0) continue;
            const auto flux = static_cast<double>(deposit.flux.mean());
            sums[static_cast<std::size_t>(cell)] += flux;
            squares[static_cast<std::size_t>(cell)] += flux * flux;
        }
    }
    const auto n = static_cast<double>(paths);
    for (std::size_t i = 0; i < cells; ++i) {
        const double mean = sums[i] / n;
        result.mean.push_back(mean);
        result.standard_error.push_back(std::sqrt(std::max(0.0, squares[i] / n - mean * mean) / n));
    }
    return result;
}

ArrivedFlux flux_by_shape(const Scene& scene, const Emit& emit, std::uint64_t paths,
                          std::uint64_t seed, int max_bounces) {
    return arrived_flux(
        scene, emit, paths, scene.shapes().size(),
        [](const Deposit& d) { return static_cast<int>(d.shape); }, seed, max_bounces);
}

}  // namespace caustics::support
