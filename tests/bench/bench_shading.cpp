// Shading of gathered photons: 100 photons a point, Schlick's law with alpha = 0.1 and Phong's with an
// exponent of 30, against the same sums in scalar code. Counters are nanoseconds per photon.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <string>

#include "photonmap/estimate/shading.h"
#include "tests/bench/bench.h"
#include "tests/bench/caustic_sets.h"
#include "tests/bench/contest.h"
#include "tests/bench/nanoflann_peer.h"
#include "tests/bench/scalar_shading.h"

namespace caustics::bench {

namespace {

constexpr std::size_t photons_a_point = 100;
constexpr std::size_t padded = 112;
constexpr float alpha = 0.1F;
constexpr float exponent = 30;
const Vec3 eye(0.3F, -1.7F, 1.3F);
/// Against the double sum; the scalar codes decode angles in float and lose some where t is near 1.
constexpr double scalar_tolerance = 2e-4;
constexpr double our_tolerance = 1e-5;

/// Points that found all their photons, with what each variant needs.
struct Work {
    Bsdf bsdf;
    std::vector<ReceiverPoint> points;
    std::vector<std::uint32_t> energy;     ///< `padded` a point
    std::vector<std::uint16_t> direction;  ///< likewise
    photonmap::Shading shading;
    photonmap::BrdfLobeTable table;
    std::vector<SpectrumSum> sums;

    Work(Isa isa, Bsdf law) : bsdf(std::move(law)), shading(isa) {}

