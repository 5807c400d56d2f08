#include "results/file_form.hpp"

#include "results/schema.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <set>
#include <string_view>
#include <utility>

namespace graze {

namespace {

std::vector<std::string> columns_of_table(const Database& database, const std::string& quoted_table) {
    std::vector<std::string> names;
    const Statement rows = database.prepare(fmt::format("SELECT * FROM main.{} LIMIT 0", quoted_table));
    for (int i = 0; i < rows.columns(); ++i)
        names.push_back(rows.name(i));
    return names;
}

bool has_table(const Database& database, const std::string& name) {
    Statement row = database.prepare("SELECT 1 FROM main.sqlite_master WHERE name = ?");
    row.bind(1, std::string_view(name));
    return row.step();
}

constexpr std::pair<ColumnGroup, std::string_view> places_of_own_names[] = {
    {ColumnGroup::coordinates, "coordinate"}, {ColumnGroup::states, "state"}, {ColumnGroup::values, "value"}};

/// What the columns of a run's own things are called in the file, in their order.
std::map<ColumnGroup, std::vector<std::string>> own_names(const Database& database, const std::string& run) {
    std::map<ColumnGroup, std::vector<std::string>> names;
    Statement row = database.prepare("SELECT place, column_name FROM columns WHERE run = ? ORDER BY position");
    row.bind(1, std::string_view(run));
    while (row.step())
        for (const auto& [group, place] : places_of_own_names)
            if (row.text(0) == place)
                names[group].push_back(row.text(1));
    return names;
}

/// A column of this format, and what it is called in the file.
struct Counterpart {
    std::string name;
    std::string there{}; ///< empty: it is not there
    bool may_lack = false;
};

struct TableForm {
    std::string table; ///< quoted
    std::vector<Counterpart> columns{};
    bool with_rowid = false;

    bool is_this_form() const {
        return std::all_of(columns.begin(), columns.end(), [](const auto& one) { return one.name == one.there; });
    }
    /// Whether nothing lacks that every file has.
    bool can_be_shown() const {
        return std::all_of(columns.begin(), columns.end(),
                           [](const auto& one) { return one.may_lack || !one.there.empty(); });
    }
};

TableForm form_of(const Database& database, const std::string& table, const std::vector<RunColumn>& columns,
                  std::map<ColumnGroup, std::vector<std::string>> own) {
    TableForm form{table};
    const std::vector<std::string> there = columns_of_table(database, table);
    const auto has = [&](const std::string& name) {
        return std::find(there.begin(), there.end(), name) != there.end();
    };
    std::set<std::string> taken; // by a run's own things, whatever a column of this format is called
    for (const RunColumn& column : columns)
        taken.insert(own[column.kind.group].begin(), own[column.kind.group].end());
    std::map<ColumnGroup, std::size_t> next;
    for (const RunColumn& column : columns) {
        Counterpart one{column.column, "", column.kind.may_lack};
        if (column.kind.group == ColumnGroup::single) {
            for (const std::string& name : {column.column, std::string(column.kind.former)})
                if (one.there.empty() && !name.empty() && has(name) && !taken.contains(name))
                    one.there = name;
        } else if (const std::size_t i = next[column.kind.group]++; i < own[column.kind.group].size()) {
            if (const std::string& name = own[column.kind.group][i]; has(name))
                one.there = name;
        }
        form.columns.push_back(std::move(one));
    }
    return form;
}

std::vector<TableForm> forms_of(const Database& database, const RunRecord& run) {
    const RunTables tables(run);
    const auto own = own_names(database, run.name);
    std::vector<TableForm> forms;
    for (const bool samples : {false, true}) {
        const std::string& table = samples ? tables.samples : tables.points;
        const std::vector<RunColumn>& columns = samples ? tables.sample_columns : tables.point_columns;
        TableForm& form = forms.emplace_back(form_of(database, table, columns, own));
        form.with_rowid = samples && !tables.is_branch;
    }
    return forms;
}

/// Tables of all runs that older files may lack, with what makes them.
std::vector<std::pair<std::string, std::string>> lacking_tables(const Database& database) {
    std::vector<std::pair<std::string, std::string>> lacking;
    for (const auto& [name, columns] : shared_tables())
        if (!has_table(database, name))
            lacking.emplace_back(name, columns);
    return lacking;
}

/// Makes the tables that are lacking, and gives those of another form to `change`, with their run. Tables without what
/// every file has stay as they are. @param kind of the tables made: "" or "TEMP "
/// @return what is missing
template <class Change>
std::vector<std::string> change_forms(const Database& database, const std::vector<RunRecord>& runs, const char* kind,
                                      const Change& change) {
    std::vector<std::string> missing;
    for (const auto& [name, columns] : lacking_tables(database)) {
        missing.push_back(name);
        database.execute(fmt::format("CREATE {}TABLE {}({}) WITHOUT ROWID", kind, name, columns));
    }
    for (const RunRecord& run : runs)
        for (const TableForm& form : forms_of(database, run)) {
            if (form.is_this_form() || !form.can_be_shown())
                continue;
            for (const Counterpart& column : form.columns)
                if (column.there.empty())
                    missing.push_back(run.name + "." + column.name);
            change(run, form);
        }
    return missing;
}

} // namespace

std::vector<std::string> show_in_this_form(const Database& database, const std::vector<RunRecord>& runs) {
    return change_forms(database, runs, "TEMP ", [&](const RunRecord&, const TableForm& form) {
        std::vector<std::string> cells;
        for (const Counterpart& column : form.columns)
            cells.push_back(fmt::format("{} AS {}", column.there.empty() ? "NULL" : quoted_name(column.there),
                                        quoted_name(column.name)));
        if (form.with_rowid)
            cells.emplace_back("rowid AS rowid");
        // Names without a schema are those of temporary views first.
        database.execute(
            fmt::format("CREATE TEMP VIEW {0} AS SELECT {1} FROM main.{0}", form.table, fmt::join(cells, ", ")));
    });
}

std::vector<std::string> bring_into_this_form(const Database& database, const std::vector<RunRecord>& runs) {
    // What a run's own columns are called from now on.
    Statement own_name =
        database.prepare("UPDATE columns SET column_name = ? WHERE run = ? AND place = ? AND position = ?");
    return change_forms(database, runs, "", [&](const RunRecord& run, const TableForm& form) {
        for (const auto& [group, place] : places_of_own_names) {
            const std::vector<std::string> names = RunTables(run).names_of(group);
            for (std::size_t i = 0; i < names.size(); ++i)
                own_name.run(names[i], run.name, place, i);
        }
        for (const Counterpart& column : form.columns)
            if (!column.there.empty() && column.there != column.name)
                database.execute(fmt::format("ALTER TABLE {} RENAME COLUMN {} TO {}", form.table,
                                             quoted_name(column.there), quoted_name(column.name)));
        for (const Counterpart& column : form.columns)
            if (column.there.empty())
                database.execute(fmt::format("ALTER TABLE {} ADD COLUMN {}", form.table, quoted_name(column.name)));
    });
}

} // namespace graze
