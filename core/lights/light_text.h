#pragma once

#include <fmt/format.h>

#include <string>

#include "core/math/spectrum.h"
#include "core/math/vec.h"

namespace caustics {

/// Numbers of a light as `info` prints them.

inline std::string rgb(const Spectrum& s) {
    return fmt::format("{:.6g} {:.6g} {:.6g}", s[0], s[1], s[2]);
}

template <class Vector>
std::string in_brackets(const Vector& v) {
    return fmt::format("({:.6g}, {:.6g}, {:.6g})", v.x(), v.y(), v.z());
}

}  // namespace caustics
