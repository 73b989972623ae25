#pragma once

#include <array>
#include <string>

#include "core/math/vec.h"
#include "core/render/film.h"

namespace caustics {

/// What the samples of one pixel add up to.
struct PixelSums {
    SpectrumSum direct = SpectrumSum::Zero();
    SpectrumSum emitted = SpectrumSum::Zero();
    SpectrumSum ambient = SpectrumSum::Zero();
    SpectrumSum caustic = SpectrumSum::Zero();
    SpectrumSum caustic_squares = SpectrumSum::Zero();
    SpectrumSum own_variance = SpectrumSum::Zero();  ///< as the method reports it of each sample
    SpectrumSum indirect = SpectrumSum::Zero();
    SpectrumSum indirect_squares = SpectrumSum::Zero();
    SpectrumSum indirect_own_variance = SpectrumSum::Zero();
    SpectrumSum beauty_squares = SpectrumSum::Zero();
    SpectrumSum albedo = SpectrumSum::Zero();
    Vec3d normal = Vec3d::Zero();
    double depth = 0;
    int hits = 0;
    int through_caster = 0;
    int samples = 0;

    SpectrumSum beauty() const { return direct + emitted + caustic + ambient + indirect; }
    /// Variance of a pixel's mean from its samples' scatter; 0 for a single sample.
    SpectrumSum variance_of_mean(const SpectrumSum& sum, const SpectrumSum& squares) const;
};

/// The planes of the eye pass in a film, and how a pixel's sums become their values.
class FilmLayers {
public:
    struct Extra {
        bool unreached = false;       ///< share of samples that see a caster first
        bool standard_error = false;  ///< of the caustic layer
        bool samples = false;         ///< number of samples
        bool ambient = false;         ///< of a scene with ambient light
        bool indirect = false;        ///< light between diffuse surfaces
        bool indirect_error = false;  ///< standard error of that layer
    };

    /// Makes the planes, black. `film` outlives this.
    FilmLayers(Film& film, const Extra& extra);

    /// Throws std::runtime_error naming pixel and layer for a value that is not finite.
    void write(std::size_t pixel, const PixelSums& sums);
    /// A caustic that was not sampled pixel by pixel. Throws as write().
    void write_caustic(std::size_t pixel, const Spectrum& radiance, const Spectrum& standard_error);
    /// The same of indirect light.
    void write_indirect(std::size_t pixel, const Spectrum& radiance,
                        const Spectrum& standard_error);
    /// Beauty: the sum of the layers.
    void sum_beauty();

private:
    struct Layer {
        std::string name;
        std::array<float*, 3> planes;
    };
    Layer rgb(const std::string& name);
    void put(const Layer& layer, std::size_t pixel, const SpectrumSum& value) const;

    Film& film_;
    Layer beauty_, direct_, specular_, caustic_, albedo_, standard_error_, ambient_, indirect_,
        indirect_error_;
    std::array<float*, 3> normal_;
    float* depth_;
    float* unreached_ = nullptr;
    float* samples_ = nullptr;
};

}  // namespace caustics
