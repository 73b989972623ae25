#include "core/method/none.h"

namespace caustics {

const DescribedMethod<NoneParams>& none_method() {
    static const DescribedMethod<NoneParams> method(
        {.facts = {.name = "none",
                   .summary = "no caustic: plain ray tracing",
                   .serves = "every scene",
                   .has_caustic = false}});
    return method;
}

}  // namespace caustics
