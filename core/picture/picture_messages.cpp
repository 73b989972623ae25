#include "core/picture/picture_messages.h"

#include <sys/socket.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

#include "core/base/interrupt.h"

namespace caustics {
namespace {

void append_number(std::string& to, std::uint64_t value) {
    to.append(reinterpret_cast<const char*>(&value), sizeof value);
}

void append_text(std::string& to, const std::string& text) {
    append_number(to, text.size());
    to += text;
}

std::string_view take_bytes(std::string_view& rest, std::uint64_t count) {
    if (count > rest.size()) throw PictureError("its description ends early");
    const std::string_view taken = rest.substr(0, count);
    rest.remove_prefix(count);
    return taken;
}

std::uint64_t take_number(std::string_view& rest) {
    std::uint64_t value = 0;
    std::memcpy(&value, take_bytes(rest, sizeof value).data(), sizeof value);
    return value;
}

std::string take_text(std::string_view& rest) {
    const std::uint64_t length = take_number(rest);
    return std::string(take_bytes(rest, length));
}

int take_size(std::string_view& rest) {
    constexpr std::uint64_t most = 1 << 30;
    const std::uint64_t value = take_number(rest);
    if (value > most) throw PictureError("its size is no size of a picture");
    return static_cast<int>(value);
}

Transfer end_of_transfer(ssize_t count) {
    return count < 0 && (errno == EAGAIN || errno == EWOULDBLOCK) ? Transfer::late : Transfer::gone;
}

Transfer send_bytes(int socket, std::string_view rest) {
    while (!rest.empty()) {
        const ssize_t sent = send(socket, rest.data(), rest.size(), MSG_NOSIGNAL);
        if (sent < 0 && errno == EINTR) {
            throw_if_interrupted();
            continue;
        }
        if (sent <= 0) return end_of_transfer(sent);
        rest.remove_prefix(static_cast<std::size_t>(sent));
    }
    return Transfer::done;
}

}  // namespace

Transfer send_message(int socket, PictureMessage kind, std::string_view bytes) {
    std::string head(1, static_cast<char>(kind));
    append_number(head, bytes.size());
    const Transfer sent = send_bytes(socket, head);
    return sent == Transfer::done ? send_bytes(socket, bytes) : sent;
}

Transfer receive_bytes(int socket, void* to, std::size_t count) {
    auto* at = static_cast<char*>(to);
    while (count > 0) {
        const ssize_t received = recv(socket, at, count, 0);
        if (received < 0 && errno == EINTR) {
            throw_if_interrupted();
            continue;
        }
        if (received <= 0) return end_of_transfer(received);
        at += received;
        count -= static_cast<std::size_t>(received);
    }
    return Transfer::done;
}

Transfer receive_head(int socket, PictureMessageHead& head) {
    std::array<char, 1 + sizeof head.length> bytes{};
    const Transfer received = receive_bytes(socket, bytes.data(), bytes.size());
    head.kind = static_cast<PictureMessage>(bytes[0]);
    std::memcpy(&head.length, &bytes[1], sizeof head.length);
    return received;
}

std::string encode_shape(const PictureShape& shape) {
    std::string bytes;
    for (const int number :
         {shape.width, shape.height, shape.channels, shape.bytes_per_value, int{shape.is_float}})
        append_number(bytes, static_cast<std::uint64_t>(number));
    append_text(bytes, shape.format);
    append_number(bytes, shape.names.size());
    for (const std::string& name : shape.names) append_text(bytes, name);
    append_number(bytes, shape.texts.size());
    for (const auto& [name, text] : shape.texts) {
        append_text(bytes, name);
        append_text(bytes, text);
    }
    return bytes;
}

PictureShape decode_shape(const std::string& bytes) {
    std::string_view rest(bytes);
    PictureShape shape;
    for (int* const number : {&shape.width, &shape.height, &shape.channels, &shape.bytes_per_value})
        *number = take_size(rest);
    shape.is_float = take_number(rest) != 0;
    shape.format = take_text(rest);
    for (std::uint64_t left = take_number(rest); left > 0; --left)
        shape.names.push_back(take_text(rest));
    for (std::uint64_t left = take_number(rest); left > 0; --left) {
        std::string name = take_text(rest);
        shape.texts[std::move(name)] = take_text(rest);
    }
    if (shape.width < 1 || shape.height < 1 || shape.channels < 1)
        throw PictureError("it has no pixels");
    if (!shape.names.empty() && shape.names.size() != static_cast<std::size_t>(shape.channels))
        throw PictureError("its channels are more or fewer than their names");
    return shape;
}

}  // namespace caustics
