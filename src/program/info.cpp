#include "base/special_numbers.hpp"
#include "graze/base/text_file.hpp"
#include "graze/model/catalogue.hpp"
#include "graze/model/microbeam.hpp"
#include "graze/results/name_advice.hpp"
#include "graze/study/file_facts.hpp"
#include "graze/study/study_catalogue.hpp"
#include "program/commands.hpp"
#include "program/describe.hpp"
#include "program/output_file.hpp"
#include "program/table_fit.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace graze {

namespace {

/// Refuses pipes and other special files, which may never end, and empty files.
/// @param named the file itself was named, not its folder
void require_contents(const std::string& path, bool named) {
    std::error_code error;
    if (!std::filesystem::exists(path, error))
        return;
    if (!std::filesystem::is_regular_file(path, error))
        throw InputError({path, 0, 0}, "this is no plain file", "name a result file, a model or a study");
    if (std::filesystem::file_size(path, error) == 0 && !error)
        throw InputError({path, 0, 0}, named ? "the file is empty" : "nothing has been computed yet",
                         named ? "name a result file, a model or a study" : "do the study again: graze run");
}

void add_text_file(Facts& facts, const std::string& path) {
    const std::string text = read_text_file(path, "file", longest_model);
    const bool study = is_study_text(text, path);
    add_file_facts(facts, path, study ? "study" : "model");
    const std::string file = is_model_path(path) ? path : "./" + path; // a file, not a shipped model of that name
    study ? add_facts(facts, load_study(file)) : add_facts(facts, load_model(file));
}

/// Adds facts of the shipped model and of the shipped study of a name; both may exist.
void add_shipped(Facts& facts, const std::string& name) {
    const std::vector<std::string> studies = shipped_studies();
    const bool study = std::find(studies.begin(), studies.end(), name) != studies.end();
    const bool model = find_in_catalogue(name).has_value() || microbeam_member(name).has_value();
    if (!study && !model) {
        std::vector<std::string> known = studies;
        for (std::string& model_name : shipped_models())
            known.push_back(std::move(model_name));
        std::sort(known.begin(), known.end());
        known.erase(std::unique(known.begin(), known.end()), known.end());
        throw InputError(fmt::format("there is no file '{}', and nothing of that name comes with graze", name),
                         name_advice(name, known, ""));
    }
    add_file_facts(facts, "", model && study ? "model and study" : model ? "model" : "study");
    if (model)
        add_facts(facts, load_model(name));
    if (study)
        add_facts(facts, load_study(name));
}

Facts facts_of(const std::string& name) {
    Facts facts;
    std::error_code error;
    const std::string results = result_path(name);
    if (std::filesystem::is_directory(name, error) && !std::filesystem::exists(results, error))
        throw InputError({name, 0, 0}, "there are no results in this folder",
                         "name a folder with a results.sqlite, which graze run makes, or a file");
    require_contents(results, results == name);
    if (is_database(results)) {
        const ResultFile file(results, ResultFile::Access::read);
        add_file_facts(facts, results, "results");
        add_facts(facts, file);
    } else if (std::filesystem::exists(name, error) || is_model_path(name)) {
        add_text_file(facts, results);
    } else {
        add_shipped(facts, name);
    }
    return facts;
}

/// A size in bytes as "1.2 MB"
std::string size_text(double bytes) {
    const char* unit = "bytes";
    for (const char* larger : {"kB", "MB", "GB"})
        if (bytes >= 1000) {
            bytes /= 1000;
            unit = larger;
        }
    return fmt::format("{:.3g} {}", bytes, unit);
}

std::string info_heading(const Facts& facts) {
    const std::string path = facts.text("file", "", "path");
    std::string text = facts.text("file", "", "kind");
    if (path.empty())
        return fmt::format("{}, of graze {}\n", text, facts.text("file", "", "version"));
    text = fmt::format("{}: {}, {}, written {}", path, text, size_text(facts.number("file", "", "size").value_or(0)),
                       facts.text("file", "", "written"));
    if (const auto format = facts.number("file", "", "format"))
        text += fmt::format(", format {:.0f}", *format);
    text += '\n';
    if (const std::string problem = facts.text("file", "", "problem"); !problem.empty())
        text += "not all of it can be used: " + problem + '\n';
    return text;
}

/// Name, description and source of a model or study.
std::string words_of(const Facts& facts, const std::string& item, const std::string& name, std::size_t width) {
    std::string text = fmt::format("\n{} {}\n", item, name);
    for (const char* property : {"text", "source"})
        if (const std::string words = facts.text(item, name, property); !words.empty())
            text += wrapped((std::string_view(property) == "source" ? "Source: " : "") + words, width) + '\n';
    for (const Fact& fact : facts.all())
        if (fact.item == item && fact.name == name && fact.property.starts_with("set."))
            text += fmt::format("with {} = {}\n", fact.property.substr(4), fact.text);
    return text;
}

/// The contents of a model as "states 3, modes 2"
std::string counts_of(const Facts& facts, const std::string& model, std::size_t width) {
    std::vector<std::string> counts;
    for (const Fact& fact : facts.all())
        if (fact.item == "model" && fact.name == model && fact.number && *fact.number > 0)
            counts.push_back(fmt::format("{} {:.0f}", fact.property, *fact.number));
    return wrapped(fmt::format("{}", fmt::join(counts, ", ")), width) + '\n';
}

/// @return `words` and the value of a property that is the same in all runs; "" if it differs or is missing
std::string common_to(const Facts& facts, const std::vector<std::string>& runs, const std::string& property,
                      const std::string& words) {
    std::string common;
    for (const std::string& run : runs) {
        const std::string here = facts.text("run", run, property);
        if (here.empty() || (!common.empty() && here != common))
            return "";
        common = here;
    }
    return words + common;
}

/// The start and the varied parameters of a run as "from rest: V from 0.1 to 1, followed"
std::string start_and_axes(const Facts& facts, const std::string& run) {
    const std::string start = facts.text("run", run, "starts_from");
    const std::string axes = fmt::format("{}", fmt::join(facts.texts("run", run, "varies"), "; "));
    return start.empty() ? axes : fmt::format("from {}{}{}", start, axes.empty() ? "" : ": ", axes);
}

/// The earliest time at which a run was begun. Times are written such that alphabetical order is their order.
std::string first_begun(const Facts& facts, const std::vector<std::string>& runs) {
    std::string first;
    for (const std::string& run : runs)
        if (const std::string begun = facts.text("run", run, "begun");
            first.empty() || (!begun.empty() && begun < first))
            first = begun;
    return first;
}

std::string list_of_runs(const Facts& facts, std::size_t width) {
    const std::vector<std::string> runs = facts.names("run");
    const auto known = [&](const std::string& property) {
        return std::any_of(runs.begin(), runs.end(),
                           [&](const std::string& run) { return !facts.text("run", run, property).empty(); });
    };
    const auto all_are_there = std::all_of(runs.begin(), runs.end(), [&](const std::string& run) {
        const auto planned = facts.number("run", run, "planned");
        return !planned || planned == facts.number("run", run, "points");
    });
    std::string heading = fmt::format("\n{} run{}", runs.size(), runs.size() == 1 ? "" : "s");
    std::vector<Table::Column> columns{{"run", ""}};
    for (const char* property :
         {"kind", "model", "status", "points", "planned", "begun", "seconds", "version", "varies"}) {
        const std::string name = property;
        const std::string common = name == "model"     ? common_to(facts, runs, name, ", of model ")
                                   : name == "version" ? common_to(facts, runs, name, ", by graze ")
                                                       : "";
        heading += common;
        if ((known(name) || (name == "varies" && known("starts_from"))) && common.empty() &&
            (name != "planned" || !all_are_there))
            columns.push_back({name, ""});
    }
    Table table(columns);
    for (const std::string& run : runs)
        for (const Table::Column& column : columns)
            if (const auto number = facts.number("run", run, column.name))
                table.add(*number);
            else if (column.name == "varies")
                table.add(start_and_axes(facts, run));
            else if (const auto texts = facts.texts("run", run, column.name); !texts.empty())
                table.add(fmt::format("{}", fmt::join(texts, "; ")));
            else if (column.name == "run")
                table.add(run);
            else
                table.add(not_a_number);
    // The columns `begun` and `seconds` are shown if they fit the width; otherwise the heading tells the first
    // beginning.
    std::vector<std::string> kept;
    for (const Table::Column& column : columns)
        if (column.name != "begun" && column.name != "seconds")
            kept.push_back(column.name);
    constexpr int digits = 4;
    const FittedTable fits = fitted(table, digits, width, kept);
    if (!fits.left_out.empty())
        heading += ", begun " + first_begun(facts, runs);
    std::ostringstream text;
    write_table(text, fits.table, TableFormat::table, digits, {}, width);
    return fmt::format("{}\n{}", heading, text.str());
}

std::string list_of(const Facts& facts, const std::string& item, const std::string& run) {
    std::string text;
    for (const Fact& fact : facts.all())
        if (fact.item == item && fact.name == run)
            text += fmt::format("  {} = {}{}\n", fact.property, fact.text, fact.unit.empty() ? "" : " " + fact.unit);
    return text;
}

std::string text_of_fact(const Facts& facts, bool all, std::size_t width) {
    std::string text = info_heading(facts);
    for (const std::string& model : facts.names("model"))
        text += words_of(facts, "model", model, width) + counts_of(facts, model, width);
    for (const std::string& study : facts.names("study"))
        text += words_of(facts, "study", study, width);
    const std::vector<std::string> runs = facts.names("run"), pictures = facts.names("picture");
    if (!runs.empty())
        text += list_of_runs(facts, width);
    for (const std::string& run : runs)
        if (const std::string failure = facts.text("run", run, "failure"); !failure.empty())
            text += '\n' + wrapped(fmt::format("run {} failed: {}", run, failure), width) + '\n';
    if (!pictures.empty())
        text += '\n' +
                wrapped(fmt::format("{} picture{}: {}", pictures.size(), pictures.size() == 1 ? "" : "s",
                                    fmt::join(pictures, ", ")),
                        width) +
                '\n';
    for (const std::string& run : all ? runs : std::vector<std::string>())
        text += fmt::format("\nrun {}: parameters\n{}run {}: settings\n{}", run, list_of(facts, "parameter", run), run,
                            list_of(facts, "setting", run));
    return text;
}

Table info_table(const Facts& facts) {
    Table table({{"item", ""}, {"name", ""}, {"property", ""}, {"value", ""}, {"unit", ""}});
    for (const Fact& fact : facts.all()) {
        table.add(fact.item, fact.name, fact.property);
        if (fact.number)
            table.add(*fact.number);
        else
            table.add(fact.text);
        table.add(fact.unit);
    }
    return table;
}

} // namespace

int info_command(const InfoArguments& arguments, const Console& console) {
    const Facts facts = facts_of(arguments.file);
    if (arguments.output.format != TableFormat::table) {
        JsonObject heading;
        heading.add("graze", GRAZE_VERSION);
        heading.add("file", arguments.file);
        deliver(info_table(facts), arguments.output, heading, console);
    } else if (arguments.output.file.empty()) {
        console.out << text_of_fact(facts, arguments.all, console.width);
    } else {
        write_file(arguments.output.file, text_of_fact(facts, arguments.all, common_line_width));
    }
    return exit_success;
}

} // namespace graze
