#include "results/schema.hpp"

#include "results/database.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <set>

namespace graze {

namespace {

constexpr const char* fixed_columns = "label TEXT, period INTEGER, duration REAL, signature TEXT, symmetric INTEGER, "
                                      "multiplier REAL, lyapunov REAL, lyapunov_error REAL, residual REAL, "
                                      "cycles INTEGER, returns INTEGER, time REAL, mode TEXT, ending TEXT, "
                                      "ending_time REAL, detail TEXT";

std::string lower(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
    return text;
}

/// The name, with a number behind it if another column has it already; SQL does not tell upper and lower case apart.
std::string distinct(const std::string& name, std::set<std::string>& taken) {
    std::string result = name;
    for (int i = 2; !taken.insert(lower(result)).second; ++i)
        result = fmt::format("{}_{}", name, i);
    return result;
}

std::string columns_of(const std::vector<std::string>& names) {
    std::string text;
    for (const std::string& name : names)
        text += ", " + quoted_name(name) + " REAL";
    return text;
}

constexpr const char* branch_columns =
    "signature TEXT, symmetry TEXT, stable INTEGER, unstable INTEGER, admissible INTEGER, reason TEXT, outcome TEXT, "
    "detail TEXT, residual REAL, error REAL, iterations INTEGER, arclength REAL, located INTEGER, bracket_low REAL, "
    "bracket_high REAL, event TEXT, event_segment INTEGER, event_time REAL, at_end INTEGER, tangent TEXT";

std::string in_quotes(const std::string& text) {
    std::string result = "'";
    for (const char c : text)
        result += c == '\'' ? std::string("''") : std::string(1, c);
    return result + "'";
}

/// Views of the orbits of all branches.
std::string branch_views(const std::vector<RunRecord>& runs) {
    std::string all;
    for (const RunRecord& run : runs) {
        if (!run.is_branch())
            continue;
        const RunTables tables(run);
        all +=
            fmt::format("{}SELECT {} AS run, number, part, step, type, label, {} AS parameter, {} AS value, period, "
                        "signature, symmetry, stable, unstable, admissible, reason, outcome, detail, residual, "
                        "error, arclength, located, bracket_low, bracket_high FROM {}",
                        all.empty() ? "" : " UNION ALL ", in_quotes(run.name),
                        run.coordinates.empty() ? "NULL" : in_quotes(run.coordinates.front().name),
                        tables.coordinates.empty() ? "NULL" : quoted_name(tables.coordinates.front()), tables.points);
    }
    const std::string drop = "DROP VIEW IF EXISTS special_points; DROP VIEW IF EXISTS branch_points; ";
    return all.empty() ? drop
                       : drop + "CREATE VIEW branch_points AS " + all +
                             "; CREATE VIEW special_points AS SELECT * FROM branch_points WHERE type <> 'RG';";
}

std::string placeholders(std::size_t count) {
    std::string text = "?";
    for (std::size_t i = 1; i < count; ++i)
        text += ",?";
    return text;
}

} // namespace

std::string common_tables() {
    return R"(
CREATE TABLE meta(key TEXT PRIMARY KEY, value TEXT) WITHOUT ROWID;
CREATE TABLE runs(number INTEGER PRIMARY KEY, name TEXT UNIQUE, kind TEXT, status TEXT, points INTEGER,
                  model_name TEXT, model TEXT, settings TEXT, fingerprint TEXT, version TEXT);
CREATE TABLE columns(run TEXT, place TEXT, position INTEGER, name TEXT, unit TEXT, column_name TEXT,
                     PRIMARY KEY(run, place, position)) WITHOUT ROWID;
CREATE TABLE names(run TEXT, what TEXT, position INTEGER, name TEXT, PRIMARY KEY(run, what, position)) WITHOUT ROWID;
CREATE TABLE multipliers(run TEXT, point INTEGER, position INTEGER, real REAL, imaginary REAL,
                         PRIMARY KEY(run, point, position)) WITHOUT ROWID;
CREATE TABLE half_multipliers(run TEXT, point INTEGER, position INTEGER, real REAL, imaginary REAL,
                              PRIMARY KEY(run, point, position)) WITHOUT ROWID;
CREATE TABLE minima(run TEXT, point INTEGER, position INTEGER, segment INTEGER, event TEXT, time REAL, value REAL,
                    size REAL, PRIMARY KEY(run, point, position)) WITHOUT ROWID;
CREATE TABLE end_values(run TEXT, point INTEGER, position INTEGER, segment INTEGER, event TEXT, value REAL, rate REAL,
                        PRIMARY KEY(run, point, position)) WITHOUT ROWID;
)";
}

