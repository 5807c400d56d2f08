#include "program/commands.hpp"

#include "graze/base/input_error.hpp"
#include "graze/model/catalogue.hpp"
#include "graze/results/name_advice.hpp"
#include "graze/study/study_catalogue.hpp"
#include "program/command_line.hpp"
#include "program/kept_inputs.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace graze {

int identify_study(const IdentifyArguments& arguments, const Console& console) {
    const std::vector<std::string> shipped = shipped_studies();
    const bool is_study =
        is_model_path(arguments.what) || std::find(shipped.begin(), shipped.end(), arguments.what) != shipped.end();
    if (!is_study) {
        std::vector<std::string> known = kinds_of_estimates();
        known.insert(known.end(), shipped.begin(), shipped.end());
        throw InputError({"WHAT", 0, 0}, fmt::format("there is no '{}' to be found", arguments.what),
                         name_advice(arguments.what, known, ""));
    }
    if (!arguments.reading.files.empty())
        throw InputError({"FILE", 0, 0}, "a study says itself which records it reads", "name the study alone");
    const Study study = load_study(arguments.what);
    keep_inputs_of(study); // before the computation: an output that would replace an input is refused now
    RunArguments run;
    run.study = arguments.what;
    run.quiet = true;
    for (const StudyRun& one : study.runs)
        if (one.kind == RunKind::identify)
            run.only.push_back(one.name);
    if (run.only.empty())
        throw InputError({arguments.what, 0, 0}, "the study has no run of kind identify",
                         "docs/study-format.md says how such runs are written");
    const int code = run_command(run, console);
    if (code != exit_success && code != exit_irregular)
        return code;
    ExportArguments found;
    found.file = study.name;
    found.what = "estimates";
    found.runs = run.only;
    found.output = arguments.reading.output;
    const TableFormat format = found.output.format;
    found.hdf5 = format == TableFormat::csv ? "csv" : format == TableFormat::json ? "json" : "table";
    export_command(found, console);
    return code;
}

} // namespace graze
