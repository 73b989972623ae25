#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "core/material/wavelength.h"
#include "experiments/export/exported_scene.h"

namespace caustics::experiments {

namespace {

/// The scene in the light of one bin, whose glass has one index.
SceneDesc in_light_of(const WavelengthBin& bin, SceneDesc scene) {
    for (Light& light : scene.lights) scale(light, bin.weight);
    for (Shape& shape : scene.shapes) {
        if (shape.radiance) *shape.radiance *= bin.weight;
        if (!is_dispersive(shape.bsdf)) continue;
        auto& glass = std::get<Dielectric>(shape.bsdf.model);
        glass.int_ior = static_cast<float>(glass.int_ior.at(bin.nm));
        glass.ext_ior = static_cast<float>(glass.ext_ior.at(bin.nm));
    }
    return scene;
}

}  // namespace

ExportedScene to_mitsuba_by_wavelength(const SceneDesc& scene, const ExportSettings& settings,
                                       int wavelengths) {
    if (std::ranges::none_of(scene.shapes, [](const Shape& s) { return is_dispersive(s.bsdf); }))
        refuse_export(settings, "/", "no glass disperses light; leave out --wavelengths");
    ExportedScene all;
    std::set<std::string> written;
    for (const WavelengthBin& bin : wavelength_bins(wavelengths)) {
        ExportedScene one = to_mitsuba(in_light_of(bin, scene), settings);
        one.files.front().name = fmt::format("scene_{:.3f}nm.xml", bin.nm);
        for (ExportedScene::File& file : one.files)
            if (written.insert(file.name).second) all.files.push_back(std::move(file));
        if (all.notes.empty()) all.notes = std::move(one.notes);
    }
    all.notes.push_back(
        fmt::format("light of {} wavelengths, a scene each; the sum of their pictures is the "
                    "picture",
                    wavelengths));
    return all;
}

}  // namespace caustics::experiments
