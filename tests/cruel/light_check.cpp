#include "tests/cruel/light_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "core/base/error.h"
#include "core/light_path/aimed_emission.h"

namespace caustics::cruel {

namespace {

constexpr int efforts = 3;
constexpr double most_sigmas = 5;
// Of every method, so that all count the same paths; many more make beams slow.
constexpr int max_bounces = 4;
// Of a biased method: of the floor's light in all, and of a square's light and the mean in squares.
constexpr double off_in_all = 0.02;
constexpr double off_in_squares = 0.1;
// Of beams, of the light on casters: what coarse polygons send elsewhere, of grazing light round in a ball for example.
constexpr double misled_by_polygons = 0.005;
constexpr double rounding = 1e-5;
// What is surer than this share of the floor's light needs no second effort; at points the share is larger.
constexpr double sure = 0.05;
constexpr double sure_at_points = 0.15;

/// A fault that is asked for, to see that it is seen: the method's light, times so much.
double planted(const std::string& method) {
    const char* const fault = std::getenv("CAUSTICS_CRUEL_FAULT");  // METHOD=FACTOR
    if (fault == nullptr) return 1;
    const std::string text = fault;
    const auto at = text.find('=');
    return text.substr(0, at) == method ? std::stod(text.substr(at + 1)) : 1;
}

void scale(FloorLight::Cells& cells, double factor) {
    for (auto& cell : cells)
        for (Measured& m : cell) m = {m.value * factor, m.variance * factor * factor};
}

experiments::Method method_of(const std::string& name, std::vector<std::string> parameters) {
    parameters.push_back(fmt::format("max_bounces={}", max_bounces));
    return experiments::parse_method(name, experiments::parameters_node(parameters));
}

/// What one method says of the floor.
struct Answer {
    FloorLight::Cells cells = {};
    bool over_discs = false;
    bool in_all_only = false;
    bool finds_by_chance = false;  ///< may have missed what is small and bright
    double off_in_all = 0;
    double off_in_squares = 0;
    // Of the light on casters; any square may have it all.
    double share_lost = 0;
    double share_misled = 0;

