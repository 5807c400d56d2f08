#include "graze/base/input_error.hpp"
#include "graze/grazing/trial.hpp"
#include "graze/results/table_text.hpp"
#include "graze/results/touch_facts.hpp"
#include "program/commands.hpp"

#include <vector>

namespace graze {

namespace {

/// The values of a table of facts, by their names.
JsonObject values_of(const Table& facts) {
    JsonObject values;
    for (std::size_t row = 0; row < facts.rows(); ++row)
        add_cell(values, facts.text(row, 0), facts, row, 1);
    return values;
}

JsonObject grazing_heading(const ResultFile& file, const StoredOrbit& stored, const TouchReport& report,
                           const Table& facts) {
    JsonObject heading = heading_of_point(file, stored);
    heading.add("reason", report.verdict.reason);
    heading.add("values", values_of(facts));
    std::vector<JsonObject> motions;
    if (report.trial)
        for (const TrialMotion& motion : report.trial->motions) {
            JsonObject& one = motions.emplace_back();
            one.add("parameter", motion.parameter);
            one.add("clearance", motion.clearance);
            one.add("predicted", motion.predicted);
            one.add("largest", motion.largest);
            one.add("contacts", static_cast<double>(motion.contacts));
            one.add("ended", motion.ended ? 1.0 : 0.0);
        }
    heading.add("trial_motions", motions);
    return heading;
}

} // namespace

int grazing_command(const GrazingArguments& arguments, const Console& console) {
    const ResultFile file(result_path(arguments.file), ResultFile::Access::read);
    const TouchingOrbit orbit =
        find_touching_orbit(file, arguments.point, arguments.parameter, {"POINT", 0, 0}, {"--parameter", 0, 0});
    const TouchReport report =
        touch_report(System(orbit.stored.run.model), orbit.map, orbit.parameter, arguments.verify);
    const Table facts = touch_facts(orbit, report);
    deliver(facts, arguments.output, grazing_heading(file, orbit.stored, report, facts), console);
    const bool contradicted = report.trial && report.trial->outcome == TrialOutcome::contradicted;
    return contradicted ? exit_irregular : exit_success;
}

} // namespace graze
