#include "graze/design/design.hpp"

#include "design/design_reader.hpp"
#include "graze/base/text_file.hpp"
#include "graze/model/catalogue.hpp"
#include "model/catalogue_data.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace graze {

Tolerance DesignTolerance::at(ParameterId parameter, double value) const {
    return {parameter, spread, share ? size * std::abs(value) : size};
}

void DesignDimension::require_first(double value) const {
    if (!(least <= value && value <= greatest))
        throw InputError(place,
                         fmt::format("'{}' is {} at first, which is not from {} to {}", name, value, least, greatest),
                         "give a range around it, or another value in `set`");
    if (tolerance && tolerance->share && value == 0)
        throw InputError(place, fmt::format("'{}' is zero, of which there are no percents", name),
                         "give the tolerance in its unit");
}

bool Wanted::is_empty() const {
    return !least && !greatest && !value && !outcome && !overshoot && !least_reset && !clear && sensitivities.empty() &&
           !least_yield;
}

std::optional<std::size_t> Design::find_dimension(std::string_view dimension) const {
    const auto found = std::ranges::find(dimensions, dimension, &DesignDimension::name);
    if (found == dimensions.end())
        return std::nullopt;
    return static_cast<std::size_t>(found - dimensions.begin());
}

Design parse_design(std::string_view text, const std::string& file) {
    const toml::table root = parse_toml(text, file, "docs/design.md shows how a design is written");
    return DesignReader(file).read(root);
}

Design read_design(const std::string& path) {
    return parse_design(read_text_file(path, "design", longest_model), path);
}

std::vector<std::string> shipped_designs() {
    std::vector<std::string> names;
    for (const EmbeddedModel& design : embedded_designs())
        names.emplace_back(design.name);
    return names;
}

std::string shipped_design_text(const std::string& name) {
    return embedded_text(embedded_designs(), "design", name);
}

Design load_design(const std::string& name_or_path) {
    return is_model_path(name_or_path) ? read_design(name_or_path)
                                       : parse_design(shipped_design_text(name_or_path), name_or_path);
}

} // namespace graze
