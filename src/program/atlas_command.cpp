#include "graze/atlas/atlas_tables.hpp"
#include "graze/base/input_error.hpp"
#include "graze/model/catalogue.hpp"
#include "graze/results/name_advice.hpp"
#include "graze/study/outdated_runs.hpp"
#include "graze/study/stored_study.hpp"
#include "program/atlas_study.hpp"
#include "program/atlas_text.hpp"
#include "program/commands.hpp"
#include "program/mpi_workers.hpp"
#include "program/output_file.hpp"
#include "program/study_computing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace graze {

namespace {

/// The atlas that is meant. @throws InputError when there is none, or several
std::string atlas_in(const Study& study, const std::string& named, const std::string& file) {
    std::vector<std::string> atlases;
    for (const StudyRun& run : study.runs)
        if (run.kind == RunKind::atlas)
            atlases.push_back(run.name);
    if (atlases.empty())
        throw InputError({file, 0, 0}, "there is no atlas in these results",
                         "make one: graze atlas MODEL --along NAME=FROM:TO");
    if (named.empty() && atlases.size() > 1)
        throw InputError({file, 0, 0}, fmt::format("there are {} atlases", atlases.size()),
                         fmt::format("choose one by --run, such as {}", atlases.front()));
    if (!named.empty() && std::ranges::find(atlases, named) == atlases.end())
        throw InputError({"--run", 0, 0}, fmt::format("there is no atlas '{}'", named),
                         name_advice(named, atlases, ""));
    return named.empty() ? atlases.front() : named;
}

/// Tables with more rows than these are not shown unless they are asked for.
constexpr std::size_t most_rows = 40;

/// Columns that people want to see of every row.
std::vector<std::string> kept_columns() {
    return {"name", "type_name", "run", "what", "count"};
}

/// @return the exit code
int show(const AtlasFindings& findings, const AtlasArguments& arguments, bool with_summary, const Console& console) {
    JsonObject heading;
    heading.add("graze", GRAZE_VERSION);
    add_summary(heading, findings);
    const OutputArguments& output = arguments.output;
    if (!arguments.what.empty()) {
        deliver(atlas_table(findings, arguments.what), output, heading, console, kept_columns());
    } else if (output.format != TableFormat::table) {
        deliver(curves_and_points(findings), output, heading, console);
    } else {
        if (with_summary)
            console.out << summary_text(findings);
        for (const char* name : {"curves", "points"})
            if (const Table table = atlas_table(findings, name); table.rows() > most_rows) {
                console.out << fmt::format("\n`graze atlas {} --what {}` lists all {} {}.\n", arguments.subject, name,
                                           table.rows(), name);
            } else if (table.rows() > 0) {
                console.out << '\n';
                deliver(table, output, heading, console, kept_columns());
            }
    }
    return has_contradiction(findings) ? exit_irregular : exit_success;
}

int show_stored(const AtlasArguments& arguments, bool with_summary, const Console& console) {
    const std::string path = result_path(arguments.subject);
    const ResultFile file(path, ResultFile::Access::read);
    const Study study = stored_study(file);
    return show(atlas_findings(study, atlas_in(study, arguments.run, path), file), arguments, with_summary, console);
}

/// Another box in the same folder would replace what may have taken hours.
/// @throws InputError when the folder has an atlas of another box, or of another model
void require_same_atlas(const Study& study, const std::string& folder) {
    const std::string path = (std::filesystem::path(folder) / "results.sqlite").string();
    if (std::error_code error; !std::filesystem::exists(path, error))
        return;
    const ResultFile file(path, ResultFile::Access::read);
    if (file.find_run(atlas_run_name) && !outdated_runs(study, file).contains(atlas_run_name))
        return;
    if (!file.runs().empty())
        throw InputError({"--output", 0, 0},
                         fmt::format("the folder {} has results of another box, model or study", folder),
                         "choose another folder, or remove this one");
}

/// Explores, tells what was found as of any study, and then shows the tables.
int explore(const AtlasArguments& arguments, const Console& console, std::unique_ptr<Workers> workers) {
    Study study = atlas_study(arguments);
    const std::string folder = arguments.folder.empty() ? study.name : arguments.folder;
    require_same_atlas(study, folder);
    RunArguments running;
    static_cast<StudyArguments&>(running) = arguments;
    running.jobs = arguments.jobs;
    // What a program reads is one table alone.
    const bool alone = arguments.output.format != TableFormat::table || !arguments.what.empty();
    running.quiet = arguments.quiet || alone;
    const int code =
        compute_study(StudyRequest::in_folder(std::move(study), folder), running, console, std::move(workers));
    const bool told = code == exit_success || code == exit_irregular;
    if (!told || arguments.quiet)
        return code;
    AtlasArguments stored = arguments;
    stored.subject = folder;
    show_stored(stored, false, console);
    return code;
}

/// @throws InputError for a model, of which nothing says what is explored
void require_results(const AtlasArguments& arguments) {
    if (is_database(result_path(arguments.subject)))
        return;
    load_model(arguments.subject); // says what is wrong if there is none either
    throw InputError({"--along", 0, 0},
                     fmt::format("nothing says along which parameter '{}' is explored", arguments.subject),
                     "give one or two ranges, --along NAME=FROM:TO, or name results that have an atlas");
}

} // namespace

int atlas_command(const AtlasArguments& arguments, const Console& console) {
    if (arguments.along.empty()) {
        require_results(arguments);
        return show_stored(arguments, true, console);
    }
    return with_workers(arguments.jobs, [&](std::unique_ptr<Workers> workers) {
        return explore(arguments, console, std::move(workers));
    });
}

} // namespace graze
