#include "tests/support/caustic_sum.h"

#include "core/render/renderer.h"

namespace caustics::support {

double caustic_sum(const Scene& scene, const CausticEstimator& estimator,
                   const RunOptions& options) {
    const Film film = render(scene, estimator, options).film;
    const std::vector<float>& green = *film.find("caustic.G");
    const std::vector<float>* const unreached = film.find("unreached");
    double sum = 0;
    for (std::size_t i = 0; i < green.size(); ++i)
        if (unreached == nullptr || (*unreached)[i] == 0) sum += static_cast<double>(green[i]);
    return sum;
}

}  // namespace caustics::support
