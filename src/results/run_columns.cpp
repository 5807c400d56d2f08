#include "results/run_columns.hpp"

#include "results/schema.hpp"

#include <array>

namespace graze {

std::string_view name_of(RunStatus status) {
    switch (status) {
    case RunStatus::complete:
        return "complete";
    case RunStatus::failed:
        return "failed";
    case RunStatus::unfinished:
        break;
    }
    return "unfinished";
}

namespace {

using Run = RunRecord;
using Type = ColumnType;

template <std::string Run::*text>
ColumnOf<NoContext, Run> text_column(const char* name) {
    return {{name, Type::text},
            [](const NoContext&, const Run& run, CellWriter& cell) { cell.text(run.*text); },
            [](const NoContext&, Run& run, CellReader& cell) { run.*text = cell.text(); }};
}

/// A list of columns of a run, and its name in the file.
struct ColumnList {
    const char* place;
    ColumnGroup group;
    std::vector<ResultColumn> Run::*columns;
};
constexpr std::array<ColumnList, 3> column_lists{{
    {"coordinate", ColumnGroup::coordinates, &Run::coordinates},
    {"state", ColumnGroup::states, &Run::states},
    {"value", ColumnGroup::values, &Run::values},
}};

struct NameList {
    const char* what;
    std::vector<std::string> Run::*names;
};
constexpr std::array<NameList, 3> name_lists{
    {{"sampling", &Run::samplings}, {"mode", &Run::modes}, {"direction", &Run::directions}}};

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
        text_column<&Run::name>("name"),
        text_column<&Run::kind>("kind"),
        {{"status", Type::text},
         [](const NoContext&, const Run& run, CellWriter& cell) { cell.text(name_of(run.status)); },
         [](const NoContext&, Run& run, CellReader& cell) {
             const std::string text = cell.text();
             for (const RunStatus status : {RunStatus::complete, RunStatus::failed})
                 if (text == name_of(status))
                     run.status = status;
         }},
        {{"points", Type::whole},
         [](const NoContext&, const Run& run, CellWriter& cell) { cell.whole(run.points); },
         [](const NoContext&, Run& run, CellReader& cell) { run.points = cell.whole(); }},
        text_column<&Run::model_name>("model_name"),
        text_column<&Run::model>("model"),
        text_column<&Run::settings>("settings"),
        text_column<&Run::fingerprint>("fingerprint"),
        text_column<&Run::version>("version"),
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
            CellWriter cells(column);
            cells.text(run.name);
            cells.text(list.place);
            cells.whole(i);
            cells.text(one.name);
            cells.text(one.unit);
            cells.text(names[i]);
            column.run();
        }
    }
    Statement name = database.prepare(insert_into("names", 4));
    for (const NameList& list : name_lists)
        for (std::size_t i = 0; i < (run.*list.names).size(); ++i) {
            CellWriter cells(name);
            cells.text(run.name);
            cells.text(list.what);
            cells.whole(i);
            cells.text((run.*list.names)[i]);
            name.run();
        }
    write_point_names(database, run.name, run.point_names);
}

void write_point_names(const Database& database, const std::string& run, const std::vector<PointName>& names) {
    Statement old = database.prepare("DELETE FROM names WHERE run = ? AND substr(what, 1, length(?)) = ?");
    for (const int place : {2, 3})
        old.bind(place, std::string_view(begin_of_point_name));
    old.bind(1, std::string_view(run)).run();
    Statement row = database.prepare(insert_into("names", 4));
    for (const PointName& one : names) {
        CellWriter cells(row);
        cells.text(run);
        cells.text(begin_of_point_name + one.label);
        cells.whole(0);
        cells.text(one.name);
        row.run();
    }
}

void read_lists(const Database& database, RunRecord& run) {
    Statement columns = database.prepare("SELECT place, name, unit FROM columns WHERE run = ? ORDER BY position");
    columns.bind(1, std::string_view(run.name));
    while (columns.step())
        for (const ColumnList& list : column_lists)
            if (columns.text(0) == list.place)
                (run.*list.columns).push_back({columns.text(1), columns.text(2)});
    Statement names = database.prepare("SELECT what, name FROM names WHERE run = ? ORDER BY position");
    names.bind(1, std::string_view(run.name));
    while (names.step())
        for (const NameList& list : name_lists)
            if (names.text(0) == list.what)
                (run.*list.names).push_back(names.text(1));
    Statement of_points = database.prepare("SELECT substr(what, length(?) + 1), name FROM names WHERE run = ? AND "
                                           "substr(what, 1, length(?)) = ? ORDER BY what");
    of_points.bind(2, std::string_view(run.name));
    for (const int place : {1, 3, 4})
        of_points.bind(place, std::string_view(begin_of_point_name));
    while (of_points.step())
        run.point_names.push_back({of_points.text(0), of_points.text(1)});
}

} // namespace graze
