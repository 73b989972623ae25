#include "experiments/run/picture_light.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/base/parallel.h"
#include "core/reference/light_trace.h"

namespace caustics::experiments {

namespace {

constexpr std::uint64_t paths_of_survey = 50'000;
constexpr std::uint64_t paths_of_doubt = 400'000;
constexpr double least_excess = 0.01;
constexpr double least_errors = 3;
constexpr std::uint32_t no_receiver = ~std::uint32_t{0};
// Threads take so many rows at a time.
constexpr std::size_t rows_together = 8;

/// The receiver that is seen through a film point; none where something else is.
std::uint32_t receiver_through(const Scene& scene, double x, double y) {
    const Camera& camera = scene.camera();
    const std::optional<SurfacePoint> hit =
        scene.intersect({camera.position(), camera.direction(x, y)});
    if (!hit) return no_receiver;
    const Bsdf& bsdf = scene.shape_at(*hit).bsdf;
    return is_receiver(bsdf) && !is_caster(bsdf) ? hit->shape : no_receiver;
}

/// For each pixel the receiver that all its corners see.
std::vector<std::uint32_t> receivers_of_pixels(const Scene& scene, int threads) {
    const auto width = static_cast<std::size_t>(scene.camera().width);
    const auto height = static_cast<std::size_t>(scene.camera().height);
    const std::size_t across = width + 1;
    std::vector<std::uint32_t> corners(across * (height + 1));
    parallel_chunks(threads, height + 1, rows_together, [&](const Chunk& rows) {
        for (std::size_t i = rows.first * across; i < rows.end * across; ++i)
            corners[i] = receiver_through(scene, static_cast<double>(i % across),
                                          static_cast<double>(i / across));
    });
    std::vector<std::uint32_t> receivers(width * height);
    for (std::size_t i = 0; i < receivers.size(); ++i) {
        const std::uint32_t* corner = &corners[i / width * across + i % width];
        const bool alike = corner[0] == corner[1] && corner[0] == corner[across] &&
                           corner[0] == corner[across + 1];
        receivers[i] = alike ? corner[0] : no_receiver;
    }
    return receivers;
}

/// The sums over the pixels of one receiver.
struct Sums {
    double picture = 0;
    double paths = 0;
    double paths_variance = 0;
    double noise = 0;  ///< variance of `picture`

