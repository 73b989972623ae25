#include "core/picture/foreign_picture.h"

#include <stdexcept>

#include "core/base/shared_library.h"

namespace caustics {
namespace {

OpenPicture module() {
    try {
        return reinterpret_cast<OpenPicture>(
            load_function(CAUSTICS_FOREIGN_PICTURES, open_picture_name));
    } catch (const std::runtime_error& error) {
        throw std::runtime_error("formats other than PNG need " CAUSTICS_FOREIGN_PICTURES
                                 " beside the program: " +
                                 std::string(error.what()));
    }
}

}  // namespace

std::unique_ptr<PictureSource> open_foreign_picture(const std::filesystem::path& file,
                                                    const std::string& bytes,
                                                    const std::string& format) {
    static const OpenPicture open = module();
    return std::unique_ptr<PictureSource>(open(file.c_str(), bytes, format));
}

}  // namespace caustics
