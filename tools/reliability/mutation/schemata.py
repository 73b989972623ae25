"""What an expression becomes, and the C++ that is the one or the other as a global number says at run time."""
import re

HEADER = """#pragma once
extern "C" int caustics_mutant;
extern "C" unsigned char caustics_mutants_reached[];
namespace mutant {
[[gnu::always_inline]] static inline bool at(int n) {
    caustics_mutants_reached[n] = 1;
    return caustics_mutant == n;
}
}
"""

# What was reached is appended to a file when the program ends; one write, as tests may start programs of their own.
SOURCE = """#include <cstdlib>
#include <fcntl.h>
#include <string>
#include <unistd.h>
extern "C" {
int caustics_mutant = -1;
unsigned char caustics_mutants_reached[@COUNT@];
}
namespace {
[[gnu::constructor(101)]] void choose() {
    if (const char* number = std::getenv("CAUSTICS_MUTANT")) caustics_mutant = std::atoi(number);
}
[[gnu::destructor]] void tell() {
    const char* path = std::getenv("CAUSTICS_MUTANTS_REACHED");
    if (path == nullptr) return;
    std::string all;
    for (int n = 0; n < @COUNT@; ++n)
        if (caustics_mutants_reached[n] != 0) all += std::to_string(n) + ' ';
    const int file = open(path, O_WRONLY | O_APPEND | O_CREAT | O_CLOEXEC, 0644);
    if (file < 0 || write(file, all.data(), all.size()) < 0) std::abort();
    close(file);
}
}
"""

# A mutant may compare alike things, overflow or change a width: no warning of the sources is about that.
QUIET = ("conversion", "sign-conversion", "float-conversion", "double-promotion", "parentheses", "unused-value", "address",
         "unused-parameter", "unused-variable", "unused-but-set-variable", "type-limits", "sign-compare", "bool-compare",
         "int-in-bool-context", "overflow", "div-by-zero", "duplicated-branches", "logical-op", "return-type", "narrowing",
         "array-bounds", "stringop-overflow", "stringop-overread", "nonnull", "null-dereference", "free-nonheap-object",
         "uninitialized", "bool-operation", "extra", "dangling-else", "misleading-indentation", "empty-body", "shadow")
PRELUDE = ('#include "mutant.h"\n' + "".join(f'#pragma GCC diagnostic ignored "-W{word}"\n' for word in QUIET)
           + "#line 1\n")

RELATIONS = {"<": ("<=", ">="), "<=": ("<", ">"), ">": (">=", "<="), ">=": (">", "<"), "==": ("!=",), "!=": ("==",)}
ARITHMETIC = {"+": "-", "-": "+", "*": "/", "/": "*", "%": "*", "+=": "-=", "-=": "+=", "*=": "/=", "/=": "*="}
LOGIC = {"&&": "||", "||": "&&"}
TWINS = {"min": "max", "max": "min", "minCoeff": "maxCoeff", "maxCoeff": "minCoeff",
         "cwiseMin": "cwiseMax", "cwiseMax": "cwiseMin", "fmin": "fmax", "fmax": "fmin"}


def replacements(operator):
    """Pairs of the mutation's name and the operator that takes the place of this one."""
    if operator in RELATIONS:
        return [("relation", other) for other in RELATIONS[operator]]
    if operator in ARITHMETIC:
        return [("arithmetic", ARITHMETIC[operator])]
    return [("logic", LOGIC[operator])] if operator in LOGIC else []


def constants(text):
    """What a literal may become: integers one more and one less, other numbers doubled or, where 0, 1."""
    if text in ("true", "false"):
        return ["false" if text == "true" else "true"]
    whole = re.fullmatch(r"(\d[\d']*)([uUlLzZ]*)", text)
    if whole:
        value = int(whole[1].replace("'", ""))
        return [f"{other}{whole[2]}" for other in (value + 1, value - 1) if other >= 0]
    real = re.fullmatch(r"((?:\d[\d']*)?\.?\d*(?:[eE][-+]?\d+)?)([fF]?)", text)
    if not real or not real[1]:
        return []
    value = float(real[1].replace("'", ""))
    return [f"1.0{real[2]}"] if value == 0 else [f"2 * {text}", f"0.0{real[2]}"]


def either(mutated, original, eigen=False):
    """An expression of Eigen is evaluated, as the two have different types before."""
    if eigen:
        return f"(::mutant::at(@N@) ? ({flat(mutated)}).eval() : ({original}).eval())"
    return f"(::mutant::at(@N@) ? ({flat(mutated)}) : ({original}))"


def negated(condition):
    return f"(::mutant::at(@N@) != static_cast<bool>({condition}))"


def optional(statement):
    """A statement that the mutant does not execute."""
    if statement.startswith("throw"):
        return f"if (!::mutant::at(@N@)) {statement}"
    return f"(::mutant::at(@N@) ? static_cast<void>(0) : static_cast<void>({statement}))"


def flat(text):
    """On one line, so that every line of a file keeps its number."""
    return re.sub(r"\s*\n\s*", " ", text)
