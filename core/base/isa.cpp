#include "core/base/isa.h"

#include "core/base/error.h"
#include "core/base/near_words.h"

namespace caustics {

const char* name(Isa isa) {
    switch (isa) {
        case Isa::avx512: return "avx512";
        case Isa::avx2: return "avx2";
        case Isa::plain: break;
    }
    return "plain";
}

std::vector<Isa> supported_isas() {
    std::vector<Isa> isas{Isa::plain};
#ifdef CAUSTICS_X86_KERNELS
    if (!__builtin_cpu_supports("avx2") || !__builtin_cpu_supports("bmi2")) return isas;
    isas.push_back(Isa::avx2);
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
        __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl"))
        isas.push_back(Isa::avx512);
#endif
    return isas;
}

Isa widest_isa() { return supported_isas().back(); }

Isa isa_from_name(const std::string& wanted) {
    std::string known;
    std::vector<std::string> names;
    for (const Isa isa : supported_isas()) {
        if (wanted == name(isa)) return isa;
        names.emplace_back(name(isa));
        known += (known.empty() ? "" : ", ") + names.back();
    }
    throw InputError("instruction set \"" + wanted + "\" cannot be run here" +
                     did_you_mean(wanted, names) + " (known: " + known + ")");
}

}  // namespace caustics
