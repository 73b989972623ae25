#pragma once

#include <string>
#include <vector>

namespace caustics {

/// The instruction sets for which hot loops are written. Every one gives the same bits.
enum class Isa {
    plain,  ///< C++ as the compiler's baseline has it
    avx2,   ///< AVX2 and BMI2
    avx512  ///< AVX-512 F, BW, DQ, VL, and AVX2
};

/// "plain", "avx2", "avx512".
const char* name(Isa isa);
/// Those this processor and this build can run, the widest last.
std::vector<Isa> supported_isas();
Isa widest_isa();
/// Throws InputError for an unknown name and for an instruction set that cannot be run here.
Isa isa_from_name(const std::string& wanted);

}  // namespace caustics
