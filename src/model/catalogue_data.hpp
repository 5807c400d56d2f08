#pragma once

#include <span>
#include <string_view>

namespace graze {

/// A file of models/, studies/ or designs/ that is embedded in the program (cmake/catalogue.cmake writes the source).
struct EmbeddedModel {
    std::string_view name; ///< name of the file, without its extension
    std::string_view text;
};

/// In alphabetical order.
std::span<const EmbeddedModel> embedded_models();
std::span<const EmbeddedModel> embedded_studies();
std::span<const EmbeddedModel> embedded_designs();

} // namespace graze
