#include "program/describe.hpp"

#include "graze/results/model_table.hpp"

#include <fmt/format.h>

namespace graze {

std::string describe(const Model& model, std::size_t width) {
    std::string text =
        fmt::format("{}{}\n", model.name, model.time_unit.empty() ? "" : fmt::format(" (time in {})", model.time_unit));
    for (const std::string& paragraph : {model.text, model.source.empty() ? "" : "Source: " + model.source})
        if (!paragraph.empty())
            text += wrapped(paragraph, width) + '\n';
    return text + model_listing(model);
}

} // namespace graze
