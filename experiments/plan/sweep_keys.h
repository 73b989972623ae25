#pragma once

#include <vector>

#include "core/base/key_text.h"

namespace caustics::experiments {

/// Every object that read_sweep_file knows, with its keys.
const std::vector<ObjectText>& sweep_keys();

}  // namespace caustics::experiments
