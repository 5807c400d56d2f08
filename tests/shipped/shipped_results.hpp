#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>

namespace graze::testing {

/// Copies what an earlier test has computed of a shipped study, if there is such a test; see shipped.cmake. Runs that
/// are not there, or have other settings, are computed as usual.
inline void copy_shipped_results(const std::string& study, const std::string& path) {
    const char* folder = std::getenv("GRAZE_SHIPPED");
    if (const auto made = std::filesystem::path(folder ? folder : "") / study / "results.sqlite";
        folder && std::filesystem::exists(made))
        std::filesystem::copy_file(made, path);
}

} // namespace graze::testing
