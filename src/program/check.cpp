#include "graze/model/check.hpp"
#include "graze/model/catalogue.hpp"
#include "graze/symbolic/input_error.hpp"
#include "program/commands.hpp"
#include "program/describe.hpp"
#include "program/graph.hpp"
#include "program/output_file.hpp"
#include "program/values.hpp"

namespace graze {

int check_command(const CheckArguments& arguments, const Console& console) {
    const Model model = load_program_model(arguments.model);
    require_distinct({{"the model", is_model_path(arguments.model) ? arguments.model : ""},
                      {"--graph", arguments.graph},
                      {"--output", arguments.output.file}});
    for (const std::string& warning : model_warnings(model))
        console.err << "graze: warning: " << arguments.model << ": " << warning << '\n';
    if (!arguments.graph.empty())
        draw_graph(model, arguments.graph);
    if (arguments.output.format != TableFormat::table) {
        JsonObject heading;
        heading.add("model", model.name);
        deliver(describe_in_table(model), arguments.output, heading, console);
    } else if (arguments.output.file.empty()) {
        console.out << describe(model);
    } else {
        write_file(arguments.output.file, describe(model));
    }
    return exit_success;
}

} // namespace graze
