#include "page/study_addition.hpp"

#include "graze/base/file_name.hpp"
#include "graze/model/catalogue.hpp"
#include "model/model_file_toml.hpp"
#include "page/proposed_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

namespace graze {

namespace {

/// What comes first is a table: a key would belong to the last table of the text before it.
void require_table_first(std::string_view addition) {
    std::size_t begin = 0;
    const auto skip = [&] { begin = std::min(addition.find_first_not_of(" \t\r\n", begin), addition.size()); };
    for (skip(); begin < addition.size() && addition[begin] == '#'; skip()) // a comment
        begin = std::min(addition.find('\n', begin), addition.size());
    if (begin < addition.size() && addition[begin] != '[')
        throw InputError("the text begins with a key outside of tables", "begin with a table [runs.NAME]");
}

} // namespace

void require_only_new(const std::string& addition, const Study& study) {
    const TomlReader reader("");
    const toml::table root = parse_toml(addition, "", "docs/study-format.md shows how a study is written");
    const auto require_new = [](const TomlEntry& one, const char* what, const auto& there) {
        if (std::ranges::any_of(there, [&](const auto& item) { return item.name == one.name; }))
            throw InputError(one.place, fmt::format("there is a {} '{}' already", what, one.name),
                             "choose another name");
    };
    for (const TomlEntry& group : reader.entries(root, "")) {
        if (group.name != "runs" && group.name != "pictures")
            throw InputError(group.place, fmt::format("'{}' is neither a run nor a picture", group.name),
                             "give tables [runs.NAME] and [pictures.NAME] only, and change the rest in the study");
        for (const TomlEntry& one : reader.entries(reader.table(group), group.path))
            group.name == "runs" ? require_new(one, "run", study.runs) : require_new(one, "picture", study.pictures);
    }
    require_table_first(addition);
}

std::string free_study_file(const std::string& folder, const std::string& name) {
    const auto path = [&](const std::string& end) {
        return (std::filesystem::path(folder) / (name + end + ".toml")).lexically_normal().string();
    };
    std::string free = path("");
    std::error_code error;
    for (int n = 2; std::filesystem::exists(std::filesystem::symlink_status(free, error)); ++n)
        free = path(fmt::format("-{}", n));
    return free;
}

bool is_study_of(const std::string& text, const std::string& model, const std::string& folder) {
    const std::string named = study_model_of(text);
    std::error_code error;
    const auto file = [&](const std::string& path) {
        return std::filesystem::weakly_canonical(std::filesystem::path(folder) / path, error);
    };
    return named.empty() || named == model ||
           (is_model_path(named) && is_model_path(model) && file(named) == file(model));
}

bool may_have_runs(const std::string& text, const std::string& file) {
    try {
        return is_study_text(text, file);
    } catch (const InputError&) {
        return true;
    }
}

} // namespace graze
