#include "graze/base/input_error.hpp"
#include "graze/layout/gds_stream.hpp"
#include "graze/layout/layout.hpp"
#include "graze/layout/layout_table.hpp"
#include "graze/layout/process_recipe.hpp"
#include "graze/layout/process_steps.hpp"
#include "graze/picture/fabrication_picture.hpp"
#include "graze/picture/layout_picture.hpp"
#include "program/commands.hpp"
#include "program/drawing.hpp"
#include "program/layout_outputs.hpp"
#include "program/mpi_workers.hpp"
#include "program/output_file.hpp"
#include "program/values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>

namespace graze {

namespace {

const std::vector<std::string> picture_kinds{"svg", "png", "pdf"};

/// Paths of the drawings that are asked for; `gds` is empty if none is.
struct AskedFiles {
    std::string gds;
    std::vector<std::string> pictures;
};

/// Sorts the drawings by kind: `--output` may name GDSII or a picture. Checks the endings of all output files.
AskedFiles asked_for(const LayoutArguments& arguments) {
    AskedFiles files;
    if (!arguments.picture.empty()) {
        picture_ending(arguments.picture, "--picture", picture_kinds);
        files.pictures.push_back(arguments.picture);
    }
    std::vector<std::string> all = picture_kinds;
    all.insert(all.begin(), {"gds", "gds2", "gdsii"});
    if (!arguments.markers.empty())
        picture_ending(arguments.markers, "--markers", {"lyrdb"});
    if (!arguments.verilog.empty())
        picture_ending(arguments.verilog, "--verilog-a", {"va"});
    if (arguments.file.empty())
        return files;
    const std::string ending = picture_ending(arguments.file, "--output", all);
    if (ending.starts_with("gds"))
        files.gds = arguments.file;
    else
        files.pictures.push_back(arguments.file);
    return files;
}

bool is_picture(const std::string& path) {
    return std::any_of(picture_kinds.begin(), picture_kinds.end(),
                       [&](const std::string& kind) { return path.ends_with('.' + kind); });
}

/// Checks that all output files can be written, before any is.
void require_places(const LayoutArguments& arguments) {
    if (!arguments.recipe.empty() && !arguments.recipe.ends_with(".md") && !is_picture(arguments.recipe))
        throw InputError({"--recipe", 0, 0}, fmt::format("'{}' is neither text nor a picture", arguments.recipe),
                         "end its name in .md, .svg, .png or .pdf");
    for (const auto& [option, path] :
         {NamedFile{"--output", arguments.file}, NamedFile{"--picture", arguments.picture},
          NamedFile{"--parameters", arguments.parameters}, NamedFile{"--recipe", arguments.recipe},
          NamedFile{"--markers", arguments.markers}, NamedFile{"--verilog-a", arguments.verilog}}) {
        if (path.empty())
            continue;
        if (const auto folder = std::filesystem::path(path).parent_path(); !folder.empty())
            make_folder(folder.string(), option);
        require_writable(path);
    }
}

/// Options of `graze layout` that draw the masks of the same device; the recipe quotes them.
std::vector<std::string> options_again(const LayoutArguments& arguments, bool ruled) {
    std::vector<std::string> options;
    if (!arguments.from_design.empty()) {
        options.emplace_back("--from-design");
        options.push_back(arguments.from_design);
    }
    for (const std::string& one : arguments.set) {
        options.emplace_back("--set");
        options.push_back(one);
    }
    if (!ruled)
        options.emplace_back("--despite-rules");
    return options;
}

/// Writes the recipe as text, or as cross-sections if the file is a picture.
void write_recipe(const LayoutArguments& arguments, const DeviceFile& file, bool ruled) {
    if (!is_picture(arguments.recipe))
        return write_file(arguments.recipe, recipe_text(file, options_again(arguments, ruled)));
    const Layout device = draw_device_layout(file);
    draw_fabrication(process_steps(file, device, plane_through_stop(device)), arguments.recipe);
}

/// @param workers for the devices of wafers; null: there are none
int draw_device(const LayoutArguments& arguments, const Console& console, Workers* workers) {
    const auto [path, pictures] = asked_for(arguments);
    require_places(arguments);
    DeviceFile file;
    with_places_of(arguments.set, [&] {
        file = load_device_file(arguments.design, parameter_values(arguments.set, dimension_of_text));
    });
    std::optional<DesignedDevice> designed;
    if (!arguments.from_design.empty()) {
        designed = matched_device(file, arguments.design, arguments.from_design);
        file = designed->matched.file;
    }
    Layout layout = arguments.wafer ? draw_wafer_layout(file) : draw_device_layout(file);
    for (const auto& [option, one] :
         {NamedFile{"--parameters", arguments.parameters}, NamedFile{"--verilog-a", arguments.verilog}})
        if (!one.empty() && layout.devices.size() > 1)
            throw InputError(
                {option, 0, 0},
                fmt::format("the wafer has {} devices that differ (wafer.vary), and one file is for one device",
                            layout.devices.size()),
                "leave --wafer out, and name the device that is meant by --set NAME=VALUE");
    const bool all_devices = arguments.yield && !arguments.wafer; // the wafer may have devices that differ
    const bool ruled = check_rules(file, all_devices ? draw_wafer_layout(file) : layout, arguments.despite_rules,
                                   arguments.markers, console);
    const Table table = layout_table(layout, file);
    if (!arguments.verilog.empty()) // first, since it throws for models that Verilog-A cannot express
        write_verilog_a(file, layout.devices.front(), arguments.verilog);
    if (!arguments.parameters.empty())
        write_device_parameters(file, layout.devices.front(), arguments.parameters);
    if (!arguments.recipe.empty())
        write_recipe(arguments, file, ruled);
    for (const std::string& picture : pictures)
        draw_layout(layout, picture, arguments.mask);
    if (!path.empty()) {
        if (!arguments.mask)
            add_masks(layout);
        write_file(path, gds_stream(arguments.mask ? mask_library(layout, *arguments.mask) : layout.library));
    }
    if (arguments.yield) {
        const Layout wafer = arguments.wafer ? layout : draw_wafer_layout(file);
        const int code = layout_yield(arguments, file, wafer, console, workers);
        return code == exit_success && !ruled ? exit_irregular : code;
    }
    if (designed) {
        const int code = report_drawn_design(*designed, arguments.from_design, arguments, console);
        return code == exit_success && !ruled ? exit_irregular : code;
    }
    JsonObject heading;
    heading.add("design", file.name);
    heading.add("top", layout.top);
    deliver(table, arguments.output, heading, console);
    return ruled ? exit_success : exit_irregular;
}

} // namespace

int layout_command(const LayoutArguments& arguments, const Console& console) {
    if (!arguments.yield)
        return draw_device(arguments, console, nullptr);
    return with_workers(arguments.jobs, [&](const std::unique_ptr<Workers>& workers) {
        return draw_device(arguments, console, workers.get());
    });
}

} // namespace graze
