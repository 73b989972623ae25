#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/math/vec.h"
#include "tests/cruel/dice.h"

namespace caustics::cruel {

using Json = nlohmann::json;

/// Steps of a transform.
inline Json scale_by(double factor) { return Json::object({{"scale", factor}}); }
inline Json move_to(const Vec3d& place) {
    return Json::object({{"translate", {place.x(), place.y(), place.z()}}});
}

/// What scenes are made for.
enum class Purpose {
    bits,  ///< anything that the program takes
    light  ///< what every method can measure well: nothing that crosses, and finely divided meshes
};

/// Draws the parts of random scenes; meshes and pictures are written into a folder.
class Parts {
public:
    Parts(Purpose purpose, std::uint64_t seed, std::filesystem::path folder)
        : purpose_(purpose), folder_(std::move(folder)), dice_(seed) {}

    Dice& dice() { return dice_; }
    bool measured() const { return purpose_ == Purpose::light; }

    Json colour(double low, double high);
    /// A transform that turns at random.
    Json turn();
    /// A closed shape about the origin, within the unit sphere, or an open one.
    Json solid();
    Json sheet();
    /// Of a receiver; not `measured` ones may be black from behind, textured and glossy.
    Json receiver_bsdf();
    Json mirror_bsdf();
    /// Between two media: keys of the outer one are those of the inside of another glass, or none.
    Json glass_bsdf(const Json& outer = Json());

private:
    Json ior(double low, double high);
    Json texture();
    Json exact_or_mesh(Json shape, int least, int most);
    Json mesh_file(bool closed);
    Json lathe(bool closed);
    Json cone(bool closed);
    Json smooth_lathe(bool closed);
    Json cut();
    Json waves();
    Json ground();
    std::filesystem::path new_file(const std::string& extension);

    Purpose purpose_;
    std::filesystem::path folder_;
    Dice dice_;
    int files_ = 0;
};

}  // namespace caustics::cruel
