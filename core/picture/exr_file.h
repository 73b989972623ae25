#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/picture/picture_source.h"

namespace caustics {

/// A float32 channel: width x height values, row by row from the top, which belong to somebody else.
template <class Value>
struct ExrChannel {
    std::string name;
    Value* values = nullptr;
};

/// An OpenEXR file of float32 channels (zip, scan lines, data window at the origin) with attributes of text. The same
/// picture gives the same bytes, which are read back before they are returned. Throws std::runtime_error.
std::string encode_exr(int width, int height, const std::vector<ExrChannel<const float>>& channels,
                       const std::map<std::string, std::string>& texts);

/// Whether these are the first bytes of an OpenEXR file.
bool is_exr(const std::string& bytes);

/// An OpenEXR file of one part, scan lines or tiles. Values of other types are read as float32, whole numbers as they
/// are.
class ExrFile {
public:
    /// `bytes` must outlive it. Throws std::runtime_error for what is no such file, deep data, channels
    /// of less than one value a pixel, a data window that is not the whole picture, and colours of other primaries
    /// than Rec. 709.
    explicit ExrFile(const std::string& bytes);
    ~ExrFile();
    ExrFile(const ExrFile&) = delete;
    ExrFile& operator=(const ExrFile&) = delete;

    int width() const;
    int height() const;
    std::vector<std::string> channels() const;
    /// The attributes of text.
    std::map<std::string, std::string> texts() const;
    /// Reads whole channels. Throws std::runtime_error for a broken file.
    void read(const std::vector<ExrChannel<float>>& channels);

    /// Reads the rows from `first` up to, not including, `last`: all values of a row of the first of channels(), then those
    /// of the next one.
    void read_rows(int first, int last, float* values);

private:
    struct Opened;
    std::unique_ptr<Opened> opened_;
};

/// Opens an OpenEXR file with all that an ExrFile has; `bytes` must outlive it. Throws std::runtime_error as ExrFile does.
std::unique_ptr<PictureSource> open_exr_film(const std::string& bytes);

}  // namespace caustics
