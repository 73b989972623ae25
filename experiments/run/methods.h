#pragma once

#include <vector>

#include "core/method/method_description.h"

namespace caustics::experiments {

/// All methods there are, in the order in which they are listed. A program that links a list of its
/// own in place of methods.cpp knows other methods.
const std::vector<const MethodDescription*>& all_methods();

}  // namespace caustics::experiments
