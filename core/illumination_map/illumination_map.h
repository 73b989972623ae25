#pragma once

#include <cstdint>
#include <memory>

#include "core/caustic_estimator.h"
#include "core/light_path/bounce_limit.h"
#include "core/method/described_method.h"

namespace caustics {

/// `illuminationmap` [Arvo 1986, "Backward ray tracing"]: light traced through the casters onto a grid
/// of texels over each receiver's texture coordinates, shared bilinearly among the four nearest, and
/// read bilinearly at render time. Row J15.
///
/// A texel's irradiance is its flux over the area that it stands for (texel_area.h): so a uniform
/// field is read without bias, edges and poles included, and the flux that is read is the flux that
/// arrived. The grid blurs; directions are forgotten, so receivers must be diffuse. Each side of
/// a surface has texels of its own.
struct IlluminationMapParams {
    std::uint64_t emitted = 1'000'000;  ///< light paths, thinned ones included
    int resolution = 256;               ///< texels along each texture coordinate
    int max_bounces = most_bounces;     ///< specular events between light and receiver
    /// Receivers are only looked at, to tell whether they can be served: no parameter.
    bool only_checked = false;
};
const DescribedMethod<IlluminationMapParams>& illuminationmap_method();

/// Phases "texels" and "trace". Counters: those of LightPathCounts and `texels`. Throws
/// UnsupportedScene naming the receiver that is not diffuse or has no texture coordinates to use.
std::unique_ptr<const CausticEstimator> build(const Scene&, const IlluminationMapParams&,
                                              const RunOptions&);

}  // namespace caustics
