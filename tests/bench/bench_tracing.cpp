// Photon tracing against the same rays through nothing but Embree: a million photons from random
// and from stratified emission, on a pool and a ball of two mesh resolutions. Counters are
// nanoseconds per stored photon.
//
// tracing/SCENE/EMISSION            trace, replay: one thread, CPU time
// tracing_threads/SCENE/EMISSION    trace_1, trace_2, replay_1, replay_2: by the wall's clock

#include <benchmark/benchmark.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "photonmap/photons/scene_photons.h"
#include "tests/bench/bench.h"
#include "tests/bench/contest.h"
#include "tests/bench/raw_replay.h"
#include "tests/bench/tracing_scenes.h"

namespace caustics::bench {

namespace {

using Emission = photonmap::PhotonMapParams::Emission;

struct Case {
    std::string scene;
    SceneDesc (*make)(int resolution);
    int resolution;
};

/// A scene and the rays of its photons.
struct Work {
    Scene scene;
    photonmap::PhotonMapParams params;
    std::vector<Ray> rays;
    std::unique_ptr<RawReplay> replay;

    Work(SceneDesc desc, const photonmap::PhotonMapParams& p) : scene(std::move(desc)), params(p) {
        photonmap::trace_scene(scene, params, {}, photonmap::AskYield::yes, &rays);
        replay = std::make_unique<RawReplay>(scene, rays);
    }
    void trace(int threads) const {
        RunOptions options;
        options.threads = threads;
        benchmark::DoNotOptimize(photonmap::trace_scene(scene, params, options).counts.stored);
    }
};

Contest make_contest(const Case& c, Emission emission, const BenchOptions& options, bool threads) {
    photonmap::PhotonMapParams params;
    params.photons = options.quick ? 50'000 : 1'000'000;
    params.emission = emission;
    const auto work = std::make_shared<Work>(c.make(c.resolution), params);
    Contest contest(static_cast<double>(params.photons));
    if (threads) contest.use_wall_clock();
    for (const int n : threads ? std::vector<int>{1, 2} : std::vector<int>{1}) {
        const std::string suffix = threads ? "_" + std::to_string(n) : "";
        contest.add("trace" + suffix, [work, n] { work->trace(n); });
        contest.add("replay" + suffix, [work, n] { work->replay->run(n); });
    }
    contest.note("rays_per_photon",
                 static_cast<double>(work->rays.size()) / static_cast<double>(params.photons));
    return contest;
}

}  // namespace

void register_benchmarks(const BenchOptions& options) {
    std::vector<Case> cases = {{"pool33k", pool_scene, 128}, {"ball65k", ball_scene, 128}};
    if (!options.quick) {
        cases.push_back({"pool524k", pool_scene, 512});
        cases.push_back({"ball261k", ball_scene, 256});
    }
    for (const Case& c : cases)
        for (const auto emission : {Emission::random, Emission::stratified}) {
            const std::string name =
                c.scene + (emission == Emission::random ? "/random" : "/stratified");
            for (const bool threads : {false, true})
                register_contest((threads ? "tracing_threads/" : "tracing/") + name,
                                 options.quick ? 1 : 2,
                                 [=] { return make_contest(c, emission, options, threads); });
        }
}

}  // namespace caustics::bench
