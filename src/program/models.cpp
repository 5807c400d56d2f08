#include "graze/base/input_error.hpp"
#include "graze/model/catalogue.hpp"
#include "graze/model/microbeam.hpp"
#include "graze/model/model_file.hpp"
#include "graze/results/model_table.hpp"
#include "program/commands.hpp"
#include "program/describe.hpp"
#include "program/output_file.hpp"
#include "program/values.hpp"

#include <fmt/format.h>

namespace graze {

namespace {

constexpr std::string_view family = "microbeam";

bool asks_for_family(const ModelsArguments& arguments) {
    return arguments.beam_modes || arguments.points || !arguments.quadrature.empty();
}

Model family_member(const ModelsArguments& arguments) {
    if (arguments.name != family)
        throw InputError("--beam-modes, --quadrature and --points choose a member of the microbeam family",
                         "write graze models microbeam --beam-modes 9");
    MicrobeamOptions options;
    options.modes = arguments.beam_modes.value_or(options.modes);
    options.points = arguments.points.value_or(options.points);
    if (arguments.quadrature == "gauss")
        options.quadrature = Quadrature::gauss;
    else if (!arguments.quadrature.empty() && arguments.quadrature != "simpson")
        throw InputError({"--quadrature", 0, 0}, fmt::format("there is no rule '{}'", arguments.quadrature),
                         name_advice(arguments.quadrature, {"simpson", "gauss"}, ""));
    return microbeam(options);
}

/// The text of the model's file. Shipped files keep their comments; others are written from the model.
std::string file_text(const ModelsArguments& arguments) {
    if (asks_for_family(arguments))
        return write_model(family_member(arguments));
    if (const auto entry = find_in_catalogue(arguments.name))
        return entry->text;
    return write_model(load_model(arguments.name));
}

void list(const ModelsArguments& arguments, const Console& console) {
    Table table({{"name", ""}, {"summary", ""}});
    for (const CatalogueEntry& entry : catalogue()) {
        table.add(entry.name, entry.summary);
    }
    deliver(table, arguments.output, {}, console);
}

} // namespace

int models_command(const ModelsArguments& arguments, const Console& console) {
    if (arguments.name.empty()) {
        if (arguments.show || !arguments.file.empty() || asks_for_family(arguments))
            throw InputError("the model's name is missing", "graze models lists the names");
        list(arguments, console);
        return exit_success;
    }
    if (!arguments.file.empty())
        write_file(arguments.file, file_text(arguments));
    if (arguments.show) {
        console.out << file_text(arguments);
    } else if (arguments.file.empty()) {
        const Model model = asks_for_family(arguments) ? family_member(arguments) : load_model(arguments.name);
        if (arguments.output.format == TableFormat::table)
            console.out << describe(model, console.width);
        else
            deliver(model_table(model), arguments.output, {}, console);
    }
    return exit_success;
}

} // namespace graze
