#include "core/geometry/heightfield.h"

#include <cmath>

namespace caustics {

double SineHeightfield::height(const Vec2d& xy) const {
    double sum = 0;
    for (const SineWave& wave : waves)
        sum += wave.amplitude * std::sin(wave.wave_vector.dot(xy) + wave.phase);
    return sum;
}

Vec2d SineHeightfield::gradient(const Vec2d& xy) const {
    Vec2d sum = Vec2d::Zero();
    for (const SineWave& wave : waves)
        sum += wave.amplitude * std::cos(wave.wave_vector.dot(xy) + wave.phase) * wave.wave_vector;
    return sum;
}

Vec3d SineHeightfield::normal(const Vec2d& xy) const {
    const Vec2d slope = gradient(xy);
    return Vec3d(-slope.x(), -slope.y(), 1).normalized();
}

double SineHeightfield::max_height() const {
    double sum = 0;
    for (const SineWave& wave : waves) sum += std::abs(wave.amplitude);
    return sum;
}

double SineHeightfield::max_curvature() const {
    double sum = 0;
    for (const SineWave& wave : waves)
        sum += std::abs(wave.amplitude) * wave.wave_vector.squaredNorm();
    return sum;
}

}  // namespace caustics
