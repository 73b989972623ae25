#pragma once

#include <string>
#include <vector>

#include "core/light_path/bounce_limit.h"
#include "core/scene/scene.h"

namespace caustics::experiments {

/// A scene as files that another renderer reads.
struct ExportedScene {
    struct File {
        std::string name;
        std::string bytes;
    };
    std::vector<File> files;         ///< the first is the one to render, or the first of them
    std::vector<std::string> notes;  ///< what is not as in the scene, one line each
};

struct ExportSettings {
    std::string scene_file = {};     ///< for messages
    int mesh_resolution = 256;       ///< of exact shapes that the renderer does not know
    int max_bounces = most_bounces;  ///< specular events between light and receiver
    bool indirect = false;           ///< with the light between receivers: paths of any length
};

/// Refuses what the renderer cannot express: throws UnsupportedScene naming the scene file, the
/// JSON pointer of the object and the reason.
[[noreturn]] void refuse_export(const ExportSettings& settings, const std::string& object,
                                const std::string& reason);
/// Why a shape at a JSON pointer is not taken, and what would be.
std::string with_setting(const ExportRefusal& refusal, const std::string& place);

/// A shape's mesh: its own, or an exact shape's at settings.mesh_resolution, with a note.
TriangleMesh baked_mesh(const Shape& shape, const ExportSettings& settings,
                        std::vector<std::string>& notes);

/// Shape names as file names and identifiers: letters, digits, '_' and '-' only, cut short,
/// unique by number.
std::string plain_name(const std::string& name, std::size_t number);

/// Mitsuba 3 (from 3.0 on): scene.xml with meshes as binary PLY and textures as PFM beside it.
/// Lengths and radiances keep their units. Throws UnsupportedScene for schlick receivers,
/// absorption, and mirrored spheres and cylinders.
ExportedScene to_mitsuba(const SceneDesc& scene, const ExportSettings& settings);

/// The same with dispersion, which Mitsuba's dielectric has not: the scene in the light of each of so many
/// bins of wavelengths (WavelengthBin), scene_NNN.NNNnm.xml with the index there. The sum of their pictures is
/// the picture, as beams make it up. Throws UnsupportedScene for a scene that disperses nothing as well.
ExportedScene to_mitsuba_by_wavelength(const SceneDesc& scene, const ExportSettings& settings,
                                       int wavelengths);

/// POV-Ray 3.7: scene.pov, and scene.ini that asks for a linear OpenEXR picture. POV-Ray has no
/// units; lights are scaled so that a pixel's value is the radiance [W m^-2 sr^-1]. Throws
/// UnsupportedScene for what POV-Ray would render differently without a word.
ExportedScene to_povray(const SceneDesc& scene, const ExportSettings& settings);

}  // namespace caustics::experiments
