#include "photonmap/gather/irradiance_map.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <utility>

#include "core/base/parallel.h"
#include "photonmap/photons/direction_code.h"
#include "photonmap/photons/facing_code.h"
#include "photonmap/tree/build_tree.h"

namespace caustics::photonmap {
namespace {

constexpr std::size_t batch_places = 64;

Vec3 normal_of(const Photon& photon) {
    const Facing at = facing_of(photon.flags);
    return Vec3(static_cast<float>(at.x), static_cast<float>(at.y), static_cast<float>(at.z))
        .normalized();
}

ReceiverPoint point_of(const Photon& place) {
    ReceiverPoint point;
    point.position = position(place);
    point.geometric_normal = point.shading_normal = point.wo = normal_of(place);
    return point;
}

std::vector<Spectrum> irradiance_at(std::span<const Photon> places, const DensityMap& density,
                                    const RunOptions& options) {
    struct Worker {
        GatherScratch scratch;
        EstimateScratch estimate;
        std::vector<ReceiverPoint> points;
    };
    std::vector<Worker> workers(static_cast<std::size_t>(std::max(1, options.threads)));
    std::vector<Spectrum> irradiance(places.size(), black());
    const std::size_t batches = (places.size() + batch_places - 1) / batch_places;
    std::atomic<std::size_t> done{0};
    parallel_for(options.threads, batches, [&](std::size_t batch, std::size_t w) {
        Worker& worker = workers[w];
        const std::size_t first = batch * batch_places;
        const auto some = places.subspan(first, std::min(batch_places, places.size() - first));
        worker.points.clear();
        for (const Photon& place : some) worker.points.push_back(point_of(place));
        density.gather(
            worker.points, worker.scratch, [&](std::size_t i, const GatheredPhotons& gathered) {
                irradiance[first + i] =
                    density.estimate().irradiance(worker.points[i], gathered, worker.estimate);
            });
        options.report(static_cast<double>(++done) / static_cast<double>(batches));
    });
    return irradiance;
}

}  // namespace

PhotonStore every_kth(std::span<const Photon> photons, int k) {
    const auto step = static_cast<std::size_t>(k);
    PhotonStore places((photons.size() + step - 1) / step);
    for (std::size_t i = 0; i < photons.size(); i += step) {
        Photon place = photons[i];
        const DirectionCode code = encode_direction(normal_of(place));
        place.theta = code.theta;
        place.phi = code.phi;
        place.energy = std::bit_cast<Rgbe>(static_cast<std::uint32_t>(i / step));
        places.append({&place, 1});
    }
    return places;
}

IrradianceMap::IrradianceMap(PhotonStore places, const DensityMap& density,
                             const RunOptions& options)
    : irradiance_(irradiance_at(places.photons(), density, options)),
      nearest_{1, density.limits().max_radius},
      tree_(build_tree(TreeKind::packed, std::move(places), options.isa, options.threads)) {}

}  // namespace caustics::photonmap
