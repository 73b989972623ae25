#include "core/illumination_map/illumination_map.h"

#include <optional>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/illumination_map/texel_area.h"
#include "core/method/unlit_estimator.h"
#include "core/reference/ordered_paths.h"

namespace caustics {
namespace {

/// What a path brings to a side of a receiver.
struct Arrival {
    std::uint32_t shape;
    bool front;
    Vec2 uv;
    Spectrum flux;
};

/// The texels over one side of a receiver.
class SideMap {
public:
    explicit SideMap(const TexelGrid& grid)
        : grid_(grid), flux_(grid.size(), SpectrumSum::Zero()) {}

    void add(const Vec2& uv, const Spectrum& flux) {
        const SpectrumSum f = flux.cast<double>();
        for (const TexelGrid::Tap& tap : grid_.taps(uv.cast<double>()))
            flux_[tap.texel] += tap.share * f;
    }
    /// Turns flux [W x emitted] into irradiance.
    void finish(const std::vector<double>& areas, double emitted) {
        irradiance_.reserve(flux_.size());
        for (std::size_t i = 0; i < flux_.size(); ++i) {
            const double area = areas[i] * emitted;
            irradiance_.emplace_back(area > 0 ? Spectrum((flux_[i] / area).cast<float>())
                                              : black());
        }
        flux_ = {};
    }
    Spectrum irradiance(const Vec2& uv) const {
        Spectrum sum = black();
        for (const TexelGrid::Tap& tap : grid_.taps(uv.cast<double>()))
            sum += static_cast<float>(tap.share) * irradiance_[tap.texel];
        return sum;
    }
    std::uint64_t bytes() const { return irradiance_.size() * sizeof(Spectrum); }

private:
    TexelGrid grid_;
    std::vector<SpectrumSum> flux_;  ///< while light arrives
    std::vector<Spectrum> irradiance_;
};

/// The maps of one receiver.
struct ReceiverMaps {
    std::vector<double> areas;        ///< of the texels, while light arrives
    std::optional<SideMap> sides[2];  ///< back, front; empty where light is not scattered

    void finish(double emitted) {
        for (std::optional<SideMap>& side : sides)
            if (side) side->finish(areas, emitted);
        areas = {};
    }
};

void require_diffuse(const Shape& shape) {
    if (!std::holds_alternative<Diffuse>(shape.bsdf.model))
        throw UnsupportedScene(
            "illuminationmap keeps no directions of light, so its receivers must be diffuse, and "
            "\"" +
            shape.name + "\" is not (photonmap and the references take any)");
}

/// Throws what making their maps would. Texture coordinates of exact shapes always name one place each.
void check_receivers(const Scene& scene, int resolution) {
    for (const Shape& shape : scene.shapes()) {
        if (!is_receiver(shape.bsdf)) continue;
        require_diffuse(shape);
        if (shape.primitive == Primitive::mesh) texel_areas(shape, texel_grid(shape, resolution));
    }
}

ReceiverMaps empty_maps(const Shape& shape, int resolution) {
    require_diffuse(shape);
    const TexelGrid grid = texel_grid(shape, resolution);
    ReceiverMaps maps;
    maps.areas = texel_areas(shape, grid);
    for (const bool front : {false, true})
        if (scatters_from(shape.bsdf, front)) maps.sides[front ? 1 : 0].emplace(grid);
    return maps;
}

class IlluminationMap final : public CausticEstimator {
public:
    IlluminationMap(const Scene& scene, const IlluminationMapParams& params,
                    const RunOptions& options)
        : maps_(scene.shapes().size()) {
        options.phase("texels");
        for (std::size_t i = 0; i < maps_.size(); ++i)
            if (is_receiver(scene.shapes()[i].bsdf))
                maps_[i] = empty_maps(scene.shapes()[i], params.resolution);
        options.phase("trace");
        trace(scene, params, options);
        for (ReceiverMaps& maps : maps_) maps.finish(static_cast<double>(params.emitted));
    }

