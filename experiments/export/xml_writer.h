#pragma once

#include <string>
#include <utility>
#include <vector>

namespace caustics::experiments {

/// Writes indented XML, element by element.
class XmlWriter {
public:
    /// Names and values; values are escaped.
    using Attributes = std::vector<std::pair<std::string, std::string>>;

    void open(const std::string& tag, const Attributes& attributes = {});
    void close();
    void leaf(const std::string& tag, const Attributes& attributes);
    /// The document, every element closed.
    const std::string& text() const { return text_; }

private:
    void begin(const std::string& tag, const Attributes& attributes);

    std::string text_ = "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n";
    std::vector<std::string> open_tags_;
};

}  // namespace caustics::experiments
