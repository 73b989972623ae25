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
constexpr double farthest_out = -1;     // barycentric, of a step
// How near to the point a ray has to come, for the length of its way.
constexpr double miss_tolerance = 1e-10;
constexpr double double_rounding = 4 * std::numeric_limits<double>::epsilon();
// Barycentric coordinates beyond an edge that still count: vertices are rounded to float, and an edge may be shared by
// polygons that are divided differently. Both neighbours find such a root, and BeamLight counts it once.
constexpr double edge_width = 1e-6;
constexpr double same_root = 1e-5;  // barycentric distance

// The nearest place of the polygon that is off its edges.
Vec2d just_inside(const Vec2d& at) {
    constexpr double inset = 1e-5;
    const Vec3d weights = Vec3d(1 - at.x() - at.y(), at.x(), at.y()).cwiseMax(0);
    return (1 - inset) * weights.tail<2>() / weights.sum() + Vec2d::Constant(inset / 3);
}

bool has_mesh_after_first(const Scene& scene, const BeamSet& set) {
    return std::any_of(set.path.begin() + 1, set.path.end(), [&](const SpecularEvent& event) {
        return scene.shapes()[event.shape].primitive == Primitive::mesh;
    });
}

}  // namespace

RootSearch::RootSearch(const Scene& scene, const BeamSet& set)
    : scene_(scene),
      set_(set),
      chain_(scene, set),
      exact_(first_exact_surface(scene, set)),
      meets_mesh_(has_mesh_after_first(scene, set)) {}

bool RootSearch::find(std::uint32_t beam, std::size_t triangle, const Vec3& point,
                      std::vector<Root>& roots) const {
    const auto corners = set_.triangle(set_.beams[beam], triangle);
    const auto plane = ArrivalPlane::at(point, corners);
    if (!plane) return true;
    const bool has_dark_part = set_.beams[beam].has_dark_part;
    const auto model =
        ImageModel::of(*plane, corners, set_.middles_of(beam, triangle), has_dark_part);
    if (!model) return true;
    const FirstPolygon polygon(scene_, set_, exact_, set_.beams[beam], triangle);
    ImageModel::Solutions known;
    bool is_any_inside = false;
    // A ray that starts beside the polygon belongs to another one.
    const auto look_from = [&](const Vec2d& from) -> std::optional<Found> {
        const auto found =
            polish(polygon, *plane, from, has_dark_part ? most_steps_in_part : most_steps);
        if (!found || known.count == known.at.size()) return {};
        const bool is_known = std::any_of(known.begin(), known.end(), [&](const Vec2d& other) {
            return (other - found->at).norm() <= same_root;
        });
        if (is_known) return {};
        known.at[known.count++] = found->at;
        if (least_weight(found->at) >= -edge_width) {
            is_any_inside = true;
            add(polygon, *found, roots);
        }
        return found;
    };
    // The model of a polygon with a dark part is rough.
    const ImageModel::Solutions starts =
        has_dark_part ? ImageModel::everywhere() : model->solutions();
    for (const Vec2d& from : starts) {
        const auto found = look_from(from);
        if (!found || !model->is_beside_fold(found->change.determinant())) continue;
        if (const auto other = partner(polygon, *plane, *found)) look_from(*other);
    }
    return is_any_inside || has_dark_part || !model->surely_holds();
}

std::optional<RootSearch::Found> RootSearch::polish(const FirstPolygon& polygon,
                                                    const ArrivalPlane& plane, Vec2d at,
                                                    int steps) const {
    std::optional<Vec2d> lit;
    // Beyond the polygon's edges the light may meet other facets, from which no step leads back.
    int returns = 0;
    for (int step = 0; step < steps && least_weight(at) >= farthest_out; ++step) {
        const auto ray = chain_.ray(polygon.start(at));
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
                                (1 + change.norm() / polygon.size());
        if (miss.norm() <= miss_tolerance * std::abs(way) + rounding) {
            if (!(way > 0)) return {};
            const double area = std::max(std::abs(change.determinant()),
                                         resolvable_area(plane.point().cast<float>())) *
                                plane.steepness(ray->direction);
            return Found{at, *ray, change, ray->light_area / area};
        }
        const Vec2d by = change.inverse() * miss;
        const double length = by.norm();
        if (!(length < std::numeric_limits<double>::infinity())) return {};
        at -= std::min(1.0, longest_step / length) * by;
        if (meets_mesh_ && returns < most_returns && least_weight(at) < -edge_width) {
            at = just_inside(at);
            ++returns;
        }
    }
    return {};
}

// Along the direction in which the image does not move the determinant goes through zero at the fold, midway between the
// two.
std::optional<Vec2d> RootSearch::partner(const FirstPolygon& polygon, const ArrivalPlane& plane,
                                         const Found& found) const {
    constexpr double step = 0.01;
    constexpr double farthest = 0.3;  // beyond the polygon
    const Eigen::Matrix2d square = found.change.transpose() * found.change;
    const Vec2d still =
        Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>().computeDirect(square).eigenvectors().col(
            0);
    const auto beside = chain_.ray(polygon.start(found.at + step * still));
    if (!beside) return {};
    const double area = found.change.determinant();
    const double slope = (plane.miss_change(*beside).determinant() - area) / step;
    const Vec2d other = found.at - 2 * area / slope * still;
    if (!(least_weight(other) >= -farthest)) return {};
    return other;
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