    double allowed(std::size_t cell, double value, double mean) const {
        if (cell == FloorLight::squares) return (off_in_all + rounding) * mean;
        return off_in_squares * (mean + value) + rounding * mean;
    }
};

/// A gap between two methods, in standard errors.
struct Gap {
    double sigmas = 0;
    std::string text;
};

// Asked at points, what was met by chance a few times says nothing of its own error.
bool is_unsure(const Measured& found) { return found.variance >= std::pow(0.2 * found.value, 2); }

Gap widest_gap(const Answer& answer, const FloorLight& particles) {
    const FloorLight::Cells& truth = answer.over_discs ? particles.in_discs : particles.in_squares;
    Gap widest;
    for (std::size_t cell = answer.in_all_only ? FloorLight::squares : 0; cell < truth.size();
         ++cell)
        for (std::size_t c = 0; c < 3; ++c) {
            const Measured &a = answer.cells[cell][c], &b = truth[cell][c];
            if (answer.finds_by_chance && is_unsure(a)) continue;
            const double mean = truth[FloorLight::squares][c].value;
            const double on_casters =
                particles.on_casters[c] * (cell == FloorLight::squares ? 1 : FloorLight::squares);
            const double off =
                std::max(a.value - b.value, b.value - a.value - answer.share_lost * on_casters);
            const double gap =
                off - answer.share_misled * on_casters - answer.allowed(cell, b.value, mean);
            const double sigmas = gap > 0 ? gap / std::sqrt(a.variance + b.variance + 1e-60) : 0;
            if (!(sigmas > widest.sigmas)) continue;
            widest = {sigmas,
                      fmt::format("{:.1f} sigma in {} {}, channel {}: {:.4g} +- {:.1g} against "
                                  "{:.4g} +- {:.1g}",
                                  sigmas, answer.over_discs ? "disc" : "square", cell, c, a.value,
                                  std::sqrt(a.variance), b.value, std::sqrt(b.variance))};
        }
    return widest;
}

/// A scene's floor, asked with one effort.
class Inquiry {
public:
    Inquiry(const Scene& scene, std::uint64_t seed, int effort)
        : scene_(scene),
          floor_(scene, 100 * seed + static_cast<std::uint64_t>(effort)),
          effort_(effort),
          paths_(24'000ULL << (2 * effort)),
          points_(10 << effort) {}

    FloorLight particles() const {
        const AimedEmission emission(scene_);
        return floor_.by_particles(support::aimed(emission), paths_, max_bounces);
    }

    Answer answer(const std::string& name) const {
        if (name == "photonmap") return over_discs(name, "emitted");
        if (name == "lighttrace") return over_discs(name, "paths");
        if (name == "pathtrace")
            return {.cells = floor_.at_points(method_of(name, {"spp=16"}), points_).in_squares,
                    .finds_by_chance = true};
        if (name == "illuminationmap") {
            const auto map = method_of(name, {"resolution=30", fmt::format("emitted={}", paths_)});
            return {.cells = floor_.at_points(map, points_).in_squares,
                    .in_all_only = true,
                    .off_in_all = off_in_all};
        }
        return by_beams(name);
    }

private:
    Answer over_discs(const std::string& name, const std::string& paths) const {
        constexpr int seeds = 16;
        const auto method = method_of(name, {fmt::format("radius={}", floor_.disc_radius()),
                                             fmt::format("{}={}", paths, paths_ / seeds)});
        return {.cells = floor_.over_discs(method, seeds).in_discs, .over_discs = true};
    }

    Answer by_beams(const std::string& name) const {
        std::vector<std::string> parameters = {fmt::format("mesh_resolution={}", 5 << effort_),
                                               fmt::format("light_samples={}", 2 << (2 * effort_)),
                                               fmt::format("max_beams={}", 20'000 << (2 * effort_)),
                                               fmt::format("prune={}", 0.02 / (1 << (2 * effort_))),
                                               fmt::format("wavelengths={}", 2 << effort_)};
        const bool in_squares = name == "beamtree squares";
        if (in_squares)
            parameters.push_back(fmt::format("footprint={}", 2 * floor_.disc_radius() / points_));
        if (name == "beamtree area") parameters.emplace_back("intensity=area");
        if (name == "beamtree refined") parameters.emplace_back("intensity=refined");
        if (name == "causticpolygons") parameters.emplace_back("receiver_resolution=3");
        const auto method = method_of(name.substr(0, name.find(' ')), parameters);
        FloorLight light = floor_.at_points(method, points_, !in_squares);
        if (in_squares)  // they lie side by side all over the floor
            for (auto& cell : light.in_squares)
                for (Measured& m : cell) m.variance = 0;
        return {.cells = light.in_squares,
                .finds_by_chance = !in_squares,
                .off_in_all = off_in_all,
                .off_in_squares = off_in_squares,
                .share_lost = 1.5 * light.share_lost,
                .share_misled = misled_by_polygons};
    }

    const Scene& scene_;
    FloorAsked floor_;
    int effort_;
    std::uint64_t paths_;
    int points_;  ///< along a side of a square
};

}  // namespace

const std::vector<std::string>& checked_methods() {
    static const std::vector<std::string> names = {
        "photonmap",     "lighttrace",       "pathtrace",        "illuminationmap",
        "beamtree area", "beamtree squares", "beamtree refined", "causticpolygons"};
    return names;
}

const FloorLight& LightCheck::particles(int effort) {
    while (particles_.size() <= static_cast<std::size_t>(effort))
        particles_.push_back(
            Inquiry(scene_, seed_, static_cast<int>(particles_.size())).particles());
    return particles_[static_cast<std::size_t>(effort)];
}

Verdict LightCheck::verdict(const std::string& method) {
    Verdict found;
    std::string text;
    for (int effort = 0; effort < efforts; ++effort) {
        Answer answer;
        try {
            answer = Inquiry(scene_, seed_, effort).answer(method);
        } catch (const UnsupportedScene&) {
            return found;
        }
        scale(answer.cells, planted(method));
        const FloorLight& truth = particles(effort);
        const Gap gap = widest_gap(answer, truth);
        const auto& all = (answer.over_discs ? truth.in_discs : truth.in_squares).back();
        const auto brightest = std::ranges::max_element(all, {}, &Measured::value) - all.begin();
        found.served = true;
        found.efforts = effort + 1;
        found.light = answer.cells.back()[static_cast<std::size_t>(brightest)];
        found.of_particles = all[static_cast<std::size_t>(brightest)];
        if (gap.sigmas >= most_sigmas) {
            text += (text.empty() ? "" : "; ") + gap.text;
            continue;
        }
        const double error = std::sqrt(found.light.variance + found.of_particles.variance);
        const double enough =
            (answer.over_discs ? sure : sure_at_points) * found.of_particles.value;
        if (effort > 0 || error <= enough) return found;
    }
    found.disagreement = text;
    return found;
}

}  // namespace caustics::cruel
