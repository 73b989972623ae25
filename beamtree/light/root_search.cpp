#include "beamtree/light/root_search.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Eigenvalues>

#include "beamtree/light/resolvable_area.h"

namespace caustics::beamtree {
namespace {

constexpr int most_steps = 14;
constexpr int most_returns = 3;         // into the polygon
constexpr int most_steps_in_part = 40;  // of a polygon with a dark part
constexpr double longest_step = 0.5;    // of the polygon's sides
constexpr double last_step = 2e-7;      // of Newton's method, barycentric
constexpr double farthest_out = -1;     // barycentric, of a step
// How near to the point a ray has to come, for the length of its way.
constexpr double miss_tolerance = 1e-10;
constexpr double double_rounding = 4 * std::numeric_limits<double>::epsilon();
// Barycentric coordinates beyond an edge that still count: vertices are rounded to float, and an edge may be shared by
// polygons that are divided differently. Both neighbours find such a root, and BeamLight counts it once.
constexpr double edge_width = 1e-6;
constexpr double same_root = 1e-5;  // barycentric distance
const Vec2d middle(1.0 / 3, 1.0 / 3);

// The nearest place of the polygon that is off its edges.
Vec2d just_inside(const Vec2d& at) {
    constexpr double inset = 1e-5;
    const Vec3d weights = Vec3d(1 - at.x() - at.y(), at.x(), at.y()).cwiseMax(0);
    return (1 - inset) * weights.tail<2>() / weights.sum() + Vec2d::Constant(inset / 3);
}

}  // namespace

RootSearch::RootSearch(const Scene& scene, const BeamSet& set)
    : scene_(scene),
      set_(set),
      chain_(scene, set),
      exact_(first_exact_surface(scene, set)),
      meets_mesh_(meets_mesh_after_first(scene, set)) {}

/// A triangle of a beam, as a point sees it.
struct RootSearch::Image {
    const FirstPolygon& polygon;
    const ArrivalPlane& plane;
    const ImageModel& model;
    bool has_dark_part;
    double beyond;  ///< Beam::beyond

