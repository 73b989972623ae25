#include "core/light_path/whole_path.h"

#include <algorithm>

#include "core/base/error.h"
#include "core/light_path/flight.h"

namespace caustics {
namespace {

/// A particle among all surfaces.
class WholePath {
public:
    WholePath(const Scene& scene, const LightParticle& particle, const WholePathSettings& settings,
              Rng& rng, LightPathCounts& counts)
        : scene_(scene),
          settings_(settings),
          rng_(rng),
          counts_(counts),
          flight_{.ray = particle.ray,
                  .flux = particle.flux,
                  .start_medium = particle.medium,
                  .start_flux = particle.flux.sum()} {}

    void follow(std::vector<Deposit>& deposits) {
        for (;;) {
            const std::optional<SurfacePoint> hit = scene_.intersect(flight_.ray);
            if (!hit) {
                ++(flight_.bounces + diffuse_ == 0 ? counts_.missed : counts_.escaped);
                return;
            }
            if (!arrive(*hit, deposits) || !leaves(*hit)) return;
        }
    }

private:
    const Bsdf& bsdf(const SurfacePoint& hit) const { return scene_.shape_at(hit).bsdf; }

    // Leaves a deposit on a receiver; false where the path ends by that.
    bool arrive(const SurfacePoint& hit, std::vector<Deposit>& deposits) {
        const Vec3 towards = -flight_.ray.direction;
        flight_.flux *= segment_transmittance(
            flight_.start_medium, medium_absorption(bsdf(hit), hit.geometric_normal, towards),
            hit.distance);
        if (is_black(flight_.flux)) {
            ++counts_.absorbed;
            return false;
        }
        here_.reset();
        if (!is_receiver(bsdf(hit))) return true;
        here_ = deposit_of(scene_, hit, flight_);
        if (!here_) {
            ++counts_.on_black_side;
            return false;
        }
        here_->diffuse_bounces = diffuse_;
        deposits.push_back(*here_);
        ++counts_.stored;
        return true;
    }

    bool leaves(const SurfacePoint& hit) {
        arriving_ = flight_.flux.sum();
        if (is_caster(bsdf(hit))) {
            if (flight_.bounces < settings_.max_bounces) {
                if (is_reflected(hit)) return true;
            } else if (!here_) {
                ++counts_.depth_limited;
            }
        }
        return here_ && scatters(hit);
    }

    // The specular events; where there are none, what is left is the receiver's.
    bool is_reflected(const SurfacePoint& hit) {
        if (!here_ && !survives(flight_, rng_)) {
            ++counts_.absorbed;
            return false;
        }
        const SpecularSplit split = split_at(scene_, hit, flight_, rng_);
        const float specular =
            Spectrum((split.reflected_weight + split.refracted_weight) * flight_.flux).sum() /
            flight_.flux.sum();
        const Fate fate = roulette(split, rng_, flight_.flux);
        if (fate == Fate::reflected || fate == Fate::refracted) {
            ++(fate == Fate::reflected ? counts_.reflected : counts_.refracted);
            leave(scene_, hit, fate == Fate::reflected ? split.reflected : split.refracted,
                  flight_);
            return true;
        }
        if (here_)
            flight_.flux /= 1 - specular;
        else
            ++(fate == Fate::absorbed ? counts_.absorbed : counts_.misdirected);
        return false;
    }

    // A diffuse reflection, or the end. Deposits are flux, so that f_r is of the geometric surface.
    bool scatters(const SurfacePoint& hit) {
        if (diffuse_ + 1 == settings_.diffuse_bounces) return false;
        require_end(diffuse_);
        const float u0 = rng_.next();
        const float u1 = rng_.next();
        const float u2 = rng_.next();
        const float u3 = rng_.next();
        const Vec3& n = here_->shading_normal;
        const auto out = sample_direction(bsdf(hit), n, here_->wi, u0, u1, u2);
        const float cosine = out ? here_->geometric_normal.dot(*out) : 0;
        const float pdf = out ? direction_pdf(bsdf(hit), n, here_->wi, *out) : 0;
        if (!(cosine > 0) || !(pdf > 0)) {
            ++counts_.absorbed;
            return false;
        }
        const Spectrum after =
            flight_.flux * evaluate(bsdf(hit), hit.uv, n, *out, here_->wi) * (cosine / pdf);
        // Of what arrived: a mirror that was asked first and passed the flux on has made it larger.
        const float kept = std::min(1.0F, after.sum() / arriving_);
        if (!(u3 < kept)) {
            ++counts_.absorbed;
            return false;
        }
        flight_.flux = after / kept;
        flight_.ray = spawn_ray({hit.position, hit.geometric_normal, hit.offset}, *out);
        flight_.bounces = 0;
        ++diffuse_;
        return true;
    }

    const Scene& scene_;
    const WholePathSettings& settings_;
    Rng& rng_;
    LightPathCounts& counts_;
    Flight flight_;
    int diffuse_ = 0;
    std::optional<Deposit> here_;
    float arriving_ = 0;  ///< sum of the flux at the hit
};

}  // namespace

void require_end(int diffuse_bounces) {
    constexpr int most = 100'000;
    if (diffuse_bounces >= most)
        throw InputError(
            "a light path does not end after 100000 diffuse reflections; give the surfaces of a "
            "closed scene a reflectance below 1");
}

void trace_whole_path(const Scene& scene, const LightParticle& particle,
                      const WholePathSettings& settings, Rng& rng, LightPathCounts& counts,
                      std::vector<Deposit>& deposits) {
    WholePath(scene, particle, settings, rng, counts).follow(deposits);
}

}  // namespace caustics
