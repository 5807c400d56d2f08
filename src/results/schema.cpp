#include "results/schema.hpp"

#include "base/letter_case.hpp"
#include "results/database.hpp"
#include "results/orbit_columns.hpp"
#include "results/point_columns.hpp"
#include "results/run_columns.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <set>

namespace graze {

void require_free_name(const std::string& name, bool branch, const std::vector<std::string>& others,
                       const Place& place) {
    // The table of orbits would have the same name as the view over all branches.
    if (branch && in_small_letters(name) == "points")
        throw InputError(place,
                         fmt::format("no branch can be called '{}': result files have a view of that name", name),
                         "give it another name");
    for (const std::string& other : others)
        if (other != name && in_small_letters(other) == in_small_letters(name))
            throw InputError(place, fmt::format("the names of the runs '{}' and '{}' differ in case only", other, name),
                             "give one of them another name");
}

std::string distinct_name(const std::string& name, std::set<std::string>& taken) {
    std::string result = name;
    for (int i = 2; !taken.insert(in_small_letters(result)).second; ++i)
        result = fmt::format("{}_{}", name, i);
    return result;
}

namespace {

const char* type_text(ColumnType type) {
    return type == ColumnType::whole ? "INTEGER" : type == ColumnType::text ? "TEXT" : "REAL";
}

std::string declared(const std::vector<ColumnKind>& columns) {
    std::string text;
    for (const ColumnKind& column : columns)
        text += fmt::format("{}{} {}", text.empty() ? "" : ", ", column.name, type_text(column.type));
    return text;
}

std::string declared(const std::vector<RunColumn>& columns) {
    std::string text;
    for (const RunColumn& column : columns)
        text +=
            fmt::format("{}{} {}", text.empty() ? "" : ", ", quoted_name(column.column), type_text(column.kind.type));
    return text;
}

/// With the names of their table: SQLite takes a quoted name that is no column for a text.
std::string select(const std::vector<RunColumn>& columns, const std::string& table) {
    std::string text;
    for (const RunColumn& column : columns)
        text += (text.empty() ? "t." : ", t.") + quoted_name(column.column);
    return fmt::format("SELECT {} FROM {} AS t", text, table);
}

std::string names_in(const std::vector<RunColumn>& columns) {
    std::string text;
    for (const RunColumn& column : columns)
        text += (text.empty() ? "" : ", ") + quoted_name(column.column);
    return text;
}

const std::vector<ResultColumn>& columns_in(const RunRecord& run, ColumnGroup group) {
    return group == ColumnGroup::coordinates ? run.coordinates : group == ColumnGroup::states ? run.states : run.values;
}

/// The columns of a run that are of these kinds.
std::vector<RunColumn> columns_for(const std::vector<ColumnKind>& kinds, const RunRecord& run,
                                   std::set<std::string> taken) {
    for (const ColumnKind& kind : kinds)
        if (kind.group == ColumnGroup::single)
            taken.insert(kind.name);
    std::vector<RunColumn> columns;
    for (const ColumnKind& kind : kinds)
        if (kind.group == ColumnGroup::single)
            columns.push_back({kind.name, kind, "", ""});
        else
            for (const ResultColumn& one : columns_in(run, kind.group))
                columns.push_back({distinct_name(kind.name + one.name, taken), kind, one.name, one.unit});
    return columns;
}

/// Query for the rows of one run in a view over all runs.
std::string view_of(const RunRecord& run, const std::vector<ColumnKind>& kinds) {
    const RunTables tables(run);
    const std::vector<std::string> coordinates = tables.names_of(ColumnGroup::coordinates);
    const std::string first = coordinates.empty() ? "NULL" : quoted_name(coordinates.front());
    std::string columns = text_literal(run.name) + " AS run";
    for (const ColumnKind& kind : kinds)
        if (kind.in_views && kind.group == ColumnGroup::single)
            columns += fmt::format(", {}", kind.name);
        else if (kind.in_views && run.is_branch())
            columns +=
                fmt::format(", {} AS parameter, {} AS value",
                            run.coordinates.empty() ? "NULL" : text_literal(run.coordinates.front().name), first);
        else if (kind.in_views)
            columns += fmt::format(", {} AS coordinate", first);
    return fmt::format("SELECT {} FROM {}", columns, tables.points);
}

/// Query for the rows of all branches, or of all other runs, in a view.
std::string united(const std::vector<RunRecord>& runs, bool branches, const std::vector<ColumnKind>& kinds) {
    std::vector<std::string> all;
    for (const RunRecord& run : runs)
        if (run.is_branch() == branches)
            all.push_back(view_of(run, kinds));
    return fmt::format("{}", fmt::join(all, " UNION ALL "));
}

} // namespace

const std::vector<DetailTable>& detail_tables() {
    static const std::vector<DetailTable> tables{
        {"multipliers", kinds_of(multiplier_columns()), false, true},
        {"half_multipliers", kinds_of(multiplier_columns()), true, true},
        {"eigenvalues", kinds_of(multiplier_columns()), false, true},
        {"minima", kinds_of(minimum_columns()), true, false},
        {"end_values", kinds_of(end_value_columns()), true, false},
        {"circles", kinds_of(circle_columns()), true, false},
    };
    return tables;
}

std::string listed(const std::vector<ColumnKind>& columns, std::string_view before_each) {
    std::string text;
    for (const ColumnKind& column : columns)
        text += fmt::format("{}{}{}", text.empty() ? "" : ", ", before_each, column.name);
    return text;
}

std::string insert_into(const std::string& table, std::size_t columns) {
    std::string places = "?";
    for (std::size_t i = 1; i < columns; ++i)
        places += ",?";
    return fmt::format("INSERT INTO {} VALUES({})", table, places);
}

std::vector<std::pair<std::string, std::string>> shared_tables() {
    std::vector<std::pair<std::string, std::string>> tables;
    for (const DetailTable& table : detail_tables())
        tables.emplace_back(table.name, fmt::format("run TEXT, point INTEGER, position INTEGER, {}, "
                                                    "PRIMARY KEY(run, point, position)",
                                                    declared(table.columns)));
    tables.emplace_back("estimates", "run TEXT, position INTEGER, name TEXT, unit TEXT, value REAL, error REAL, "
                                     "low REAL, high REAL, freedom REAL, note TEXT, PRIMARY KEY(run, position)");
    tables.emplace_back("covariances", "run TEXT, position INTEGER, other INTEGER, covariance REAL, "
                                       "PRIMARY KEY(run, position, other)");
    return tables;
}

std::string common_tables() {
    std::string text = "CREATE TABLE meta(key TEXT PRIMARY KEY, value TEXT) WITHOUT ROWID;"
                       "CREATE TABLE columns(run TEXT, place TEXT, position INTEGER, name TEXT, unit TEXT, "
                       "column_name TEXT, PRIMARY KEY(run, place, position)) WITHOUT ROWID;"
                       "CREATE TABLE names(run TEXT, what TEXT, position INTEGER, name TEXT, "
                       "PRIMARY KEY(run, what, position)) WITHOUT ROWID;";
    text += fmt::format("CREATE TABLE runs(number INTEGER PRIMARY KEY, {}, UNIQUE(name));",
                        declared(kinds_of(run_columns())));
    for (const auto& [name, columns] : shared_tables())
        text += fmt::format("CREATE TABLE {}({}) WITHOUT ROWID;", name, columns);
    return text;
}

std::string views(const std::vector<RunRecord>& runs) {
    std::string text;
    for (const char* view :
         {"special_points", "branch_points", "label_changes", "orbits", "label_counts", "all_points"})
        text += fmt::format("DROP VIEW IF EXISTS {}; ", view);
    if (const std::string all = united(runs, true, kinds_of(orbit_columns())); !all.empty())
        text += "CREATE VIEW branch_points AS " + all +
                "; CREATE VIEW special_points AS SELECT * FROM branch_points WHERE type <> 'RG';";
    const std::string all = united(runs, false, kinds_of(point_columns()));
    if (all.empty())
        return text;
    return text + "CREATE VIEW all_points AS " + all + R"(;
CREATE VIEW orbits AS SELECT run, number, direction, coordinate, period, duration, signature, symmetric, multiplier,
    residual FROM all_points WHERE label = 'periodic';
CREATE VIEW label_counts AS SELECT run, direction, label, period, symmetric, count(*) AS points FROM all_points
    GROUP BY run, direction, label, period, symmetric;
CREATE VIEW label_changes AS SELECT run, chain, direction, coordinate_before, coordinate, label_before, label,
    period_before, period, signature_before, signature, symmetric_before, symmetric FROM (
    SELECT run, number, chain, direction, coordinate, label, period, signature, symmetric,
        lag(coordinate) OVER chains AS coordinate_before, lag(label) OVER chains AS label_before,
        lag(period) OVER chains AS period_before, lag(symmetric) OVER chains AS symmetric_before,
        lag(direction) OVER chains AS direction_before, lag(signature) OVER chains AS signature_before
    FROM all_points WINDOW chains AS (PARTITION BY run, chain ORDER BY number))
    WHERE direction_before = direction
      AND (label IS NOT label_before OR period IS NOT period_before OR symmetric IS NOT symmetric_before
           OR signature IS NOT signature_before);
)";
}

