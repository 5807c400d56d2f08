#pragma once

#include <span>
#include <string_view>

namespace graze {

/// A file of models/, studies/ or designs/ in the program; the build writes the source that defines them
/// (cmake/catalogue.cmake).
struct EmbeddedModel {
    std::string_view name; ///< of the file, without its ending
    std::string_view text;
};

/// In alphabetical order.
std::span<const EmbeddedModel> embedded_models();
std::span<const EmbeddedModel> embedded_studies();
std::span<const EmbeddedModel> embedded_designs();

} // namespace graze
