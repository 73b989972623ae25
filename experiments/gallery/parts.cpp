#include "experiments/gallery/parts.h"

#include <fmt/format.h>

#include <cmath>

namespace caustics::experiments::gallery_parts {

Bsdf grey() { return {Diffuse{Spectrum(Spectrum::Constant(0.5F))}, false}; }

Bsdf mirror() { return {Conductor{Spectrum::Ones()}, true}; }

Bsdf glass(double ior, double absorption) {
    Dielectric glass;
    glass.int_ior = static_cast<float>(ior);
    glass.ext_ior = 1;
    glass.absorption = Spectrum::Constant(static_cast<float>(absorption));
    return {glass, false};
}

Shape rectangle(const std::string& name, const Vec3d& centre, const Vec3d& u, const Vec3d& v,
                const Bsdf& bsdf) {
    Shape shape;
    shape.name = name;
    shape.primitive = Primitive::rectangle;
    shape.to_world.linear() << u, v, u.cross(v).normalized();
    shape.to_world.translation() = centre;
    shape.bsdf = bsdf;
    return shape;
}

Shape square(const std::string& name, double z, double half, bool up, const Bsdf& bsdf) {
    return rectangle(name, {0, 0, z}, {half, 0, 0}, {0, up ? half : -half, 0}, bsdf);
}

Shape disk_facing_down(const std::string& name, double z, double radius, const Bsdf& bsdf) {
    Shape shape = square(name, z, radius, false, bsdf);
    shape.primitive = Primitive::disk;
    return shape;
}

Shape mesh(const std::string& name, TriangleMesh mesh, const Bsdf& bsdf) {
    Shape shape;
    shape.name = name;
    shape.primitive = Primitive::mesh;
    shape.mesh = std::move(mesh);
    shape.bsdf = bsdf;
    return shape;
}

PointLight point_light(const Vec3d& position, double intensity) {
    return {position.cast<float>(), Spectrum::Constant(static_cast<float>(intensity))};
}

DirectionalLight directional_light(const Vec3d& direction, double irradiance) {
    return {direction.normalized().cast<float>(),
            Spectrum::Constant(static_cast<float>(irradiance))};
}

TriangleMesh turned(const std::function<ProfilePoint(double)>& profile, int bands) {
    TriangleMesh mesh;
    const int sectors = 4 * bands;
    for (int band = 0; band <= bands; ++band) {
        const ProfilePoint at = profile(static_cast<double>(band) / bands);
        for (int sector = 0; sector < sectors; ++sector) {
            const double angle = 2 * pi_d * sector / sectors;
            const Vec3d out(std::cos(angle), std::sin(angle), 0);
            mesh.positions.emplace_back(
                Vec3d(at.radius * out + at.z * Vec3d::UnitZ()).cast<float>());
            mesh.normals.emplace_back(
                Vec3d(at.normal.x() * out + at.normal.y() * Vec3d::UnitZ()).cast<float>());
        }
    }
    const auto add = [&mesh](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        const Vec3 across =
            (mesh.positions[b] - mesh.positions[a]).cross(mesh.positions[c] - mesh.positions[a]);
        if (across.isZero(0)) return;  // at the axis
        if (across.dot(mesh.normals[a] + mesh.normals[b] + mesh.normals[c]) < 0) std::swap(b, c);
        mesh.triangles.push_back({a, b, c});
    };
    for (int band = 0; band < bands; ++band)
        for (int sector = 0; sector < sectors; ++sector) {
            const auto at = [&](int b, int s) {
                return static_cast<std::uint32_t>(b * sectors + s % sectors);
            };
            add(at(band, sector), at(band, sector + 1), at(band + 1, sector + 1));
            add(at(band, sector), at(band + 1, sector + 1), at(band + 1, sector));
        }
    return mesh;
}

TriangleMesh joined(TriangleMesh first, const TriangleMesh& second) {
    const auto offset = static_cast<std::uint32_t>(first.positions.size());
    first.positions.insert(first.positions.end(), second.positions.begin(), second.positions.end());
    first.normals.insert(first.normals.end(), second.normals.begin(), second.normals.end());
    for (const auto& [a, b, c] : second.triangles)
        first.triangles.push_back({a + offset, b + offset, c + offset});
    return first;
}

namespace {

// The R2 sequence: an even spread without a grid [Roberts 2018].
Vec2d even(int i) {
    return {std::fmod(0.5 + 0.7548776662466927 * i, 1.0),
            std::fmod(0.5 + 0.5698402909980532 * i, 1.0)};
}

std::vector<std::string> with(std::vector<std::string> parameters, const std::string& more) {
    if (!more.empty()) parameters.push_back(more);
    return parameters;
}

// Of meshes where a method takes them as they are: fine enough that none of its own error is theirs.
constexpr int fine = 128;

}  // namespace

std::vector<Vec2d> spread(int count, const Vec2d& centre, double half) {
    std::vector<Vec2d> points;
    for (int i = 0; i < count; ++i)
        points.emplace_back(centre + half * (2 * even(i) - Vec2d::Ones()));
    return points;
}

std::vector<Vec2d> spread_over_ring(int count, double inner, double outer) {
    std::vector<Vec2d> points;
    for (int i = 0; i < count; ++i) {
        const Vec2d u = even(i);
        const double r = std::sqrt(inner * inner + u.x() * (outer * outer - inner * inner));
        points.emplace_back(r * std::cos(2 * pi_d * u.y()), r * std::sin(2 * pi_d * u.y()));
    }
    return points;
}

std::vector<KnownPoint> known_on_ring(const Meridian& light, double z, bool up, double inner,
                                      double outer) {
    const Vec3d normal = up ? Vec3d::UnitZ() : Vec3d(-Vec3d::UnitZ());
    std::vector<KnownPoint> points;
    for (const Vec2d& p : spread_over_ring(asked, inner, outer))
        points.push_back({{p.x(), p.y(), z}, normal, Vec3d::Zero(), light.irradiance(p.norm())});
    return points;
}

Series light_trace(double radius, double tolerance, std::uint64_t paths) {
    Series series{"lighttrace", {}, 2, tolerance, radius, {}};
    for (int step = 0; step < 3; ++step, paths *= 4)
        series.efforts.push_back({fine, {fmt::format("paths={}", paths)}});
    return series;
}

Series path_trace(double tolerance, int paths) {
    Series series{"pathtrace", {}, 2, tolerance, 0, {}};
    for (int step = 0; step < 3; ++step, paths *= 4)
        series.efforts.push_back({fine, {fmt::format("spp={}", paths)}});
    return series;
}

// Of N photons an estimate scatters by 1 / sqrt(N - 2). Four times N of eight times as many photons
// are found in discs of half the area: scatter and blur both fall.
Series photon_map(double tolerance, const std::string& more, int photons, int nearest) {
    Series series{"photonmap", {}, 2, tolerance, 0, more};
    for (int step = 0; step < 3; ++step, photons *= 8, nearest *= 4)
        series.efforts.push_back(
            {fine,
             with({fmt::format("photons={}", photons), fmt::format("nearest={}", nearest)}, more)});
    return series;
}

Series beam_tree(double factor, double tolerance, const std::string& more, int coarsest) {
    Series series{"beamtree", {}, factor, tolerance, 0, more};
    for (const int n : {coarsest, 2 * coarsest, 4 * coarsest})
        series.efforts.push_back({n, with({fmt::format("mesh_resolution={}", n)}, more)});
    return series;
}

Series caustic_polygons(double factor, double tolerance, const std::string& more, int coarsest) {
    Series series = beam_tree(factor, tolerance, more, coarsest);
    series.method = "causticpolygons";
    return series;
}

std::vector<Series> usual_series(double radius, double beam_factor, double beam_tolerance,
                                 int coarsest) {
    return {
        light_trace(radius, 0.05), photon_map(0.08),
        beam_tree(beam_factor, beam_tolerance, "preset=chuang1995", coarsest),
        beam_tree(beam_factor, beam_tolerance, "intensity=area", coarsest),
        // Exact shapes and flat facets are right to rounding. The density of light that goes by a mesh's
        // interpolated normals is of first order, as their slope is.
        beam_tree(beam_factor, beam_tolerance / 3, "", coarsest),
        caustic_polygons(beam_factor, beam_tolerance, "", coarsest)};
}

}  // namespace caustics::experiments::gallery_parts
