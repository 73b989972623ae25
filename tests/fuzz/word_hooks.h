#pragma once

#include "tests/fuzz/reading.h"
#include "tests/fuzz/word_mutator.h"

// libFuzzer's hook for inputs that are words. The one source file of a program includes this and defines `words`.

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t most, unsigned seed) {
    return caustics::fuzz::mutate_words(data, size, most, seed, caustics::fuzz::words());
}
