#include "core/render/eye_path.h"

#include <array>

#include "core/material/optics.h"

namespace caustics {
namespace {

// Below this share of the picture a branch is no longer worth a split of its own.
constexpr float split_threshold = 0.05F;
constexpr int max_eye_bounces = 64;

struct Branch {
    Ray ray;
    Spectrum weight = Spectrum::Ones();
    const Spectrum* start_absorption = nullptr;
    int bounces = 0;
    PathWavelength wavelength = {};
};

// Depth-first: each pop pushes at most two branches, and weights bound how many are pending.
struct BranchStack {
    std::array<Branch, 64> branches;
    std::size_t size = 0;
    void push(const Branch& branch) { branches[size++] = branch; }
    Branch pop() { return branches[--size]; }
    bool full() const { return size + 2 > branches.size(); }
};

Branch continued(const SurfacePoint& hit, const Bsdf& bsdf, const Vec3& direction,
                 const Spectrum& weight, const Branch& before) {
    return {spawn_ray({hit.position, hit.geometric_normal, hit.offset}, direction), weight,
            medium_after(bsdf, hit.geometric_normal, direction, before.start_absorption),
            before.bounces + 1, before.wavelength};
}

void scatter(const SurfacePoint& hit, const Bsdf& bsdf, int split_depth, Branch& branch, Rng& rng,
             BranchStack& stack) {
    branch.wavelength.arrive_at(bsdf, rng, branch.weight);
    const SpecularSplit split = split_specular(bsdf, hit.geometric_normal, hit.shading_normal,
                                               -branch.ray.direction, branch.wavelength.nm);
    Spectrum reflected = branch.weight * split.reflected_weight;
    Spectrum refracted = branch.weight * split.refracted_weight / (split.eta * split.eta);
    const float reflected_share = (branch.weight * split.reflected_weight).mean();
    const float refracted_share = (branch.weight * split.refracted_weight).mean();
    const float both = reflected_share + refracted_share;
    if (both <= 0) return;
    const bool both_matter =
        reflected_share >= split_threshold && refracted_share >= split_threshold;
    const bool split_path = (both_matter || branch.bounces < split_depth) && !stack.full();
    if (!split_path && reflected_share > 0 && refracted_share > 0) {
        if (rng.next() * both < reflected_share) {
            reflected *= both / reflected_share;
            refracted = black();
        } else {
            refracted *= both / refracted_share;
            reflected = black();
        }
    }
    if (reflected.maxCoeff() > 0)
        stack.push(continued(hit, bsdf, split.reflected, reflected, branch));
    if (refracted.maxCoeff() > 0)
        stack.push(continued(hit, bsdf, split.refracted, refracted, branch));
}

FirstHit first_hit(const SurfacePoint& hit, const Bsdf& bsdf) {
    return {albedo(bsdf, hit.uv), hit.shading_normal, hit.distance, is_caster(bsdf)};
}

}  // namespace

EyePath trace_eye_path(const Scene& scene, const Ray& camera_ray, const Spectrum& absorption,
                       Rng& rng, std::vector<WeightedPoint>& points,
                       std::optional<double> wavelength) {
    EyePath path;
    BranchStack stack;
    stack.push({camera_ray, Spectrum::Ones(), &absorption, 0, {.choice = wavelength}});
    while (stack.size > 0) {
        Branch branch = stack.pop();
        const auto hit = scene.intersect(branch.ray);
        if (!hit) {
            path.emitted += branch.weight * scene.background() *
                            scene.transmittance_along(branch.ray, branch.start_absorption);
            continue;
        }
        const Bsdf& bsdf = scene.shape_at(*hit).bsdf;
        const Vec3 wo = -branch.ray.direction;
        if (branch.bounces == 0) path.first = first_hit(*hit, bsdf);
        branch.weight *= segment_transmittance(branch.start_absorption,
                                               medium_absorption(bsdf, hit->geometric_normal, wo),
                                               hit->distance);
        const AreaLight* light = scene.area_light(hit->shape);
        if (light != nullptr && hit->geometric_normal.dot(wo) > 0)
            path.emitted += branch.weight * light->radiance;
        if (auto point = receiver_point(scene, *hit, wo)) {
            point->nm = branch.wavelength.nm;
            point->medium = branch.start_absorption;
            points.push_back({*point, branch.weight, branch.bounces == 0});
        }
        if (is_caster(bsdf) && branch.bounces < max_eye_bounces)
            scatter(*hit, bsdf, scene.sampling().split_depth, branch, rng, stack);
    }
    return path;
}

}  // namespace caustics
