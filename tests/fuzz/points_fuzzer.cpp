#include "core/base/parallel.h"
#include "core/scene/scene_reader.h"
#include "experiments/run/probe.h"
#include "tests/fuzz/reading.h"
#include "tests/fuzz/small_scene.h"
#include "tests/fuzz/word_hooks.h"

namespace {

using namespace caustics;
using namespace caustics::experiments;

const Scene& small_scene() {
    static const Scene scene(load_scene(fuzz::put("small.json", fuzz::small_scene)).desc);
    return scene;
}

void ask(const ProbeList& list) {
    static const Method methods[] = {
        parse_method("none", parameters_node({})),
        parse_method("photonmap", parameters_node({"emitted=200", "nearest=5"}))};
    for (const Method& method : methods) {
        const ProbeAnswers answers = probe(small_scene(), method, list, {});
        fuzz::require(answers.irradiance.size() == list.points.size(), "not one answer a point");
        probe_table(list, answers);
    }
}

}  // namespace

const std::vector<std::string>& caustics::fuzz::words() {
    static const std::vector<std::string> all = {"x",      "y",    "z",    "nx",          "ny",
                                                 "nz",     "wx",   "wy",   "wz",          "-1",
                                                 "radius", "\r\n", "0.25", "\xEF\xBB\xBF"};
    return all;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text = fuzz::view(data, size);
    const auto file = fuzz::put("points.csv", text);
    std::optional<ProbeList> list;
    if (!fuzz::taken(fuzz::Naming::file, [&] { list = read_probe_list(file); })) return 0;
    fuzz::require(list->points.size() == list->table.rows.size(), "not one point a row");
    for (const ProbePoint& point : list->points)
        fuzz::require(point.position.allFinite() && point.normal.allFinite() &&
                          std::abs(point.normal.norm() - 1) < 1e-3F && point.wo.allFinite(),
                      "a point without a place or direction");
    // Photons take as long as reading a hundred files.
    if (!fuzz::one_in(64, text)) return 0;
    run_single_threaded([&] { fuzz::taken(fuzz::Naming::file, [&] { ask(*list); }); });
    return 0;
}
