#include <gtest/gtest.h>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <map>
#include <optional>

#include "core/base/error.h"
#include "core/base/isa.h"
#include "core/render/renderer.h"
#include "core/scene/scene_reader.h"
#include "experiments/run/method.h"
#include "tests/cruel/cruel_scene.h"
#include "tests/cruel/scene_range.h"
#include "tests/support/temporary_folder.h"

namespace caustics::cruel {
namespace {

/// A method with parameters; all of one family give the same bits.
struct Setting {
    std::string family;
    std::string method;
    std::vector<std::string> parameters;
};

/// Some of photons, of beams and of the eye's samples, so that threads, packets of rays and SIMD registers have tails
/// of every length.
std::vector<Setting> settings(Dice& dice) {
    std::vector<Setting> all;
    const std::string emitted = fmt::format("emitted={}", dice.pick({70, 500, 2000, 4500}));
    const std::string nearest = fmt::format("nearest={}", dice.pick({5, 16, 20, 33, 70}));
    for (const char* const tree : {"balanced", "unbalanced", "packed"}) {
        all.push_back({"photons",
                       "photonmap",
                       {emitted, nearest, "kernel=point", fmt::format("tree={}", tree)}});
        all.push_back({"stratified photons",
                       "photonmap",
                       {emitted, "emission=stratified", "interaction=split", "nearest=9",
                        "filter=cone", "kernel=point", fmt::format("tree={}", tree)}});
        all.push_back({"adaptive photons",
                       "photonmap",
                       {emitted, "adaptive=true", "nearest=60", fmt::format("tree={}", tree)}});
    }
    all.push_back({"photons' own discs", "photonmap", {emitted, nearest}});
    all.push_back({"photons' own cones at points",
                   "photonmap",
                   {emitted, "filter=cone", "pixel_footprint=false", "nearest=9"}});
    all.push_back({"photons' own discs over squares", "photonmap", {emitted, "footprint=0.05"}});
    const std::vector<std::string> few = {
        fmt::format("mesh_resolution={}", dice.whole(2, 5)),
        fmt::format("light_samples={}", dice.pick({1, 1, 2})),
        fmt::format("max_bounces={}", dice.chance(0.01) ? 2 : 1),
        fmt::format("wavelengths={}", dice.whole(1, 2)),
        fmt::format("max_beams={}", dice.chance(0.15) ? 1000 : 100'000)};
    const std::string prune = fmt::format("prune={}", dice.pick({0.5, 0.2, 0.05}));
    const auto beams = [&](const char* family, std::vector<std::string> more) {
        more.insert(more.end(), few.begin(), few.end());
        more.push_back(prune);
        all.push_back({family, "beamtree", std::move(more)});
    };
    for (const char* const bound : {"single", "double", "hybrid", "sphere_swept"}) {
        beams("beams across receivers", {fmt::format("bound={}", bound)});
        beams("beams on fixed planes", {fmt::format("bound={}", bound), "leaf=fixed"});
        beams("refined beams", {fmt::format("bound={}", bound), "leaf=fixed", "intensity=refined"});
    }
    beams("beams across receivers", {"merging=cones", "bound=single"});
    beams("beams across receivers", {"hierarchy=binned", "spread_threshold=1"});
    beams("slices", {"bound=two_slice"});
    beams("refined slices", {"bound=two_slice", "intensity=refined"});
    all.push_back({"polygons",
                   "causticpolygons",
                   {few[0], few[1], few[2], few[3], few[4], prune, "receiver_resolution=4"}});
    all.push_back({"texels", "illuminationmap", {emitted, "resolution=8"}});
    all.push_back({"paths", "lighttrace", {fmt::format("paths={}", dice.pick({70, 2000, 4500}))}});
    all.push_back({"eye paths", "pathtrace", {"spp=1"}});
    all.push_back({"none", "none", {}});
    return all;
}

/// A picture, or why there is none.
struct Outcome {
    std::optional<Film> film;
    std::string refusal;
};

Outcome picture(const Scene& scene, const Setting& setting, int threads, Isa isa) {
    RunOptions options;
    options.threads = threads;
    options.isa = isa;
    options.samples_per_pixel = scene.sampling().sample_count;
    try {
        const auto method = experiments::parse_method(
            setting.method, experiments::parameters_node(setting.parameters));
        const auto built = method.configured->build(scene, options, 0);
        return {render(scene, *built, options).film, ""};
    } catch (const UnsupportedScene& error) {
        return {{}, error.what()};
    }
}

/// How far two planes are apart, of the largest value: 0 where every bit is the same.
double gap(const std::vector<float>& a, const std::vector<float>& b) {
    if (std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0) return 0;
    float largest = 0, widest = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        largest = std::max(largest, std::abs(a[i]));
        if (std::memcmp(&a[i], &b[i], sizeof(float)) != 0)
            widest = std::max(widest, std::abs(a[i] - b[i]));
    }
    // Other bits of the same value are a gap as well.
    return static_cast<double>(widest) / static_cast<double>(largest) + 1e-30;
}

/// The same of two pictures; of refusals whether they say the same.
double gap(const Outcome& a, const Outcome& b) {
    if (!a.film || !b.film) return a.refusal == b.refusal ? 0 : HUGE_VAL;
    const auto &first = a.film->planes(), &second = b.film->planes();
    if (first.size() != second.size()) return HUGE_VAL;
    double widest = 0;
    for (std::size_t i = 0; i < first.size(); ++i)
        widest = std::max(widest, gap(first[i].values, second[i].values));
    return widest;
}

bool is_finite(const Outcome& outcome) {
    if (!outcome.film) return true;
    for (const Plane& plane : outcome.film->planes())
        for (const float value : plane.values)
            if (!std::isfinite(value) && plane.channel != "depth.Z") return false;
    return true;
}

/// Holds the variants of one scene against each other; every difference is a failure that names them.
class BitsCheck {
public:
    BitsCheck(const Scene& scene, std::uint64_t seed) : scene_(scene), seed_(seed), dice_(seed) {}

    /// All settings, but of the slow ones with beams one in three, the first of a family always.
    void check_all() {
        int turn = dice_.whole(0, 2);
        for (const Setting& setting : settings(dice_)) {
            const bool has_beams = setting.method == "beamtree";
            if (has_beams && families_.contains(setting.family) && ++turn % 3 != 0) continue;
            check(setting);
        }
    }
    /// Pictures that were held against another; refusals are not counted.
    std::uint64_t compared() const { return compared_; }

private:
    void check(const Setting& setting) {
        name_ = fmt::format("seed {}: {} {}", seed_, setting.method,
                            fmt::join(setting.parameters, " "));
        const Outcome here = picture(scene_, setting, 1, Isa::plain);
        EXPECT_TRUE(is_finite(here)) << name_;
        const auto [known, is_new] = families_.try_emplace(setting.family, here);
        if (!is_new) expect_same(known->second, here, "as the first of " + setting.family);
        for (const Isa isa : supported_isas()) {
            const auto expect_same_by = [&](int threads) {
                expect_same(here, picture(scene_, setting, threads, isa),
                            fmt::format("{} by {} threads", caustics::name(isa), threads));
            };
            if (isa != Isa::plain) expect_same_by(1);
            expect_same_by(dice_.pick({2, 3, 8}));
        }
    }

    void expect_same(const Outcome& a, const Outcome& b, const std::string& what) {
        if (a.film) ++compared_;
        EXPECT_EQ(gap(a, b), 0) << name_ << ", " << what << ": " << a.refusal << " | " << b.refusal;
    }

    const Scene& scene_;
    std::uint64_t seed_;
    Dice dice_;
    std::string name_;
    std::map<std::string, Outcome> families_;
    std::uint64_t compared_ = 0;
};

void check_bits(const SceneRange& range, std::uint64_t seed) {
    const support::TemporaryFolder folder("cruel_bits" + std::to_string(seed));
    std::ofstream(folder / "scene.json") << cruel_scene(Purpose::bits, seed, folder.path()).dump(1);
    const Scene scene(load_scene(folder / "scene.json").desc);
    BitsCheck check(scene, seed);
    check.check_all();
    range.note("{}\t{}", seed, check.compared());
    // The photon map and its trees serve every scene.
    EXPECT_GE(check.compared(), 9 * 5);
}

TEST(CruelBits, AreTheSameByEveryVariant) {
    const SceneRange range = SceneRange::asked(3);
    for (std::uint64_t seed = range.first; seed < range.first + range.count; ++seed) {
        SCOPED_TRACE(seed);
        EXPECT_NO_THROW(check_bits(range, seed));
    }
}

}  // namespace
}  // namespace caustics::cruel