    void radiance(std::span<const ReceiverPoint> points, std::span<Estimate> out,
                  QueryContext&) const override {
        for (std::size_t i = 0; i < points.size(); ++i) {
            const ReceiverPoint& p = points[i];
            // A diffuse f_r does not depend on where the light came from.
            out[i] = {irradiance_at(p) *
                          evaluate(*p.bsdf, p.uv, p.shading_normal, p.wo, p.shading_normal),
                      black()};
        }
    }
    void irradiance(std::span<const ReceiverPoint> points, std::span<Estimate> out,
                    QueryContext&) const override {
        for (std::size_t i = 0; i < points.size(); ++i)
            out[i] = {irradiance_at(points[i]), black()};
    }

    BuildReport build_report() const override {
        BuildReport report;
        counts_.add_to(report.counters);
        report.light = counts_.watts();
        for (const ReceiverMaps& maps : maps_)
            for (const std::optional<SideMap>& side : maps.sides)
                if (side) report.bytes += side->bytes();
        report.counters["texels"] = report.bytes / sizeof(Spectrum);
        return report;
    }

private:
    void trace(const Scene& scene, const IlluminationMapParams& params, const RunOptions& options) {
        const AimedEmission emission(scene);
        const OrderedPaths paths{scene,          emission,
                                 params.emitted, params.max_bounces,
                                 options.seed,   Stage::illumination_map};
        const auto collect = [](const Deposit& d, std::uint64_t, std::vector<Arrival>& arrivals) {
            arrivals.push_back({d.shape, d.front, d.uv, d.flux});
        };
        counts_ = trace_in_order<Arrival>(paths, options, collect, [this](const Arrival& a) {
            maps_[a.shape].sides[a.front ? 1 : 0]->add(a.uv, a.flux);
        });
    }

    Spectrum irradiance_at(const ReceiverPoint& point) const {
        const std::optional<SideMap>& side = maps_[point.shape].sides[point.front ? 1 : 0];
        return side ? side->irradiance(point.uv) : black();
    }

    std::vector<ReceiverMaps> maps_;  ///< of the shapes; empty for casters
    LightPathCounts counts_;
};

}  // namespace

const DescribedMethod<IlluminationMapParams>& illuminationmap_method() {
    using P = IlluminationMapParams;
    static const DescribedMethod<P> method(
        {.facts = {.name = "illuminationmap",
                   .summary = "Arvo 1986: light gathered on texels over the receivers' texture "
                              "coordinates (`resolution` squared), read bilinearly",
                   .serves = "diffuse receivers without overlapping texture coordinates: any "
                             "exact shape, meshes with an atlas",
                   .work = {.parameter = "emitted", .first = 1000, .most = 1'000'000'000'000},
                   .refined_with = {{.parameter = "resolution", .power = 2, .most = 4096}}},
         .parameters = {parameter::whole_number<P>(
                            &P::emitted, 1, 1'000'000'000'000,
                            {.key = "emitted",
                             .meaning = "Light paths emitted, thinned ones included.",
                             .unit = "paths",
                             .source = "[Arvo 1986]"}),
                        parameter::whole_number<P>(
                            &P::resolution, 1, 4096,
                            {.key = "resolution",
                             .meaning = "Texels along each texture coordinate of a receiver.",
                             .unit = "texels",
                             .source = "[Arvo 1986]"}),
                        parameter::max_bounces<P>()},
         .take_least_work = [](P& params) { params.only_checked = true; },
         .take_share = [](P& params,
                          double share) { return take_share_of(params.emitted, share); }});
    return method;
}

std::unique_ptr<const CausticEstimator> build(const Scene& scene,
                                              const IlluminationMapParams& params,
                                              const RunOptions& options) {
    if (!params.only_checked) return std::make_unique<IlluminationMap>(scene, params, options);
    check_receivers(scene, params.resolution);
    return std::make_unique<UnlitEstimator>();
}

}  // namespace caustics
