#include "graze/model/parameter_file.hpp"

#include "graze/base/text_file.hpp"
#include "model/model_file_toml.hpp"

#include <fmt/format.h>

#include <cmath>

namespace graze {

namespace {

constexpr std::size_t longest_file = 16'000'000;

ParameterFile::Values group_values(const TomlReader& toml, const TomlEntry& group,
                                   std::map<std::string, Place>& places) {
    ParameterFile::Values values;
    for (const TomlEntry& entry : toml.entries(toml.table(group), group.path)) {
        const auto number = entry.node->value<double>();
        if (!entry.node->is_number() || !number)
            toml.fail_type(entry, "a number");
        if (!std::isfinite(*number))
            throw InputError(toml.place(*entry.node), fmt::format("'{}' is not finite", entry.name),
                             "give a finite number");
        values.emplace_back(entry.name, *number);
        places[entry.path] = entry.place;
    }
    return values;
}

std::string quoted_value(const std::string& value) {
    std::string text = "\"";
    for (const char c : value)
        if (c == '"' || c == '\\')
            text += std::string("\\") + c;
        else if (static_cast<unsigned char>(c) < ' ' || c == 127)
            text += fmt::format("\\u{:04x}", static_cast<unsigned>(c));
        else
            text += c;
    return text + "\"";
}

std::string table_of(const char* name, const ParameterFile::Values& values) {
    if (values.empty())
        return {};
    std::string text = fmt::format("\n[{}]\n", name);
    for (const auto& [key, value] : values)
        text += fmt::format("{} = {}{}\n", key, value,
                            fmt::format("{}", value).find_first_of(".en") == std::string::npos ? ".0" : "");
    return text;
}

} // namespace

ParameterFile parse_parameter_file(const std::string& text, const std::string& path) {
    const toml::table root =
        parse_toml(text, path, "docs/measure-identify-predict.md shows how a file of parameters is written");
    const TomlReader toml(path);
    ParameterFile file;
    for (const TomlEntry& entry : toml.entries(root, "", {"model", "text", "set", "from", "errors"})) {
        if (entry.name == "model") {
            file.model = toml.line(entry);
            file.places["model"] = entry.place;
        } else if (entry.name == "text")
            file.text = toml.string(entry);
        else
            (entry.name == "set"    ? file.set
             : entry.name == "from" ? file.from
                                    : file.errors) = group_values(toml, entry, file.places);
    }
    return file;
}

ParameterFile read_parameter_file(const std::string& path) {
    return parse_parameter_file(read_text_file(path, "parameter file", longest_file), path);
}

std::string write_parameter_file(const ParameterFile& file) {
    std::string text;
    if (!file.model.empty())
        text += fmt::format("model = {}\n", quoted_value(file.model));
    if (!file.text.empty())
        text += fmt::format("text = {}\n", quoted_value(file.text));
    return text + table_of("set", file.set) + table_of("from", file.from) + table_of("errors", file.errors);
}

} // namespace graze
