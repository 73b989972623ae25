#include "core/picture/exr_file.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfThreading.h>
#include <OpenEXR/ImfVersion.h>

#include <cstdint>
#include <cstring>
#include <optional>
#include <stdexcept>
#include <utility>

#include "core/base/parallel.h"
#include "core/picture/exr_header.h"
#include "core/picture/picture_limits.h"
#include "core/picture/primaries.h"

namespace caustics {
namespace {

class MemoryInput : public Imf::IStream {
public:
    explicit MemoryInput(const std::string& bytes) : IStream("it"), bytes_(bytes) {}

    bool read(char to[], int count) override {
        const auto wanted = static_cast<std::uint64_t>(count);
        if (at_ > bytes_.size() || wanted > bytes_.size() - at_)
            throw std::runtime_error("the file ends early");
        std::memcpy(to, bytes_.data() + at_, wanted);
        at_ += wanted;
        return at_ < bytes_.size();
    }
    std::uint64_t tellg() override { return at_; }
    void seekg(std::uint64_t to) override { at_ = to; }

private:
    const std::string& bytes_;
    std::uint64_t at_ = 0;
};

/// The writer comes back to its table of offsets, so that it overwrites.
class MemoryOutput : public Imf::OStream {
public:
    MemoryOutput() : OStream("it") {}

    void write(const char from[], int count) override {
        const auto length = static_cast<std::size_t>(count);
        if (bytes.size() < at_ + length) bytes.resize(at_ + length);
        std::memcpy(bytes.data() + at_, from, length);
        at_ += length;
    }
    std::uint64_t tellp() override { return at_; }
    void seekp(std::uint64_t to) override { at_ = to; }

    std::string bytes;

private:
    std::uint64_t at_ = 0;
};

/// Threads of OpenEXR for large pictures, as long as it lives: afterwards a child may be forked again.
class ExrThreads {
public:
    explicit ExrThreads(std::size_t values) {
        constexpr std::size_t worth_threads = 1 << 20;
        const int threads = values < worth_threads ? 0 : available_threads();
        if (threads > 1) Imf::setGlobalThreadCount(threads);
    }
    ~ExrThreads() { Imf::setGlobalThreadCount(0); }
    ExrThreads(const ExrThreads&) = delete;
    ExrThreads& operator=(const ExrThreads&) = delete;
};

Imf::Slice slice(const float* values, const Imath::Box2i& window) {
    return Imf::Slice::Make(Imf::FLOAT, values, window);
}

std::size_t value_count(int width, int height, std::size_t channels) {
    return static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * channels;
}

// OpenEXR may keep to itself that it had no memory to compress a block, or to end the file.
void require_encoded(const std::string& bytes,
                     const std::vector<ExrChannel<const float>>& channels) {
    ExrFile file(bytes);
    const std::size_t count = value_count(file.width(), file.height(), 1);
    std::vector<float> values(count * channels.size());
    std::vector<ExrChannel<float>> found;
    for (std::size_t i = 0; i < channels.size(); ++i)
        found.push_back({channels[i].name, values.data() + i * count});
    file.read(found);
    for (std::size_t i = 0; i < channels.size(); ++i)
        if (std::memcmp(found[i].values, channels[i].values, count * sizeof(float)) != 0)
            throw std::runtime_error("what was encoded of channel " + channels[i].name +
                                     " is not what was given");
}

}  // namespace

std::string encode_exr(int width, int height, const std::vector<ExrChannel<const float>>& channels,
                       const std::map<std::string, std::string>& texts) {
    Imf::Header header(width, height);
    header.compression() = Imf::ZIP_COMPRESSION;
    // The hour of writing would make other bytes of the same picture.
    Imf::addCapDate(header, "1970:01:01 00:00:00");
    for (const auto& [name, text] : texts) header.insert(name, Imf::StringAttribute(text));
    Imf::FrameBuffer buffer;
    for (const auto& [name, values] : channels) {
        header.channels().insert(name, Imf::Channel(Imf::FLOAT));
        buffer.insert(name, slice(values, header.dataWindow()));
    }
    const ExrThreads threads(value_count(width, height, channels.size()));
    MemoryOutput memory;
    {
        Imf::OutputFile file(memory, header);
        file.setFrameBuffer(buffer);
        file.writePixels(height);
    }  // writes the table of offsets
    require_encoded(memory.bytes, channels);
    return std::move(memory.bytes);
}

bool is_exr(const std::string& bytes) { return bytes.size() >= 4 && Imf::isImfMagic(bytes.data()); }

struct ExrFile::Opened {
    explicit Opened(const std::string& bytes) : memory(checked(bytes)), file(memory) {}

