#include "graze/results/stored_run.hpp"

#include "graze/base/input_error.hpp"
#include "graze/results/name_advice.hpp"
#include "results/point_columns.hpp"
#include "results/run_query.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace graze {

namespace {

RunRecord record_named(const ResultFile& file, const std::string& name, const Place& place) {
    if (auto found = file.find_run(name))
        return std::move(*found);
    throw InputError(place, fmt::format("there are no results of a run '{}'", name),
                     name_advice(name, names_of(file.runs()), "run the study first"));
}

std::vector<std::string> texts_of(ResultFile::Rows rows) {
    std::vector<std::string> texts;
    while (rows.next())
        texts.push_back(rows.text(0));
    return texts;
}

} // namespace

StoredRun::StoredRun(const ResultFile& from, const std::string& name, const Place& place)
    : file(from), record(record_named(from, name, place)), model(stored_model(record)) {
    // Only in a model without parameters a family is followed along none.
    if (record.is_followed() && record.coordinates.empty() && !model.independent_parameters().empty())
        throw_contradiction(file.path(), fmt::format("run '{}' varies nothing", name));
}

std::vector<StoredColumn> StoredRun::columns(bool of_samples) const {
    const RunTables tables(record);
    std::vector<StoredColumn> result;
    for (const RunColumn& column : of_samples ? tables.sample_columns : tables.point_columns)
        result.push_back({column.column, unit_of(column, *this), column.kind.type});
    return result;
}

std::string StoredRun::unit(const std::string& name) const {
    for (const auto* columns : {&record.coordinates, &record.values})
        for (const ResultColumn& column : *columns)
            if (column.name == name)
                return column.unit;
    for (const bool of_samples : {false, true})
        for (const StoredColumn& column : columns(of_samples))
            if (column.name == name)
                return column.unit;
    return "";
}

bool StoredRun::has_value(const std::string& name) const {
    return std::any_of(record.values.begin(), record.values.end(),
                       [&](const ResultColumn& column) { return column.name == name; });
}

std::vector<std::string> StoredRun::coordinate_names() const {
    return names_of(record.coordinates);
}

std::vector<std::string> StoredRun::value_names() const {
    return names_of(record.values);
}

std::vector<std::string> StoredRun::number_columns() const {
    std::vector<std::string> names;
    for (const RunColumn& column : RunTables(record).point_columns)
        if (column.kind.group == ColumnGroup::single && column.kind.type != ColumnType::text)
            names.push_back(column.column);
    return names;
}

ResultFile::Rows StoredRun::rows(const Selection& selection) const {
    const RunQuery query(record);
    const bool grouped = !selection.statistics.empty(), samples = selection.samples || grouped;
    std::vector<std::string> columns;
    for (const std::string& name : selection.columns)
        columns.push_back(query.column(name, samples));
    for (const std::string& name : selection.quantities)
        columns.push_back(query.quantity(name));
    for (const std::string& name : selection.values)
        columns.push_back(query.value(name));
    for (const std::string& name : selection.statistics)
        for (const char* statistic : {"avg", "min", "max"})
            columns.push_back(fmt::format("{}({})", statistic, query.value(name)));
    std::string order = query.order(samples && !grouped);
    if (!selection.sorted_by.empty())
        order = fmt::format("{}, {}", query.quantity(selection.sorted_by), order);
    return file.query(fmt::format(
        "SELECT {} FROM {} WHERE {}{} ORDER BY {}", fmt::join(columns, ", "), query.tables(samples, grouped),
        query.condition(selection.directions, samples ? selection.samplings : std::vector<std::string>()),
        grouped ? " GROUP BY p.number" : "", order));
}

std::size_t StoredRun::points() const {
    return file.point_count(record.name);
}

std::size_t StoredRun::samples() const {
    auto rows = file.query(fmt::format("SELECT count(*) FROM {}", RunTables(record).samples));
    return rows.next() ? static_cast<std::size_t>(rows.integer(0)) : 0;
}

std::optional<std::pair<double, double>> StoredRun::extent(const std::string& quantity) const {
    const RunQuery query(record);
    auto rows = file.query(
        fmt::format("SELECT min({0}), max({0}) FROM {1}", query.quantity(quantity), query.tables(false, false)));
    if (!rows.next() || rows.is_null(0) || !(rows.number(0) < rows.number(1)))
        return std::nullopt;
    return std::pair(rows.number(0), rows.number(1));
}

std::vector<std::pair<std::string, std::size_t>> StoredRun::label_counts() const {
    std::vector<std::pair<std::string, std::size_t>> counts;
    auto rows = file.query(
        fmt::format("SELECT label, count(*) FROM {} GROUP BY label ORDER BY 2 DESC, 1", RunTables(record).points));
    while (rows.next())
        counts.emplace_back(rows.text(0), static_cast<std::size_t>(rows.integer(1)));
    return counts;
}

std::vector<std::string> StoredRun::parts() const {
    if (!record.is_branch())
        return {};
    return texts_of(file.query("SELECT DISTINCT part FROM " + RunTables(record).points));
}

std::vector<std::string> StoredRun::special_labels() const {
    if (!record.is_branch())
        return {};
    return texts_of(file.query(
        fmt::format("SELECT label FROM {} WHERE label IS NOT NULL ORDER BY number", RunTables(record).points)));
}

std::optional<std::size_t> StoredRun::nearest(const std::vector<std::pair<std::string, double>>& at,
                                              const std::vector<std::string>& directions) const {
    const std::vector<std::string> known = coordinate_names();
    for (const auto& [name, value] : at)
        if (std::find(known.begin(), known.end(), name) == known.end())
            throw InputError(fmt::format("run '{}' does not vary '{}'", record.name, name), "");
    return nearest_number(file, record, at, directions);
}

} // namespace graze
