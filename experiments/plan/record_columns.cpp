#include "experiments/plan/record_columns.h"

namespace caustics::experiments {

namespace {

using Kind = RecordColumn::Kind;

constexpr RecordColumn columns[] = {
    {"trial", "/trial", Kind::text, "", "name of its folder: readable words, then `config_hash`"},
    {"status", "/status", Kind::text, "",
     "`done`; `failed` (`message` says why, `log.txt` when); `timeout` (gave no result within "
     "`timeout_s`); `unsupported` (the method cannot serve the scene); `interrupted` (at work when "
     "the sweep was stopped: not kept, runs again)"},
    {"scene", "/scene/name", Kind::text, "", "name of the scene file"},
    {"method", "/method/name", Kind::text, "", "name of the method"},
    {"seed", "/seed", Kind::count, "", "of all random numbers"},
    {"repeat", "/repeat", Kind::count, "", "from 1; repeats have the same picture and other times"},
    {"threads", "/threads", Kind::count, "", "that the trial could use"},
    {"isa", "/isa", Kind::text, "", "instruction set of the hot loops: plain, avx2, avx512"},
    {"photons_emitted", "/counters/photons_emitted", Kind::number, "", "light paths started"},
    {"photons_stored", "/counters/photons_stored", Kind::number, "", "photons in the map"},
    {"nearest", "/method/parameters/nearest", Kind::any, "", "parameter: photons of an estimate"},
    {"alpha", "/swept/alpha", Kind::any, "", "swept: the receiver's roughness"},
    {"mesh_resolution", "/swept/mesh_resolution", Kind::any, "",
     "swept: resolution of the scene's mesh"},
    {"polygons", "/scene/polygons", Kind::number, "", "triangles of the casters"},
    {"beams", "/counters/beams", Kind::number, "", "beams traced"},
    {"cone_point_tests", "/counters/cone_point_tests", Kind::number, "",
     "cones tested against points"},
    {"beam_point_tests", "/counters/beam_point_tests", Kind::number, "",
     "beams tested against points"},
    {"beam_point_hits", "/counters/beam_point_hits", Kind::number, "",
     "of these, beams that hold the point"},
    {"map_bytes", "/memory/map_bytes", Kind::number, "bytes", "of what the method built"},
    {"rss_start_bytes", "/memory/rss_start_bytes", Kind::number, "bytes",
     "of the trial's process in memory before it began"},
    {"peak_rss_bytes", "/memory/peak_rss_bytes", Kind::number, "bytes",
     "most in memory until the picture was there"},
    {"parse_s", "/seconds/parse/wall", Kind::number, "s, wall", "reading the scene"},
    {"precompute_s", "/seconds/precompute/wall", Kind::number, "s, wall",
     "the method's precompute pass without `balance_s`"},
    {"balance_s", "/seconds/balance/wall", Kind::number, "s, wall", "building the photon tree"},
    {"render_s", "/seconds/render/wall", Kind::number, "s, wall", "the eye pass"},
    {"total_s", "/seconds/total/wall", Kind::number, "s, wall", "sum of the four"},
    {"cpu_s", "/seconds/total/cpu", Kind::number, "s, CPU", "the same summed over the threads"},
    {"rmse", "/metrics/rmse", Kind::number, "W m⁻² sr⁻¹",
     "sqrt(mean (x − r)²) of the caustic layer x against the reference r, over all reached pixels "
     "and channels"},
    {"relmse", "/metrics/relmse", Kind::number, "1", "mean (x − r)² / (r² + 0.01 mean(r)²)"},
    {"bias", "/metrics/bias", Kind::number, "1", "mean(x − r) / mean(r)"},
    {"variance", "/variance", Kind::number, "(W m⁻² sr⁻¹)²",
     "sample variance of the caustic over the seeds of the row's cell (divided by seeds − 1), mean "
     "over the channels of the pixels that `rmse` counts too: those that neither a picture of the "
     "cell nor its reference marks `unreached`; with at least two seeds, and while their pictures "
     "and the reference are at hand"},
    {"mean_ratio", "/metrics/mean_ratio", Kind::number, "1", "mean(x) / mean(r)"},
    {"leak_energy", "/metrics/leak_energy", Kind::number, "1",
     "mean of x where r is exactly 0, over mean(r)"},
    {"beauty_rmse", "/beauty_rmse", Kind::number, "W m⁻² sr⁻¹", "`rmse` of the whole picture"},
    {"unreached_fraction", "/unreached_fraction", Kind::number, "1",
     "share of the pixels that no metric counts, because the reference or the method cannot reach "
     "them"},
    {"reference", "/reference/name", Kind::text, "", "method and key of the reference"},
    {"reference_stderr", "/reference/stderr", Kind::number, "1",
     "standard error of a pixel of the reference over its mean"},
    {"config_hash", "/config_hash", Kind::text, "",
     "of everything the picture and its errors depend on, but the code"},
    {"code_version", "/code_version", Kind::text, "",
     "version, commit, and `-dirty` where the tree had changes"},
    {"mask_rmse", "/mask_metrics/rmse", Kind::number, "W m⁻² sr⁻¹",
     "`rmse` where the reference is at least its mean"},
    {"mask_relmse", "/mask_metrics/relmse", Kind::number, "1", "`relmse` there"},
    {"mask_mean_ratio", "/mask_metrics/mean_ratio", Kind::number, "1", "`mean_ratio` there"},
    {"mask_fraction", "/mask_fraction", Kind::number, "1", "share of the pixels there"},
    {"flip", "/flip", Kind::number, "1",
     "mean HDR-FLIP over all reached pixels between the reference's beauty and the same with the "
     "trial's caustic in place of its own; empty until `tools/flip_column.py DIR` has filled it, "
     "by flip-evaluator"},
    {"parse_cpu_s", "/seconds/parse/cpu", Kind::number, "s, CPU", "as `parse_s`"},
    {"precompute_cpu_s", "/seconds/precompute/cpu", Kind::number, "s, CPU", "as `precompute_s`"},
    {"balance_cpu_s", "/seconds/balance/cpu", Kind::number, "s, CPU", "as `balance_s`"},
    {"render_cpu_s", "/seconds/render/cpu", Kind::number, "s, CPU", "as `render_s`"},
    {"reference_mean", "/reference/mean", Kind::number, "W m⁻² sr⁻¹",
     "mean of the reference's caustic"},
    {"spp", "/spp", Kind::count, "",
     "camera samples a pixel (the first ones, where sampling is adaptive)"},
    {"trees", "/counters/trees", Kind::number, "", "cone trees"},
    {"trees_binned", "/method/resolved/trees_binned", Kind::number, "",
     "of these, built by binning"},
    {"nodes", "/counters/nodes", Kind::number, "", "of all cone trees"},
    {"tree_height", "/counters/height", Kind::number, "", "of the highest tree of beams"},
    {"casters_with_face_normals", "/method/resolved/casters_with_face_normals", Kind::number, "",
     "casters whose mesh has no smooth normals"},
    {"flux_share_captured", "/method/resolved/flux_share_captured", Kind::number, "1",
     "share of the light on casters that beams carry to its last specular event; the rest is "
     "missing"},
    {"camera_rays", "/counters/camera_rays", Kind::number, "", "traced from the camera"},
    {"gathers", "/counters/gathers", Kind::number, "", "radiance estimates"},
    {"gathered_photons", "/counters/gathered_photons", Kind::number, "", "photons found by them"},
    {"used_photons", "/counters/used_photons", Kind::number, "", "photons that adaptive N took"},
    {"photons_aimed", "/counters/photons_aimed", Kind::number, "",
     "light paths that met the casters' bounds"},
    {"photons_reflected", "/counters/photons_reflected", Kind::number, "", "specular reflections"},
    {"photons_refracted", "/counters/photons_refracted", Kind::number, "", "refractions"},
    {"photons_connected", "/counters/photons_connected", Kind::number, "",
     "light paths connected to the camera"},
    {"empty_gathers", "/counters/empty_gathers", Kind::number, "", "estimates without a photon"},
    {"receiver_points", "/counters/receiver_points", Kind::number, "",
     "points that the camera saw on receivers"},
    {"lit_points", "/counters/lit_points", Kind::number, "", "of these, not black"},
    {"picture_hash", "/picture_hash", Kind::text, "", "of all values of all layers of image.exr"},
    {"elapsed_s", "/elapsed_s", Kind::number, "s, wall",
     "of the trial's whole process: also loading the reference, measuring errors, writing files; "
     "until the end of one that failed or timed out"},
    {"finished", "/finished", Kind::text, "UTC", "when"},
    {"host", "/machine/host", Kind::text, "", "name of the machine"},
    {"cpu", "/machine/cpu", Kind::text, "", "model of its processor"},
    {"load_average", "/load/average", Kind::number, "processes",
     "the machine's, over the minute before the trial began"},
    {"other_cores", "/load/other_cores", Kind::number, "processors",
     "kept busy by other processes than the trial's, on average over its `total_s`; for trials of "
     "0.2 s and more"},
    {"jobs", "/limits/jobs", Kind::number, "", "trials at a time that were allowed"},
    {"timeout_s", "/limits/timeout_s", Kind::number, "s", "that the trial was allowed"},
    {"memory_limit_bytes", "/limits/memory_bytes", Kind::number, "bytes",
     "that the trial was allowed to have in memory at a time"},
    {"why_empty", "/why_empty", Kind::text, "", "why the caustic is black all over"},
    {"message", "/message", Kind::text, "", "why the trial failed"},
};

}  // namespace

std::span<const RecordColumn> record_columns_of_all() { return columns; }

}  // namespace caustics::experiments
