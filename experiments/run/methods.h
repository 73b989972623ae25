#pragma once

#include <vector>

#include "core/method/method_description.h"

namespace caustics::experiments {

/// All methods of the indirect layer, but `none`, in the order in which they are listed.
const std::vector<const IndirectDescription*>& all_indirect_methods();

/// All methods there are, in the order in which they are listed. A program that links a list of its
/// own in place of methods.cpp knows other methods.
const std::vector<const MethodDescription*>& all_methods();

}  // namespace caustics::experiments
