#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "beamtree/beams/lit_caster.h"
#include "beamtree/tracing/beam_path.h"

namespace caustics::beamtree {

/// How well drifts tell where light of a wavelength goes.
struct DriftAccount {
    double rays = 0;
    double unknown = 0;  ///< of them: at neither end of the bin do they go the beam's way
    /// How far the direction at the bin's middle is from the mean of those at its ends, at most [rad].
    double bend = 0;

    void add(const DriftAccount& other);
};

/// Finds how the rays of a set move with the wavelength (BeamSet::ends): each is sent again, from its place on
/// the first surface and along its beam's way, at both ends of the light's bin. Where at one end it
/// meets another piece of a surface, the other end decides; where both do, the other corners of a beam.
class BeamDrift {
public:
    /// All outlive this.
    BeamDrift(const Scene& scene, const CasterMesh& caster, const LightSample& light);
    BeamDrift(const BeamDrift&) = delete;
    BeamDrift& operator=(const BeamDrift&) = delete;

    /// Of the rays of the beams that are kept.
    DriftAccount add_to(Level& level, const std::vector<bool>& kept) const;

private:
    enum class Known : std::uint8_t { not_asked, yes, no, guessed };
    // How rays move that go no way at either end; returns their number.
    static double guess(BeamSet& set, const Beam& beam, std::vector<Known>& known);

    const Scene& scene_;
    std::array<LightSample, 2> lights_;  ///< at the ends of the bin
    std::array<LitCaster, 2> ends_;
};

}  // namespace caustics::beamtree
