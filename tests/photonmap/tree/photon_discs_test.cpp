#include "photonmap/tree/photon_discs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "tests/photonmap/estimate_map.h"
#include "tests/support/statistics.h"

namespace caustics::photonmap {
namespace {

using test::floor_point;
using test::photon_at;
using test::store_of;

constexpr FilterKind filters[] = {FilterKind::none, FilterKind::cone, FilterKind::gaussian,
                                  FilterKind::epanechnikov};

RunOptions run(Isa isa, int threads = 1) {
    RunOptions options;
    options.isa = isa;
    options.threads = threads;
    return options;
}

/// Photons with their discs, and the estimate over them.
class DiscMap {
public:
    DiscMap(const std::vector<Photon>& photons, const DiscWidths& widths,
            FilterKind filter = FilterKind::none, const RunOptions& options = {})
        : estimate_({.limits = {}, .filter = {.kind = filter}}, options.isa),
          discs_(std::make_unique<PackedKdTree>(store_of(photons), options.isa, options.threads),
                 widths, static_cast<float>(CellKernel({.kind = filter}).reach()), options) {}

    std::vector<double> irradiance(const std::vector<ReceiverPoint>& points) const {
        std::vector<double> found(points.size());
        GatherScratch gather;
        EstimateScratch scratch;
        discs_.gather(points, {}, gather, [&](std::size_t i, const GatheredPhotons& near) {
            found[i] = static_cast<double>(estimate_.irradiance(points[i], near, scratch).mean());
        });
        return found;
    }
    double irradiance(const ReceiverPoint& point) const {
        return irradiance(std::vector{point})[0];
    }
    const PhotonDiscs& discs() const { return discs_; }

private:
    RadianceEstimate estimate_;
    PhotonDiscs discs_;
};

double square_of(float value) { return static_cast<double>(value) * static_cast<double>(value); }

/// The radius of each photon's disc, by looking at all photons.
std::vector<float> widths_by_scan(const std::vector<Photon>& photons, const DiscWidths& widths) {
    std::vector<float> found;
    for (const Photon& own : photons) {
        std::vector<float> distances;
        for (const Photon& other : photons) {
            const Vec3 way = position(other) - position(own);
            distances.push_back(way.x() * way.x() + way.y() * way.y() + way.z() * way.z());
        }
        std::ranges::sort(distances);
        found.push_back(widths.nearest < distances.size()
                            ? std::min(std::sqrt(distances[widths.nearest]), widths.max_radius)
                            : widths.max_radius);
    }
    return found;
}

std::vector<ReceiverPoint> points_at_random(std::size_t count, float width) {
    Rng rng(7, Stage::test, 1);
    std::vector<ReceiverPoint> points;
    for (std::size_t i = 0; i < count; ++i) {
        const float x = rng.next(), y = rng.next();
        points.push_back(floor_point({width * x, y, 0}));
    }
    return points;
}

TEST(PhotonDiscs, GivePhotonsDiscsUpToTheirNthNeighbourAndPointsTheSumOfThose) {
    const std::vector<Photon> photons = test::uniform_field(700, 3);
    for (const DiscWidths& widths :
         {DiscWidths{.nearest = 9, .max_radius = 1}, DiscWidths{.nearest = 40, .max_radius = 0.1F},
          DiscWidths{.nearest = 900, .max_radius = 0.2F}}) {
        const std::vector<float> radius = widths_by_scan(photons, widths);
        const DiscMap map(photons, widths);
        for (const ReceiverPoint& point : points_at_random(100, 1)) {
            double expected = 0;
            for (std::size_t i = 0; i < photons.size(); ++i)
                if ((position(photons[i]) - point.position).norm() < radius[i])
                    expected += 1 / (pi_d * square_of(radius[i]));
            EXPECT_NEAR(map.irradiance(point), expected, 1e-5 * expected);
        }
    }
}

TEST(PhotonDiscs, AreTheSameBitsOnEveryInstructionSetAndNumberOfThreads) {
    const std::vector<Photon> photons = test::uniform_field(5'000, 5, 2);
    std::vector<ReceiverPoint> points = points_at_random(500, 2);
    std::vector<PixelCell> cells(points.size(), PixelCell::square(Vec3d::UnitZ(), 0.03));
    for (std::size_t i = 0; i < points.size(); i += 2) points[i].cell = &cells[i];
    for (const FilterKind filter : filters) {
        const DiscWidths widths{.nearest = 20};
        const auto plain = DiscMap(photons, widths, filter, run(Isa::plain)).irradiance(points);
        for (const Isa isa : supported_isas())
            for (const int threads : {1, 3})
                EXPECT_EQ(DiscMap(photons, widths, filter, run(isa, threads)).irradiance(points),
                          plain);
    }
}

/// Mean over points in the middle of the unit square, each with the cell where there is one.
double mean_inside(const DiscMap& map, const PixelCell* cell) {
    std::vector<ReceiverPoint> points = test::square_grid(6);
    for (ReceiverPoint& point : points) {
        point.position = Vec3(0.3F, 0.3F, 0) + 0.4F * point.position;
        point.cell = cell;
    }
    double sum = 0;
    for (const double value : map.irradiance(points)) sum += value;
    return sum / static_cast<double>(points.size());
}

TEST(PhotonDiscs, AreUnbiasedInAUniformField) {
    constexpr std::size_t count = 2'000;
    const PixelCell cell = PixelCell::square(Vec3d::UnitZ(), 0.05);
    for (const FilterKind filter : filters)
        for (const std::size_t nearest : {3UL, 30UL}) {
            support::Moments at_points, on_cells;
            for (std::uint64_t seed = 1; seed <= 60; ++seed) {
                const DiscMap map(test::uniform_field(count, seed), {.nearest = nearest}, filter);
                at_points.add(mean_inside(map, nullptr) / count);
                on_cells.add(mean_inside(map, &cell) / count);
            }
            for (const support::Moments& found : {at_points, on_cells}) {
                EXPECT_NEAR(found.mean(), 1, 4 * found.standard_error());
                EXPECT_LT(found.standard_error(), 0.03);
            }
        }
}

/// Photons on [0, 1]^2 whose density along x goes as 2 x, or as 1 / (2 sqrt(x)): light beside a fold.
std::vector<Photon> uneven_field(std::size_t count, std::uint64_t seed, double power) {
    std::vector<Photon> photons = test::uniform_field(count, seed);
    for (Photon& photon : photons)
        photon.position[0] =
            static_cast<float>(std::pow(static_cast<double>(photon.position[0]), power));
    return photons;
}

// The discs' area goes as one over the density, so that the bias is of the fourth order of their width.
TEST(PhotonDiscs, FollowALinearField) {
    support::Moments found;
    for (std::uint64_t seed = 1; seed <= 200; ++seed) {
        const DiscMap map(uneven_field(4'000, seed, 0.5), {.nearest = 30},
                          FilterKind::epanechnikov);
        found.add(map.irradiance(floor_point({0.4F, 0.5F, 0})) / (4'000 * 0.8));
    }
    EXPECT_NEAR(found.mean(), 1, 4 * found.standard_error());
    EXPECT_LT(found.standard_error(), 0.02);
}

/// Over the flux of the photons: the integral over a plane, by the middles of a fine grid's squares that reaches
/// `beyond` the field.
template <typename Irradiance>
double integral(const Irradiance& irradiance, double photons, double beyond) {
    constexpr int side = 300;
    const double step = (1 + 2 * beyond) / side;
    std::vector<ReceiverPoint> points;
    for (int i = 0; i < side * side; ++i)
        points.push_back(floor_point(Vec3d(step * (i % side + 0.5) - beyond,
                                           step * (static_cast<double>(i / side) + 0.5) - beyond, 0)
                                         .cast<float>()));
    double sum = 0;
    for (const double value : irradiance(points)) sum += value;
    return sum * step * step / photons;
}

// Nearest N gives the dark a disc that reaches the bright line: the same photons then bring more than their light.
TEST(PhotonDiscs, KeepTheSumOfUnevenLightWhereNearestNDoesNot) {
    constexpr std::size_t count = 20'000;
    constexpr float far = 0.3F;
    const std::vector<Photon> photons = uneven_field(count, 11, 4);
    const test::EstimateMap nearest(photons);
    const auto by_nearest = [&](const std::vector<ReceiverPoint>& points) {
        std::vector<double> found;
        for (const Spectrum& value :
             nearest.irradiance({.limits = {.nearest = 50, .max_radius = far}}, points))
            found.push_back(static_cast<double>(value.mean()));
        return found;
    };
    EXPECT_GT(integral(by_nearest, count, static_cast<double>(far)), 1.03);
    for (const FilterKind filter : filters) {
        const DiscMap map(photons, {.nearest = 50, .max_radius = far}, filter);
        const auto by_discs = [&](const std::vector<ReceiverPoint>& points) {
            return map.irradiance(points);
        };
        // What is left is the grid's, whose squares are wider than some discs.
        EXPECT_NEAR(integral(by_discs, count, static_cast<double>(far)), 1, 0.01);
    }
}

/// Cells of a grid of parallelograms, and their points.
struct Cells {
    std::vector<PixelCell> cells;
    std::vector<ReceiverPoint> points;
    double area = 0;
};

Cells cells_over(const Vec2d& first, const Vec2d& second, int side) {
    Cells all;
    all.area = std::abs(first.x() * second.y() - first.y() * second.x());
    const PlaneAxes axes(Vec3d::UnitZ());
    for (int i = 0; i < side * side; ++i) {
        const Vec2d low = (i % side - side / 2) * first + (i / side - side / 2) * second;
        PixelCell cell = PixelCell::square(Vec3d::UnitZ(), 1);
        // The point lies somewhere in its cell.
        const Vec2d point = low + 0.3 * first + 0.8 * second;
        const Vec2d corners[4] = {low, low + first, low + first + second, low + second};
        cell.radius = 0;
        for (std::size_t corner = 0; corner < 4; ++corner) {
            const Vec2d way = corners[corner] - point;
            cell.corners[corner] = cell.along({way.x(), way.y(), 0});
            cell.radius = std::max(cell.radius, way.norm());
        }
        all.cells.push_back(cell);
        all.points.push_back(floor_point(Vec3d(point.x(), point.y(), 0).cast<float>()));
    }
    for (std::size_t i = 0; i < all.points.size(); ++i) all.points[i].cell = &all.cells[i];
    return all;
}

TEST(PhotonDiscs, ShareEachPhotonAmongCells) {
    std::vector<Photon> photons;
    for (const Vec3& x : {Vec3(0.013F, -0.02F, 0), Vec3(0.1F, 0.05F, 0), Vec3(0.1F, 0.06F, 0)})
        photons.push_back(photon_at(x));
    for (const FilterKind filter : filters)
        for (const float width : {1e-3F, 0.05F, 0.3F})
            for (const double slant : {0.0, 0.02, -0.04}) {
                const Cells all = cells_over({0.03, 0.002}, {slant, 0.02}, 60);
                const DiscMap map(photons, {.max_radius = width, .fixed = true}, filter);
                double sum = 0;
                for (const double value : map.irradiance(all.points)) sum += value * all.area;
                EXPECT_NEAR(sum, 3, 3e-5) << width << " " << slant;
            }
}

TEST(PhotonDiscs, CountPhotonsInCellsThatAreWideAgainstTheirDiscs) {
    const std::vector<Photon> photons = test::uniform_field(3'000, 9);
    const DiscMap map(photons, {.max_radius = 1e-5F, .fixed = true});
    const Cells all = cells_over({0.05, 0}, {0, 0.04}, 60);
    const auto found = map.irradiance(all.points);
    for (std::size_t i = 0; i < all.points.size(); ++i) {
        const Vec3 low = all.points[i].position - Vec3(0.3F * 0.05F, 0.8F * 0.04F, 0);
        const auto inside = std::ranges::count_if(photons, [&](const Photon& photon) {
            const Vec3 way = position(photon) - low;
            return way.x() > 0 && way.x() < 0.05F && way.y() > 0 && way.y() < 0.04F;
        });
        // A disc may lie across a side.
        EXPECT_NEAR(found[i] * all.area, static_cast<double>(inside), 1.01);
    }
}

TEST(PhotonDiscs, LeaveOutPhotonsOfSurfacesThatFaceElsewhere) {
    std::vector<Photon> photons = test::uniform_field(2'000, 4);
    const float up[3] = {0, 0, 1}, aside[3] = {1, 0, 0};
    const DirectionCode slanted = encode_direction(Vec3(1, 0, 1).normalized());
    for (Photon& photon : photons) {
        photon.flags = facing_flags(up);
        photon.theta = slanted.theta;
        photon.phi = slanted.phi;
    }
    const DiscMap floor(photons, {.nearest = 30});
    // A wall's photons through the same places change neither the floor's widths nor its light.
    for (std::size_t i = 0; i < 2'000; ++i) {
        Photon other = photons[i];
        other.position[2] += 1e-4F;
        other.flags = facing_flags(aside);
        photons.push_back(other);
    }
    const DiscMap both(photons, {.nearest = 30});
    const auto points = points_at_random(100, 1);
    const auto alone = floor.irradiance(points), among = both.irradiance(points);
    for (std::size_t i = 0; i < points.size(); ++i)
        EXPECT_NEAR(among[i], alone[i], 1e-6 * alone[i]);
}

/// Mean over a rectangle of a field of density 1.
template <typename Irradiance>
double mean_over(const Irradiance& irradiance, const Vec2d& low, const Vec2d& size) {
    std::vector<ReceiverPoint> points;
    for (const ReceiverPoint& point : test::square_grid(60)) {
        const Vec2d at = low + size.cwiseProduct(point.position.head<2>().cast<double>());
        points.push_back(floor_point(Vec3d(at.x(), at.y(), 0).cast<float>()));
    }
    double sum = 0;
    for (const double value : irradiance(points)) sum += value;
    return sum / static_cast<double>(points.size());
}

// Photons know no edge, and discs of photons there are wider: some of their light falls beside the receiver. A strip
// inside a straight edge, as wide as discs are elsewhere, keeps 0.79 of its light, a square of that side in a corner
// 0.50.
TEST(PhotonDiscs, LoseAKnownShareAtAReceiversEdgeAndCorner) {
    constexpr std::size_t count = 20'000, nearest = 50;
    const double r = std::sqrt(nearest / (pi_d * count));
    support::Moments edge, corner, inside;
    for (std::uint64_t seed = 1; seed <= 12; ++seed) {
        const DiscMap map(test::uniform_field(count, seed), {.nearest = nearest},
                          FilterKind::epanechnikov);
        const auto light = [&](const std::vector<ReceiverPoint>& points) {
            return map.irradiance(points);
        };
        for (const double x : {0.0, 1 - r}) {
            edge.add(mean_over(light, {x, 0.1}, {r, 0.8}) / count);
            edge.add(mean_over(light, {0.1, x}, {0.8, r}) / count);
            for (const double y : {0.0, 1 - r})
                corner.add(mean_over(light, {x, y}, {r, r}) / count);
        }
        inside.add(mean_over(light, {0.2, 0.2}, {0.6, 0.6}) / count);
    }
    EXPECT_NEAR(edge.mean(), 0.79, 0.01 + 4 * edge.standard_error());
    EXPECT_NEAR(corner.mean(), 0.50, 0.02 + 4 * corner.standard_error());
    EXPECT_NEAR(inside.mean(), 1, 4 * inside.standard_error());
}

TEST(PhotonDiscs, AnswerWithoutPhotonsAndAtPerfectFoci) {
    EXPECT_EQ(DiscMap({}, {}).irradiance(floor_point({0, 0, 0})), 0);
    const std::vector<Photon> focus(200, photon_at({1, 1, 0}));
    const DiscMap map(focus, {.nearest = 10});
    const double most = map.irradiance(floor_point({1, 1, 0}));
    EXPECT_TRUE(std::isfinite(most));
    EXPECT_GT(most, 1e12);
    EXPECT_EQ(map.irradiance(floor_point({1.01F, 1, 0})), 0);
    const PixelCell cell = PixelCell::square(Vec3d::UnitZ(), 0.1);
    ReceiverPoint point = floor_point({1.01F, 1, 0});
    point.cell = &cell;
    EXPECT_NEAR(map.irradiance(point), 200 / square_of(0.1F), 1e-3 * 200 / square_of(0.1F));
}

}  // namespace
}  // namespace caustics::photonmap
