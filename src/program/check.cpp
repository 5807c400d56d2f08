#include "graze/base/input_error.hpp"
#include "graze/model/catalogue.hpp"
#include "graze/results/model_findings.hpp"
#include "graze/results/model_table.hpp"
#include "program/commands.hpp"
#include "program/describe.hpp"
#include "program/drawing.hpp"
#include "program/output_file.hpp"
#include "program/values.hpp"

#include <fmt/format.h>

#include <fstream>
#include <string>

namespace graze {

namespace {

/// The place in a model file where the part "TABLE.NAME" is defined: as [TABLE.NAME], or as NAME = ... under [TABLE].
/// It has no line if the definition is not found.
Place place_of(const std::string& model, const std::string& part) {
    Place place{model, 0, 0};
    const std::size_t dot = part.find('.');
    if (dot == std::string::npos || !is_model_path(model))
        return place;
    const std::string table = part.substr(0, dot), name = part.substr(dot + 1);
    std::ifstream stream(model, std::ios::binary);
    bool inside = false;
    int number = 0;
    for (std::string line; std::getline(stream, line);) {
        ++number;
        const std::size_t begin = line.find_first_not_of(" \t");
        if (begin == std::string::npos)
            continue;
        const bool header = line[begin] == '[';
        if (header)
            inside = line.compare(begin, table.size() + 2, fmt::format("[{}]", table)) == 0;
        const std::string whole = fmt::format("[{}]", part);
        const std::size_t after = line.find_first_not_of(" \t", begin + name.size());
        const bool key = inside && !header && line.compare(begin, name.size(), name) == 0 &&
                         after != std::string::npos && (line[after] == '=' || line[after] == '.');
        if (key || (header && line.compare(begin, whole.size(), whole) == 0))
            return {model, number, static_cast<int>(begin) + 1};
    }
    return place;
}

} // namespace

int check_command(const CheckArguments& arguments, const Console& console) {
    const Model model = load_model(arguments.model);
    for (const ModelWarning& warning : model_findings(model))
        console.err << "graze: warning: " << place_of(arguments.model, warning.part).text() << ": " << warning.text
                    << '\n';
    if (!arguments.graph.empty())
        draw_graph(model, arguments.graph);
    if (arguments.output.format != TableFormat::table) {
        JsonObject heading;
        heading.add("model", model.name);
        deliver(model_table(model), arguments.output, heading, console);
    } else if (arguments.output.file.empty()) {
        console.out << describe(model, console.width);
    } else {
        write_file(arguments.output.file, describe(model));
    }
    return exit_success;
}

} // namespace graze
