#include "graze/study/run_summary.hpp"
#include "graze/study/runner.hpp"
#include "graze/study/stored_study.hpp"
#include "graze/study/study_catalogue.hpp"
#include "graze/study/study_schema.hpp"
#include "program/commands.hpp"
#include "program/interrupt.hpp"
#include "program/kept_inputs.hpp"
#include "program/output_file.hpp"
#include "program/progress_line.hpp"
#include "program/step_lines.hpp"
#include "program/study_outputs.hpp"
#include "program/values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

namespace graze {

namespace {

std::string status_of(const RunReport& report) {
    if (!report.complete())
        return std::string(name_of(report.outcome));
    return report.computed == 0 ? "was there" : report.computed < report.points ? "gone on with" : "done";
}

/// The estimates with known errors of a run of kind identify, as one line. Estimates of single records are left out:
/// their names contain blanks.
std::string estimates_text(const std::string& run, const ResultFile& file) {
    std::string text;
    for (const EstimateRecord& number : file.estimates(run).numbers)
        if (number.estimate.freedom > 0 && number.estimate.error > 0 && number.name.find(' ') == std::string::npos)
            text +=
                fmt::format("{}{} = {:.6g} +- {:.2g}{}{}", text.empty() ? "" : ", ", number.name, number.estimate.value,
                            number.estimate.error, number.unit.empty() ? "" : " ", number.unit);
    return text;
}

/// The readable table of runs: the last column has "periodic 1330, chaotic 270; up: ..." and is broken into lines.
Table run_table(const std::vector<RunReport>& reports, const ResultFile& file) {
    Table table({{"run", ""}, {"points", ""}, {"seconds", "s"}, {"status", ""}, {"results", ""}});
    for (const RunReport& report : reports) {
        table.add(report.name, report.points, report.seconds, status_of(report));
        const RunSummary run = summary_of(report, file);
        std::string results = estimates_text(report.name, file);
        for (const auto& [label, count] : results.empty() ? run.labels : LabelCounts())
            results += fmt::format("{}{} {}", results.empty() ? "" : ", ", label, count);
        const auto add = [&](const std::string& text) { results += (results.empty() ? "" : "; ") + text; };
        if (!run.escapes.empty())
            add("rate of escape " + run.escapes);
        if (!run.remedy.empty())
            add(run.remedy);
        for (const auto& [part, detail] : run.ends)
            add(fmt::format("{}: {}", part, detail));
        table.add(results);
    }
    return table;
}

/// The table of runs for csv and json: each number and each text has its own cell.
Table cells_of(const std::vector<RunReport>& reports, const ResultFile& file) {
    std::vector<RunSummary> runs;
    std::vector<std::string> labels;
    std::size_t parts = 0;
    for (const RunReport& report : reports) {
        runs.push_back(summary_of(report, file));
        parts = std::max(parts, runs.back().ends.size());
        for (const auto& one : runs.back().labels)
            if (std::find(labels.begin(), labels.end(), one.first) == labels.end())
                labels.push_back(one.first);
    }
    std::vector<Table::Column> columns{{"run", ""},      {"kind", ""},     {"points", ""},
                                       {"computed", ""}, {"seconds", "s"}, {"status", ""}};
    for (std::string label : labels) {
        std::replace(label.begin(), label.end(), ' ', '_');
        columns.push_back({"points_" + label, ""});
    }
    columns.insert(columns.end(), {{"problem", ""}, {"rate_of_escape", ""}});
    for (std::size_t p = 1; p <= parts; ++p)
        columns.insert(columns.end(), {{fmt::format("part_{}", p), ""}, {fmt::format("ended_{}", p), ""}});
    Table table(columns);
    for (std::size_t r = 0; r < reports.size(); ++r) {
        const RunReport& report = reports[r];
        table.add(report.name, report.kind, report.points, report.computed, report.seconds, status_of(report));
        for (const std::string& label : labels) {
            const auto found = std::find_if(runs[r].labels.begin(), runs[r].labels.end(),
                                            [&](const auto& one) { return one.first == label; });
            table.add(found == runs[r].labels.end() ? 0.0 : static_cast<double>(found->second));
        }
        table.add(runs[r].remedy, runs[r].escapes);
        for (std::size_t p = 0; p < parts; ++p) {
            const bool there = p < runs[r].ends.size();
            table.add(there ? runs[r].ends[p].first : "", there ? runs[r].ends[p].second : "");
        }
    }
    return table;
}

/// Prints failed runs, with their remedies. @return true if there are any
bool tell_failures(const std::vector<RunReport>& reports, const Console& console) {
    bool any = false;
    for (const RunReport& report : reports)
        if (report.outcome == RunOutcome::failed || report.outcome == RunOutcome::skipped) {
            any = true;
            console.err << fmt::format("graze: run '{}' {}: {}; {}\n", report.name, status_of(report), report.problem,
                                       report.remedy);
        }
    return any;
}

/// The study with only these runs, and only the tables and pictures that need no other run.
Study with_only_runs(const Study& study, const std::vector<RunReport>& reports) {
    std::vector<std::string> done;
    for (const RunReport& report : reports)
        done.push_back(report.name);
    const auto missing = [&](const std::string& run) { return std::find(done.begin(), done.end(), run) == done.end(); };
    const auto shows_others = [&](const auto& shown) { return std::any_of(shown.begin(), shown.end(), missing); };
    Study result = study;
    std::erase_if(result.runs, [&](const StudyRun& run) { return missing(run.name); });
    std::erase_if(result.tables, [&](const StudyTable& table) { return shows_others(table.runs); });
    std::erase_if(result.pictures, [&](const StudyPicture& picture) {
        return shows_others(picture.runs) || shows_others(picture.over);
    });
    return result;
}

void check_names(const Study& study, const std::vector<std::string>& only) {
    const std::vector<std::string> known = names_of(study.runs);
    for (const std::string& name : only)
        if (std::find(known.begin(), known.end(), name) == known.end())
            throw InputError({"--only", 0, 0}, fmt::format("the study has no run '{}'", name),
                             name_advice(name, known, "it has none"));
}

/// A study, its folder and its result file.
struct StudyRequest {
    Study study;
    std::string folder, file;
};

/// Values as "k=50,m=2"
std::string text_of_values(const ParameterValues& set) {
    std::string text;
    for (const auto& [name, value] : set)
        text += fmt::format("{}{}={}", text.empty() ? "" : ",", name, value);
    return text;
}

/// @throws InputError if the result file was made with other values of --set
void require_same_values(const Study& study, const ResultFile& file) {
    const auto other = other_set(study, file);
    if (!other)
        return;
    const auto words = [](ParameterValues set) {
        std::ranges::sort(set);
        return set.empty() ? std::string("the study's own values") : text_of_values(set);
    };
    throw InputError(Place{file.path(), 0, 0},
                     fmt::format("the results there were made with {}, and those asked for are of {}", words(*other),
                                 words(study.set)),
                     "choose another folder by --output");
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
        result.file = (std::filesystem::path(result.folder) / "results.sqlite").string();
    return result;
}

} // namespace

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
    const StudyRequest request = study_request(arguments);
    const Study& study = request.study;
    keep_inputs_of(study);
    check_names(study, split_list(arguments.only));
    const std::string& folder = request.folder;
    make_folder(folder, "--output");
    const InterruptGuard guard;
    ResultFile file(request.file, ResultFile::Access::write);
    require_same_values(study, file);
    std::vector<RunReport> reports;
    {
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
        reports = run_study(study, file, options);
    }
    if (!arguments.quiet) {
        OutputArguments output = arguments.output;
        const bool for_people = output.format == TableFormat::table;
        output.digits = for_people ? 6 : 17;
        const Table table = for_people ? run_table(reports, file) : cells_of(reports, file);
        std::vector<std::string> every;
        for (const Table::Column& column : table.columns())
            every.push_back(column.name);
        deliver(table, output, {}, console, every);
    }
    const bool failed = tell_failures(reports, console);
    if (std::any_of(reports.begin(), reports.end(),
                    [](const RunReport& report) { return report.outcome == RunOutcome::interrupted; })) {
        console.err << "graze: interrupted; what was computed is kept, and the same command goes on from there\n";
        return InterruptGuard::exit_code();
    }
    if (!arguments.no_pictures) {
        const Study shown = with_only_runs(study, reports);
        const WrittenTables tables = write_study_tables(shown, file, folder, console);
        DrawnPictures drawn;
        if (const bool asks = !study.pictures.empty() || !study.tables.empty(); !asks || !shown.pictures.empty())
            drawn = draw_study_pictures(shown, file, folder, console);
        std::vector<std::string> paths = tables.paths;
        paths.insert(paths.end(), drawn.paths.begin(), drawn.paths.end());
        for (const std::string& path : paths)
            if (!arguments.quiet && arguments.output.format == TableFormat::table)
                console.out << path << '\n';
        if (drawn.interrupted) {
            console.err << "graze: interrupted; all is computed, and the same command draws the other pictures\n";
            return InterruptGuard::exit_code();
        }
        if (!tables.complete || !drawn.complete)
            return exit_bad_input;
    }
    return failed ? exit_irregular : exit_success;
}

} // namespace graze
