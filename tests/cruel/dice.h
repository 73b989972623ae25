#pragma once

#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <iterator>

#include "core/math/rng.h"

namespace caustics::cruel {

/// Random choices by one number, the same on every machine.
class Dice {
public:
    explicit Dice(std::uint64_t seed) : rng_(seed, Stage::test, 0) {}

    /// Even in [low, high), with three digits, so that a scene's file stays legible.
    double number(double low, double high) {
        const double digits = std::pow(10, 2 - std::floor(std::log10(high - low)));
        return std::round((low + (high - low) * rng_.next_fine()) * digits) / digits;
    }
    /// A whole number from low to high.
    int whole(int low, int high) {
        return low + static_cast<int>((high - low + 1) * rng_.next_fine());
    }
    bool chance(double share) { return rng_.next_fine() < share; }
    template <class Item>
    Item pick(std::initializer_list<Item> items) {
        return *std::next(items.begin(), whole(0, static_cast<int>(items.size()) - 1));
    }

private:
    Rng rng_;
};

}  // namespace caustics::cruel
