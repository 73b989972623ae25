#include "core/render/renderer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <set>
#include <tuple>

#include "core/base/error.h"
#include "core/math/rng.h"
#include "core/render/camera_samples.h"
#include "tests/support/build_scene.h"
#include "tests/support/statistics.h"

namespace caustics {
namespace {

// Answers with a function of the point; says it is statistical when told.
class Stub : public CausticEstimator {
public:
    using Answer = std::function<Estimate(const ReceiverPoint&)>;
    explicit Stub(Answer answer, bool statistical = false)
        : answer_(std::move(answer)), statistical_(statistical) {}
    void radiance(std::span<const ReceiverPoint> points, std::span<Estimate> out,
                  QueryContext&) const override {
        for (std::size_t i = 0; i < points.size(); ++i) out[i] = answer_(points[i]);
    }
    void irradiance(std::span<const ReceiverPoint>, std::span<Estimate>,
                    QueryContext&) const override {}
    bool is_statistical() const override { return statistical_; }
    std::optional<CameraLayer> camera_layer(const RunOptions&) const override { return layer; }

    std::optional<CameraLayer> layer;

private:
    Answer answer_;
    bool statistical_;
};

Stub constant(float value) {
    return Stub([value](const ReceiverPoint&) {
        return Estimate{Spectrum(Spectrum::Constant(value)), black()};
    });
}

// A noisy answer that depends on nothing but the point's id.
Estimate noise(const ReceiverPoint& point) {
    Rng rng(1, Stage::test, point.id);
    return {Spectrum(Spectrum::Constant(rng.next())), Spectrum(Spectrum::Constant(0.125F))};
}

// A floor, half of it under a glass plate, a lamp, a mirror ball and some sky.
SceneDesc still_life(int width, int height) {
    SceneDesc desc;
    desc.shapes.push_back(support::horizontal("floor", 0, 3, true, support::diffuse(0.5F)));
    desc.shapes.push_back(
        support::rectangle("plate", {1.5, 0, 0.2}, {1.4, 0, 0}, {0, 3, 0}, support::glass(1.5F)));
    desc.shapes.push_back(support::sphere("ball", {-1, 0, 0.5}, 0.5, support::mirror()));
    desc.shapes.push_back(support::horizontal("lamp", 4, 0.5, false, support::diffuse(0)));
    desc.shapes.back().radiance = Spectrum(3, 2, 1);
    desc.lights.push_back(support::point_light({-2, -2, 3}, 5));
    desc.camera = support::camera({0, -6, 3}, {0, 0, 1}, {0, 0, 1}, 50, width, height);
    return desc;
}

RunOptions run(int spp, int threads = 1, std::uint64_t seed = 1) {
    RunOptions options;
    options.samples_per_pixel = spp;
    options.threads = threads;
    options.seed = seed;
    return options;
}

bool same_planes(const Film& a, const Film& b) {
    if (a.planes().size() != b.planes().size()) return false;
    for (const Plane& plane : a.planes()) {
        const std::vector<float>* other = b.find(plane.channel);
        if (other == nullptr || *other != plane.values) return false;
    }
    return true;
}

TEST(Renderer, BeautyIsExactlyTheSumOfItsLayers) {
    for (const auto& [width, height, spp] :
         {std::tuple{1, 1, 1}, std::tuple{17, 33, 3}, std::tuple{32, 16, 1}}) {
        const Scene scene(still_life(width, height));
        const Film film = render(scene, constant(0.75F), run(spp)).film;
        EXPECT_EQ(film.width(), width);
        EXPECT_EQ(film.height(), height);
        for (std::size_t pixel = 0; pixel < film.pixel_count(); ++pixel) {
            const Spectrum sum = film.rgb("direct", pixel) + film.rgb("caustic", pixel) +
                                 film.rgb("specular", pixel);
            EXPECT_TRUE((film.rgb("", pixel) == sum).all());
        }
        EXPECT_EQ(film.find("unreached.Y"), nullptr);
        EXPECT_EQ(film.find("stderr.R"), nullptr);
    }
}

TEST(Renderer, TheSamePictureForAnyNumberOfThreadsAnotherForAnotherSeed) {
    const Scene scene(still_life(37, 21));
    const Stub stub(noise, true);
    const Film one = render(scene, stub, run(2, 1)).film;
    EXPECT_TRUE(same_planes(one, render(scene, stub, run(2, 2)).film));
    EXPECT_TRUE(same_planes(one, render(scene, stub, run(2, 5)).film));
    EXPECT_FALSE(same_planes(one, render(scene, stub, run(2, 1, 2)).film));
}

TEST(Renderer, TheBackgroundIsBlackAndFarAway) {
    SceneDesc desc;
    desc.lights.push_back(support::point_light({0, 0, 0}, 1));
    desc.camera.width = 5;
    desc.camera.height = 3;
    const Scene scene(std::move(desc));
    const Rendering rendering = render(scene, constant(1), run(2));
    for (const Plane& plane : rendering.film.planes())
        for (const float value : plane.values) EXPECT_EQ(value, 0) << plane.channel;
    EXPECT_EQ(rendering.report.counters.at("camera_rays"), 30U);
}

TEST(Renderer, AnswersAreWeightedByTheEyePath) {
    SceneDesc desc;
    desc.shapes.push_back(support::horizontal("floor", 0, 50, true, support::diffuse(0.5F)));
    desc.camera = support::camera({0, 0, 2}, {0, 0.1, 0}, {0, 1, 0}, 20, 4, 4);
    const Scene scene(std::move(desc));
    const Film film = render(scene, constant(0.75F), run(4)).film;
    for (std::size_t pixel = 0; pixel < film.pixel_count(); ++pixel) {
        EXPECT_FLOAT_EQ(film.rgb("caustic", pixel)[1], 0.75F);
        EXPECT_FLOAT_EQ(film.rgb("albedo", pixel)[1], 0.5F);
        EXPECT_FLOAT_EQ((*film.find("normal.Z"))[pixel], 1);
        EXPECT_NEAR((*film.find("depth.Z"))[pixel], 2, 0.1F);
    }
}

// The standard error of the pixel's mean, from the scatter of its samples.
TEST(Renderer, StandardErrorPredictsTheScatterBetweenSeeds) {
    SceneDesc desc;
    desc.shapes.push_back(support::horizontal("floor", 0, 50, true, support::diffuse(0.5F)));
    desc.camera = support::camera({0, 0, 2}, {0, 0.1, 0}, {0, 1, 0}, 20, 32, 32);
    const Scene scene(std::move(desc));
    const Film film = render(scene, Stub(noise, true), run(16)).film;
    support::Moments value, variance;
    for (std::size_t pixel = 0; pixel < film.pixel_count(); ++pixel) {
        value.add(static_cast<double>(film.rgb("caustic", pixel)[0]));
        variance.add(std::pow(static_cast<double>(film.rgb("stderr", pixel)[0]), 2));
    }
    // Uniform numbers: variance 1/12 a sample.
    EXPECT_NEAR(variance.mean(), 1.0 / 12 / 16, 4 * variance.standard_error());
    EXPECT_NEAR(value.deviation(), std::sqrt(1.0 / 12 / 16), 0.1 * std::sqrt(1.0 / 12 / 16));

    // A single sample has only what the estimator says of itself.
    const Film single = render(scene, Stub(noise, true), run(1)).film;
    for (std::size_t pixel = 0; pixel < single.pixel_count(); ++pixel)
        EXPECT_FLOAT_EQ(single.rgb("stderr", pixel)[0], 0.125F);
}

CameraLayer layer_of(std::size_t pixels, float value) {
    CameraLayer layer;
    layer.radiance.assign(pixels, Spectrum::Constant(value));
    layer.standard_error.assign(pixels, Spectrum::Constant(0.5F));
    layer.counters["paths"] = 7;
    return layer;
}

TEST(Renderer, ACameraLayerTakesTheCausticsPlaceAndMarksWhatItCannotReach) {
    const Scene scene(still_life(24, 16));
    Stub stub([](const ReceiverPoint&) -> Estimate { throw std::logic_error("asked"); }, true);
    stub.layer = layer_of(24 * 16, 2);
    const Rendering rendering = render(scene, stub, run(4));
    const Film& film = rendering.film;
    const std::vector<float>& unreached = *film.find("unreached.Y");
    int fully = 0, not_at_all = 0;
    for (std::size_t pixel = 0; pixel < film.pixel_count(); ++pixel) {
        EXPECT_EQ(film.rgb("caustic", pixel)[0], 2);
        EXPECT_EQ(film.rgb("stderr", pixel)[0], 0.5F);
        EXPECT_EQ(std::fmod(unreached[pixel] * 4, 1.0F), 0);
        fully += unreached[pixel] == 1 ? 1 : 0;
        not_at_all += unreached[pixel] == 0 ? 1 : 0;
    }
    EXPECT_GT(fully, 10);
    EXPECT_GT(not_at_all, 100);
    EXPECT_EQ(rendering.report.counters.at("paths"), 7U);
}

/// An estimator that counts how many of its kind there are.
class Counted final : public Stub {
public:
    Counted(float value, int& alive) : Stub(constant(value)), alive_(alive) { ++alive_; }
    ~Counted() override { --alive_; }

private:
    int& alive_;
};

TEST(Renderer, PassesAreAveragedAtTheSameCameraSamplesOneInMemoryAtATime) {
    const Scene scene(still_life(37, 21));
    int alive = 0;
    std::vector<int> built;
    const Passes passes{3, [&](int pass) {
                            EXPECT_EQ(alive, 0);
                            built.push_back(pass);
                            return std::make_unique<Counted>(static_cast<float>(pass + 1), alive);
                        }};
    std::vector<double> shares;
    RunOptions options = run(4);
    options.progress = [&](double share) { shares.push_back(share); };
    const Rendering mean = render(scene, passes, options);
    const Rendering twos = render(scene, constant(2), run(4));
    EXPECT_EQ(built, (std::vector<int>{0, 1, 2}));
    EXPECT_EQ(alive, 0);
    EXPECT_TRUE(std::ranges::is_sorted(shares));
    EXPECT_EQ(shares.back(), 1);
    EXPECT_EQ(mean.report.counters.at("camera_rays"), 3 * twos.report.counters.at("camera_rays"));
    for (const Plane& plane : twos.film.planes()) {
        const std::vector<float>& other = *mean.film.find(plane.channel);
        for (std::size_t i = 0; i < other.size(); ++i)
            ASSERT_NEAR(other[i], plane.values[i], 1e-6F * std::abs(plane.values[i]))
                << plane.channel;
    }
    EXPECT_TRUE(same_planes(render(scene, {1, passes.build}, run(4)).film,
                            render(scene, constant(1), run(4)).film));
    EXPECT_TRUE(same_planes(mean.film, render(scene, passes, run(4, 3)).film));
}

TEST(Renderer, PassesAreNotSampledAdaptively) {
    SceneDesc desc = still_life(8, 8);
    desc.sampling.max_sample_count = 16;
    const Scene scene(std::move(desc));
    const Passes passes{2, [&](int) { return std::make_unique<Stub>(constant(1)); }};
    EXPECT_THROW(render(scene, passes, run(2)), InputError);
}

std::string message_of(const Scene& scene, const CausticEstimator& estimator) {
    try {
        render(scene, estimator, run(1, 2));
    } catch (const std::runtime_error& error) {
        return error.what();
    }
    return "nothing was thrown";
}

TEST(Renderer, NamesThePixelAndTheLayerOfANaN) {
    SceneDesc desc;
    desc.shapes.push_back(support::horizontal("floor", 0, 50, true, support::diffuse(0.5F)));
    desc.camera = support::camera({0, 0, 2}, {0, 0.1, 0}, {0, 1, 0}, 20, 8, 8);
    const Scene scene(std::move(desc));
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const Stub broken([&](const ReceiverPoint& point) {
        const bool here = (point.id >> 8U) == 8 * 5 + 3;
        return Estimate{Spectrum(Spectrum::Constant(here ? nan : 1.0F)), black()};
    });
    const std::string message = message_of(scene, broken);
    EXPECT_NE(message.find("(3, 5)"), std::string::npos) << message;
    EXPECT_NE(message.find("caustic"), std::string::npos) << message;

    Stub layered = constant(1);
    layered.layer = layer_of(64, 1);
    layered.layer->radiance[8 * 2 + 6][1] = nan;
    const std::string of_layer = message_of(scene, layered);
    EXPECT_NE(of_layer.find("(6, 2)"), std::string::npos) << of_layer;
}

TEST(Renderer, StratifiedSamplesStandInTheirCells) {
    for (const bool jitter : {false, true}) {
        SceneDesc desc;
        desc.shapes.push_back(support::horizontal("floor", 0, 50, true, support::diffuse(0.5F)));
        desc.camera = support::camera({0, 0, 2}, {0, 0.1, 0}, {0, 1, 0}, 20, 3, 2);
        desc.sampling.stratified = true;
        desc.sampling.jitter = jitter;
        const Scene scene(std::move(desc));
        const Camera& camera = scene.camera();
        std::vector<int> cells(6 * 9);
        const Stub recorder([&](const ReceiverPoint& point) {
            const auto seen = FilmProjection(camera).project(point.position);
            if (!seen) return Estimate{};
            const int x = static_cast<int>(seen->x * 3), y = static_cast<int>(seen->y * 3);
            ++cells[static_cast<std::size_t>(y * 9 + x)];
            if (!jitter) {
                EXPECT_NEAR(seen->x * 3 - x, 0.5, 1e-2);
                EXPECT_NEAR(seen->y * 3 - y, 0.5, 1e-2);
            }
            return Estimate{};
        });
        render(scene, recorder, run(9));
        for (const int count : cells) EXPECT_EQ(count, 1);
    }
}

// A floor seen from straight above, black for x below 0.1 m and grey beyond.
class AdaptiveSampling : public testing::Test {
protected:
    static SceneDesc floor(int most, float error) {
        SceneDesc desc;
        desc.shapes.push_back(support::horizontal("floor", 0, 50, true, support::diffuse(0.5F)));
        desc.camera = support::camera({0, 0, 2}, {0, 0.001, 0}, {0, 1, 0}, 30, 33, 21);
        desc.sampling.max_sample_count = most;
        desc.sampling.max_error = error;
        return desc;
    }
    Stub step_{[](const ReceiverPoint& point) {
        return Estimate{Spectrum(Spectrum::Constant(point.position.x() > 0.1F ? 1.0F : 0.0F)),
                        black()};
    }};
    /// The largest value of a plane at the pixel and its eight neighbours.
    static float brightest_around(const std::vector<float>& plane, std::size_t pixel) {
        constexpr int width = 33, height = 21;
        const int x = static_cast<int>(pixel) % width, y = static_cast<int>(pixel) / width;
        float brightest = 0;
        for (int j = std::max(0, y - 1); j <= std::min(height - 1, y + 1); ++j)
            for (int i = std::max(0, x - 1); i <= std::min(width - 1, x + 1); ++i)
                brightest = std::max(brightest, plane[static_cast<std::size_t>(j * width + i)]);
        return brightest;
    }
    /// Mean squared error of red against pixel averages by many samples.
    static double squared_error(const Film& film, const Film& truth) {
        double sum = 0;
        for (std::size_t pixel = 0; pixel < film.pixel_count(); ++pixel)
            sum += std::pow(film.rgb("", pixel)[0] - truth.rgb("", pixel)[0], 2);
        return sum / static_cast<double>(film.pixel_count());
    }
};

TEST_F(AdaptiveSampling, TakesMoreSamplesWhereThePixelIsNotEven) {
    const Scene scene(floor(64, 0.02F));
    const Rendering rendering = render(scene, step_, run(4));
    const std::vector<float>& samples = *rendering.film.find("samples.Y");
    int refined = 0;
    double sum = 0;
    for (std::size_t pixel = 0; pixel < samples.size(); ++pixel) {
        const float value = rendering.film.rgb("", pixel)[0];
        // 16: an even one beside the edge.
        EXPECT_TRUE(samples[pixel] == 4 || samples[pixel] == 16 || samples[pixel] == 64)
            << samples[pixel];
        EXPECT_EQ(samples[pixel] == 64, value > 0 && value < 1) << pixel;
        EXPECT_EQ(samples[pixel] > 4, brightest_around(samples, pixel) == 64) << pixel;
        refined += samples[pixel] == 64 ? 1 : 0;
        sum += static_cast<double>(samples[pixel]);
    }
    EXPECT_GT(refined, 15) << "about a pixel a row lies on the edge";
    EXPECT_LT(refined, 2 * 21);
    EXPECT_EQ(rendering.report.counters.at("camera_rays"), static_cast<std::uint64_t>(sum));
}

TEST_F(AdaptiveSampling, BeatsTheSameNumberOfRaysSpreadEvenly) {
    const Scene scene(floor(64, 0.02F));
    RunOptions fixed = run(1024);
    fixed.adaptive = false;
    const Film truth = render(scene, step_, fixed).film;
    EXPECT_EQ(truth.find("samples.Y"), nullptr);
    const Rendering adaptive = render(scene, step_, run(4));
    const double mean_samples = static_cast<double>(adaptive.report.counters.at("camera_rays")) /
                                static_cast<double>(truth.pixel_count());
    fixed.samples_per_pixel = static_cast<int>(std::ceil(mean_samples));
    fixed.seed = 3;
    EXPECT_LT(4 * squared_error(adaptive.film, truth),
              squared_error(render(scene, step_, fixed).film, truth));
}

TEST_F(AdaptiveSampling, LeavesDarkNoiseAloneAndIsTheSameForAnyNumberOfThreads) {
    const Scene scene(floor(32, 0.1F));
    // Noise a thousandth as bright as the rest of the picture.
    const Stub dark([](const ReceiverPoint& point) {
        const float value = point.position.x() > 0 ? 1 : 0.001F * noise(point).value[0];
        return Estimate{Spectrum(Spectrum::Constant(value)), black()};
    });
    const Film one = render(scene, dark, run(4, 1)).film;
    EXPECT_TRUE(same_planes(one, render(scene, dark, run(4, 3)).film));
    const std::vector<float>& samples = *one.find("samples.Y");
    for (std::size_t pixel = 0; pixel < samples.size(); ++pixel)
        if (brightest_around(*one.find("R"), pixel) < 0.002F) {
            EXPECT_EQ(samples[pixel], 4);
        }
}

// The first 4, 8, 16, ... samples of a pixel have one in each cell of every grid of so many cells.
TEST_F(AdaptiveSampling, FillsTheCellsOfEveryGridOfPowersOfTwo) {
    const Scene scene(floor(64, 1e-6F));
    RunOptions options = run(4);
    const CameraSamples samples(scene, options, 64);
    double sum_x = 0, sum_y = 0;
    for (int pixel = 0; pixel < 33 * 21; ++pixel) {
        const int x = pixel % 33, y = pixel / 33;
        std::vector<Vec2d> places;
        for (int sample = 0; sample < 64; ++sample) {
            Rng rng(options.seed, Stage::eye, samples.id(x, y, sample));
            places.push_back(samples.film_point(x, y, sample, rng) - Vec2d(x, y));
            sum_x += places.back().x();
            sum_y += places.back().y();
        }
        for (int count = 1; count <= 64; count *= 2)
            for (int columns = 1; columns <= count; columns *= 2) {
                std::set<int> cells;
                for (int i = 0; i < count; ++i) {
                    const Vec2d& p = places[static_cast<std::size_t>(i)];
                    cells.insert(static_cast<int>(p.x() * columns) +
                                 columns * static_cast<int>(p.y() * count / columns));
                }
                ASSERT_EQ(cells.size(), static_cast<std::size_t>(count)) << columns;
            }
    }
    // Their mean is uniform: within its cells of a 64th all samples of a pixel are shifted alike.
    const double scatter = 4 * std::sqrt(1.0 / 12 / (33 * 21)) / 64;
    EXPECT_NEAR(sum_x / (64 * 33 * 21), 0.5, scatter);
    EXPECT_NEAR(sum_y / (64 * 33 * 21), 0.5, scatter);
}

// Behind dispersive glass a pixel's samples have wavelengths far apart: with so few that each were drawn by
// itself, channels would scatter by 1.2 / sqrt(16) = 30 %.
TEST(Renderer, SamplesOfAPixelShareOutTheWavelengths) {
    SceneDesc desc;
    desc.camera = support::camera({0, 0, 3}, {0, 0, 0}, {0, 1, 0}, 20, 16, 16);
    Bsdf glass = support::glass(1.5F);
    std::get<Dielectric>(glass.model).int_ior = Ior::cauchy(1.5, 0.01);
    desc.shapes = {support::horizontal("water", 1, 5, true, glass),
                   support::horizontal("floor", 0, 5, true, support::diffuse(0.5F))};
    desc.sampling.split_depth = 1;  // reflections are not left to chance either
    const Scene scene(std::move(desc));
    RunOptions options;
    options.samples_per_pixel = 16;
    const Film film = render(scene, constant(1), options).film;
    std::array<support::Moments, 3> channels;
    for (std::size_t pixel = 0; pixel < film.pixel_count(); ++pixel)
        for (std::size_t c = 0; c < 3; ++c)
            channels[c].add(
                static_cast<double>(film.rgb("caustic", pixel)[static_cast<Eigen::Index>(c)]));
    for (const support::Moments& channel : channels) {
        EXPECT_LT(channel.deviation(), 0.08 * channel.mean());
        // The shorter the waves, the more (1 - F) / n^2 takes of them.
        EXPECT_NEAR(channel.mean() / channels[1].mean(), 1, 0.04);
    }
}

TEST(Renderer, AProgressCallbackMayStopIt) {
    const Scene scene(still_life(40, 40));
    RunOptions options = run(1, 2);
    options.progress = [](double) { throw std::runtime_error("stop"); };
    EXPECT_THROW(render(scene, constant(1), options), std::runtime_error);
}

}  // namespace
}  // namespace caustics
