#pragma once

#include <map>
#include <string>
#include <vector>

namespace caustics {

/// The use that a picture is read for.
enum class PictureUse {
    texture,  ///< colours and alpha: at most 4 channels
    film      ///< every channel of an OpenEXR file, with its attributes of text
};

/// How much of a picture is read.
enum class PictureDepth {
    header,  ///< its size and channels
    whole
};

/// What a picture's header says.
struct PictureShape {
    int width = 0;
    int height = 0;
    int channels = 0;
    int bytes_per_value = 0;  ///< of one channel, as the reader hands it over: 1 for 1 to 8 bits
    bool is_float = false;    ///< or else whole numbers, which are read as 0 to 1
    std::string format;       ///< as picture_format() calls it
    std::vector<std::string> names = {};            ///< of a film's channels
    std::map<std::string, std::string> texts = {};  ///< a film's attributes
};

/// An opened picture. Colours are as written, not multiplied by alpha.
class PictureSource {
public:
    virtual ~PictureSource() = default;
    const PictureShape& shape() const { return shape_; }
    /// Writes the rows from `first` up to, not including, `last`. A row of a texture has `channels` floats a pixel; a
    /// row of a film has all values of one channel after those of another. Rows are asked for in their order. Throws
    /// std::runtime_error with the reason.
    virtual void read_rows(int first, int last, float* values) = 0;

protected:
    PictureShape shape_;
};

}  // namespace caustics
