#pragma once

#include <functional>

namespace caustics::beamtree {

/// The depth in [first, last] where a convex `size` is least: the neck of a beam. By the paper's
/// proposal [CC95 (2)] with all four cases of the next bracket, of which two are printed, and by
/// the golden section where the proposal does not lie inside the bracket or has stalled. Most
/// beams have their neck at an end, which is a legal answer.
double find_neck(const std::function<double(double)>& size, double first, double last);

}  // namespace caustics::beamtree
