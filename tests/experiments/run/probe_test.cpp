#include "experiments/run/probe.h"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

#include "core/base/atomic_file.h"
#include "core/method/described_method.h"
#include "tests/experiments/refusal.h"
#include "tests/support/build_scene.h"
#include "tests/support/temporary_folder.h"

namespace caustics::experiments {
namespace {

/// A lamp above a sheet of water, and a floor below it.
SceneDesc probed_pool() {
    SceneDesc desc;
    desc.shapes = {support::horizontal("water", 1, 1, true, support::glass(1.33F)),
                   support::horizontal("floor", 0, 3, true, support::diffuse(0.5F))};
    desc.lights = {support::point_light({0.1, 0.2, 2}, 1)};
    return desc;
}

const std::string position_and_normal = "x,y,z,nx,ny,nz\n";
const std::string on_the_floor = position_and_normal + "0,0,0,0,0,1\n";

class Probes : public testing::Test {
protected:
    ProbeList list(const std::string& csv) const {
        const std::string file = folder_ / "points.csv";
        write_atomic_file(file, csv);
        return read_probe_list(file);
    }
    /// By beams, which answer the same every time.
    ProbeAnswers by_beams(const SceneDesc& desc, const std::string& csv) const {
        return probe(Scene(desc), parse_method("beamtree", parameters_node({"max_bounces=1"})),
                     list(csv), RunOptions{});
    }

    support::TemporaryFolder folder_;
};

TEST_F(Probes, NameTheRowThatIsNoPointOfASurface) {
    const auto refusal = [&](const std::string& columns, const std::string& row) {
        const std::string said =
            refusal_of([&] { list("x,y,z,nx,ny,nz" + columns + "\n0,0,0,0,0,1" + row + "\n"); });
        const std::size_t place = said.find("row 1: ");
        return place == std::string::npos ? said : said.substr(place);
    };
    for (const char* below : {",0,0,-1", ",1,0,0"})
        EXPECT_EQ(refusal(",wx,wy,wz", below),
                  "row 1: the viewer direction lies below the surface its normal names");
    EXPECT_EQ(refusal(",wx,wy,wz", ",0,0,0"), "row 1: the viewer direction is zero");
    EXPECT_EQ(refusal(",wx,wy,wz", ",1,0,0.001"), "taken");
    for (const char* radius : {",0", ",-1", ",1e18"})
        EXPECT_EQ(refusal(",radius", radius),
                  "row 1: the radius must be above 0, and 5e+17 m at most");
    EXPECT_EQ(refusal(",radius", ",1e-3"), "taken");
}

TEST_F(Probes, WantARadiusWhereAMethodGathersOverDiscs) {
    const Scene scene(probed_pool());
    const ProbeList points = list(on_the_floor);
    const auto ask = [&](const std::vector<std::string>& params) {
        return probe(scene, parse_method("lighttrace", parameters_node(params)), points,
                     RunOptions{});
    };
    const auto ask_indirect = [&](const std::vector<std::string>& params) {
        return probe(scene, *parse_indirect("lighttrace", parameters_node(params)), points,
                     RunOptions{});
    };
    const std::string wanted =
        ": row 1: lighttrace gathers over a disc round the point: give a column radius or ";
    EXPECT_TRUE(refusal_of([&] { ask({"paths=10"}); }).ends_with(wanted + "--param radius=metres"));
    EXPECT_TRUE(refusal_of([&] {
                    ask_indirect({"paths=10"});
                }).ends_with(wanted + "--indirect-param radius=metres"));
    EXPECT_GT(ask({"paths=1000", "radius=0.5"}).irradiance.at(0).value.mean(), 0);
    EXPECT_EQ(ask_indirect({"paths=10", "radius=0.5"}).irradiance.size(), 1U);
}

TEST_F(Probes, TellRadianceOnlyWhereThereIsAViewer) {
    const Method method = parse_method("lighttrace", parameters_node({"paths=100", "radius=0.5"}));
    const auto header = [&](const std::string& csv) {
        const ProbeList points = list(csv);
        const std::string table =
            probe_table(points, probe(Scene(probed_pool()), method, points, RunOptions{}));
        const std::size_t first = table.find('\n');
        const auto columns = std::ranges::count(table.substr(0, first), ',');
        EXPECT_EQ(std::ranges::count(table.substr(first), ','), columns) << "of the row";
        return table.substr(0, first);
    };
    EXPECT_EQ(header(on_the_floor),
              "x,y,z,nx,ny,nz,irradiance_r,irradiance_g,irradiance_b,stderr_r,stderr_g,stderr_b");
    EXPECT_EQ(header("x,y,z,nx,ny,nz,wx,wy,wz\n0,0,0,0,0,1,0,0,1\n"),
              "x,y,z,nx,ny,nz,wx,wy,wz,irradiance_r,irradiance_g,irradiance_b,radiance_r,"
              "radiance_g,radiance_b,stderr_r,stderr_g,stderr_b,stderr_radiance_r,"
              "stderr_radiance_g,stderr_radiance_b");
}

TEST_F(Probes, AreTheMeanOfAllPassesAndNoteOnce) {
    SceneDesc desc = probed_pool();
    Phong shiny;
    shiny.exponent = 1000;
    desc.shapes[1].bsdf.model = shiny;
    const Scene scene(desc);
    const ProbeList points = list(on_the_floor);
    const auto ask = [&](const char* passes) {
        return probe(
            scene,
            parse_method("photonmap", parameters_node({"emitted=500", "radius=0.5", passes})),
            points, RunOptions{});
    };
    const ProbeAnswers one = ask("passes=1"), three = ask("passes=3");
    EXPECT_EQ(one.notes.size(), 1U) << "photons blur its lobe";
    EXPECT_EQ(three.notes, one.notes);
    // Each holds some hundred photons; a sum of passes would be three times as much.
    EXPECT_NEAR(three.irradiance.at(0).value[0] / one.irradiance.at(0).value[0], 1, 0.5);
}

TEST_F(Probes, AreOfTheNearestReceiver) {
    // Both lie within the tolerance of 1e-4 diameters; the lower one shows the point its black back.
    SceneDesc desc = probed_pool();
    desc.shapes.push_back(support::horizontal("ceiling", -7e-4, 3, false, support::diffuse(0.5F)));
    const auto at = [&](const std::string& z) {
        return by_beams(desc, position_and_normal + "0,0," + z + ",0,0,1\n")
            .irradiance.at(0)
            .value.mean();
    };
    EXPECT_GT(at("0"), 0);
    EXPECT_GT(at("-1e-4"), 0);
    EXPECT_EQ(at("-6e-4"), 0);
}

TEST_F(Probes, FindTheReceiverThroughAFewCasters) {
    const auto under_films = [&](int films) {
        SceneDesc desc = probed_pool();
        for (int i = 1; i <= films; ++i)
            for (const double side : {1.0, -1.0})
                desc.shapes.push_back(support::horizontal("film", 1.5e-5 * i * side, 0.5, true,
                                                          support::glass(1.33F)));
        return refusal_of([&] { by_beams(desc, position_and_normal + "0,0,5e-4,0,0,1\n"); });
    };
    EXPECT_EQ(under_films(3), "taken");
    EXPECT_NE(under_films(20).find("row 1: the point (0, 0, 0.0005) is farther than 1e-4 of the "
                                   "scene's diameter"),
              std::string::npos);
}

/// Answers what no method should.
template <bool in_error>
struct BrokenParams {};

class BrokenEstimator final : public CausticEstimator {
public:
    explicit BrokenEstimator(const Estimate& answer) : answer_(answer) {}

