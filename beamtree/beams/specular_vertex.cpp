#include "beamtree/beams/specular_vertex.h"

#include <algorithm>
#include <cmath>

#include "core/material/optics.h"

namespace caustics::beamtree {

MeshPoint LightBender::at(const Vec3& position, const Vec3& normal) const {
    MeshPoint point{position, normal.squaredNorm() > 0 ? Vec3(normal.normalized()) : normal, {}};
    const Vec3& n = point.normal;
    const Vec3 w = to_light(light_, position);
    if (w.isZero(0) || n.isZero(0)) return point;
    point.bent = along(n, w, distance_from(light_, position));
    return point;
}

SpecularVertex LightBender::along(const Vec3& normal, const Vec3& to_light, float distance) const {
    SpecularVertex bent;
    bent.front = normal.dot(to_light) > 0;
    const SpecularSplit split = split_specular(bsdf_, normal, normal, to_light, light_.bin.nm);
    const Spectrum strength = arriving(normal, to_light, distance);
    bent.direction = {split.reflected, split.refracted};
    bent.weight = {split.reflected_weight * strength, split.refracted_weight * strength};
    return bent;
}

Spectrum LightBender::arriving(const Vec3& normal, const Vec3& to_light, float distance) const {
    const Spectrum* const medium = medium_absorption(bsdf_, normal, to_light);
    return strength_along(light_, to_light) *
           segment_transmittance(light_.medium, medium, distance);
}

const Spectrum* LightBender::medium_after(const Vec3& normal, const Vec3& direction) const {
    return caustics::medium_after(bsdf_, normal, direction, light_.medium);
}

MeshPoint LightBender::between(const MeshPoint& a, const MeshPoint& b, float t) const {
    return at((1 - t) * a.position + t * b.position, (1 - t) * a.normal + t * b.normal);
}

MeshPoint LightBender::inside(const MeshPiece& piece, const Vec3& weights) const {
    Vec3 position = Vec3::Zero();
    Vec3 normal = Vec3::Zero();
    for (std::size_t i = 0; i < 3; ++i) {
        const float weight = weights[static_cast<Eigen::Index>(i)];
        position += weight * piece[i].position;
        normal += weight * piece[i].normal;
    }
    return at(position, normal);
}

MeshPoint LightBender::nearest_to_light(const MeshPiece& piece) const {
    Vec3 weights = Vec3::Constant(1.0F / 3);
    if (light_.kind != LightSample::Kind::directional) {
        const Vec3& a = piece[0].position;
        Vec3 b = piece[1].position - a;
        Vec3 c = piece[2].position - a;
        Vec3 w = light_.position - a;
        // By a power of two, which changes no digit: squares of areas of 1e-10 m or 1e10 m are no floats.
        const float unit =
            std::exp2(-std::floor(std::log2(b.cwiseAbs().cwiseMax(c.cwiseAbs()).maxCoeff())));
        for (Vec3* const each : {&b, &c, &w}) *each *= unit;
        const Vec3 normal = b.cross(c);
        const float area2 = normal.squaredNorm();
        if (area2 > 0) {
            weights.y() = w.cross(c).dot(normal) / area2;
            weights.z() = b.cross(w).dot(normal) / area2;
            weights.x() = 1 - weights.y() - weights.z();
            weights = weights.cwiseMax(0);
            weights /= weights.sum();
        }
    }
    return inside(piece, weights);
}

Spectrum LightBender::flux(const PieceCorners& corners, Event event) const {
    const MeshPoint& a = *corners[0];
    const MeshPoint& b = *corners[1];
    const MeshPoint& c = *corners[2];
    if (!weights_differ(corners, event))
        return (a.bent.weight[event] + b.bent.weight[event] + c.bent.weight[event]) *
               static_cast<float>(measure(light_, a.position, b.position, c.position) / 3);
    const MeshPiece piece = {a, b, c};
    const auto at = [&](const Vec3& l) -> Vec3 {
        return l[0] * a.position + l[1] * b.position + l[2] * c.position;
    };
    const auto part = [&](const Vec3& u, const Vec3& v, const Vec3& w) -> Spectrum {
        return inside(piece, (u + v + w) / 3).bent.weight[event] *
               static_cast<float>(measure(light_, at(u), at(v), at(w)));
    };
    constexpr int n = 8;
    const auto corner = [](int i, int j) -> Vec3 {
        const Vec2 share(static_cast<float>(i) / n, static_cast<float>(j) / n);
        return {1 - share.x() - share.y(), share.x(), share.y()};
    };
    Spectrum sum = black();
    for (int i = 0; i < n; ++i)
        for (int j = 0; i + j < n; ++j) {
            sum += part(corner(i, j), corner(i + 1, j), corner(i, j + 1));
            if (i + j + 2 <= n)
                sum += part(corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1));
        }
    return sum;
}

bool weights_differ(const std::array<float, 3>& weights) {
    const auto [least, most] = std::minmax({weights[0], weights[1], weights[2]});
    return most > 1.5F * least;
}

bool weights_differ(const PieceCorners& corners, Event event) {
    const auto weight = [&](std::size_t i) { return corners[i]->bent.weight[event].mean(); };
    return weights_differ({weight(0), weight(1), weight(2)});
}

}  // namespace caustics::beamtree
