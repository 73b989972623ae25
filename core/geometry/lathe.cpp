#include "core/geometry/lathe.h"

#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/mesh/exact_positions.h"
#include "core/mesh/mesh_rows.h"

namespace caustics {
namespace {

// As of the other shapes (tessellate.cpp).
constexpr int most_sectors = 16384;

// A vertex whose position is exact until the mesh is complete.
std::uint32_t add_exact_vertex(TriangleMesh& mesh, const Vec3d& position, const Vec3d& normal,
                               const Vec2d& uv) {
    mesh.exact_positions.push_back(position);
    return add_vertex(mesh, position, normal, uv);
}

bool on_axis(const ProfileStation& station) { return station.at.x() == 0; }

// A ring of vertices; the last one is the first again.
std::uint32_t add_ring(TriangleMesh& mesh, const ProfileStation& station, const Vec2d& normal,
                       int sectors) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (int sector = 0; sector <= sectors; ++sector) {
        const Vec2d way = on_circle(sector, sectors);
        const Vec2d xy = station.at.x() * way;
        add_exact_vertex(mesh, {xy.x(), xy.y(), station.at.y()},
                         {normal.x() * way.x(), normal.x() * way.y(), normal.y()},
                         {fraction(sector, sectors), station.v});
    }
    return first;
}

// The sector's copy of a pole; at a cone's tip its normal leans to the sector's middle.
std::uint32_t add_pole(TriangleMesh& mesh, const ProfileStation& station, const Vec2d& normal,
                       double u) {
    const double angle = 2 * pi_d * u;
    return add_exact_vertex(
        mesh, {0, 0, station.at.y()},
        {normal.x() * std::cos(angle), normal.x() * std::sin(angle), normal.y()}, {u, station.v});
}

// The rings of the band that follows a station and of the one before it.
struct Rings {
    std::uint32_t before = 0, after = 0;
};

std::vector<Rings> add_rings(TriangleMesh& mesh, const std::vector<ProfileStation>& stations,
                             int sectors) {
    std::vector<Rings> rings(stations.size());
    for (std::size_t i = 0; i < stations.size(); ++i) {
        const ProfileStation& station = stations[i];
        if (on_axis(station)) continue;
        const bool first = i == 0;
        const bool last = i + 1 == stations.size();
        if (!first) rings[i].before = add_ring(mesh, station, station.normal_before, sectors);
        const bool shared = !first && station.normal_before == station.normal_after;
        if (shared || last)
            rings[i].after = rings[i].before;
        else
            rings[i].after = add_ring(mesh, station, station.normal_after, sectors);
    }
    return rings;
}

}  // namespace

TriangleMesh tessellate_lathe(const LatheProfile& profile, int sectors) {
    if (sectors < 3 || sectors > most_sectors)
        throw InputError(fmt::format("{} sectors are not in [3, {}]", sectors, most_sectors));
    const std::vector<ProfileStation> stations = profile_stations(profile);
    TriangleMesh mesh;
    const std::vector<Rings> rings = add_rings(mesh, stations, sectors);
    const bool south = on_axis(stations.front());
    const bool north = on_axis(stations.back());
    if (south)
        add_fan(mesh, rings[1].before, sectors, false, [&](double u) {
            return add_pole(mesh, stations.front(), stations.front().normal_after, u);
        });
    const std::size_t begin = south ? 1 : 0;
    const std::size_t end = stations.size() - (north ? 2 : 1);
    add_patch(mesh, sectors, static_cast<int>(end) - static_cast<int>(begin), 2);
    for (std::size_t i = begin; i < end; ++i)
        add_row_triangles(mesh, rings[i].after, rings[i + 1].before, sectors);
    if (north)
        add_fan(mesh, rings[stations.size() - 2].after, sectors, true, [&](double u) {
            return add_pole(mesh, stations.back(), stations.back().normal_before, u);
        });
    set_positions(mesh, std::move(mesh.exact_positions));
    return mesh;
}

}  // namespace caustics
