#include "tests/support/caustic_sum.h"

namespace caustics::support {

double share_of_traced(const Film& picture, const Film& traced) {
    double sum = 0, truth = 0;
    for (std::size_t i = 0; i < traced.pixel_count(); ++i) {
        if ((*traced.find("unreached.Y"))[i] != 0) continue;
        sum += static_cast<double>(picture.rgb("caustic", i)[1]);
        truth += static_cast<double>(traced.rgb("caustic", i)[1]);
    }
    return sum / truth;
}

}  // namespace caustics::support
