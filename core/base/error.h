#pragma once

#include <stdexcept>
#include <string>

#include "core/base/printable.h"

namespace caustics {

/// Bad input: a scene, sweep, mesh, point list or parameter that cannot be used as it stands.
/// The message is one line naming the place, the reason and the alternatives; what it quotes of a
/// file or of the command line is made fit to print. Exit code 2.
class InputError : public std::runtime_error {
public:
    explicit InputError(const std::string& message) : std::runtime_error(one_line(message)) {}
};

/// A scene that is valid but that the chosen method cannot serve; the message says why and what
/// can. A method never becomes another one instead. Exit code 3.
class UnsupportedScene : public std::runtime_error {
public:
    explicit UnsupportedScene(const std::string& message) : std::runtime_error(one_line(message)) {}
};

/// Thrown out of long work when the user asked to stop (see `Progress`). Exit code 130.
class Interrupted : public std::runtime_error {
public:
    Interrupted() : std::runtime_error("interrupted") {}
};

}  // namespace caustics
