// The program that decodes pictures with OpenImageIO, for PictureReader.

#include "core/picture/openimageio_source.h"
#include "core/picture/picture_format.h"
#include "core/picture/picture_server.h"

int main() {
    caustics::serve_pictures([](const std::string& bytes, caustics::PictureUse) {
        return caustics::open_with_openimageio(bytes, caustics::picture_format(bytes));
    });
}
