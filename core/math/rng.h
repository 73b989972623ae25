#pragma once

#include <array>
#include <cstdint>

#include "core/math/philox.h"

namespace caustics {

/// The four random words of a counter and a key.
inline std::array<std::uint32_t, 4> philox4x32(const std::array<std::uint32_t, 4>& counter,
                                               const std::array<std::uint32_t, 2>& key) {
    std::uint32_t words[4] = {counter[0], counter[1], counter[2], counter[3]};
    philox4x32(words, key[0], key[1]);
    return {words[0], words[1], words[2], words[3]};
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
    wavelength = 11,
    global_photons = 12,
    global_pilot = 13,
    final_gather = 14,
    indirect_light_trace = 15,
    indirect_path_trace = 16,
    shadow_photons = 17,
    pencils = 18,
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
    /// The same stream after `used` of its first four words, which are known already.
    Rng(std::uint64_t seed, Stage stage, std::uint64_t path,
        const std::array<std::uint32_t, 4>& first_words, unsigned used)
        : Rng(seed, stage, path) {
        counter_[0] = 1;
        words_ = first_words;
        used_ = used;
    }
    /// The same with other words in place of its first eight.
    Rng(std::uint64_t seed, Stage stage, std::uint64_t path,
        const std::array<std::uint32_t, 4>& first_words,
        const std::array<std::uint32_t, 4>& next_words, unsigned used)
        : Rng(seed, stage, path, first_words, used) {
        next_words_ = next_words;
        has_next_words_ = true;
    }

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
        words_ = has_next_words_ ? next_words_ : philox4x32(counter_, key_);
        has_next_words_ = false;
        ++counter_[0];
        used_ = 0;
    }

    std::array<std::uint32_t, 2> key_;
    std::array<std::uint32_t, 4> counter_;
    std::array<std::uint32_t, 4> words_{};
    std::array<std::uint32_t, 4> next_words_{};
    unsigned used_ = 4;
    bool has_next_words_ = false;
};

}  // namespace caustics
