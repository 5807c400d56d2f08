#include "graze/results/result_table.hpp"

#include "graze/results/name_advice.hpp"
#include "results/run_columns.hpp"
#include "results/run_query.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <set>

namespace graze {

namespace {

/// Units by the name of the column; several if the runs have different units.
using Units = std::map<std::string, std::set<std::string>>;

void add_units(Units& units, const StoredRun& run, const std::vector<RunColumn>& columns) {
    for (const RunColumn& column : columns)
        units[column.column].insert(unit_of(column, run));
}

/// Adds the units of the columns in which views over all runs show the first coordinate.
void add_units_of_views(Units& units, const StoredRun& run) {
    for (const char* column : {"coordinate", "coordinate_before", "value"})
        units[column].insert(unit_of(ColumnUnit::followed, run));
}

ResultTable with_units(ResultFile::Rows rows, const Units& units) {
    std::vector<std::string> of_columns;
    for (std::size_t c = 0; c < rows.columns(); ++c) {
        const auto found = units.find(rows.column_name(c));
        of_columns.push_back(found != units.end() && found->second.size() == 1 ? *found->second.begin() : "");
    }
    return {std::move(rows), std::move(of_columns), {}};
}

/// A shown column: its SQL expression, its unit, and its name, to which a number is appended if it is already taken.
struct ShownColumn {
    std::string sql, unit, name = "";
};

/// Merges the units of the columns of a further run; a unit that differs between runs becomes empty.
void merge(std::vector<std::string>& units, const std::vector<ShownColumn>& columns, bool first) {
    if (first)
        for (const ShownColumn& column : columns)
            units.push_back(column.unit);
    else
        for (std::size_t c = 0; c < std::min(units.size(), columns.size()); ++c)
            if (units[c] != columns[c].unit)
                units[c].clear();
}

/// The table of all runs, with the numbers of points that they have so far.
ResultTable table_of_runs(const ResultFile& file) {
    std::string counts;
    for (const RunRecord& run : file.runs())
        counts += fmt::format(" WHEN {} THEN (SELECT count(*) FROM {})", text_literal(run.name), RunTables(run).points);
    return with_units(
        file.query(fmt::format("SELECT r.name AS run, r.kind, r.status, r.points, {} AS done, r.model_name AS model, "
                               "r.version, m.value AS failure FROM runs AS r LEFT JOIN meta AS m "
                               "ON r.status = {} AND m.key = {} || r.name ORDER BY r.number",
                               counts.empty() ? "0" : fmt::format("CASE r.name{} END", counts),
                               text_literal(std::string(name_of(RunStatus::failed))), text_literal(begin_of_failure))),
        {});
}

/// SQL condition for the requested rows. @param type column that is also compared with the requested label
std::string condition_of(const ResultTableRequest& request, const std::string& type, const std::string& direction) {
    std::string where = "1";
    if (!request.label.empty())
        where += fmt::format(" AND {} IN (p.label, {})", text_literal(request.label), type);
    if (!request.direction.empty())
        where += fmt::format(" AND {} = {}", direction, text_literal(request.direction));
    return where;
}

ResultTable table_of_details(const ResultFile& file, const ResultTableRequest& request, const DetailTable& table) {
    const std::vector<std::string> names = chosen_runs(file, request.runs, request.place_of_runs);
    std::vector<std::string> views;
    for (const RunRecord& run : file.runs())
        // On a branch, the part is the direction, and the followed parameter the coordinate.
        views.emplace_back(
            run.is_branch()
                ? "SELECT run, number, part AS direction, value AS coordinate, label, type FROM branch_points"
                : "SELECT run, number, direction, coordinate, label, label AS type FROM all_points");
    std::sort(views.begin(), views.end(), std::greater<>());
    views.erase(std::unique(views.begin(), views.end()), views.end());
    if (views.empty())
        throw InputError("there are no runs in the file", "run the study first");
    std::vector<std::string> units;
    for (const std::string& name : names) {
        const StoredRun run(file, name, request.place_of_runs);
        std::vector<ShownColumn> columns{{"m.run", ""}, {"m.point", ""}, {"p.direction", ""}};
        columns.push_back({"p.coordinate", unit_of(ColumnUnit::followed, run)});
        if (table.position_matters)
            columns.push_back({"m.position", ""});
        for (const ColumnKind& column : table.columns)
            columns.push_back({std::string("m.") + column.name, unit_of(column.unit, run)});
        merge(units, columns, units.empty());
    }
    return {file.query(fmt::format(
                "SELECT m.run, m.point, p.direction, p.coordinate, {}{} FROM {} AS m JOIN ({}) AS p ON p.run = m.run "
                "AND p.number = m.point WHERE m.run IN ({}) AND {} ORDER BY m.run, m.point, m.position",
                table.position_matters ? "m.position, " : "", listed(table.columns, "m."), table.name,
                fmt::join(views, " UNION ALL "), text_literals(names), condition_of(request, "p.type", "p.direction"))),
            std::move(units),
            {}};
}

/// Column with the name that the study gives to a point, or else its label.
ShownColumn name_of_point(const StoredRun& run) {
    return {fmt::format("coalesce((SELECT name FROM names WHERE run = {} AND what = {} || p.label), p.label)",
                        text_literal(run.record.name), text_literal(begin_of_point_name)),
            "", "name"};
}

/// Columns of the rows of one run, with the columns of points that identify the rows.
/// @param named whether there is a column with names of points
std::vector<ShownColumn> columns_of(const StoredRun& run, const std::string& what, bool named) {
    const RunQuery query(run.record);
    const RunTables& tables = query.run_tables();
    std::vector<ShownColumn> columns;
    const auto add = [&](const char* table, const RunColumn& column) {
        columns.push_back({table + quoted_name(column.column), unit_of(column, run), column.column});
        if (named && table[0] == 'p' && column.column == "label")
            columns.push_back(name_of_point(run));
    };
    if (what == "points") {
        for (const RunColumn& column : tables.point_columns)
            add("p.", column);
        return columns;
    }
    columns.push_back({"s.point", "", "point"});
    if (what == "segments")
        columns.insert(columns.end(), {{"p.part", "", "part"}, {"p.type", "", "type"}, {"p.label", "", "label"}});
    if (what == "segments" && named)
        columns.push_back(name_of_point(run));
    if (what != "segments")
        columns.push_back({"p.direction", "", "direction"});
    std::size_t shown = what == "samples" ? run.record.coordinates.size() : 1; // on a branch the followed parameter
    for (const RunColumn& column : tables.point_columns)
        if (column.kind.group == ColumnGroup::coordinates && shown > 0) {
            add("p.", column);
            --shown;
        }
    for (const RunColumn& column : tables.sample_columns)
        if (column.column != "point")
            add("s.", column);
    return columns;
}

/// Columns as listed after SELECT. A second column of the same name gets a number appended to its name.
std::string listed_columns(const std::vector<ShownColumn>& columns) {
    std::vector<std::string> texts;
    std::set<std::string> taken;
    for (const ShownColumn& column : columns)
        texts.push_back(fmt::format("{} AS {}", column.sql, quoted_name(distinct_name(column.name, taken))));
    return fmt::format("{}", fmt::join(texts, ", "));
}

/// The runs that have the requested table. Only branches have segments, only other runs have samples, and points of
/// branches are not mixed with other points. @param left_out receives names of runs that the user did not name and that
/// are left out because their columns are different
std::vector<StoredRun> runs_with(const ResultFile& file, const ResultTableRequest& request,
                                 std::vector<std::string>& left_out) {
    const std::string& what = request.what;
    std::vector<StoredRun> branches, others;
    for (const std::string& name : chosen_runs(file, request.runs, request.place_of_runs)) {
        StoredRun run(file, name, {});
        (run.record.is_branch() ? branches : others).push_back(std::move(run));
    }
    const bool named = !request.runs.empty();
    const bool wants_branches = what == "segments" || (what == "points" && others.empty());
    std::vector<StoredRun>& chosen = wants_branches ? branches : others;
    const std::vector<StoredRun>& excluded = wants_branches ? others : branches;
    if (chosen.empty() && excluded.empty())
        throw InputError("there are no runs in the file", "run the study first");
    if (chosen.empty() || (named && !excluded.empty()))
        throw InputError(request.place_of_what,
                         fmt::format("run '{}' is of kind {}, which has no {}{}", excluded.front().record.name,
                                     excluded.front().record.kind, what, what == "points" ? " like the others" : ""),
                         what == "points" ? "export one of them at a time"
                                          : fmt::format("export its {}", wants_branches ? "samples" : "segments"));
    if (what == "points")
        for (const StoredRun& run : excluded)
            left_out.push_back(run.record.name);
    return std::move(chosen);
}

/// @throws InputError if the runs do not have the same columns
void require_same_columns(const std::vector<StoredRun>& runs) {
    const auto names_of_columns = [](const StoredRun& run) {
        std::vector<std::string> names;
        for (const auto* list : {&run.record.coordinates, &run.record.values, &run.record.states})
            for (const ResultColumn& column : *list)
                names.push_back(column.name);
        return names;
    };
    const std::vector<std::string> first = names_of_columns(runs.front());
    for (const StoredRun& run : runs) {
        const bool branch = run.record.is_branch();
        if (first != names_of_columns(run)) // the table has only one line of names, that of the first run
            throw InputError("the runs do not have the same columns",
                             branch ? "export one of them at a time, or list their points"
                                    : "export one of them at a time");
    }
}

ResultTable table_of_rows(const ResultFile& file, const ResultTableRequest& request) {
    std::vector<std::string> left_out;
    const std::vector<StoredRun> runs = runs_with(file, request, left_out);
    require_same_columns(runs);
    const bool of_points = request.what == "points";
    const bool several = runs.size() > 1;
    const bool named =
        std::any_of(runs.begin(), runs.end(), [](const StoredRun& run) { return !run.record.point_names.empty(); });
    std::string all;
    std::vector<std::string> units;
    for (const StoredRun& run : runs) {
        const RunQuery query(run.record);
        const bool branch = run.record.is_branch();
        std::vector<ShownColumn> columns = columns_of(run, request.what, named);
        if (several)
            columns.insert(columns.begin(), {text_literal(run.record.name), "", "run"});
        merge(units, columns, units.empty());
        all += fmt::format("{}SELECT {} FROM {} WHERE {}", all.empty() ? "" : " UNION ALL ", listed_columns(columns),
                           query.tables(!of_points, false),
                           condition_of(request, branch ? "p.type" : "p.label", query.direction()));
        if (!several)
            all += of_points ? " ORDER BY p.number" : branch ? " ORDER BY s.point, s.segment" : " ORDER BY s.rowid";
    }
    return {file.query(all), std::move(units), std::move(left_out)};
}

/// The table of estimates, or of the covariances of pairs of estimates, by their names.
ResultTable table_of_estimates(const ResultFile& file, const ResultTableRequest& request) {
    std::vector<std::string> names;
    for (const RunRecord& run : file.runs())
        if (request.runs.empty()
                ? run.kind == "identify"
                : std::find(request.runs.begin(), request.runs.end(), run.name) != request.runs.end()) {
            if (run.kind != "identify")
                throw InputError(
                    request.place_of_what,
                    fmt::format("run '{}' is of kind {}, which has no {}", run.name, run.kind, request.what),
                    "name runs of kind identify");
            names.push_back(run.name);
        }
    if (names.empty())
        throw InputError(request.place_of_what, "no run of the file is of kind identify",
                         "export what others have: points or samples");
    const char* columns = request.what == "estimates"
                              ? "r.name AS run, e.name, e.unit, e.value, e.error, e.low, e.high, e.freedom, e.note"
                              : "r.name AS run, e.name, o.name AS other, c.covariance";
    const char* more = request.what == "estimates"
                           ? ""
                           : " JOIN covariances AS c ON c.run = e.run AND c.position = e.position JOIN estimates AS o "
                             "ON o.run = c.run AND o.position = c.other";
    return with_units(file.query(fmt::format("SELECT {} FROM estimates AS e JOIN runs AS r ON r.name = e.run{} WHERE "
                                             "r.name IN ({}) ORDER BY r.number, e.position{}",
                                             columns, more, text_literals(names), *more == 0 ? "" : ", c.other")),
                      {});
}

} // namespace

std::vector<std::string> result_table_names() {
    std::vector<std::string> names{"points", "samples", "segments"};
    for (const DetailTable& table : detail_tables())
        names.emplace_back(table.name);
    names.insert(names.end(), {"estimates", "covariances", "runs"});
    return names;
}

std::vector<std::string> chosen_runs(const ResultFile& file, const std::vector<std::string>& wanted,
                                     const Place& place) {
    const std::vector<std::string> known = names_of(file.runs());
    for (const std::string& name : wanted)
        if (std::find(known.begin(), known.end(), name) == known.end())
            throw InputError(place, fmt::format("there are no results of a run '{}'", name),
                             name_advice(name, known, "there are none at all"));
    return wanted.empty() ? known : wanted;
}

ResultTable result_table(const ResultFile& file, const ResultTableRequest& request) {
    chosen_runs(file, request.runs, request.place_of_runs);
    if (request.what == "runs")
        return table_of_runs(file);
    if (request.what == "estimates" || request.what == "covariances")
        return table_of_estimates(file, request);
    for (const DetailTable& table : detail_tables())
        if (request.what == table.name)
            return table_of_details(file, request, table);
    const std::vector<std::string> known = result_table_names();
    if (std::find(known.begin(), known.end(), request.what) == known.end())
        throw InputError(request.place_of_what, fmt::format("there is no table '{}'", request.what),
                         name_advice(request.what, known, ""));
    return table_of_rows(file, request);
}

ResultTable queried_table(const ResultFile& file, const std::string& sql, const std::vector<std::string>& runs,
                          const Place& place_of_runs) {
    Units units;
    for (const std::string& name : chosen_runs(file, runs, place_of_runs)) {
        const StoredRun run(file, name, place_of_runs);
        const RunTables tables(run.record);
        add_units(units, run, tables.point_columns);
        add_units(units, run, tables.sample_columns);
        add_units_of_views(units, run);
    }
    return with_units(file.query(sql), units);
}

} // namespace graze