    photonmap::WeightedPhotons photons(std::size_t i) const {
        return {{nullptr, &energy[i * padded], &direction[i * padded], photons_a_point, 0}};
    }
    bool is_phong() const { return std::holds_alternative<Phong>(bsdf.model); }
    ScalarQuery scalar(std::size_t i) const {
        const ReceiverPoint& p = points[i];
        const Vec3 &n = p.shading_normal, &wo = p.wo;
        return {&energy[i * padded],   &direction[i * padded],   photons_a_point,
                {n.x(), n.y(), n.z()}, {wo.x(), wo.y(), wo.z()}, is_phong() ? exponent : alpha};
    }
};

void add_point(Work& work, const float* x, const std::vector<photonmap::Photon>& photons,
               const std::uint32_t* found) {
    ReceiverPoint point{};
    point.position = Vec3(x[0], x[1], x[2]);
    point.geometric_normal = point.shading_normal = Vec3::UnitZ();
    point.wo = (eye - point.position).normalized();
    point.bsdf = &work.bsdf;
    work.points.push_back(point);
    for (std::size_t i = 0; i < padded; ++i) {
        const photonmap::Photon& photon = photons[found[i < photons_a_point ? i : 0]];
        work.energy.push_back(std::bit_cast<std::uint32_t>(photon.energy));
        work.direction.push_back(
            std::bit_cast<std::uint16_t>(photonmap::DirectionCode{photon.theta, photon.phi}));
    }
}

std::shared_ptr<Work> make_work(Caustic caustic, const BenchOptions& options, const Bsdf& law) {
    const auto work = std::make_shared<Work>(options.isa, law);
    const std::size_t count = 250'677;
    const std::vector<photonmap::Photon> photons = caustic_photons(caustic, Arrival::random, count);
    const NanoflannTree tree(photons.front().position, count, 5, 10);
    const Queries queries = scanlines(caustic, 320, 240, options.quick ? 2 : 8, 4);
    const float radius = max_radius(caustic, photons_a_point, count);
    std::vector<std::uint32_t> found(photons_a_point);
    std::vector<float> distances(photons_a_point);
    for (std::size_t i = 0; i < queries.size(); ++i)
        if (tree.nearest(NanoflannTree::ResultSet::heap, queries[i], photons_a_point,
                         radius * radius, found.data(), distances.data()) == photons_a_point)
            add_point(*work, queries[i], photons, found.data());
    work->sums.resize(work->points.size());
    return work;
}

/// f_r of [J96 (5)], [J96 (6)], or of Phong's law, in double, over the floor.
double reflection(bool phong, const Vec3d& wo, const Vec3d& wi) {
    if (phong) {
        const double cosine = std::max(0.0, 2 * wo.z() * wi.z() - wo.dot(wi));
        const auto e = static_cast<double>(exponent);
        return 0.5 / pi_d + 0.5 * (e + 2) / (2 * pi_d) * std::pow(cosine, e);
    }
    const auto a = static_cast<double>(alpha);
    const double v = wo.z(), v_in = wi.z(), t = (wo + wi).normalized().z();
    const double g = 1 / ((a - a * v + v) * (a - a * v_in + v_in));
    const double lobe = 1 + a * t * t - t * t;
    return (1 - g * v * v_in) / pi_d + g / (4 * pi_d) * a / (lobe * lobe);
}

/// The sum in double.
SpectrumSum truth(const Work& work, std::size_t i) {
    const Vec3d wo = work.points[i].wo.cast<double>().normalized();
    SpectrumSum sum = SpectrumSum::Zero();
    for (std::size_t p = i * padded; p < i * padded + photons_a_point; ++p) {
        const auto code = std::bit_cast<photonmap::DirectionCode>(work.direction[p]);
        const Vec3d wi =
            photonmap::decode_direction(code.theta, code.phi).cast<double>().normalized();
        if (wi.z() <= 0) continue;
        sum +=
            photonmap::decode_rgbe(std::bit_cast<photonmap::Rgbe>(work.energy[p])).cast<double>() *
            reflection(work.is_phong(), wo, wi);
    }
    return sum;
}

/// The largest relative error of the sums; throws when it is too large.
double error_of(const Work& work, const std::string& contestant, double tolerance) {
    double largest = 0;
    for (std::size_t i = 0; i < work.points.size(); ++i) {
        const SpectrumSum exact = truth(work, i);
        largest = std::max(largest, ((work.sums[i] - exact).abs() / exact).maxCoeff());
    }
    if (!(largest <= tolerance))
        throw std::runtime_error(contestant + " errs by " + std::to_string(largest));
    return largest;
}

Contest make_contest(Caustic caustic, const BenchOptions& options, const Bsdf& law) {
    const std::shared_ptr<Work> work = make_work(caustic, options, law);
    const std::size_t count = work->points.size();
    Contest contest(static_cast<double>(count * photons_a_point));
    const auto add = [&](const std::string& name, double tolerance, const auto& shade_one) {
        const auto run = [work, count, shade_one] {
            for (std::size_t i = 0; i < count; ++i) shade_one(*work, i);
        };
        run();
        contest.note(name + "_error", error_of(*work, name, tolerance));
        contest.add(name, run);
    };
    const auto add_scalar = [&](const std::string& name, auto shade) {
        add(name, scalar_tolerance, [shade](Work& w, std::size_t i) {
            float rgb[3];
            shade(w.scalar(i), rgb);
            w.sums[i] = Spectrum(rgb[0], rgb[1], rgb[2]).cast<double>();
        });
    };
    if (work->is_phong()) {
        add_scalar("tables", shade_phong);
    } else {
        add_scalar("libm", shade_by_libm);
        add_scalar("tables", shade_by_tables);
    }
    add("ours", our_tolerance,
        [](Work& w, std::size_t i) { w.sums[i] = w.shading.reflected(w.points[i], w.photons(i)); });
    add("ours_tables", our_tolerance, [](Work& w, std::size_t i) {
        w.sums[i] = w.shading.reflected(w.points[i], w.photons(i), w.table);
    });
    contest.note("table_fillings_per_photon", static_cast<double>(work->table.fillings()) /
                                                  static_cast<double>(work->table.lookups()));
    return contest;
}

}  // namespace

void register_benchmarks(const BenchOptions& options) {
    const Bsdf schlick{Schlick{Spectrum(Spectrum::Ones()), alpha}};
    const Texture half = Spectrum(Spectrum::Constant(0.5F));
    const Bsdf phong{
        Phong{.diffuse_reflectance = half, .specular_reflectance = half, .exponent = exponent}};
    for (const Caustic caustic : {Caustic::water, Caustic::ball}) {
        const int rounds = options.quick ? 2 : 10;
        register_contest(std::string("shading/") + name(caustic), rounds,
                         [=] { return make_contest(caustic, options, schlick); });
        register_contest(std::string("shading_phong/") + name(caustic), rounds,
                         [=] { return make_contest(caustic, options, phong); });
    }
}

}  // namespace caustics::bench
