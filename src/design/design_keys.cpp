#include "design/design_keys.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <filesystem>
#include <sstream>

namespace graze {

void require_design_key(const TomlReader& reader, const TomlEntry& entry) {
    reader.require_known(entry, "",
                         {"name", "text", "source", "model", "control", "set", "approach", "trip", "points", "planes",
                          "dimensions", "yield", "adjustable", "wanted", "device", "process", "wafer", "rules",
                          "spread"});
}

std::string design_fingerprint(const toml::table& root) {
    toml::table said = root;
    for (const char* other : {"text", "source", "points", "planes", "device", "process", "wafer", "rules", "spread"})
        said.erase(other);
    std::ostringstream text;
    text << said;
    std::uint64_t hash = 0xcbf29ce484222325ULL; // FNV-1a
    for (const char letter : text.str())
        hash = (hash ^ static_cast<unsigned char>(letter)) * 0x100000001b3ULL;
    return fmt::format("{:016x}", hash);
}

std::string beside(const std::string& file, const std::string& path) {
    return std::filesystem::path(path).is_relative() ? (std::filesystem::path(file).parent_path() / path).string()
                                                     : path;
}

} // namespace graze
