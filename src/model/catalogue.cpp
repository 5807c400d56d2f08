#include "graze/model/catalogue.hpp"

#include "graze/base/input_error.hpp"
#include "graze/model/microbeam.hpp"
#include "graze/model/model_file.hpp"
#include "model/catalogue_data.hpp"
#include "model/model_file_toml.hpp"
#include "model/model_validate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

namespace graze {

namespace {

/// Returns the first sentence of the text, or its first line.
std::string first_sentence(const std::string& text) {
    const std::size_t start = std::min(text.find_first_not_of(" \t\n"), text.size());
    const std::size_t end = std::min({text.find(". ", start), text.find(".\n", start), text.find("\n\n", start)});
    std::string result = text.substr(start, end == std::string::npos ? end : end - start);
    for (char& c : result)
        if (c == '\n')
            c = ' ';
    while (!result.empty() && (result.back() == '.' || result.back() == ' '))
        result.pop_back();
    return result;
}

CatalogueEntry entry_of(const EmbeddedModel& model) {
    const toml::table table = parse_toml(model.text, std::string(model.name));
    return {std::string(model.name), first_sentence(table["text"].value_or(std::string())), std::string(model.text)};
}

std::vector<CatalogueEntry> all_entries() {
    std::vector<CatalogueEntry> result;
    for (const EmbeddedModel& model : embedded_models())
        result.push_back(entry_of(model));
    return result;
}

} // namespace

const std::vector<CatalogueEntry>& catalogue() {
    static const std::vector<CatalogueEntry> entries = all_entries();
    return entries;
}

std::vector<std::string> shipped_models() {
    std::vector<std::string> names;
    for (const EmbeddedModel& model : embedded_models())
        names.emplace_back(model.name);
    return names;
}

std::optional<CatalogueEntry> find_in_catalogue(std::string_view name) {
    for (const EmbeddedModel& model : embedded_models())
        if (model.name == name)
            return entry_of(model);
    return std::nullopt;
}

bool is_model_path(std::string_view name_or_path) {
    return name_or_path.find('/') != std::string_view::npos || name_or_path.ends_with(".toml");
}

Model load_model(const std::string& name_or_path) {
    if (is_model_path(name_or_path))
        return read_model(name_or_path);
    if (const auto entry = find_in_catalogue(name_or_path))
        return parse_model(entry->text, name_or_path);
    if (const auto member = microbeam_member(name_or_path))
        return microbeam(*member);
    std::vector<std::string> names;
    for (const EmbeddedModel& model : embedded_models())
        names.emplace_back(model.name);
    std::error_code error;
    if (const std::string file = name_or_path + ".toml"; std::filesystem::exists(file, error))
        throw InputError(fmt::format("there is no shipped model '{}'", name_or_path),
                         fmt::format("the file is called {}", file));
    throw InputError(fmt::format("there is no shipped model '{}'", name_or_path),
                     name_remedy(name_or_path, names) + " (the name of a file ends in .toml or contains a slash)");
}

} // namespace graze
