#pragma once

#include <memory>
#include <string>

#include "core/picture/picture_source.h"

namespace caustics {

/// Opens the picture in `bytes`, which outlive it. Throws std::runtime_error with the reason.
using OpenPicture = std::unique_ptr<PictureSource> (*)(const std::string& bytes, PictureUse use);

/// The work of a process that decodes pictures: answers the messages of standard input, a socket, until its other end is
/// closed. Before the first byte of a picture it is confined.
void serve_pictures(OpenPicture open);

}  // namespace caustics
