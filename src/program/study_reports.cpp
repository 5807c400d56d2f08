#include "program/study_reports.hpp"

#include "graze/atlas/atlas_findings.hpp"
#include "graze/atlas/atlas_tables.hpp"
#include "graze/study/run_summary.hpp"
#include "graze/study/stored_study.hpp"
#include "program/atlas_text.hpp"
#include "program/commands.hpp"
#include "program/interrupt.hpp"
#include "program/study_outputs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iterator>

namespace graze {

namespace {

std::string status_of(const RunReport& report) {
    if (report.outcome == RunOutcome::partial)
        return "in part";
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

/// Tells what the atlases among these runs have found. @return true if something contradicts their branches
bool tell_atlases(const Study& study, const std::vector<RunReport>& reports, const ResultFile& file,
                  const StudyArguments& arguments, const Console& console) {
    bool any = false;
    for (const RunReport& report : reports) {
        if (report.kind != name_of(RunKind::atlas) || !report.complete())
            continue;
        const AtlasFindings findings = atlas_findings(study, report.name, file);
        any = any || has_contradiction(findings);
        if (!arguments.quiet && arguments.output.format == TableFormat::table)
            console.out << '\n' << summary_text(findings);
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

} // namespace

std::vector<RunReport> asked_for(const Study& study, const std::vector<RunReport>& reports) {
    std::vector<RunReport> asked;
    std::ranges::copy_if(reports, std::back_inserter(asked),
                         [&](const RunReport& report) { return !atlas_that_made(study, report.name); });
    return asked;
}

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

std::string text_of_values(const ParameterValues& set) {
    std::string text;
    for (const auto& [name, value] : set)
        text += fmt::format("{}{}={}", text.empty() ? "" : ",", name, value);
    return text;
}

void require_same_values(const Study& study, const ResultFile& file) {
    require_same_values(study, file, text_of_values, "choose another folder by --output");
}

std::optional<ResultFile> earlier_results(const Study& study, const std::string& path) {
    if (std::error_code error; !std::filesystem::exists(path, error))
        return std::nullopt;
    std::optional<ResultFile> results(std::in_place, path, ResultFile::Access::read);
    require_same_values(study, *results);
    return results;
}

bool is_interrupted(const std::vector<RunReport>& reports) {
    return std::ranges::any_of(reports,
                               [](const RunReport& report) { return report.outcome == RunOutcome::interrupted; });
}

int told_interruption(const Console& console) {
    console.err << "graze: interrupted; what was computed is kept, and the same command goes on from there\n";
    return InterruptGuard::exit_code();
}

void list_runs(const std::vector<RunReport>& reports, const ResultFile& file, const StudyArguments& arguments,
               const Console& console) {
    if (arguments.quiet)
        return;
    OutputArguments output = arguments.output;
    const bool for_people = output.format == TableFormat::table;
    output.digits = for_people ? 6 : 17;
    std::vector<RunReport> begun; // others are left to somebody else
    std::ranges::copy_if(reports, std::back_inserter(begun),
                         [&](const RunReport& report) { return file.find_run(report.name).has_value(); });
    const Table table = for_people ? run_table(begun, file) : cells_of(begun, file);
    std::vector<std::string> every;
    for (const Table::Column& column : table.columns())
        every.push_back(column.name);
    deliver(table, output, {}, console, every);
}

int finish_study(const Study& study, const std::vector<RunReport>& reports, ResultFile& file, const std::string& folder,
                 const StudyArguments& arguments, const Console& console) {
    const std::vector<RunReport> asked = asked_for(study, reports);
    list_runs(asked, file, arguments, console);
    bool failed = tell_failures(asked, console);
    failed = tell_atlases(study, reports, file, arguments, console) || failed;
    if (is_interrupted(reports))
        return told_interruption(console);
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
