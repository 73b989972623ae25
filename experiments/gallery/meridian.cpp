#include "experiments/gallery/meridian.h"

#include <cmath>

namespace caustics::experiments {

double Meridian::density(double wanted) const {
    constexpr int steps = 2000;
    const double step = (last - first) / steps;
    const double h = 0.01 * step;
    const auto radius = [this](double u) { return land(u)->radius; };
    double sum = 0;
    for (int i = 0; i < steps; ++i) {
        double low = first + i * step, high = low + step;
        const auto a = land(low), b = land(high);
        if (!a || !b || (a->radius < wanted) == (b->radius < wanted)) continue;
        const bool rises = a->radius < wanted;
        for (int round = 0; round < 60; ++round) {
            const double middle = (low + high) / 2;
            ((radius(middle) < wanted) == rises ? low : high) = middle;
        }
        const double u = (low + high) / 2;
        const double slope =
            (8 * (radius(u + h) - radius(u - h)) - (radius(u + 2 * h) - radius(u - 2 * h))) /
            (12 * h);
        sum += flux(u) * land(u)->share / std::abs(slope);
    }
    return sum;
}

double Meridian::irradiance(double r) const { return (density(r) + density(-r)) / (2 * pi_d * r); }

bool PlaneRay::reach_plane(double z) {
    const double t = (z - origin.y()) / direction.y();
    origin += t * direction;
    return t > 0;
}

bool PlaneRay::reach_circle(double z, double radius, bool nearer) {
    const Vec2d from = origin - Vec2d(0, z);
    const double b = from.dot(direction);
    const double square = b * b - from.squaredNorm() + radius * radius;
    if (square < 0) return false;
    origin += (-b + (nearer ? -std::sqrt(square) : std::sqrt(square))) * direction;
    return true;
}

bool PlaneRay::refract(const Vec2d& normal, double n) {
    const Vec2d against = direction.dot(normal) < 0 ? normal : Vec2d(-normal);
    const double cos_i = -direction.dot(against);
    const double sin2 = (1 - cos_i * cos_i) / (n * n);
    if (sin2 >= 1) return false;
    share *= 1 - fresnel_reflectance(cos_i, n);
    direction = direction / n + (cos_i / n - std::sqrt(1 - sin2)) * against;
    return true;
}

double fresnel_reflectance(double cos_i, double n) {
    const double sin2 = (1 - cos_i * cos_i) / (n * n);
    if (sin2 >= 1) return 1;
    const double cos_t = std::sqrt(1 - sin2);
    const double s = (cos_i - n * cos_t) / (cos_i + n * cos_t);
    const double p = (n * cos_i - cos_t) / (n * cos_i + cos_t);
    return (s * s + p * p) / 2;
}

}  // namespace caustics::experiments
