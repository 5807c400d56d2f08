#include "program/layout_outputs.hpp"

#include "graze/base/input_error.hpp"
#include "graze/design/design_folder.hpp"
#include "graze/model/model_file.hpp"
#include "program/commands.hpp"
#include "program/design_progress.hpp"
#include "program/interrupt.hpp"
#include "program/kept_inputs.hpp"
#include "program/output_file.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <optional>

namespace graze {

namespace {

std::string path_in(const std::string& folder, const char* name) {
    return (std::filesystem::path(folder) / name).string();
}

} // namespace

DesignedDevice matched_device(const DeviceFile& file, const std::string& design, const std::string& folder) {
    const Design own = load_design(design);
    require_device_of(own, folder, {"--from-design", 0, 0});
    const std::string path = path_in(folder, device_model_name);
    DesignedDevice result{own, read_model(path), {}};
    keep_inputs_of(result.own);
    KeptInputs::add("the designed device", path);
    if (result.device.name != result.own.model.name)
        throw InputError({"--from-design", 0, 0},
                         fmt::format("the device of {} is one of the model {}, and the design {} has the model {}",
                                     folder, result.device.name, design, result.own.model.name),
                         "name the design from which the folder comes");
    result.matched = match_drawing(file, result.device);
    return result;
}

int report_drawn_design(const DesignedDevice& designed, const std::string& folder, const LayoutArguments& arguments,
                        const Console& console) {
    const auto path = [&](const char* name) { return path_in(folder, name); };
    const InterruptGuard guard;
    StatusLine line(console, console.terminal);
    const std::optional<DrawnDesign> drawn =
        drawn_design(designed, path("drawn.sqlite"), interactive_options(arguments.jobs, line));
    if (!drawn) {
        console.err << "graze: interrupted; nothing but the way to the trip point is kept\n";
        return InterruptGuard::exit_code();
    }
    write_file(path("drawing.toml"), write_parameter_file(solved_numbers(designed)));
    write_file(path("drawn.toml"), write_parameter_file(drawn_parameters(designed)));
    write_file(path("drawn.csv"), csv_text(drawn->table));
    JsonObject heading;
    heading.add("design", designed.own.name);
    deliver(drawn->table, arguments.output, heading, console);
    if (arguments.output.format == TableFormat::table)
        for (const char* name : {"drawing.toml", "drawn.toml", "drawn.csv"})
            console.out << path(name) << '\n';
    return drawn->met ? exit_success : exit_irregular;
}

} // namespace graze
