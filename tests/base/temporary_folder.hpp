#pragma once

#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <string>
#include <vector>

namespace graze::testing {

inline std::string contents(const std::filesystem::path& path) {
    std::ifstream stream(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

/// Contents of all files of a folder, by name.
inline std::map<std::string, std::string> files_of(const std::string& folder) {
    std::map<std::string, std::string> result;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
        result[entry.path().filename().string()] = contents(entry.path());
    return result;
}

/// Names of files that differ between two folders, or exist in only one.
inline std::vector<std::string> different_files(const std::string& one, const std::string& other) {
    const auto first = files_of(one), second = files_of(other);
    std::vector<std::string> names;
    for (const auto& [name, text] : first)
        if (const auto found = second.find(name); found == second.end() || found->second != text)
            names.push_back(name);
    for (const auto& [name, text] : second)
        if (!first.contains(name))
            names.push_back(name);
    return names;
}

/// A folder that is removed after the test.
class TemporaryFolder {
public:
    TemporaryFolder() {
        std::string name = (std::filesystem::temp_directory_path() / "graze-test-XXXXXX").string();
        path_ = mkdtemp(name.data());
    }
    ~TemporaryFolder() { std::filesystem::remove_all(path_); }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    std::string operator/(const std::string& name) const { return (path_ / name).string(); }
    std::string path() const { return path_.string(); }
    /// Writes a file into the folder. @return its path
    std::string write(const std::string& name, const std::string& contents) const {
        std::ofstream(path_ / name, std::ios::binary) << contents;
        return *this / name;
    }
    std::size_t files() const {
        return static_cast<std::size_t>(
            std::distance(std::filesystem::directory_iterator(path_), std::filesystem::directory_iterator()));
    }

private:
    std::filesystem::path path_;
};

} // namespace graze::testing
