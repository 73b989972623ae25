#include "core/base/parallel.h"
#include "core/scene/scene_keys.h"
#include "experiments/plan/plan_file.h"
#include "experiments/plan/sweep_file.h"
#include "experiments/plan/sweep_keys.h"
#include "experiments/plan/sweep_selection.h"
#include "experiments/run/methods.h"
#include "tests/fuzz/json_hooks.h"
#include "tests/fuzz/reading.h"
#include "tests/fuzz/small_scene.h"

namespace {

using namespace caustics;
using namespace caustics::experiments;

/// Valid, but much work: examining a reference begins it.
const std::map<std::string, double> limits = {
    {"mesh_resolution", 8}, {"resolution", 8}, {"receiver_resolution", 8},
    {"light_samples", 8},   {"photons", 1000}, {"emitted", 1000},
    {"paths", 1000},        {"spp", 64},       {"repeats", 20},
    {"max_bounces", 16}};

double count(const SweepFile& sweep) {
    double trials = sweep.repeats;
    for (const SweepFile::Axis& axis : sweep.axes)
        trials *= static_cast<double>(axis.values.size());
    return trials * static_cast<double>(sweep.scenes.size() * sweep.methods.size() *
                                        sweep.indirect.size() * sweep.seeds.size());
}

void read_sweep(std::string_view text) {
    const auto file = fuzz::put("sweep.json", text);
    std::optional<SweepFile> sweep;
    if (!fuzz::taken(fuzz::Naming::file, [&] { sweep = read_sweep_file(file); })) return;
    // A plan reads the scenes and begins the reference.
    if (count(*sweep) > 50 || !fuzz::one_in(4, text)) return;
    fuzz::taken(fuzz::Naming::file, [&] {
        SweepPlan plan = read_plan({file});
        fuzz::require(
            plan.trials.size() + plan.duplicates == static_cast<std::size_t>(count(*sweep)),
            "not as many trials as the product of the lists");
        write_plan(plan_file(plan), fuzz::scratch());
        fuzz::require(read_plan_of(fuzz::scratch()).trials == plan_file(plan).trials,
                      "another plan when written and read");
    });
}

}  // namespace

const std::vector<std::string>& caustics::fuzz::words() {
    static const std::vector<std::string> all = [] {
        std::vector<ObjectText> objects = sweep_keys();
        for (const MethodDescription* method : all_methods())
            objects.push_back({method->facts().name, "", method->parameters()});
        for (const IndirectDescription* method : all_indirect_methods())
            objects.push_back({method->facts().name, "", method->parameters()});
        std::vector<std::string> known = fuzz::words_of(objects);
        for (const char* word :
             {"small.json", "other/small.json", "sweep.json", "../small.json", "/ball/radius",
              "/floor/bsdf/reflectance", "/camera", "/none/x", "/"})
            known.emplace_back(word);
        return known;
    }();
    return all;
}

extern "C" int LLVMFuzzerInitialize(int*, char***) {
    caustics::fuzz::words();  // by the tables of all readers
    fuzz::put("small.json", fuzz::small_scene);
    fuzz::put("other/small.json", fuzz::small_scene);
    return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text = fuzz::view(data, size);
    if (!fuzz::asks_for_much(text, limits)) run_single_threaded([&] { read_sweep(text); });
    return 0;
}
