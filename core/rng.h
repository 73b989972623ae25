#pragma once

#include <array>
#include <cstdint>

namespace caustics {

/// Philox4x32-10, the counter-based generator of Salmon et al., "Parallel Random Numbers: As Easy
/// as 1, 2, 3" (SC'11): four random words as a pure function of a counter and a key.
inline std::array<std::uint32_t, 4> philox4x32(std::array<std::uint32_t, 4> counter,
                                               std::array<std::uint32_t, 2> key) {
    constexpr std::uint64_t multiplier0 = 0xD2511F53U;
    constexpr std::uint64_t multiplier1 = 0xCD9E8D57U;
    constexpr std::uint32_t weyl0 = 0x9E3779B9U;
    constexpr std::uint32_t weyl1 = 0xBB67AE85U;
    for (int round = 0; round < 10; ++round) {
        const std::uint64_t product0 = multiplier0 * counter[0];
        const std::uint64_t product1 = multiplier1 * counter[2];
        counter = {static_cast<std::uint32_t>(product1 >> 32U) ^ counter[1] ^ key[0],
                   static_cast<std::uint32_t>(product1),
                   static_cast<std::uint32_t>(product0 >> 32U) ^ counter[3] ^ key[1],
                   static_cast<std::uint32_t>(product0)};
        key[0] += weyl0;
        key[1] += weyl1;
    }
    return counter;
}

/// What a stream of random numbers is for; streams of different stages never coincide.
enum class Stage : std::uint32_t {
    eye = 1,
    photons = 2,
    light_trace = 3,
    path_trace = 4,
    shading = 5,
    photon_pilot = 6,
    photon_choice = 7,
    beams = 8,
    illumination_map = 9,
    survey = 10,
    test = 100,
};

/// The random numbers of one path: f(seed, stage, path, dimension). Which thread draws them, and
/// in which order paths are traced, changes nothing.
class Rng {
public:
    Rng(std::uint64_t seed, Stage stage, std::uint64_t path)
        : key_{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32U)},
          counter_{0, static_cast<std::uint32_t>(stage), static_cast<std::uint32_t>(path),
                   static_cast<std::uint32_t>(path >> 32U)} {}

    /// Uniform in [0, 1), 24 bits.
    float next() { return static_cast<float>(next_word() >> 8U) * 0x1p-24F; }
    /// Uniform in [0, 1), 32 bits: for numbers that are split into cells before use.
    double next_fine() { return static_cast<double>(next_word()) * 0x1p-32; }
    std::uint32_t next_word() {
        if (used_ == 4) refill();
        return words_[used_++];
    }

private:
    void refill() {
        words_ = philox4x32(counter_, key_);
        ++counter_[0];
        used_ = 0;
    }

    std::array<std::uint32_t, 2> key_;
    std::array<std::uint32_t, 4> counter_;
    std::array<std::uint32_t, 4> words_{};
    unsigned used_ = 4;
};

}  // namespace caustics
