#include "graze/atlas/atlas_tables.hpp"

#include "atlas/atlas_runs.hpp"
#include "graze/base/input_error.hpp"
#include "graze/results/name_advice.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>

namespace graze {

namespace {

using Columns = std::vector<Table::Column>;

std::string joined(const std::vector<std::string>& texts) {
    return fmt::format("{}", fmt::join(texts, "; "));
}

/// "SN+GR" where curves of folds and grazings meet.
std::string short_names(const std::vector<PointType>& types) {
    std::vector<std::string_view> names;
    for (const PointType type : types)
        names.push_back(short_name(type));
    return fmt::format("{}", fmt::join(names, "+"));
}

std::string yes_or_no(bool value) {
    return value ? "yes" : "no";
}

void append(Columns& columns, const Columns& more) {
    columns.insert(columns.end(), more.begin(), more.end());
}

/// A column for each parameter.
Columns parameter_columns(const AtlasFindings& findings, const std::string& prefix = "") {
    Columns columns;
    for (const AtlasAxis& axis : findings.axes)
        columns.push_back({prefix + axis.name, axis.unit});
    return columns;
}

void add_numbers(Table& table, const std::vector<double>& numbers) {
    for (const double number : numbers)
        table.add(number);
}

/// The value of the second parameter, where there is one.
void add_row(Table& table, const AtlasFindings& findings, std::size_t row) {
    if (!findings.rows.empty())
        table.add(findings.rows.at(row));
}

Columns row_columns(const AtlasFindings& findings) {
    return findings.rows.empty() ? Columns{} : Columns{{findings.axes.at(1).name, findings.axes.at(1).unit}};
}

/// The least or greatest values of both parameters on a curve.
std::vector<double> bound_of(const AtlasCurve& curve, bool greatest) {
    std::vector<double> bound(2, std::numeric_limits<double>::quiet_NaN());
    for (const auto& point : curve.line)
        for (std::size_t i = 0; i < 2; ++i)
            if (!(greatest ? point[i] <= bound[i] : point[i] >= bound[i]))
                bound[i] = point[i];
    return bound;
}

Table curve_table(const AtlasFindings& findings) {
    Columns columns{{"name", ""},     {"type", ""},     {"type_name", ""},
                    {"multiple", ""}, {"contacts", ""}, {"signature", ""}};
    append(columns, parameter_columns(findings, "least_"));
    append(columns, parameter_columns(findings, "greatest_"));
    append(columns, {{"crossings", ""}, {"ends", ""}, {"run", ""}, {"same", ""}});
    Table table(columns);
    for (const AtlasCurve& curve : findings.curves) {
        table.add(curve.name, short_name(curve.type), name_of(curve.type), curve.multiple, curve.contacts,
                  curve.signature);
        add_numbers(table, bound_of(curve, false));
        add_numbers(table, bound_of(curve, true));
        table.add(curve.crossings, joined(curve.ends), curve.run, joined(curve.same));
    }
    return table;
}

Table points_table(const AtlasFindings& findings) {
    Columns columns{{"name", ""}, {"type", ""}, {"type_name", ""}};
    append(columns, parameter_columns(findings));
    append(columns, {{"period", ""},
                     {"multiple", ""},
                     {"contacts", ""},
                     {"signature", ""},
                     {"on_branch", ""},
                     {"curves", ""},
                     {"found", ""},
                     {"detail", ""}});
    Table table(columns);
    for (const AtlasPoint& point : findings.points) {
        table.add(point.name, short_names(point.types), words_of(point));
        add_numbers(table, point.at);
        table.add(point.period, point.multiple, point.contacts, point.signature, yes_or_no(point.on_row),
                  joined(point.curves), joined(point.found), point.detail);
    }
    return table;
}

Table branch_table(const AtlasFindings& findings) {
    Columns columns{{"run", ""}};
    append(columns, row_columns(findings));
    append(columns, {{"multiple", ""}, {"contacts", ""}, {"signature", ""}});
    const AtlasAxis& first = findings.axes.at(0);
    append(columns, {{"least_" + first.name, first.unit},
                     {"greatest_" + first.name, first.unit},
                     {"stable_stretches", ""},
                     {"confirmed", ""},
                     {"stable", ""},
                     {"ends", ""},
                     {"same", ""}});
    Table table(columns);
    for (const AtlasBranch& branch : findings.branches) {
        std::vector<std::string> stable;
        for (const AtlasStretch& stretch : branch.stable)
            stable.push_back(fmt::format("{}:{}", stretch.from, stretch.to));
        table.add(branch.run);
        add_row(table, findings, branch.row);
        table.add(branch.multiple, branch.contacts, branch.signature, branch.least, branch.greatest,
                  branch.stable.size(),
                  std::ranges::count_if(branch.stable,
                                        [](const AtlasStretch& stretch) { return !stretch.confirmed.empty(); }),
                  joined(stable), joined(branch.ends), joined(branch.same));
    }
    return table;
}

Table motion_table(const AtlasFindings& findings) {
    const AtlasAxis& first = findings.axes.at(0);
    Columns columns{{"run", ""}, {"number", ""}, {first.name, first.unit}};
    append(columns, row_columns(findings));
    append(columns, {{"label", ""},
                     {"attractor", ""},
                     {"multiple", ""},
                     {"contacts", ""},
                     {"accumulates", ""},
                     {"claim", ""},
                     {"branch", ""},
                     {"confirms", ""},
                     {"detail", ""}});
    Table table(columns);
    for (const AtlasMotion& motion : findings.motions) {
        table.add(motion.run, motion.number, motion.value);
        add_row(table, findings, motion.row);
        table.add(name_of(motion.label), motion.attractor(), motion.period, motion.contacts,
                  yes_or_no(motion.accumulates), name_of(motion.claim), motion.branch, yes_or_no(motion.confirms),
                  motion.detail);
    }
    return table;
}

Table remainder_table(const AtlasFindings& findings) {
    Table table({{"what", ""}, {"count", ""}, {"where", ""}, {"why", ""}});
    for (const AtlasRemainder& one : findings.remainders)
        table.add(one.what, one.count, one.where, one.why);
    return table;
}

using MakeTable = Table (*)(const AtlasFindings&);

const std::vector<std::pair<std::string, MakeTable>>& tables() {
    static const std::vector<std::pair<std::string, MakeTable>> all{{"curves", curve_table},
                                                                    {"points", points_table},
                                                                    {"branches", branch_table},
                                                                    {"motions", motion_table},
                                                                    {"left", remainder_table}};
    return all;
}

} // namespace

const StudyRun* atlas_that_made(const Study& study, const std::string& run) {
    const auto found = std::ranges::find_if(
        study.runs, [&](const StudyRun& one) { return one.kind == RunKind::atlas && is_made_by(run, one.name); });
    return found == study.runs.end() ? nullptr : &*found;
}

std::string words_of(const AtlasPoint& point) {
    std::vector<std::string_view> names;
    for (const PointType type : point.types)
        names.push_back(name_of(type));
    return fmt::format("{}", fmt::join(names, " and "));
}

std::vector<std::string> atlas_table_names() {
    std::vector<std::string> names;
    for (const auto& one : tables())
        names.push_back(one.first);
    return names;
}

Table atlas_table(const AtlasFindings& findings, std::string_view name) {
    for (const auto& one : tables())
        if (one.first == name)
            return one.second(findings);
    throw InputError(fmt::format("an atlas has no table '{}'", name), name_advice(name, atlas_table_names(), ""));
}

Table curves_and_points(const AtlasFindings& findings) {
    Columns columns{{"kind", ""}, {"name", ""}, {"type", ""}};
    append(columns, parameter_columns(findings));
    append(columns, {{"period", ""},
                     {"multiple", ""},
                     {"contacts", ""},
                     {"signature", ""},
                     {"curves", ""},
                     {"found", ""},
                     {"detail", ""}});
    Table table(columns);
    constexpr double missing = std::numeric_limits<double>::quiet_NaN();
    for (const AtlasCurve& curve : findings.curves) {
        std::vector<std::string> runs{curve.run};
        runs.insert(runs.end(), curve.same.begin(), curve.same.end());
        table.add("curve", curve.name, short_name(curve.type));
        add_numbers(table, std::vector<double>(findings.axes.size() + 1, missing));
        table.add(curve.multiple, curve.contacts, curve.signature, curve.name, joined(runs), joined(curve.ends));
    }
    for (const AtlasPoint& point : findings.points) {
        table.add("point", point.name, short_names(point.types));
        add_numbers(table, point.at);
        table.add(point.period, point.multiple, point.contacts, point.signature, joined(point.curves),
                  joined(point.found), point.detail);
    }
    return table;
}

} // namespace graze
