#include "graze/atlas/run_atlas.hpp"
#include "graze/base/with_place.hpp"
#include "graze/study/runner.hpp"
#include "graze/study/stored_study.hpp"
#include "graze/study/study_catalogue.hpp"
#include "graze/study/study_part.hpp"
#include "graze/study/study_schema.hpp"
#include "program/commands.hpp"
#include "program/interrupt.hpp"
#include "program/kept_inputs.hpp"
#include "program/mpi_workers.hpp"
#include "program/output_file.hpp"
#include "program/progress_line.hpp"
#include "program/slurm.hpp"
#include "program/step_lines.hpp"
#include "program/study_computing.hpp"
#include "program/study_reports.hpp"
#include "program/values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <utility>

namespace graze {

namespace {

void check_names(const Study& study, const std::vector<std::string>& only) {
    const std::vector<std::string> known = names_of(study.runs);
    for (const std::string& name : only)
        if (std::find(known.begin(), known.end(), name) == known.end())
            throw InputError({"--only", 0, 0}, fmt::format("the study has no run '{}'", name),
                             name_advice(name, known, "it has none"));
}

/// Loads the study: a shipped one, one in a file, or the copy in a result file.
StudyRequest study_request(const RunArguments& arguments) {
    const std::string stored = result_path(arguments.study);
    std::error_code error;
    const bool from_results =
        stored.ends_with(".sqlite") && (stored == arguments.study || std::filesystem::exists(stored, error));
    const std::vector<std::string> shipped = shipped_studies();
    const bool is_shipped = std::find(shipped.begin(), shipped.end(), arguments.study) != shipped.end();
    StudyRequest result;
    if (is_shipped || !from_results) {
        with_places_of(arguments.set,
                       [&] { result.study = load_study(arguments.study, parameter_values(arguments.set)); });
        std::vector<std::string> models;
        for (const StudyRun& run : result.study.runs)
            if (!run.model.name.empty() && std::find(models.begin(), models.end(), run.model.name) == models.end())
                models.push_back(run.model.name);
        require_models_of_files(arguments.set, models);
        const std::string own = result.study.set.empty() ? "" : "-" + text_of_values(result.study.set);
        result.folder = arguments.folder.empty() ? result.study.name + own : arguments.folder;
    } else {
        if (!arguments.set.empty())
            throw InputError({"--set", 0, 0}, "results have numbers, and no longer what the study computes from them",
                             "name the study instead of its results");
        result.study = stored_study(ResultFile(stored, ResultFile::Access::read));
        result.folder = arguments.folder;
        result.file = stored;
    }
    const std::filesystem::path own = std::filesystem::path(result.file).parent_path();
    if (result.folder.empty()) // continue in the folder of the result file
        result.folder = own.empty() ? "." : own.string();
    else
        return StudyRequest::in_folder(std::move(result.study), result.folder);
    return result;
}

/// Computes with the options of the command, and shows how it goes on.
std::vector<RunReport> computed(const Study& study, const RunArguments& arguments, const Console& console,
                                const std::function<std::vector<RunReport>(const RunnerOptions&)>& compute) {
    ProgressLine progress(console, (arguments.progress || console.terminal) && !arguments.steps);
    StepLines steps(study, console.err);
    RunnerOptions options;
    options.jobs = threads_for(arguments.jobs);
    options.only = split_list(arguments.only);
    options.interrupted = [] { return InterruptGuard::requested(); };
    options.one_by_one = arguments.steps; // lines of several runs at once could not be told apart
    options.progress = [&](const StudyProgress& made) { progress.update(made); };
    options.orbit = [&](const std::string& run, const OrbitRecord& record) {
        if (arguments.steps)
            steps.show(run, record);
        progress.update(run, record);
    };
    return compute(options);
}

/// Computes one part of a study into a file of its own.
int run_one_part(StudyRequest request, const RunArguments& arguments, const Console& console) {
    StudyPart part;
    with_place({"--part", 0, 0}, [&] { part = study_part(arguments.part); });
    const std::string folder = (std::filesystem::path(request.folder) / folder_of_parts).string();
    make_folder(folder, "--output");
    const std::optional<ResultFile> results = earlier_results(request.study, request.file);
    ResultFile file((std::filesystem::path(folder) / file_of_part(part)).string(), ResultFile::Access::write);
    require_same_values(request.study, file);
    if (results)
        add_atlas_runs(request.study, *results);
    std::vector<std::string> waiting;
    const std::vector<RunReport> reports = computed(request.study, arguments, console, [&](const auto& options) {
        PartReports made = run_part(request.study, part, results ? &*results : nullptr, file, options);
        waiting = std::move(made.waiting);
        return std::move(made.runs);
    });
    const std::vector<RunReport> asked = asked_for(request.study, reports);
    list_runs(asked, file, arguments, console);
    const bool failed = tell_failures(asked, console);
    if (is_interrupted(reports))
        return told_interruption(console);
    for (const std::string& run : waiting)
        console.err << fmt::format(
            "graze: run '{}' waits for runs that several parts compute: merge them, then compute "
            "the parts again\n",
            run);
    return failed ? exit_irregular : exit_success;
}

/// Looks at what is said about a study, and makes its folder.
void prepare(const StudyRequest& request, const RunArguments& arguments) {
    keep_inputs_of(request.study);
    check_names(request.study, split_list(arguments.only));
    make_folder(request.folder, "--output");
}

/// Computes a part, or has SLURM compute all parts, whatever other processes were started with this one.
int compute_alone(const RunArguments& arguments, const Console& console) {
    StudyRequest request = study_request(arguments);
    prepare(request, arguments);
    const InterruptGuard guard;
    return arguments.slurm > 0 ? run_by_slurm(request.study, request.folder, request.file, arguments, console)
                               : run_one_part(std::move(request), arguments, console);
}

} // namespace

StudyRequest StudyRequest::in_folder(Study study, const std::string& folder) {
    return {std::move(study), folder, (std::filesystem::path(folder) / "results.sqlite").string()};
}

int compute_study(StudyRequest request, const RunArguments& arguments, const Console& console,
                  std::unique_ptr<Workers> workers) {
    prepare(request, arguments);
    const InterruptGuard guard;
    ResultFile file(request.file, ResultFile::Access::write);
    require_same_values(request.study, file);
    const StudyRunner runner = [&](const Study& study, ResultFile& to, const RunnerOptions& options) {
        return workers ? workers->run_study(study, to, options) : run_study(study, to, options);
    };
    const std::vector<RunReport> reports = computed(request.study, arguments, console, [&](const auto& options) {
        return run_with_atlases(request.study, file, options, runner);
    });
    workers.reset(); // the rest is for one process
    return finish_study(request.study, reports, file, request.folder, arguments, console);
}

int run_command(const RunArguments& arguments, const Console& console) {
    if (arguments.list)
        return list_studies(arguments, console);
    if (!arguments.keys.empty())
        return list_study_keys(arguments, console);
    if (arguments.schema) {
        console.out << study_schema();
        return exit_success;
    }
    if (arguments.study.empty())
        throw InputError("no study is named", "graze run --list names those that come with graze");
    if (arguments.show) {
        console.out << shipped_study_text(arguments.study);
        return exit_success;
    }
    if (!arguments.part.empty() || arguments.slurm > 0)
        return compute_alone(arguments, console);
    return with_workers(arguments.jobs, [&](std::unique_ptr<Workers> workers) {
        return compute_study(study_request(arguments), arguments, console, std::move(workers));
    });
}

} // namespace graze
