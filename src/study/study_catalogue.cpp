#include "graze/study/study_catalogue.hpp"

#include "graze/model/catalogue.hpp"
#include "model/catalogue_data.hpp"
#include "study/study_reader.hpp"

namespace graze {

std::vector<std::string> shipped_studies() {
    std::vector<std::string> names;
    for (const EmbeddedModel& study : embedded_studies())
        names.emplace_back(study.name);
    return names;
}

std::string shipped_study_text(const std::string& name) {
    return embedded_text(embedded_studies(), "study", name);
}

Study load_study(const std::string& name_or_path, const ParameterValues& set) {
    return is_model_path(name_or_path) ? read_study(name_or_path, set)
                                       : parse_study(shipped_study_text(name_or_path), name_or_path, set);
}

} // namespace graze