    void radiance(std::span<const ReceiverPoint>, std::span<Estimate> out,
                  QueryContext&) const override {
        std::ranges::fill(out, answer_);
    }
    void irradiance(std::span<const ReceiverPoint>, std::span<Estimate> out,
                    QueryContext&) const override {
        std::ranges::fill(out, answer_);
    }

private:
    Estimate answer_;
};

template <bool in_error>
std::string answer_of_broken(const Scene& scene, const ProbeList& points) {
    using Params = BrokenParams<in_error>;
    const DescribedMethod<Params> description(
        {.facts = {.name = "broken", .summary = "", .serves = ""},
         .make = [](const Scene&, const Params&, const RunOptions&,
                    int) -> std::unique_ptr<const CausticEstimator> {
             Estimate answer;
             (in_error ? answer.standard_error : answer.value)[1] =
                 std::numeric_limits<float>::quiet_NaN();
             return std::make_unique<BrokenEstimator>(answer);
         }});
    try {
        probe(scene, Method{"broken", &description, description.configure(parameters_node({}))},
              points, RunOptions{});
    } catch (const std::runtime_error& error) {
        return error.what();
    }
    return "printed";
}

TEST_F(Probes, PrintNoAnswerThatIsNotFinite) {
    const Scene scene(probed_pool());
    const ProbeList points = list(on_the_floor);
    const std::string refused = points.file.string() + ": row 1: the method's answer is not finite";
    EXPECT_EQ(answer_of_broken<false>(scene, points), refused);
    EXPECT_EQ(answer_of_broken<true>(scene, points), refused);
}

}  // namespace
}  // namespace caustics::experiments