    void add(const Sums& other) {
        picture += other.picture;
        paths += other.paths;
        paths_variance += other.paths_variance;
        noise += other.noise;
    }
    ReceiverLight light(const std::string& name, double pixels, double more_noise) const {
        ReceiverLight light{name, picture / pixels, paths / pixels};
        const double of_paths = paths_variance / (paths * paths);
        const double of_picture = noise / (paths * paths) + more_noise * of_paths;
        light.error = std::sqrt(of_paths * std::pow(picture / paths, 2) + of_picture);
        return light;
    }
};

/// The variance of a pixel, from above: of the second difference with its neighbours in the row, of one receiver.
std::optional<double> variance_of_pixel(const std::vector<double>& values,
                                        const std::vector<std::uint32_t>& receivers,
                                        std::size_t i) {
    if (i == 0 || i + 1 == values.size()) return {};
    if (receivers[i - 1] != receivers[i] || receivers[i + 1] != receivers[i]) return {};
    const double bend = values[i - 1] - 2 * values[i] + values[i + 1];
    return bend * bend / 6;
}

std::vector<Sums> sums_of(const Scene& scene, const Rendering& rendering, const CameraLayer& layer,
                          const std::vector<std::uint32_t>& receivers) {
    const Film& film = rendering.film;
    std::vector<double> values(film.pixel_count());
    for (std::size_t i = 0; i < values.size(); ++i)
        values[i] = static_cast<double>(film.rgb("caustic", i).mean());
    std::vector<Sums> sums(scene.shapes().size());
    std::vector<double> differing(sums.size());
    std::vector<double> pixels(sums.size());
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (receivers[i] == no_receiver) continue;
        Sums& own = sums[receivers[i]];
        own.picture += values[i];
        own.paths += static_cast<double>(layer.radiance[i].mean());
        own.paths_variance += std::pow(static_cast<double>(layer.standard_error[i].mean()), 2);
        ++pixels[receivers[i]];
        const auto variance = rendering.caustic_error.empty()
                                  ? variance_of_pixel(values, receivers, i)
                                  : std::pow(static_cast<double>(rendering.caustic_error[i]), 2);
        if (!variance) continue;
        own.noise += *variance;
        ++differing[receivers[i]];
    }
    for (std::size_t shape = 0; shape < sums.size(); ++shape)
        if (differing[shape] > 0) sums[shape].noise *= pixels[shape] / differing[shape];
    return sums;
}

// The sums of a picture and of so many light paths.
std::optional<PictureLight> light_beside(std::uint64_t paths, const Scene& scene,
                                         const Rendering& rendering,
                                         const std::vector<std::uint32_t>& receivers,
                                         double photons, int threads) {
    RunOptions options;
    options.threads = threads;
    const auto traced = build(scene, LightTraceParams{.paths = paths}, options);
    const std::optional<CameraLayer> layer = traced->camera_layer(options);
    const std::vector<Sums> sums = sums_of(scene, rendering, *layer, receivers);
    const auto arrived = layer->counters.find("photons_stored");
    const double more_noise = photons > 0 && arrived != layer->counters.end()
                                  ? static_cast<double>(arrived->second) / photons
                                  : 0;
    const auto pixels = static_cast<double>(rendering.film.pixel_count());
    PictureLight light;
    Sums all;
    for (std::size_t shape = 0; shape < sums.size(); ++shape) {
        if (!(sums[shape].paths > 0)) continue;
        light.receivers.push_back(
            sums[shape].light(scene.shapes()[shape].name, pixels, more_noise));
        all.add(sums[shape]);
    }
    if (light.receivers.empty()) return {};
    light.all = all.light("", pixels, more_noise);
    return light;
}

// True where more paths may tell a difference that these leave open.
bool is_in_doubt(const ReceiverLight& all) {
    constexpr double plain = 6;  // errors
    const double excess = std::abs(all.ratio() - 1);
    return excess >= least_excess && excess > all.error && excess < plain * all.error;
}

}  // namespace

std::optional<PictureLight> picture_light(const Scene& scene, const Rendering& rendering,
                                          const Method& method, double photons, int threads,
                                          bool few_paths) {
    if (!method.facts().has_caustic || method.name == "lighttrace") return {};
    const std::vector<std::uint32_t> receivers = receivers_of_pixels(scene, threads);
    auto light = light_beside(paths_of_survey, scene, rendering, receivers, photons, threads);
    if (!light || !is_in_doubt(light->all)) return light;
    light->is_open = true;
    if (few_paths) return light;
    return light_beside(paths_of_doubt, scene, rendering, receivers, photons, threads);
}

nlohmann::json to_json(const PictureLight& light) {
    nlohmann::json receivers = nlohmann::json::object();
    for (const ReceiverLight& one : light.receivers)
        receivers[one.receiver] = {{"picture", one.picture},
                                   {"paths", one.paths},
                                   {"ratio", one.ratio()},
                                   {"error", one.error}};
    return {{"ratio", light.all.ratio()}, {"error", light.all.error}, {"receivers", receivers}};
}

std::optional<std::string> note_on(const PictureLight& light) {
    const double excess = light.all.ratio() - 1;
    if (light.is_open)
        return fmt::format(
            "this picture's caustic has {:.3f} ± {:.3f} of the light that light paths bring to "
            "what "
            "the camera sees; more paths would tell (leave out --seconds or --few-light-paths)",
            light.all.ratio(), light.all.error);
    if (std::abs(excess) < least_excess || std::abs(excess) < least_errors * light.all.error)
        return {};
    std::string where;
    if (light.receivers.size() > 1)
        for (const ReceiverLight& one : light.receivers)
            where += fmt::format("{}{} {:.3f} ± {:.3f}", where.empty() ? ": " : ", ", one.receiver,
                                 one.ratio(), one.error);
    return fmt::format(
        "this picture's caustic has {:.3f} ± {:.3f} of the light that light paths bring to what "
        "the camera sees{}",
        light.all.ratio(), light.all.error, where);
}

}  // namespace caustics::experiments
