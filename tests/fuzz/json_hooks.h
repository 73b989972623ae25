#pragma once

#include <string>

#include "tests/fuzz/json_mutator.h"
#include "tests/fuzz/reading.h"

// libFuzzer's hooks for inputs that are JSON. The one source file of a program includes this and defines `words`.

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t most, unsigned seed) {
    return caustics::fuzz::mutate_json(data, size, most, seed, caustics::fuzz::words());
}

extern "C" std::size_t LLVMFuzzerCustomCrossOver(const std::uint8_t* first, std::size_t first_size,
                                                 const std::uint8_t* second,
                                                 std::size_t second_size, std::uint8_t* out,
                                                 std::size_t most, unsigned seed) {
    namespace fuzz = caustics::fuzz;
    return fuzz::cross_json(std::string(fuzz::view(first, first_size)),
                            std::string(fuzz::view(second, second_size)), out, most, seed);
}
