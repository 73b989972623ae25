#pragma once

#include <vector>

#include "core/scene/scene.h"

namespace caustics::beamtree {

/// Points of an area light from which it can shine on casters: half of a spherical lamp is turned
/// away from them, and beams that start there bring nothing. The density follows the light that a
/// point sends to places all over the boxes round the casters, corners among them; so it is above 0
/// wherever light can leave towards the boxes. A flat lamp's is even.
class AreaLightSampler {
public:
    AreaLightSampler(const Scene& scene, const AreaLight& light);

    struct Sample {
        Vec3 position;
        Vec3 normal;   ///< unit, front side
        float offset;  ///< as AreaSampler::Sample::offset
        float weight;  ///< even density over this one's
    };
    /// Maps the unit square.
    Sample sample(float u0, float u1) const;

private:
    static constexpr std::size_t cells = 32;  ///< of the square along each side

    void weigh_triangles();
    void weigh_square();
    double light_sent(const Vec3& position, const Vec3& normal) const;
    Sample sample_triangles(float u0, float u1) const;
    Sample sample_square(float u0, float u1) const;

    const Shape& shape_;
    const AreaSampler& even_;
    std::vector<Box> casters_;
    std::vector<double> density_;     ///< of triangles or, row by row, cells, over the even one
    std::vector<double> cumulative_;  ///< of triangles or rows
    std::vector<std::vector<double>> row_cumulative_;
};

}  // namespace caustics::beamtree
