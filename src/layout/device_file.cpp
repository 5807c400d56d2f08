#include "graze/layout/device_file.hpp"

#include "graze/base/text_file.hpp"
#include "graze/design/design.hpp"
#include "graze/model/catalogue.hpp"
#include "layout/device_file_reader.hpp"

namespace graze {

Place DeviceFile::place(const std::string& key) const {
    for (std::string part = key; !part.empty(); part.resize(part.rfind('.') == std::string::npos ? 0 : part.rfind('.')))
        if (const auto found = places.find(part); found != places.end())
            return found->second;
    return {file, 1, 1};
}

namespace {

constexpr std::string_view given_beside = "given ";

} // namespace

Place given_place(const std::string& name) {
    return {std::string(given_beside) + name, 0, 0};
}

bool is_given_place(const Place& place) {
    return place.file.starts_with(given_beside);
}

DeviceFile parse_device_file(std::string_view text, const std::string& file, const GivenLengths& given) {
    const toml::table root = parse_toml(text, file, "docs/layout.md shows how a device is described");
    return DeviceFileReader(file).read(root, given);
}

DeviceFile load_device_file(const std::string& name_or_path, const GivenLengths& given) {
    const std::string text = is_model_path(name_or_path) ? read_text_file(name_or_path, "design", longest_model)
                                                         : shipped_design_text(name_or_path);
    return parse_device_file(text, name_or_path, given);
}

} // namespace graze
