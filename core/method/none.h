#pragma once

#include "core/method/described_method.h"

namespace caustics {

const DescribedMethod<NoneParams>& none_method();

}  // namespace caustics
