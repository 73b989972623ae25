#pragma once

#include <stdint.h>

namespace caustics::photonmap {

/// Two registers side by side, operation by operation: a long chain of operations waits half as long, since the
/// processor works at one register's while the other's is not done. The same bits as one after the other.
template <typename Lanes>
struct TwoOf {
    struct Floats {
        typename Lanes::Floats first, second;
    };
    struct Choice {
        typename Lanes::Choice first, second;
    };

    static Floats all(float value) { return {Lanes::all(value), Lanes::all(value)}; }
    static Floats add(Floats a, Floats b) {
        return {Lanes::add(a.first, b.first), Lanes::add(a.second, b.second)};
    }
    static Floats sub(Floats a, Floats b) {
        return {Lanes::sub(a.first, b.first), Lanes::sub(a.second, b.second)};
    }
    static Floats mul(Floats a, Floats b) {
        return {Lanes::mul(a.first, b.first), Lanes::mul(a.second, b.second)};
    }
    static Floats div(Floats a, Floats b) {
        return {Lanes::div(a.first, b.first), Lanes::div(a.second, b.second)};
    }
    static Floats max(Floats a, Floats b) {
        return {Lanes::max(a.first, b.first), Lanes::max(a.second, b.second)};
    }
    static uint32_t less(Floats a, Floats b) {
        return Lanes::less(a.first, b.first) | Lanes::less(a.second, b.second);
    }
    static Floats split(Floats a, Floats* mantissa) {
        return {Lanes::split(a.first, &mantissa->first), Lanes::split(a.second, &mantissa->second)};
    }
    static Floats times_power_of_2(Floats a, Floats shifted) {
        return {Lanes::times_power_of_2(a.first, shifted.first),
                Lanes::times_power_of_2(a.second, shifted.second)};
    }
    static Choice is_less(Floats a, Floats b) {
        return {Lanes::is_less(a.first, b.first), Lanes::is_less(a.second, b.second)};
    }
    static Choice is_equal(Floats a, Floats b) {
        return {Lanes::is_equal(a.first, b.first), Lanes::is_equal(a.second, b.second)};
    }
    static Floats chosen(Choice choice, Floats a, Floats b) {
        return {Lanes::chosen(choice.first, a.first, b.first),
                Lanes::chosen(choice.second, a.second, b.second)};
    }
};

}  // namespace caustics::photonmap