RunTables::RunTables(const RunRecord& run)
    : points(quoted_name((run.is_branch() ? "branch_" : "points_") + run.name)),
      samples(quoted_name((run.is_branch() ? "segments_" : "samples_") + run.name)), is_branch(run.is_branch()),
      point_columns(columns_for(is_branch ? kinds_of(orbit_columns()) : kinds_of(graze::point_columns()), run, {})),
      sample_columns(is_branch ? columns_for(kinds_of(segment_columns()), run, {})
                               : columns_for(kinds_of(graze::sample_columns()), run, {"rowid"})) {}

std::vector<std::string> RunTables::names_of(ColumnGroup group) const {
    std::vector<std::string> names;
    for (const auto* columns : {&point_columns, &sample_columns})
        for (const RunColumn& column : *columns)
            if (column.kind.group == group)
                names.push_back(column.column);
    return names;
}

std::string RunTables::create() const {
    const std::string of_points = declared(point_columns).insert(declared(point_columns).find(','), " PRIMARY KEY");
    return fmt::format("CREATE TABLE {}({}); CREATE TABLE {}({}){};", points, of_points, samples,
                       declared(sample_columns) + (is_branch ? ", PRIMARY KEY(point, segment)" : ""),
                       is_branch ? " WITHOUT ROWID" : "");
}

std::string RunTables::insert_point() const {
    return insert_into(fmt::format("{}({})", points, names_in(point_columns)), point_columns.size());
}

std::string RunTables::insert_sample() const {
    return is_branch ? insert_into(fmt::format("{}({})", samples, names_in(sample_columns)), sample_columns.size())
                     : insert_into(fmt::format("{}(rowid, {})", samples, names_in(sample_columns)),
                                   1 + sample_columns.size());
}

std::string RunTables::select_point() const {
    return select(point_columns, points);
}

std::string RunTables::select_sample() const {
    return select(sample_columns, samples);
}

} // namespace graze
