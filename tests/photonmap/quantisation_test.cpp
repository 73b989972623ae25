#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/light_path/aimed_emission.h"
#include "photonmap/photon_map.h"
#include "shading_sets.h"
#include "tests/support/build_scene.h"

namespace caustics::photonmap {
namespace {

constexpr std::size_t nearest = 100;

/// What `count` photons stored before they were coded: a glass ball over a floor, lit from the side.
std::vector<Deposit> ball_deposits(std::size_t count) {
    SceneDesc desc;
    desc.shapes = {support::sphere("ball", {0, 0, 0.35}, 0.3, support::glass(1.5F)),
                   support::horizontal("floor", 0, 0.75, true, support::diffuse(0.5F))};
    desc.lights = {support::point_light({-1.2, 0.4, 1.6}, 10)};
    const Scene scene(std::move(desc));
    const AimedEmission emission(scene);
    std::vector<Deposit> deposits;
    LightPathCounts counts;
    for (std::uint64_t path = 0; deposits.size() < count; ++path) {
        Rng rng(61, Stage::photons, path);
        const std::optional<LightParticle> particle = emission.emit(rng);
        if (!particle) continue;
        trace_light_path(scene, *particle, {16}, rng, counts, deposits);
    }
    return deposits;
}

/// The nearest deposits to a point, in no order.
std::vector<const Deposit*> nearest_to(const std::vector<Deposit>& deposits, const Vec3& x) {
    std::vector<const Deposit*> all;
    for (const Deposit& deposit : deposits) all.push_back(&deposit);
    std::nth_element(all.begin(), all.begin() + nearest, all.end(),
                     [&x](const Deposit* a, const Deposit* b) {
                         return (a->position - x).squaredNorm() < (b->position - x).squaredNorm();
                     });
    all.resize(nearest);
    return all;
}

/// Sums at points of the caustic that eyes see: with the true directions, and with codes.
struct Sums {
    std::vector<double> exact;
    std::vector<double> coded;
};

void add_sums(const ReceiverPoint& point, float alpha, const std::vector<const Deposit*>& found,
              Sums& sums) {
    const Vec3d n = point.shading_normal.cast<double>(), wo = point.wo.cast<double>().normalized();
    test::PhotonArrays photons(nearest);
    double exact = 0;
    for (std::size_t i = 0; i < nearest; ++i) {
        const Rgbe energy = encode_rgbe(found[i]->flux);
        photons.set(i, energy, encode_direction(found[i]->wi));
        const Vec3d wi = found[i]->wi.cast<double>().normalized();
        exact += test::schlick_as_printed(static_cast<double>(alpha), n, wo, wi) *
                 static_cast<double>(decode_rgbe(energy)[1]);
    }
    sums.exact.push_back(exact);
    sums.coded.push_back(Shading(Isa::plain).reflected(point, photons.photons())[1]);
}

/// Root of the mean squared relative error.
double relative_rmse(const Sums& sums) {
    double squares = 0;
    for (std::size_t i = 0; i < sums.exact.size(); ++i) {
        const double error = sums.coded[i] / sums.exact[i] - 1;
        squares += error * error;
    }
    return std::sqrt(squares / static_cast<double>(sums.exact.size()));
}

double cost_of_codes(float alpha, const Vec3& eye, const std::vector<Deposit>& deposits) {
    const Bsdf floor{Schlick{Spectrum(Spectrum::Ones()), alpha}};
    Sums sums;
    for (std::size_t i = 0; i < deposits.size(); i += 199) {
        ReceiverPoint point{};
        point.position = deposits[i].position;
        point.geometric_normal = point.shading_normal = Vec3::UnitZ();
        point.wo = (eye - point.position).normalized();
        point.bsdf = &floor;
        add_sums(point, alpha, nearest_to(deposits, point.position), sums);
    }
    return relative_rmse(sums);
}

TEST(Quantisation, DirectionCodesCostLittleHoweverSharpTheLobe) {
    const std::vector<Deposit> deposits = ball_deposits(40'000);
    // The mirror direction of the spot, from the side, and from above.
    for (const Vec3& eye : {Vec3(1.8F, -0.4F, 1.4F), Vec3(0.3F, -1.7F, 1.3F), Vec3(0.2F, 0, 2)}) {
        EXPECT_LE(cost_of_codes(0.01F, eye, deposits), 0.02) << eye.transpose();
        EXPECT_LE(cost_of_codes(0.1F, eye, deposits), 0.006) << eye.transpose();
        EXPECT_LE(cost_of_codes(1, eye, deposits), 0.001) << eye.transpose();
    }
}

}  // namespace
}  // namespace caustics::photonmap
