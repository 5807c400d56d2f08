#include "graze/study/study_catalogue.hpp"

#include "graze/model/catalogue.hpp"
#include "model/catalogue_data.hpp"
#include "study/study_reader.hpp"

#include <fmt/format.h>

#include <filesystem>

namespace graze {

std::vector<std::string> shipped_studies() {
    std::vector<std::string> names;
    for (const EmbeddedModel& study : embedded_studies())
        names.emplace_back(study.name);
    return names;
}

std::string shipped_study_text(const std::string& name) {
    for (const EmbeddedModel& study : embedded_studies())
        if (study.name == name)
            return std::string(study.text);
    std::error_code error;
    if (const std::string file = name + ".toml"; std::filesystem::exists(file, error))
        throw InputError(fmt::format("there is no study '{}'", name), fmt::format("the file is called {}", file));
    throw InputError(fmt::format("there is no study '{}'", name),
                     study_name_remedy(name, shipped_studies()) + " (the name of a file ends in .toml)");
}

Study load_study(const std::string& name_or_path, const ParameterValues& set) {
    return is_model_path(name_or_path) ? read_study(name_or_path, set)
                                       : parse_study(shipped_study_text(name_or_path), name_or_path, set);
}

} // namespace graze
