#include "results/run_columns.hpp"

#include "base/enumerator_name.hpp"
#include "results/schema.hpp"

#include <array>

namespace graze {

std::string_view name_of(RunStatus status) {
    constexpr std::string_view names[] = {"unfinished", "complete", "failed"};
    return enumerator_name(names, status, "unfinished");
}

namespace {

/// A list of columns of a run, and its name in the file.
struct ColumnList {
    const char* place;
    ColumnGroup group;
    std::vector<ResultColumn> RunRecord::*columns;
};
constexpr std::array<ColumnList, 3> column_lists{{
    {"coordinate", ColumnGroup::coordinates, &RunRecord::coordinates},
    {"state", ColumnGroup::states, &RunRecord::states},
    {"value", ColumnGroup::values, &RunRecord::values},
}};

struct NameList {
    const char* what;
    std::vector<std::string> RunRecord::*names;
};
constexpr std::array<NameList, 3> name_lists{
    {{"sampling", &RunRecord::samplings}, {"mode", &RunRecord::modes}, {"direction", &RunRecord::directions}}};

} // namespace

const std::string& RunRecord::point_name(const std::string& label) const {
    for (const PointName& point : point_names)
        if (point.label == label)
            return point.name;
    return label;
}

std::string RunRecord::label_named(const std::string& shown) const {
    for (const PointName& point : point_names)
        if (point.name == shown)
            return point.label;
    return "";
}

const ColumnsOf<NoContext, RunRecord>& run_columns() {
    static const ColumnsOf<NoContext, RunRecord> columns{
        text_column(kept("name"), [](auto& run) { return &run.name; }),
        text_column(kept("kind"), [](auto& run) { return &run.kind; }),
        {{"status", ColumnType::text},
         [](const NoContext&, const RunRecord& run, CellWriter& cell) { cell.text(name_of(run.status)); },
         [](const NoContext&, RunRecord& run, CellReader& cell) {
             run.status = enumerator_named(cell.text(), RunStatus::failed).value_or(RunStatus::unfinished);
         }},
        whole_column(kept("points"), [](auto& run) { return &run.points; }),
        text_column(kept("model_name"), [](auto& run) { return &run.model_name; }),
        text_column(kept("model"), [](auto& run) { return &run.model; }),
        text_column(kept("settings"), [](auto& run) { return &run.settings; }),
        text_column(kept("fingerprint"), [](auto& run) { return &run.fingerprint; }),
        text_column(kept("version"), [](auto& run) { return &run.version; }),
    };
    return columns;
}

std::string key_of_failure(const std::string& run) {
    return std::string(begin_of_failure) + run;
}

void write_lists(const Database& database, const RunRecord& run) {
    const RunTables tables(run);
    Statement column = database.prepare(insert_into("columns", 6));
    for (const ColumnList& list : column_lists) {
        const std::vector<std::string> names = tables.names_of(list.group);
        for (std::size_t i = 0; i < names.size(); ++i) {
            const ResultColumn& one = (run.*list.columns)[i];
            column.run(run.name, list.place, i, one.name, one.unit, names[i]);
        }
    }
    Statement name = database.prepare(insert_into("names", 4));
    for (const NameList& list : name_lists)
        for (std::size_t i = 0; i < (run.*list.names).size(); ++i)
            name.run(run.name, list.what, i, (run.*list.names)[i]);
    write_point_names(database, run.name, run.point_names);
}

void write_point_names(const Database& database, const std::string& run, const std::vector<PointName>& names) {
    database.prepare("DELETE FROM names WHERE run = ? AND substr(what, 1, length(?)) = ?")
        .run(run, begin_of_point_name, begin_of_point_name);
    Statement row = database.prepare(insert_into("names", 4));
    for (const PointName& one : names)
        row.run(run, begin_of_point_name + one.label, std::size_t{0}, one.name);
}

void read_lists(const Database& database, RunRecord& run) {
    Statement columns = database.prepare("SELECT place, name, unit FROM columns WHERE run = ? ORDER BY position");
    columns.bind_all(run.name);
    while (columns.step())
        for (const ColumnList& list : column_lists)
            if (columns.text(0) == list.place)
                (run.*list.columns).push_back({columns.text(1), columns.text(2)});
    Statement names = database.prepare("SELECT what, name FROM names WHERE run = ? ORDER BY position");
    names.bind_all(run.name);
    while (names.step())
        for (const NameList& list : name_lists)
            if (names.text(0) == list.what)
                (run.*list.names).push_back(names.text(1));
    Statement of_points = database.prepare("SELECT substr(what, length(?) + 1), name FROM names WHERE run = ? AND "
                                           "substr(what, 1, length(?)) = ? ORDER BY what");
    of_points.bind_all(begin_of_point_name, run.name, begin_of_point_name, begin_of_point_name);
    while (of_points.step())
        run.point_names.push_back({of_points.text(0), of_points.text(1)});
}

} // namespace graze
