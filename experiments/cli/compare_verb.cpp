#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "experiments/base/file_io.h"
#include "experiments/cli/verbs.h"
#include "experiments/picture/metrics.h"
#include "experiments/picture/previews.h"
#include "experiments/plan/record.h"
#include "experiments/run/cli_options.h"
#include "experiments/run/light_differences.h"

namespace caustics::experiments {

namespace {

struct CompareOptions {
    std::string picture;
    std::string reference;
    std::string layer;  ///< empty: not named
    std::string mask;
    std::string strip;
    bool json = false;
};

PixelMask mask_from(const std::string& file, const Film& reference) {
    const Film mask = read_exr(file);
    if (mask.width() != reference.width() || mask.height() != reference.height())
        throw InputError(fmt::format("{}: the mask is {}x{} pixels, the reference {}x{}", file,
                                     mask.width(), mask.height(), reference.width(),
                                     reference.height()));
    PixelMask counted(mask.pixel_count(), false);
    for (const Plane& plane : mask.planes())
        for (std::size_t i = 0; i < counted.size(); ++i) {
            if (!std::isfinite(plane.values[i]))
                throw InputError(fmt::format("{}: the mask is not finite", file));
            if (plane.values[i] != 0) counted[i] = true;
        }
    return counted;
}

const char* unit_of(const std::string& metric) {
    return metric == "rmse" ? " W/(m^2 sr)" : " (no unit)";
}

void append_text(std::string& text, const char* title, const nlohmann::json& metrics) {
    text += fmt::format("{}\n", title);
    for (const auto& [name, value] : metrics.items())
        text += fmt::format("  {:<12} {}\n", name,
                            value.is_null() ? "undefined"
                            : value.is_number_float()
                                ? fmt::format("{:.4g}{}", value.get<double>(), unit_of(name))
                                : value.dump());
}

/// What the reference's own standard error leaves of a difference, in one line; empty where it has none.
std::string said_of_reference(const Film& reference, const std::string& layer,
                              const PixelMask& reached, const nlohmann::json& metrics) {
    const auto share = relative_standard_error(reference, layer, reached);
    if (!share || !metrics.at("rmse").is_number()) return "";
    const double error = *share * mean(reference, layer, reached);
    const double rmse = metrics.at("rmse").get<double>();
    return fmt::format(
        "the reference's own standard error is {:.4g} W/(m^2 sr) (root mean square): {}\n", error,
        rmse <= 1.5 * error
            ? "the difference is within it, and says nothing about the picture"
            : fmt::format("{:.0f} % of rmse squared", 100 * error * error / (rmse * rmse)));
}

void tell(const std::vector<std::string>& differences) {
    constexpr std::size_t most = 5;
    if (differences.empty()) return;
    const std::vector<std::string> first(
        differences.begin(),
        differences.begin() + static_cast<std::ptrdiff_t>(std::min(differences.size(), most)));
    const std::string more =
        differences.size() > most ? fmt::format(", and {} more", differences.size() - most) : "";
    print_notes({fmt::format("the two pictures ask for different light: {}{}",
                             fmt::join(first, ", "), more)});
}

/// What --layer takes for these pictures.
std::vector<std::string> common_layers(const Film& picture, const Film& reference) {
    const auto both_have = [&](const std::string& layer) {
        return picture.has_layer(layer) && reference.has_layer(layer);
    };
    std::vector<std::string> all;
    if (both_have("")) all.emplace_back("beauty");
    for (const Plane& plane : picture.planes()) {
        if (!plane.channel.ends_with(".R")) continue;
        const std::string layer = plane.channel.substr(0, plane.channel.size() - 2);
        if (both_have(layer)) all.push_back(layer);
    }
    return all;
}

/// The layer that is judged; empty: RGB.
std::string judged_layer(const CompareOptions& options, const Film& picture,
                         const Film& reference) {
    if (options.layer == "beauty") return "";
    if (options.layer.empty())
        return picture.has_layer("caustic") && reference.has_layer("caustic") ? "caustic" : "";
    for (const auto& [film, file] :
         {std::pair{&picture, &options.picture}, std::pair{&reference, &options.reference}})
        if (!film->has_layer(options.layer))
            throw InputError(fmt::format("{}: has no layer \"{}\" (both pictures have: {})", *file,
                                         options.layer,
                                         fmt::join(common_layers(picture, reference), ", ")));
    return options.layer;
}

/// A picture of luminance alone cannot be told from one of another hue.
void require_colours(const Film& film, const std::string& file) {
    if (film.has_layer("")) return;
    std::vector<std::string> channels;
    for (const Plane& plane : film.planes()) channels.push_back(plane.channel);
    throw InputError(
        fmt::format("{}: has no channels R, G and B to judge, but {}; name a layer that both files "
                    "have by --layer, or write its values to R, G and B",
                    file, one_line(fmt::format("{}", fmt::join(channels, ", ")))));
}

struct Comparison {
    std::string layer;  ///< empty: RGB
    PixelMask reached;
    PixelMask mask;
    nlohmann::json whole, masked;  ///< metrics
    std::vector<std::string> light_differences;
};

Comparison compared(const CompareOptions& options, const Film& picture, const Film& reference) {
    if (picture.width() != reference.width() || picture.height() != reference.height())
        throw InputError(fmt::format("{} has {}x{} pixels, {} has {}x{}", options.picture,
                                     picture.width(), picture.height(), options.reference,
                                     reference.width(), reference.height()));
    Comparison result;
    const std::string& layer = result.layer = judged_layer(options, picture, reference);
    if (layer.empty()) {
        require_colours(picture, options.picture);
        require_colours(reference, options.reference);
    }
    require_finite(picture, layer, options.picture);
    require_finite(reference, layer, options.reference);
    result.reached = reached_pixels(picture, reference);
    result.whole = to_json(measure(picture, reference, layer, result.reached));
    result.mask = options.mask.empty()
                      ? bright_pixels(reference, layer, result.reached)
                      : intersection(result.reached, mask_from(options.mask, reference));
    result.masked = to_json(measure(picture, reference, layer, result.mask));
    result.light_differences = light_differences(picture, reference, layer);
    return result;
}

std::string as_json(const Comparison& found, const Film& reference) {
    const std::optional<double> own =
        relative_standard_error(reference, found.layer, found.reached);
    const nlohmann::json all = {{"layer", found.layer.empty() ? "beauty" : found.layer},
                                {"unreached_fraction", 1 - fraction(found.reached)},
                                {"mask_fraction", fraction(found.mask)},
                                {"reference_stderr", own ? nlohmann::json(*own) : nlohmann::json()},
                                {"metrics", found.whole},
                                {"mask_metrics", found.masked},
                                {"light_differences", found.light_differences},
                                {"formulas", metric_formulas}};
    return all.dump(2) + "\n";
}

std::string as_text(const Comparison& found, const CompareOptions& options, const Film& reference) {
    const bool lacks_caustic = found.layer.empty() && options.layer.empty();
    std::string text =
        fmt::format("layer {}{}\nunreached pixels left out: {:.4g} % of all\n",
                    found.layer.empty() ? "beauty" : found.layer,
                    lacks_caustic ? " (RGB, because not both files have a layer \"caustic\")" : "",
                    100 * (1 - fraction(found.reached)));
    append_text(text, "all pixels", found.whole);
    append_text(
        text,
        options.mask.empty() ? "pixels whose reference is at least its mean" : "pixels of the mask",
        found.masked);
    text += said_of_reference(reference, found.layer, found.reached, found.whole);
    return text + metric_formulas;
}

int compare(const CompareOptions& options) {
    if (!options.strip.empty()) require_png("--strip", options.strip, "strips");
    const Film picture = read_exr(options.picture);
    const Film reference = read_exr(options.reference);
    const Comparison found = compared(options, picture, reference);
    if (!options.strip.empty()) write_png(strip(picture, reference, found.layer), options.strip);
    tell(found.light_differences);
    write_stdout(options.json ? as_json(found, reference) : as_text(found, options, reference));
    return 0;
}

}  // namespace

Verb add_compare(CLI::App& app) {
    auto options = std::make_shared<CompareOptions>();
    CLI::App* const verb = app.add_subcommand("compare", "Errors of a picture against a reference");
    verb->add_option("PICTURE", options->picture, "EXR to judge")->required();
    verb->add_option("REFERENCE", options->reference, "EXR to judge it by")->required();
    verb->add_flag("--json", options->json, "Print JSON");
    verb->add_option("--layer", options->layer,
                     "Layer to judge: caustic, indirect, direct, specular or beauty (default: "
                     "caustic, or beauty when not both files have it)")
        ->type_name("NAME");
    verb->add_option("--mask", options->mask,
                     "EXR whose pixels other than 0 are judged apart (default: pixels whose "
                     "reference is at least its mean)")
        ->type_name("FILE");
    verb->add_option("--strip", options->strip, "PNG to write: reference | picture | signed error")
        ->type_name("FILE");
    verb->footer(
        "Unreached pixels are left out.\n"
        "A note says where the two ask for different light. --json prints every digit.\n" +
        std::string(metric_formulas) +
        "Example:\n  causticbench compare photonmap.exr lighttrace.exr --strip strip.png");
    return {verb, [options] { return compare(*options); }};
}

}  // namespace caustics::experiments
