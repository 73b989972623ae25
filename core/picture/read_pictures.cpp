// The program that decodes PNG pictures and films, for PictureReader.

#include "core/picture/exr_file.h"
#include "core/picture/picture_server.h"
#include "core/picture/png_file.h"

int main() {
    caustics::serve_pictures([](const std::string& bytes, caustics::PictureUse use) {
        return use == caustics::PictureUse::film ? caustics::open_exr_film(bytes)
                                                 : caustics::open_png(bytes);
    });
}
