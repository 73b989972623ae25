#include "core/method/none.h"

namespace caustics {

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