std::vector<std::string> tables_of_details() {
    return {"multipliers", "half_multipliers", "minima", "end_values"};
}

std::string views(const std::vector<RunRecord>& runs) {
    std::string all;
    for (const RunRecord& run : runs) {
        if (run.is_branch())
            continue;
        const RunTables tables(run);
        const std::string coordinate = tables.coordinates.empty() ? "NULL" : quoted_name(tables.coordinates.front());
        all +=
            fmt::format("{}SELECT {} AS run, number, chain, direction, {} AS coordinate, label, period, duration, "
                        "signature, symmetric, multiplier, lyapunov, lyapunov_error, residual, cycles, returns, time, "
                        "mode, ending, ending_time FROM {}",
                        all.empty() ? "" : " UNION ALL ", in_quotes(run.name), coordinate, tables.points);
    }
    const std::string text =
        branch_views(runs) +
        "DROP VIEW IF EXISTS label_changes; DROP VIEW IF EXISTS orbits; DROP VIEW IF EXISTS label_counts; "
        "DROP VIEW IF EXISTS all_points; ";
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
      samples(quoted_name((run.is_branch() ? "segments_" : "samples_") + run.name)), is_branch(run.is_branch()) {
    std::set<std::string> taken{"number",   "chain",       "direction", "label",         "period",
                                "duration", "signature",   "symmetric", "multiplier",    "lyapunov",
                                "residual", "cycles",      "returns",   "time",          "mode",
                                "ending",   "ending_time", "detail",    "lyapunov_error"};
    if (is_branch)
        taken = {"number",   "part",         "step",          "type",       "label",   "period",  "signature",
                 "symmetry", "stable",       "unstable",      "admissible", "reason",  "outcome", "detail",
                 "residual", "error",        "iterations",    "arclength",  "located", "event",   "bracket_low",
                 "tangent",  "bracket_high", "event_segment", "event_time", "at_end"};
    for (const ResultColumn& column : run.coordinates)
        coordinates.push_back(distinct(column.name, taken));
    std::set<std::string> taken_by_samples{"point", "sampling", "time", "rowid"};
    for (const ResultColumn& column : run.values)
        values.push_back(distinct(column.name, is_branch ? taken : taken_by_samples));
    if (is_branch)
        taken = {};
    for (const ResultColumn& column : run.states)
        states.push_back(distinct((is_branch ? "start_" : "end_") + column.name, taken));
}

std::string RunTables::create() const {
    if (is_branch)
        return fmt::format(
            "CREATE TABLE {}(number INTEGER PRIMARY KEY, part TEXT, step INTEGER, type TEXT, label TEXT{}, period "
            "REAL{}, "
            "{}); CREATE TABLE {}(point INTEGER, segment INTEGER, mode TEXT, ending TEXT, duration REAL, "
            "approach_speed REAL, departure REAL, guard_margin REAL{}, PRIMARY KEY(point, segment)) WITHOUT ROWID;",
            points, columns_of(coordinates), columns_of(values), branch_columns, samples, columns_of(states));
    return fmt::format("CREATE TABLE {}(number INTEGER PRIMARY KEY, chain INTEGER, direction TEXT{}, {}{});"
                       "CREATE TABLE {}(point INTEGER, sampling TEXT, time REAL{});",
                       points, columns_of(coordinates), fixed_columns, columns_of(states), samples, columns_of(values));
}

std::size_t RunTables::point_columns() const {
    return is_branch ? 6 + coordinates.size() + values.size() + fixed_branch_columns
                     : 3 + coordinates.size() + fixed_point_columns + states.size();
}

std::size_t RunTables::sample_columns() const {
    return is_branch ? 8 + states.size() : 3 + values.size();
}

std::string RunTables::insert_point() const {
    return fmt::format("INSERT INTO {} VALUES({})", points, placeholders(point_columns()));
}

std::string RunTables::insert_sample() const {
    if (is_branch)
        return fmt::format("INSERT INTO {} VALUES({})", samples, placeholders(sample_columns()));
    std::string names = "rowid, point, sampling, time";
    for (const std::string& value : values)
        names += ", " + quoted_name(value);
    return fmt::format("INSERT INTO {}({}) VALUES({})", samples, names, placeholders(4 + values.size()));
}

std::string RunTables::select_point() const {
    return "SELECT * FROM " + points;
}

} // namespace graze
