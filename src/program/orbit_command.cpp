#include "graze/base/input_error.hpp"
#include "graze/picture/figure_script.hpp"
#include "graze/picture/result_picture.hpp"
#include "graze/results/orbit_table.hpp"
#include "graze/results/stored_orbit.hpp"
#include "graze/results/table_text.hpp"
#include "program/commands.hpp"
#include "program/drawing.hpp"
#include "program/values.hpp"

#include <fmt/format.h>

#include <cmath>
#include <complex>

namespace graze {

namespace {

constexpr std::size_t default_samples = 200;

/// Real and imaginary parts of multipliers; infinite ones as a text. Multipliers do not exist after a contact without
/// speed: the list is empty then.
std::vector<JsonObject> list_of(const std::vector<std::complex<double>>& multipliers) {
    std::vector<JsonObject> list;
    for (const std::complex<double>& multiplier : multipliers) {
        JsonObject& one = list.emplace_back();
        if (std::isinf(multiplier.real()))
            one.add("real", multiplier.real() > 0 ? "inf" : "-inf");
        else
            one.add("real", multiplier.real());
        one.add("imaginary", multiplier.imag());
    }
    return list;
}

JsonObject orbit_heading(const ResultFile& file, const StoredOrbit& stored) {
    const OrbitRecord& record = stored.record;
    const OrbitSolution& solution = record.point.solution;
    const Model& model = stored.run.model;
    JsonObject heading = heading_of_point(file, stored), parameters, units;
    const std::vector<double> values = parameters_of(stored.run, record);
    for (std::size_t i = 0; i < values.size(); ++i)
        parameters.add(stored.run.record.coordinates[i].name, values[i]);
    for (const ResultColumn& column : stored.run.record.coordinates)
        units.add(column.name, column.unit);
    heading.add("type", short_name(record.point.type));
    heading.add("parameters", parameters);
    heading.add("parameter_units", units);
    heading.add("time_unit", model.time_unit);
    heading.add("period", solution.orbit.period());
    heading.add("signature", to_string(model, solution.orbit.signature));
    heading.add("symmetry", solution.orbit.symmetry ? model.symmetries[*solution.orbit.symmetry].name : "");
    heading.add("multipliers", list_of(solution.multipliers));
    if (solution.other_multipliers > 0) {
        heading.add("other_multipliers", static_cast<double>(solution.other_multipliers));
        heading.add("others_within", solution.others_within);
    }
    heading.add("half_multipliers", list_of(solution.half_multipliers));
    heading.add("eigenvalues", list_of(solution.eigenvalues));
    heading.add("stable", record.stable ? 1.0 : 0.0);
    heading.add("admissible", solution.certificate.admissible ? 1.0 : 0.0);
    heading.add("reason", solution.certificate.reason);
    heading.add("detail", record.point.detail);
    heading.add("residual", solution.residual);
    heading.add("segments", json_rows(segment_table(model, solution), MissingCells::null));
    heading.add("minima", json_rows(minimum_table(model, solution), MissingCells::null));
    heading.add("end_values", json_rows(end_value_table(model, solution), MissingCells::null));
    return heading;
}

void draw_orbit(const OrbitArguments& arguments, const ResultFile& file, const StoredOrbit& stored,
                const Console& console) {
    StudyPicture picture;
    picture.kind = arguments.x == "t" ? "history" : "portrait";
    picture.name = picture.title = "";
    picture.runs = {stored.run.record.name};
    picture.points = {fmt::format("{}", stored.record.number)};
    picture.x = arguments.x;
    picture.y = split_list(arguments.y);
    picture.place = {"--plot", 0, 0};
    draw_figure(make_picture(picture, file).figure, arguments.plot, arguments.data);
    console.out << arguments.plot << '\n';
}

} // namespace

int orbit_command(const OrbitArguments& arguments, const Console& console) {
    if (!arguments.plot.empty())
        picture_ending(arguments.plot, "--plot", {"svg", "png", "pdf", "eps"});
    const ResultFile file(result_path(arguments.file), ResultFile::Access::read);
    const StoredOrbit stored = find_stored_orbit(file, arguments.point, {"POINT", 0, 0});
    if (!arguments.plot.empty()) {
        draw_orbit(arguments, file, stored, console);
        return exit_success;
    }
    if (!arguments.x.empty() || !arguments.y.empty())
        throw InputError("--x and --y say what to draw, and nothing is drawn", "name a picture by --plot FILE");
    const Orbit orbit = whole_orbit(System(stored.run.model), stored.record.point.solution.orbit);
    const Model model = model_at(stored.run.model, orbit);
    const auto quantities = requested_quantities(model, arguments.quantities, "--quantity");
    const auto motion = orbit_motion(model, orbit, arguments.samples.value_or(default_samples));
    deliver(orbit_table(model, motion, quantities), arguments.output, orbit_heading(file, stored), console,
            names_of(quantities));
    bool whole = true;
    for (std::size_t s = 0; s < motion.size(); ++s)
        if (!motion[s].problem.empty()) {
            whole = false;
            console.err << fmt::format("graze: segment {} cannot be followed to its end: {}\n", s + 1,
                                       motion[s].problem);
        }
    if (is_unphysical(stored.record))
        console.err << fmt::format("graze: warning: the model would not follow this orbit: {}\n",
                                   stored.record.point.solution.certificate.reason);
    return whole ? exit_success : exit_irregular;
}

} // namespace graze
