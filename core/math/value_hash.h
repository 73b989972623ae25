#pragma once

#include <type_traits>
#include <vector>

#include "core/base/hash.h"
#include "core/math/spectrum.h"
#include "core/math/vec.h"

namespace caustics {

/// The hash of values added one after another, by their bytes.
class ValueHash {
public:
    /// A value without padding.
    template <typename T>
    void add(const T& value) {
        static_assert(std::is_arithmetic_v<T> || std::is_enum_v<T>);
        add_bytes(&value, sizeof(value));
    }
    template <typename Scalar, int rows, int columns>
    void add(const Eigen::Matrix<Scalar, rows, columns>& m) {
        add_bytes(m.data(), sizeof(Scalar) * static_cast<std::size_t>(m.size()));
    }
    void add(const Spectrum& s) { add_bytes(s.data(), 3 * sizeof(float)); }
    /// A list of plain values without padding.
    template <typename T>
    void add(const std::vector<T>& list) {
        static_assert(sizeof(Vec3) == 3 * sizeof(float));
        add(list.size());
        add_bytes(list.data(), list.size() * sizeof(T));
    }
    std::uint64_t value() const { return state_; }

private:
    void add_bytes(const void* data, std::size_t size) {
        state_ = fnv1a({static_cast<const char*>(data), size}, state_);
    }
    std::uint64_t state_ = fnv1a("");
};

}  // namespace caustics
