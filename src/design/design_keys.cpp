#include "design/design_keys.hpp"

#include <filesystem>

namespace graze {

void require_design_key(const TomlReader& reader, const TomlEntry& entry) {
    reader.require_known(entry, "",
                         {"name", "text", "source", "model", "control", "set", "approach", "trip", "points", "planes",
                          "dimensions", "yield", "adjustable", "wanted", "device", "process", "wafer", "rules",
                          "spread"});
}

std::string beside(const std::string& file, const std::string& path) {
    return std::filesystem::path(path).is_relative() ? (std::filesystem::path(file).parent_path() / path).string()
                                                     : path;
}

} // namespace graze
