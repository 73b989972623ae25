#include "experiments/plan/reference_cache.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "core/base/disk.h"
#include "core/base/error.h"
#include "core/base/hash.h"
#include "core/scene/eye_medium.h"
#include "experiments/base/csv.h"
#include "experiments/picture/metrics.h"
#include "experiments/plan/reference_extension.h"

namespace caustics::experiments {

namespace {

Film readable_picture(const std::filesystem::path& file) {
    try {
        return read_exr(file);
    } catch (const InputError& error) {
        throw InputError(fmt::format("{} (remake it with --references rebuild)", error.what()));
    }
}

/// Keeps a layer's standard error, its root mean square over the channels.
void keep_error(const Film& rendered, const std::string& errors, Film& film) {
    if (!rendered.has_layer(errors)) return;
    std::vector<float>& grey = film.plane(errors + ".Y");
    for (std::size_t i = 0; i < film.pixel_count(); ++i) {
        const SpectrumSum s = rendered.rgb(errors, i).cast<double>();
        grey[i] = static_cast<float>(std::sqrt(s.square().sum() / 3));
    }
}

/// What is kept of a rendered picture.
Film reference_film(const Film& rendered) {
    Film film(rendered.width(), rendered.height());
    for (std::size_t i = 0; i < film.pixel_count(); ++i) {
        film.set_rgb("", i, rendered.rgb("", i));
        film.set_rgb("caustic", i, rendered.rgb("caustic", i));
        if (rendered.has_layer("indirect"))
            film.set_rgb("indirect", i, rendered.rgb("indirect", i));
    }
    if (const std::vector<float>* const unreached = rendered.find("unreached.Y"))
        film.plane("unreached.Y") = *unreached;
    for (const char* const layer : {"caustic", "indirect"})
        keep_error(rendered, error_layer(layer), film);
    return film;
}

Reference::Light light_of(const Film& film, const std::string& layer, const PixelMask& reached) {
    return {mean(film, layer, reached), relative_standard_error(film, layer, reached)};
}

/// Pictures of version 1 keep no standard error of their indirect layer; of version 2, `pathtrace` left out the water before
/// the eye's receivers, and weighed direct light about smooth normals; of version 3, it drew other numbers.
constexpr int indirect_version = 4;

bool has_classic_phong(const Scene& scene) {
    return std::ranges::any_of(scene.shapes(), [](const Shape& shape) {
        const auto* phong = std::get_if<Phong>(&shape.bsdf.model);
        return phong != nullptr && phong->model == Phong::Model::classic;
    });
}

}  // namespace

int reference_version(const Scene& scene) {
    if (has_classic_phong(scene)) return 4;
    if (absorbs_at_mirrors_or_lamps(scene)) return 3;
    return is_black(eye_medium(scene).absorption) ? 1 : 2;
}

std::string reference_key(const RunRequest& request, const SceneFile& scene, int version) {
    nlohmann::json configuration = {
        {"reference_version", version},     {"scene", scene.hash},
        {"method", request.method.name},    {"parameters", identity(request.method)},
        {"spp", request.samples_per_pixel}, {"seed", request.seed},
        {"width", scene.desc.camera.width}, {"height", scene.desc.camera.height}};
    if (request.indirect) {
        configuration["indirect_version"] = indirect_version;
        configuration["indirect"] = request.indirect->name;
        configuration["indirect_parameters"] = identity(*request.indirect);
    }
    return hex(fnv1a(configuration.dump()));
}

std::filesystem::path ReferenceCache::file_of(const ReferenceRequest& request) const {
    const std::string name = request.key + ".exr";
    const std::filesystem::path kept = request.kept_folder / name;
    const bool keeps =
        std::filesystem::exists(kept) ||
        (policy_ == ReferencePolicy::rebuild && std::filesystem::is_directory(request.kept_folder));
    return keeps ? kept : own_folder_ / name;
}

bool ReferenceCache::must_render(const ReferenceRequest& request) const {
    if (policy_ == ReferencePolicy::rebuild && !rendered_.contains(request.key)) return true;
    return !std::filesystem::exists(file_of(request));
}

void ReferenceCache::render(const ReferenceRequest& request, const RunOptions& options) const {
    SceneFile file = load_scene(request.request.scene_file, request.request.overrides);
    const Scene scene(take_shapes(file));
    const int version = reference_version(scene);
    if (reference_key(request.request, file, version) != request.key)
        throw InputError(
            fmt::format("{}: changed while the sweep runs", request.request.scene_file.string()));
    std::optional<SmallerReference> begun;
    if (policy_ == ReferencePolicy::extend && !request.request.indirect)
        begun = find_smaller({request.kept_folder, own_folder_}, request.request, file, version);
    Stopwatch stopwatch;
    const RunResult result = run(
        scene, begun ? remainder(request.request, *begun) : request.request, options, stopwatch);
    require_finite(result.film, "the reference");
    Film film = reference_film(result.film);
    if (begun) film = joined(request.request, *begun, film);
    film.metadata = picture_metadata(request.request, file, result);
    // The command names the scene as it was reached from here, and the version that of today; the
    // file depends on neither.
    film.metadata.erase("command");
    film.metadata["reference_key"] = request.key;
    if (version > 1) film.metadata["reference_version"] = fmt::format("{}", version);
    if (begun) film.metadata["extends"] = begun->file.filename().string();
    if (result.why_empty) film.metadata["why_empty"] = *result.why_empty;
    const std::filesystem::path target = file_of(request);
    make_folders(target.parent_path());
    write_exr(film, target);
    // The one that is kept stands for the sweep's own from now on.
    if (target.parent_path() != own_folder_) {
        std::error_code none;
        std::filesystem::remove(own_folder_ / target.filename(), none);
    }
}

std::shared_ptr<const Reference> ReferenceCache::get(const ReferenceRequest& request) {
    if (last_ && last_->key == request.key) return last_;
    const std::filesystem::path file = file_of(request);
    auto reference =
        std::make_shared<Reference>(Reference{request.key, readable_picture(file), {}, {}});
    const auto key = reference->film.metadata.find("reference_key");
    if (key != reference->film.metadata.end() && key->second != request.key)
        throw InputError(
            fmt::format("{}: is the reference {}, renamed (remake it with --references rebuild)",
                        file.string(), key->second));
    for (const char* layer : {"", "caustic"})
        if (!reference->film.has_layer(layer))
            throw InputError(
                fmt::format("{}: not a reference: no layer \"{}\" (remake it with "
                            "--references rebuild)",
                            file.string(), layer));
    const PixelMask reached = reached_pixels(reference->film, reference->film);
    reference->caustic = light_of(reference->film, "caustic", reached);
    if (reference->film.has_layer("indirect"))
        reference->indirect = light_of(reference->film, "indirect", reached);
    last_ = reference;
    return reference;
}

}  // namespace caustics::experiments
