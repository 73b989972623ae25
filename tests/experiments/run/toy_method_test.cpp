#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "core/base/error.h"
#include "core/method/described_method.h"
#include "core/method/none.h"
#include "experiments/base/file_io.h"
#include "experiments/cli/help_text.h"
#include "experiments/cli/verbs.h"
#include "experiments/plan/sweep_plan.h"
#include "experiments/run/method.h"
#include "experiments/run/methods.h"
#include "tests/support/temporary_folder.h"

// A method that is added goes everywhere by its description alone. This program's list of methods
// stands in place of experiments/run/methods.cpp.

namespace caustics::experiments {

namespace {

/// The same irradiance everywhere.
struct ToyParams {
    double irradiance = 2;
};

class ToyEstimator final : public CausticEstimator {
public:
    explicit ToyEstimator(const ToyParams& params)
        : irradiance_(Spectrum::Constant(static_cast<float>(params.irradiance))) {}

    void radiance(std::span<const ReceiverPoint> points, std::span<Estimate> out,
                  QueryContext&) const override {
        for (std::size_t i = 0; i < points.size(); ++i) out[i] = {irradiance_ / pi, black()};
    }
    void irradiance(std::span<const ReceiverPoint>, std::span<Estimate> out,
                    QueryContext&) const override {
        std::ranges::fill(out, Estimate{irradiance_, black()});
    }

private:
    Spectrum irradiance_;
};

std::unique_ptr<const CausticEstimator> build(const Scene&, const ToyParams& params,
                                              const RunOptions&) {
    return std::make_unique<ToyEstimator>(params);
}

DescribedMethod<ToyParams> described(const std::string& name, bool is_unbiased) {
    return DescribedMethod<ToyParams>(
        {.facts = {.name = name,
                   .summary = "the same everywhere",
                   .serves = "every scene",
                   .is_unbiased = is_unbiased},
         .parameters = {parameter::number<ToyParams>(
             &ToyParams::irradiance, 0, 100,
             {.key = "irradiance", .meaning = "Of every point of a receiver.", .unit = "W/m^2"})}});
}

}  // namespace

const std::vector<const MethodDescription*>& all_methods() {
    static const DescribedMethod<ToyParams> toy = described("toy", false);
    static const DescribedMethod<ToyParams> truth = described("truth", true);
    static const std::vector<const MethodDescription*> methods = {&none_method(), &truth, &toy};
    return methods;
}

const std::vector<const IndirectDescription*>& all_indirect_methods() {
    static const std::vector<const IndirectDescription*> none;
    return none;
}

namespace {

const std::string scene = CAUSTICS_SOURCE_DIR "/tests/experiments/scenes/ball.json";

struct Printed {
    int exit_code = 0;
    std::string text;
};

/// What the program prints on standard output.
Printed run_program(std::vector<std::string> words) {
    CLI::App app("test", "causticbench");
    const std::vector<Verb> verbs = add_verbs(app);
    std::ranges::reverse(words);
    app.parse(words);
    testing::internal::CaptureStdout();
    Printed printed;
    for (const Verb& verb : verbs)
        if (verb.app->parsed()) printed.exit_code = verb.run();
    printed.text = testing::internal::GetCapturedStdout();
    return printed;
}

bool holds(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

TEST(ToyMethod, IsRenderedAndProbed) {
    const support::TemporaryFolder folder;
    const std::string picture = folder / "toy.exr";
    EXPECT_EQ(run_program({"render", scene, "--method", "toy", "-o", picture}).exit_code, 0);
    EXPECT_TRUE(std::filesystem::exists(picture));
    const std::string points = folder / "points.csv";
    std::ofstream(points) << "x,y,z,nx,ny,nz\n1,1,0,0,0,1\n";
    const Printed probed = run_program(
        {"probe", scene, "--method", "toy", "--param", "irradiance=7", "--points", points});
    EXPECT_TRUE(holds(probed.text, "1,1,0,0,0,1,7,7,7")) << probed.text;
}

TEST(ToyMethod, IsPlannedInSweeps) {
    const support::TemporaryFolder folder;
    const std::filesystem::path file = folder / "sweep.json";
    std::ofstream(file)
        << R"({"version": 1, "spp": 4, "scenes": [")" << scene
        << R"("], "methods": [{"method": "toy", "param": {"irradiance": [1, 3]}}]})";
    const SweepPlan plan = read_plan({file});
    ASSERT_EQ(plan.trials.size(), 2U);
    EXPECT_EQ(plan.trials[1].id.find("ball-toy-irradiance3-s1-"), 0U) << plan.trials[1].id;
}

TEST(ToyMethod, IsVerifiedOnAScene) {
    const Printed verified = run_program({"verify", scene, "--method", "toy", "--threads", "2"});
    EXPECT_EQ(verified.exit_code, 0) << verified.text;
    EXPECT_TRUE(holds(verified.text, "holds     threads: toy")) << verified.text;
    EXPECT_TRUE(holds(verified.text, "reference                              truth, "));
    EXPECT_TRUE(holds(verified.text, "holds     against the reference: toy")) << verified.text;
}

TEST(ToyMethod, IsTold) {
    EXPECT_TRUE(holds(run_program({"info", scene}).text, "  toy              yes"));
    EXPECT_TRUE(holds(run_program({"help"}).text, "toy                the same everywhere"));
    const std::string help = run_program({"help", "toy"}).text;
    EXPECT_TRUE(holds(help, "irradiance           number, 0 to 100 W/m^2, default 2")) << help;
    EXPECT_EQ(help_text("photonmap"), "") << "it is not in this program's list";
    EXPECT_THROW(run_program({"help", "photonmap"}), InputError);
}

}  // namespace
}  // namespace caustics::experiments