    // A ray that starts beside the polygon belongs to another one.
    bool holds(const Vec2d& at) const { return least_weight(at, beyond) >= -edge_width; }
    // True where Newton's method, of which a step of this length led here, ends beside the polygon.
    bool is_left(const Vec2d& at, double step) const {
        constexpr double longest = 0.1;
        constexpr double most_steps_left = 4;
        return step < longest && least_weight(at, beyond) < -most_steps_left * step - edge_width;
    }
};

bool RootSearch::find(std::uint32_t number, std::size_t triangle, const Vec3& point,
                      std::vector<Root>& roots) const {
    const Beam& beam = set_.beams[number];
    const auto corners = set_.triangle(beam, triangle);
    const auto plane = ArrivalPlane::at(point, corners);
    if (!plane) return true;
    const auto model =
        ImageModel::of(*plane, corners, set_.middles_of(number, triangle), beam.has_dark_part);
    if (!model) return true;
    const FirstPolygon polygon(scene_, set_, exact_, beam, triangle);
    const Image image{polygon, *plane, *model, beam.has_dark_part, beam.share_beyond()};
    ImageModel::Solutions known;
    bool is_any_inside = false;
    const auto look_from = [&](const Vec2d& from) -> std::optional<Found> {
        const auto found = polish(image, from);
        if (!found || known.count == known.at.size()) return {};
        const bool is_known = std::any_of(known.begin(), known.end(), [&](const Vec2d& other) {
            return (other - found->at).norm() <= same_root;
        });
        if (is_known) return {};
        known.at[known.count++] = found->at;
        if (image.holds(found->at)) {
            is_any_inside = true;
            add(polygon, *found, roots);
        }
        return found;
    };
    // The model of a polygon with a dark part is rough.
    const ImageModel::Solutions starts =
        beam.has_dark_part ? ImageModel::everywhere() : model->solutions();
    const auto look_round = [&](const Vec2d& from) {
        const auto found = look_from(from);
        if (!found) return;
        if (!model->is_uneven() && !model->is_beside_fold(found->change.determinant())) return;
        const Partners others = partners(image, *found);
        bool is_alone = true;
        for (std::size_t i = 0; i < others.count; ++i)
            if (const auto other = look_from(others.at[i]); other && image.holds(other->at))
                is_alone = false;
        if (is_alone) look_from(middle);
    };
    for (const Vec2d& from : starts) look_round(from);
    if (beam.has_dark_part) return true;
    if (!is_any_inside && model->is_uneven()) look_round(middle);
    if (!is_any_inside && model->folds())
        for (const Vec2d& from : ImageModel::everywhere()) look_round(from);
    return is_any_inside || !model->surely_holds();
}

std::optional<RootSearch::Found> RootSearch::polish(const Image& image, Vec2d at) const {
    const ArrivalPlane& plane = image.plane;
    const int steps = image.has_dark_part ? most_steps_in_part : most_steps;
    std::optional<Vec2d> lit;
    // Beyond the polygon's edges the light may meet other facets, from which no step leads back.
    int returns = 0;
    for (int step = 0; step < steps && least_weight(at) >= farthest_out; ++step) {
        const auto ray = chain_.ray(image.polygon.start(at));
        if (!ray || !(plane.steepness(ray->direction) > 0)) {
            if (!lit) return {};
            at = (at + *lit) / 2;
            continue;
        }
        lit = at;
        const Vec2d miss = plane.miss(ray->position, ray->direction);
        const Eigen::Matrix2d change = plane.miss_change(*ray);
        const double way = plane.way(ray->position, ray->direction);
        // Rounding of the first place, as far as the miss moves with it.
        const double rounding = double_rounding *
                                (ray->first.position.norm() + plane.point().norm()) *
                                (1 + change.norm() / image.polygon.size());
        const Vec2d by = change.inverse() * miss;
        const double length = by.norm();
        if (miss.norm() <= miss_tolerance * std::abs(way) + rounding || length <= last_step) {
            if (!(way > 0)) return {};
            const double area = std::max(std::abs(change.determinant()),
                                         resolvable_area(plane.point().cast<float>())) *
                                plane.steepness(ray->direction);
            return Found{at, *ray, change, ray->light_area / area};
        }
        if (!(length < std::numeric_limits<double>::infinity())) return {};
        at -= std::min(1.0, longest_step / length) * by;
        if (!meets_mesh_ && image.is_left(at, length) &&
            !image.model.is_beside_fold(change.determinant()))
            return {};
        if (meets_mesh_ && returns < most_returns && least_weight(at) < -edge_width) {
            at = just_inside(at);
            ++returns;
        }
    }
    return {};
}

// Along the direction in which the image does not move the miss grows as the integral of the determinant: a quadratic of
// the way t, which is zero at the fold, or twice beside a cusp. Where the integral is zero again, another ray starts.
RootSearch::Partners RootSearch::partners(const Image& image, const Found& found) const {
    constexpr double step = 0.01;
    const Eigen::Matrix2d square = found.change.transpose() * found.change;
    const Vec2d still =
        Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>().computeDirect(square).eigenvectors().col(
            0);
    const auto area_at = [&](double t) -> std::optional<double> {
        const auto ray = chain_.ray(image.polygon.start(found.at + t * still));
        if (!ray) return {};
        return image.plane.miss_change(*ray).determinant();
    };
    const double area = found.change.determinant();
    const auto ahead = area_at(step);
    if (!ahead) return {};
    Partners partners;
    const auto take = [&](double t) {
        constexpr double farthest = 0.3;  // beyond the polygon
        const Vec2d other = found.at + t * still;
        if (least_weight(other) >= -farthest) partners.at[partners.count++] = other;
    };
    const auto behind = area_at(-step);
    if (!behind) {
        take(-2 * area * step / (*ahead - area));
        return partners;
    }
    // area + slope t + bend t² is the determinant, and area t + slope t² / 2 + bend t³ / 3 the miss.
    const double slope = (*ahead - *behind) / (2 * step);
    const double bend = (*ahead - 2 * area + *behind) / (2 * step * step);
    const double room = slope * slope / 4 - 4 * area * bend / 3;
    if (!(room >= 0)) {
        take(-2 * area / slope);
        return partners;
    }
    const double sum = -slope / 2 - std::copysign(std::sqrt(room), slope);
    take(2 * area / sum);  // the nearer one
    if (bend != 0) take(sum / (2 * bend / 3));
    return partners;
}

void RootSearch::add(const FirstPolygon& polygon, const Found& found,
                     std::vector<Root>& roots) const {
    Root root;
    root.first = found.ray.first.position;
    if (least_weight(found.at) <= edge_width) root.edge_room = 4 * edge_width * polygon.size();
    root.start = {found.ray.position.cast<float>(), found.ray.across.cast<float>(),
                  found.ray.offset};
    root.direction = found.ray.direction.cast<float>();
    root.weight = chain_.weight(polygon.start(found.at));
    root.density = found.density;
    if (!is_black(root.weight)) roots.push_back(root);
}

}  // namespace caustics::beamtree
