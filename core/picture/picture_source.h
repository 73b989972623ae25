#pragma once

#include <string>

namespace caustics {

/// What a picture's header says.
struct PictureShape {
    int width = 0;
    int height = 0;
    int channels = 0;
    int bytes_per_value = 0;  ///< of one channel, as the reader hands it over: 1 for 1 to 8 bits
    bool is_float = false;    ///< or else whole numbers, which are read as 0 to 1
    std::string format;       ///< "png", or OpenImageIO's name: "openexr", "jpeg", ...
};

/// An opened picture. Colours are as written, not multiplied by alpha.
class PictureSource {
public:
    virtual ~PictureSource() = default;
    const PictureShape& shape() const { return shape_; }
    /// Writes the rows from `first` up to, not including, `last`: `channels` floats a pixel. Rows are asked for
    /// in their order. Throws std::runtime_error with the reason.
    virtual void read_rows(int first, int last, float* values) = 0;

protected:
    PictureShape shape_;
};

}  // namespace caustics
