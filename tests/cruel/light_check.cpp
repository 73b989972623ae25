#include "tests/cruel/light_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <utility>

#include "core/base/error.h"
#include "experiments/base/stopwatch.h"

namespace caustics::cruel {

namespace {

using experiments::Agreement;
using experiments::Difference;
using experiments::Limit;

// The same for every method, so that all count the same paths; many more make beams slow.
constexpr int max_bounces = 4;
constexpr Limit limit_in_all;
// Noise of the particles, and of points that a method is asked at: together below what can be judged.
constexpr double particles_error = 0.002;
constexpr double points_error = 0.003;
constexpr std::uint64_t most_particles = 4'500'000;
constexpr std::size_t most_points = 400'000;
// Floats, and photons that are kept in few bits.
constexpr double rounding = 2e-4;

/// A fault that is asked for, to see that it is seen: the method's light, times so much.
double planted(const std::string& method) {
    const char* const fault = std::getenv("CAUSTICS_CRUEL_FAULT");  // METHOD=FACTOR
    if (fault == nullptr) return 1;
    const std::string text = fault;
    const auto at = text.find('=');
    return text.substr(0, at) == method ? std::stod(text.substr(at + 1)) : 1;
}

void plant(Comparison& found, double factor) {
    if (factor == 1) return;
    for (std::size_t cell = 0; cell < found.light.cells.size(); ++cell)
        for (std::size_t c = 0; c < 3; ++c)
            found.difference.at(cell, c).value += (factor - 1) * found.light.at(cell, c).value;
}

experiments::Method method_of(const std::string& name, std::vector<std::string> parameters) {
    parameters.push_back(fmt::format("max_bounces={}", max_bounces));
    return experiments::parse_method(name, experiments::parameters_node(parameters));
}

/// What a method's light is like beside the particles', in shares of these.
struct Gap {
    Difference whole;         ///< in the brightest channel
    Difference worst_square;  ///< of all squares and channels that can be judged
    bool is_off = false;      ///< by more than the limit, in all or in a square
    bool is_noticed = false;  ///< in all by more than its error explains
    bool can_judge = true;
    std::string text;

    bool is_within() const { return !is_off && !is_noticed; }
};

Limit limit_of(std::size_t cell) {
    return cell == FloorCells::all ? limit_in_all
                                   : experiments::limit_of_part(limit_in_all, FloorCells::squares);
}

/// As a share of the cell's light or of the floor's mean, whichever is more.
Difference difference(const Comparison& found, std::size_t cell, std::size_t channel) {
    const double unit = std::max({found.truth.at(cell, channel).value,
                                  found.truth.at(FloorCells::all, channel).value, found.faint});
    const Measured& m = found.difference.at(cell, channel);
    if (!(unit > 0)) return {m.value > 0 ? 1.0 : 0.0, 0};
    return {m.value / unit, std::sqrt(m.variance) / unit};
}

Gap gap(const Comparison& found, bool in_all_only) {
    Gap gap;
    const std::size_t brightest = found.truth.brightest();
    gap.whole = difference(found, FloorCells::all, brightest);
    gap.can_judge = limit_in_all.can_judge(gap.whole);
    double worst = 0;
    for (std::size_t cell = in_all_only ? FloorCells::all : 0; cell <= FloorCells::all; ++cell)
        for (std::size_t c = 0; c < 3; ++c) {
            const Limit limit = limit_of(cell);
            const Difference d = difference(found, cell, c);
            // A square or a channel with too much noise says something only where it is clearly off.
            const bool is_off =
                limit.can_judge(d) ? std::abs(d.value) > limit.share : limit.is_exceeded(d);
            const bool is_noticed =
                cell == FloorCells::all && std::abs(d.value) > Limit::errors * d.error + rounding;
            if (is_off) gap.can_judge = true;
            gap.is_off = gap.is_off || is_off;
            gap.is_noticed = gap.is_noticed || is_noticed;
            if (cell != FloorCells::all && limit.can_judge(d) &&
                std::abs(d.value) > std::abs(gap.worst_square.value))
                gap.worst_square = d;
            const double off = std::abs(d.value) / limit.share;
            if ((!is_off && !is_noticed) || off <= worst) continue;
            worst = off;
            gap.text = fmt::format("{} {}, channel {}: {:.4f} +- {:.4f} of {:.4g}",
                                   cell == FloorCells::all ? "all" : "square", cell, c, 1 + d.value,
                                   d.error, found.truth.at(cell, c).value);
        }
    if (!gap.text.empty() && found.share_lost > 1e-3)
        gap.text += fmt::format(", it reports {:.1f} % of the light on casters as lost",
                                100 * found.share_lost);
    return gap;
}

/// A scene's floor, asked with one effort (0, 1, 2: 1, 4 and 16 times the work).
class Inquiry {
public:
    using Particles = std::function<const ParticleLight&()>;

    Inquiry(const FloorAsked& floor, Particles particles, int effort)
        : floor_(floor), particles_(std::move(particles)), effort_(effort) {}

