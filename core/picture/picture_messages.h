#pragma once

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>

#include "core/picture/picture_source.h"

namespace caustics {

/// Kinds of messages between the program and the process that decodes pictures for it. A message is its kind (1 byte),
/// the number of its bytes (8) and these bytes.
enum class PictureMessage : std::uint8_t {
    ready,         ///< the first one of the process that decodes
    open_texture,  ///< asks for the shape of the picture in the bytes
    open_film,
    read_rows,  ///< asks for all rows of the opened picture
    shape,
    rows,   ///< rows_at_once() of them, or the last ones
    error,  ///< the reason, as text
    no_memory
};

struct PictureMessageHead {
    PictureMessage kind = PictureMessage::error;
    std::uint64_t length = 0;
};

/// How a transfer over a socket ended: `gone` where the other side is no longer there, `late` where it was silent for as
/// long as the socket waits.
enum class Transfer { done, gone, late };

Transfer send_message(int socket, PictureMessage kind, std::string_view bytes = {});
Transfer receive_bytes(int socket, void* to, std::size_t count);
Transfer receive_head(int socket, PictureMessageHead& head);

/// Why a picture cannot be read.
class PictureError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

std::string encode_shape(const PictureShape& shape);
/// Throws PictureError where the bytes are no shape, or one without a pixel.
PictureShape decode_shape(const std::string& bytes);

}  // namespace caustics
