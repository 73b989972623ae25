#pragma once

#include <array>
#include <cstdint>

namespace caustics {

/// Philox4x32-10, the counter-based generator of Salmon et al., "Parallel Random Numbers: As Easy
/// as 1, 2, 3" (SC'11): four random words as a pure function of a counter and a key.
std::array<std::uint32_t, 4> philox4x32(std::array<std::uint32_t, 4> counter,
                                        std::array<std::uint32_t, 2> key);

/// What a stream of random numbers is for; streams of different stages never coincide.
enum class Stage : std::uint32_t {
    eye = 1,
    photons = 2,
    light_trace = 3,
    path_trace = 4,
    shading = 5,
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