    Comparison answer(const std::string& name) const {
        if (name == "photonmap") return over_discs(name, "emitted", Stage::photons);
        if (name == "lighttrace") return over_discs(name, "paths", Stage::light_trace);
        if (name == "pathtrace")
            return floor_.at_points(method_of(name, {"spp=64"}), particles_(), points_error,
                                    most_points);
        if (name == "illuminationmap")
            return floor_.over_texels(
                method_of(name, {"resolution=30", fmt::format("emitted={}", paths())}), 30,
                paths());
        return by_beams(name);
    }

private:
    std::uint64_t paths() const { return 8000ULL << (2 * effort_); }

    Comparison over_discs(const std::string& name, const std::string& paths_key,
                          Stage stage) const {
        std::vector<std::string> parameters = {fmt::format("radius={}", floor_.disc_radius()),
                                               "emission=random",
                                               fmt::format("{}={}", paths_key, paths())};
        // The particles are counted in discs.
        if (name == "photonmap") parameters.emplace_back("filter=none");
        const auto method = method_of(name, parameters);
        return floor_.over_discs(method, stage, paths());
    }

    Comparison by_beams(const std::string& name) const {
        std::vector<std::string> parameters = {fmt::format("mesh_resolution={}", 16 << effort_),
                                               fmt::format("light_samples={}", 8 << effort_),
                                               fmt::format("max_beams={}", 200'000 << effort_),
                                               fmt::format("prune={}", 2e-3 / (1 << (2 * effort_))),
                                               fmt::format("wavelengths={}", 4 << effort_)};
        const bool in_squares = name == "beamtree squares";
        if (in_squares) parameters.push_back(fmt::format("footprint={}", floor_.square()));
        if (name == "beamtree area") parameters.emplace_back("intensity=area");
        if (name == "beamtree refined") parameters.emplace_back("intensity=refined");
        if (name == "causticpolygons") parameters.emplace_back("receiver_resolution=3");
        const auto method = method_of(name.substr(0, name.find(' ')), parameters);
        return in_squares ? floor_.over_squares(method, particles_())
                          : floor_.at_points(method, particles_(), points_error, most_points);
    }

    const FloorAsked& floor_;
    Particles particles_;
    int effort_;
};

/// Judges a method that is off by its differences at growing work: it converges if they shrink as its order says, or if
/// they were within the limit from the start and the last one is not noticed.
Agreement with_more_work(const std::vector<Gap>& gaps, std::string& text) {
    std::array<Difference, experiments::work_steps> whole;
    for (std::size_t i = 0; i < gaps.size(); ++i) whole[i] = gaps[i].whole;
    const experiments::Convergence found = experiments::convergence(whole, limit_in_all);
    text += "; " + found.text();
    const auto is_small = [](const Gap& gap) {
        return std::abs(gap.whole.value) <= limit_in_all.share;
    };
    const bool vanishes = std::ranges::all_of(gaps, is_small) && !gaps.back().is_noticed;
    return !gaps.back().is_off && (found.shrinks || vanishes) ? Agreement::converges
                                                              : Agreement::fails;
}

}  // namespace

const std::vector<std::string>& checked_methods() {
    static const std::vector<std::string> names = {
        "photonmap",     "lighttrace",       "pathtrace",        "illuminationmap",
        "beamtree area", "beamtree squares", "beamtree refined", "causticpolygons"};
    return names;
}

LightCheck::LightCheck(const Scene& scene, std::uint64_t seed) : floor_(scene, seed, max_bounces) {}

const ParticleLight& LightCheck::particles() {
    if (!particles_) particles_ = floor_.by_particles(particles_error, most_particles);
    return *particles_;
}

Verdict LightCheck::verdict(const std::string& method) {
    Verdict found;
    const experiments::Stopwatch watch;
    std::vector<Gap> gaps;
    try {
        for (int effort = 0; effort < static_cast<int>(experiments::work_steps); ++effort) {
            Comparison answer =
                Inquiry(
                    floor_, [this]() -> const ParticleLight& { return particles(); }, effort)
                    .answer(method);
            plant(answer, planted(method));
            if (effort == 0)
                found.light = answer.truth.at(FloorCells::all, answer.truth.brightest()).value;
            gaps.push_back(gap(answer, method == "illuminationmap"));
            if (!gaps.back().text.empty())
                found.text += (found.text.empty() ? "" : "; ") + gaps.back().text;
            if (effort == 0 && (gaps[0].is_within() || !gaps[0].can_judge)) break;
        }
    } catch (const UnsupportedScene&) {
        return found;
    }
    found.served = true;
    found.efforts = static_cast<int>(gaps.size());
    found.whole = gaps.front().whole;
    if (!gaps.front().can_judge)
        found.agreement = Agreement::unsure;
    else if (!gaps.front().is_within())
        found.agreement = with_more_work(gaps, found.text);
    found.cpu_seconds = watch.total().cpu;
    return found;
}

}  // namespace caustics::cruel
