#include "core/method/none.h"

#include <algorithm>

namespace caustics {
namespace {

class NoCaustic : public CausticEstimator {
public:
    explicit NoCaustic(const NoneParams& params) : params_(params) {}

    Shadows shadows() const override { return params_.shadows; }
    void radiance(std::span<const ReceiverPoint>, std::span<Estimate> out,
                  QueryContext&) const override {
        std::fill(out.begin(), out.end(), Estimate{});
    }
    void irradiance(std::span<const ReceiverPoint>, std::span<Estimate> out,
                    QueryContext&) const override {
        std::fill(out.begin(), out.end(), Estimate{});
    }

private:
    NoneParams params_;
};

}  // namespace

std::unique_ptr<const CausticEstimator> build(const Scene&, const NoneParams& params,
                                              const RunOptions&) {
    return std::make_unique<NoCaustic>(params);
}

const DescribedMethod<NoneParams>& none_method() {
    using P = NoneParams;
    static const DescribedMethod<P> method(
        {.facts = {.name = "none",
                   .summary = "no caustic: plain ray tracing",
                   .serves = "every scene",
                   .has_caustic = false},
         .parameters = {
             parameter::choice<P>(
                 &P::shadows, {{"opaque", Shadows::opaque}, {"transparent", Shadows::transparent}},
                 {.key = "shadows",
                  .meaning = "Of glass in direct light: dark, or weakened light that goes "
                             "straight through, as POV-Ray has it without photons.",
                  .source = "[C11]"})
                 .only_if([](const P& p) { return p.shadows != Shadows::opaque; })}});
    return method;
}

}  // namespace caustics
