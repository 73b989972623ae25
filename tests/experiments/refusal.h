#pragma once

#include <functional>
#include <string>

#include "core/base/error.h"

namespace caustics::experiments {

/// What is told of bad input; "taken" where it is none.
inline std::string refusal_of(const std::function<void()>& work) {
    try {
        work();
    } catch (const InputError& error) {
        return error.what();
    }
    return "taken";
}

}  // namespace caustics::experiments
