#include "core/picture/picture_server.h"

#include <malloc.h>
#include <unistd.h>

#include <algorithm>
#include <exception>
#include <new>
#include <stdexcept>
#include <string_view>
#include <utility>
#include <vector>

#include "core/picture/confinement.h"
#include "core/picture/picture_limits.h"
#include "core/picture/picture_messages.h"

namespace caustics {
namespace {

constexpr int program = STDIN_FILENO;

/// The picture that was opened last.
struct ServedPicture {
    std::string bytes;
    std::unique_ptr<PictureSource> source;

    void open(OpenPicture open_source, PictureUse use) {
        source = open_source(bytes, use);
        send_message(program, PictureMessage::shape, encode_shape(source->shape()));
    }

    void send_rows() {
        if (!source) throw std::runtime_error("no picture is open");
        const PictureShape& shape = source->shape();
        const std::size_t row = row_values(shape);
        const int rows = rows_at_once(shape);
        std::vector<float> values(row * static_cast<std::size_t>(rows));
        for (int first = 0; first < shape.height; first += rows) {
            const int last = std::min(first + rows, shape.height);
            source->read_rows(first, last, values.data());
            const std::size_t count = row * static_cast<std::size_t>(last - first);
            send_message(program, PictureMessage::rows,
                         {reinterpret_cast<const char*>(values.data()), count * sizeof(float)});
        }
    }
};

void answer(OpenPicture open, PictureMessage asked, ServedPicture& picture) {
    try {
        if (asked == PictureMessage::open_texture) picture.open(open, PictureUse::texture);
        if (asked == PictureMessage::open_film) picture.open(open, PictureUse::film);
        if (asked == PictureMessage::read_rows) picture.send_rows();
    } catch (const std::bad_alloc&) {
        send_message(program, PictureMessage::no_memory);
    } catch (const std::exception& error) {
        send_message(program, PictureMessage::error, error.what());
    }
}

}  // namespace

void serve_pictures(OpenPicture open) {
    confine_this_process();
    send_message(program, PictureMessage::ready);
    ServedPicture picture;
    PictureMessageHead asked;
    while (receive_head(program, asked) == Transfer::done) {
        if (asked.kind != PictureMessage::read_rows) {
            picture = {};
            picture.bytes.resize(asked.length);
        }
        if (receive_bytes(program, picture.bytes.data(), asked.length) != Transfer::done) break;
        answer(open, asked.kind, picture);
        if (asked.kind == PictureMessage::read_rows) picture = {};
        malloc_trim(0);
    }
    // Without the destructors of hundreds of libraries.
    _exit(0);
}

}  // namespace caustics