    static const std::string& checked(const std::string& bytes) {
        require_attributes_within(bytes);
        return bytes;
    }

    const Imf::Header& header() const { return file.header(); }

    MemoryInput memory;
    Imf::InputFile file;
};

namespace {

void require_one_part(const std::string& bytes) {
    MemoryInput memory(bytes);
    const int parts = Imf::MultiPartInputFile(memory).parts();
    if (parts != 1)
        throw std::runtime_error("it holds " + std::to_string(parts) +
                                 " parts, and pictures of one are read");
}

Primaries primaries(const Imf::Chromaticities& of) {
    return {of.red.x,  of.red.y,  of.green.x, of.green.y,
            of.blue.x, of.blue.y, of.white.x, of.white.y};
}

}  // namespace

ExrFile::ExrFile(const std::string& bytes) : opened_(std::make_unique<Opened>(bytes)) {
    const Imf::Header& header = opened_->header();
    require_one_part(bytes);
    if (header.hasType() && Imf::isDeepData(header.type()))
        throw std::runtime_error("it holds deep data");
    const Imf::ChannelList& channels = header.channels();
    for (auto channel = channels.begin(); channel != channels.end(); ++channel)
        if (channel.channel().xSampling != 1 || channel.channel().ySampling != 1)
            throw std::runtime_error(std::string("channel ") + channel.name() +
                                     " has less than one value a pixel");
    if (header.dataWindow() != header.displayWindow())
        throw std::runtime_error("its data window is not the whole picture");
    if (Imf::hasChromaticities(header)) require_rec709(primaries(Imf::chromaticities(header)));
}

ExrFile::~ExrFile() = default;

int ExrFile::width() const { return opened_->header().dataWindow().size().x + 1; }

int ExrFile::height() const { return opened_->header().dataWindow().size().y + 1; }

std::vector<std::string> ExrFile::channels() const {
    std::vector<std::string> names;
    const Imf::ChannelList& channels = opened_->header().channels();
    for (auto channel = channels.begin(); channel != channels.end(); ++channel)
        names.emplace_back(channel.name());
    return names;
}

std::map<std::string, std::string> ExrFile::texts() const {
    std::map<std::string, std::string> found;
    const Imf::Header& header = opened_->header();
    for (auto entry = header.begin(); entry != header.end(); ++entry)
        if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(&entry.attribute()))
            found[entry.name()] = text->value();
    return found;
}

void ExrFile::read_rows(int first, int last, float* values) {
    const Imath::Box2i& window = opened_->header().dataWindow();
    const auto across = static_cast<std::size_t>(width());
    const std::vector<std::string> names = channels();
    const std::size_t row = across * names.size() * sizeof(float);
    Imf::FrameBuffer buffer;
    for (std::size_t i = 0; i < names.size(); ++i)
        buffer.insert(names[i], Imf::Slice::Make(Imf::FLOAT, values + i * across,
                                                 Imath::V2i(window.min.x, window.min.y + first),
                                                 width(), last - first, sizeof(float), row));
    opened_->file.setFrameBuffer(buffer);
    opened_->file.readPixels(window.min.y + first, window.min.y + last - 1);
}

void ExrFile::read(const std::vector<ExrChannel<float>>& channels) {
    const Imath::Box2i& window = opened_->header().dataWindow();
    Imf::FrameBuffer buffer;
    for (const auto& [name, values] : channels) buffer.insert(name, slice(values, window));
    const ExrThreads threads(value_count(width(), height(), channels.size()));
    opened_->file.setFrameBuffer(buffer);
    opened_->file.readPixels(window.min.y, window.max.y);
}

namespace {

/// A film, some rows at a time: all values of one channel after those of another, row by row.
class ExrFilmSource : public PictureSource {
public:
    explicit ExrFilmSource(const std::string& bytes) : file_(bytes) {
        shape_.width = file_.width();
        shape_.height = file_.height();
        shape_.names = file_.channels();
        shape_.channels = static_cast<int>(shape_.names.size());
        shape_.bytes_per_value = sizeof(float);
        shape_.is_float = true;
        shape_.format = "openexr";
        shape_.texts = file_.texts();
    }

    void read_rows(int first, int last, float* values) override {
        if (!threads_)
            threads_.emplace(row_values(shape_) * static_cast<std::size_t>(shape_.height));
        file_.read_rows(first, last, values);
    }

private:
    ExrFile file_;
    std::optional<ExrThreads> threads_;
};

}  // namespace

std::unique_ptr<PictureSource> open_exr_film(const std::string& bytes) {
    return std::make_unique<ExrFilmSource>(bytes);
}

}  // namespace caustics
