#include "experiments/export/xml_writer.h"

namespace caustics::experiments {

namespace {

std::string escaped(const std::string& value) {
    std::string text;
    for (const char c : value) {
        switch (c) {
            case '&': text += "&amp;"; break;
            case '<': text += "&lt;"; break;
            case '>': text += "&gt;"; break;
            case '"': text += "&quot;"; break;
            default: text += c;
        }
    }
    return text;
}

}  // namespace

void XmlWriter::begin(const std::string& tag, const Attributes& attributes) {
    text_ += std::string(2 * open_tags_.size(), ' ') + "<" + tag;
    for (const auto& [name, value] : attributes)
        text_ += " " + name + "=\"" + escaped(value) + "\"";
}

void XmlWriter::open(const std::string& tag, const Attributes& attributes) {
    begin(tag, attributes);
    text_ += ">\n";
    open_tags_.push_back(tag);
}

void XmlWriter::close() {
    const std::string tag = open_tags_.back();
    open_tags_.pop_back();
    text_ += std::string(2 * open_tags_.size(), ' ') + "</" + tag + ">\n";
}

void XmlWriter::leaf(const std::string& tag, const Attributes& attributes) {
    begin(tag, attributes);
    text_ += "/>\n";
}

}  // namespace caustics::experiments
