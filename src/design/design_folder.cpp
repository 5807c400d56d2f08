#include "graze/design/design_folder.hpp"

#include "graze/base/input_error.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>

namespace graze {

namespace {

constexpr std::string_view heading_begin = "# Found by graze design for '";

std::string first_line(const std::filesystem::path& path) {
    std::string line;
    std::getline(std::ifstream(path), line);
    return line;
}

} // namespace

std::string unfinished_text(const Design& design) {
    return fmt::format(
        "The work on the design '{}' has not come to its end: what else lies here is not of it, or not all. "
        "graze design takes this file away when it is done.\n",
        design.name);
}

std::string device_heading(const Design& design) {
    return fmt::format("{}{}' ({})\n", heading_begin, design.name, design.fingerprint);
}

void require_device_of(const Design& design, const std::string& folder, const Place& place) {
    const std::string remedy = fmt::format("make it by designing {} into {}", design.file, folder);
    const std::filesystem::path in(folder), device = in / device_model_name;
    std::error_code error;
    if (!std::filesystem::is_regular_file(device, error))
        throw InputError(place, fmt::format("the folder {} has no {}", folder, device_model_name), remedy);
    if (std::filesystem::exists(in / unfinished_name, error))
        throw InputError(place,
                         fmt::format("the last run of graze design in {} has not come to its end: its {} is of an "
                                     "earlier one",
                                     folder, device_model_name),
                         remedy);
    const std::string heading = first_line(device);
    if (heading.starts_with(heading_begin) && heading + "\n" != device_heading(design))
        throw InputError(place,
                         fmt::format("the device of {} is of another design, or of this one before it was changed: {}",
                                     folder, heading.substr(2)),
                         "name the design from which the folder comes, or " + remedy);
}

} // namespace graze
