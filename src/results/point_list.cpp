#include "graze/results/point_list.hpp"

#include "base/special_numbers.hpp"
#include "graze/base/rounded.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <optional>
#include <utility>

namespace graze {

namespace {

/// Columns of the file that CSV and JSON copy without change.
const std::vector<std::string>& stored_columns() {
    static const std::vector<std::string> names{"slowest_approach"};
    return names;
}

/// The numbers in these columns, by the number of the orbit.
std::map<std::size_t, std::vector<double>> stored_values(const StoredRun& run) {
    std::map<std::size_t, std::vector<double>> values;
    auto rows = run.rows({.columns = {"number"}, .quantities = stored_columns()});
    while (rows.next())
        for (std::size_t c = 1; c < rows.columns(); ++c)
            values[static_cast<std::size_t>(rows.integer(0))].push_back(
                rows.is_null(c) ? std::numeric_limits<double>::quiet_NaN() : rows.number(c));
    return values;
}

double value_of_parameter(const PointList& list, const ListedPoint& point, const std::string& name) {
    const std::vector<ResultColumn>& columns = list.run_of(point).record.coordinates;
    for (std::size_t i = 0; i < std::min(columns.size(), point.parameters.size()); ++i)
        if (columns[i].name == name)
            return point.parameters[i];
    return std::numeric_limits<double>::quiet_NaN();
}

/// Parameters, except the followed one, that do not have the same value at all points.
std::vector<std::string> differing_parameters(const PointList& list) {
    std::vector<std::string> names;
    for (const StoredRun& run : list.runs)
        for (const ResultColumn& column : run.record.coordinates)
            if (column.name != list.followed && std::find(names.begin(), names.end(), column.name) == names.end())
                names.push_back(column.name);
    std::erase_if(names, [&](const std::string& name) {
        return std::all_of(list.points.begin(), list.points.end(), [&](const ListedPoint& point) {
            const double first = value_of_parameter(list, list.points.front(), name),
                         here = value_of_parameter(list, point, name);
            return first == here || (std::isnan(first) && std::isnan(here));
        });
    });
    return names;
}

} // namespace

PointList listed_points(const ResultFile& file, const PointListRequest& request) {
    PointList list;
    const std::vector<PointType>& types = request.types;
    for (const RunRecord& run : branch_runs(file, request.runs, request.place))
        list.runs.emplace_back(file, run.name, request.place);
    bool several = false;
    for (std::size_t r = 0; r < list.runs.size(); ++r) {
        const RunRecord& run = list.runs[r].record;
        const std::string followed = followed_parameter(run);
        if (!followed.empty()) {
            several = several || (!list.followed.empty() && list.followed != followed);
            list.followed = followed;
        }
        const bool wants_regular = request.regular || run.kind == "orbit" ||
                                   std::find(types.begin(), types.end(), PointType::regular) != types.end();
        auto stored = stored_values(list.runs[r]);
        for (OrbitRecord& record : file.orbits(run.name, !wants_regular)) {
            if (!types.empty() && std::find(types.begin(), types.end(), record.point.type) == types.end())
                continue;
            if (!request.images && record.point.detail.starts_with("twin of ")) {
                ++list.images_left_out;
                continue;
            }
            std::vector<double> parameters = parameters_of(list.runs[r], record), values = stored[record.number];
            list.points.push_back({r, std::move(record), std::move(parameters), std::move(values)});
        }
    }
    if (several)
        list.followed.clear();
    list.differing = differing_parameters(list);
    return list;
}

namespace {

/// Fills the table of points: for people with the main columns, for CSV and JSON with every column.
class PointTable {
public:
    PointTable(const PointList& list, const PointTableStyle& style)
        : list_(list), for_people_(style.for_people), brief_(style.brief && for_people_), digits_(style.digits) {
        const auto any = [&](auto holds) { return std::any_of(list.points.begin(), list.points.end(), holds); };
        with_symmetry_ = !for_people_ ||
                         any([](const ListedPoint& p) { return p.record.point.solution.orbit.symmetry.has_value(); });
        with_reason_ = !for_people_ || any([](const ListedPoint& p) { return is_unphysical(p.record); });
        with_bracket_ = !for_people_ || any([](const ListedPoint& p) { return !p.record.point.located; });
        with_detail_ = !for_people_ || any([](const ListedPoint& p) {
            return !p.record.point.detail.empty() || is_unphysical(p.record);
        });
        with_name_ = any(
            [&](const ListedPoint& p) { return list.run_of(p).record.point_name(p.record.label) != p.record.label; });
        with_verdict_ = any([](const ListedPoint& p) { return p.record.touch.has_value(); });
        for (const ListedPoint& p : list.points) {
            segments_ = std::max(segments_, p.record.point.solution.orbit.segments());
            multipliers_ = std::max(multipliers_, p.record.point.solution.multipliers.size());
        }
        collect_monitors();
        with_type_ = !for_people_ || any([](const ListedPoint& p) { return p.record.label.empty(); });
        with_run_ = !brief_ || list.runs.size() != 1;
        with_parameter_ = list.followed.empty() &&
                          any([&](const ListedPoint& p) { return !followed_parameter(list.run_of(p).record).empty(); });
    }

    Table make() {
        declare();
        table_ = Table(columns_);
        for (const ListedPoint& point : list_.points)
            add(point);
        return std::move(table_);
    }

private:
    void declare() {
        add_columns({"run"}, with_run_);
        add_columns({"label"}, true);
        add_columns({"name"}, with_name_);
        add_columns({"type"}, with_type_);
        if (with_parameter_)
            for (const char* name : {"parameter", "value"})
                columns_.push_back({name, ""});
        else if (!list_.followed.empty())
            columns_.push_back({list_.followed, unit_of(list_.followed)});
        for (const std::string& name : list_.differing)
            columns_.push_back({name, unit_of(name)});
        const std::string time = list_.runs.empty() ? "" : list_.runs.front().model.time_unit;
        columns_.push_back({"period", time});
        if (for_people_)
            columns_.push_back({"durations", time});
        for (std::size_t s = 1; !for_people_ && s <= segments_; ++s)
            columns_.push_back({fmt::format("duration_{}", s), time});
        add_columns({"signature"}, true);
        add_columns({"symmetry"}, with_symmetry_);
        add_columns({"stable", "multiplier"}, true);
        for (std::size_t m = 1; !for_people_ && m <= multipliers_; ++m)
            for (const char* part : {"real", "imaginary"})
                columns_.push_back({fmt::format("multiplier_{}_{}", m, part), ""});
        add_columns({for_people_ ? "physical" : "admissible"}, with_reason_);
        add_columns({"reason"}, !for_people_);
        add_columns({"located", "low", "high"}, with_bracket_);
        add_columns({"touch_verdict", "touch_next_contact"}, with_verdict_);
        add_columns({"touch_map", "touch_verdict_reason", "touch_projection_1", "touch_growth", "touch_jump_growth",
                     "touch_reach", "touch_clearance_rate", "touch_speed_factor", "touch_fold_distance"},
                    with_verdict_ && !for_people_);
        add_columns({"detail"}, with_detail_);
        add_monitors();
        add_columns({"residual"}, !for_people_);
        add_columns(stored_columns(), !for_people_);
    }
    /// Collects the monitors of all runs by name; for people without the period, which has its own column.
    void collect_monitors() {
        for (const StoredRun& run : list_.runs)
            for (const ResultColumn& value : run.record.values)
                if (std::none_of(monitors_.begin(), monitors_.end(),
                                 [&](const ResultColumn& one) { return one.name == value.name; }) &&
                    !(for_people_ && value.name == "period"))
                    monitors_.push_back(value);
    }
    /// A monitor with the name of another column gets a number appended to its name, as in the result file.
    void add_monitors() {
        for (const ResultColumn& monitor : monitors_) {
            std::string name = monitor.name;
            for (int i = 2; std::any_of(columns_.begin(), columns_.end(),
                                        [&](const Table::Column& column) { return column.name == name; });
                 ++i)
                name = fmt::format("{}_{}", monitor.name, i);
            columns_.push_back({name, monitor.unit});
        }
    }
    void add_columns(const std::vector<std::string>& names, bool wanted) {
        for (const std::string& name : names)
            if (wanted)
                columns_.push_back({name, ""});
    }
    std::string unit_of(const std::string& name) const {
        return list_.runs.empty() ? "" : list_.runs.front().unit(name);
    }

    void add(const ListedPoint& point) {
        const OrbitRecord& record = point.record;
        const OrbitSolution& solution = record.point.solution;
        const RunRecord& run = list_.run_of(point).record;
        if (with_run_)
            table_.add(run.name);
        table_.add(record.label);
        if (with_name_)
            table_.add(run.point_name(record.label));
        if (with_type_)
            table_.add(short_name(record.point.type));
        const std::string followed = followed_parameter(run);
        if (with_parameter_)
            table_.add(followed);
        if (with_parameter_)
            table_.add(followed.empty() ? not_a_number : value_of_parameter(list_, point, followed));
        else if (!list_.followed.empty())
            table_.add(value_of_parameter(list_, point, list_.followed));
        for (const std::string& name : list_.differing)
            table_.add(value_of_parameter(list_, point, name));
        table_.add(solution.orbit.period());
        if (for_people_)
            table_.add(numbers_text(solution.orbit.durations, 6));
        for (std::size_t s = 0; !for_people_ && s < segments_; ++s)
            table_.add(s < solution.orbit.segments() ? solution.orbit.durations[s] : not_a_number);
        table_.add(to_string(list_.run_of(point).model, solution.orbit.signature));
        if (with_symmetry_)
            table_.add(solution.orbit.symmetry ? list_.run_of(point).model.symmetries[*solution.orbit.symmetry].name
                                               : "");
        add_truth(record.stable);
        add_multiplier(solution);
        for (std::size_t m = 0; !for_people_ && m < multipliers_; ++m) {
            const bool known = m < solution.multipliers.size();
            table_.add_extended(known ? solution.multipliers[m].real() : not_a_number);
            table_.add_extended(known ? solution.multipliers[m].imag() : not_a_number);
        }
        if (with_reason_ && for_people_)
            table_.add(solution.certificate.admissible ? "yes" : is_unphysical(record) ? "no" : "limit");
        else if (with_reason_)
            add_truth(solution.certificate.admissible);
        if (!for_people_)
            table_.add(solution.certificate.reason);
        if (with_bracket_) {
            add_truth(record.point.located);
            table_.add(record.point.bracket.first);
            table_.add(record.point.bracket.second);
        }
        if (with_verdict_)
            add_verdict(record.touch.value_or(TouchFindings()));
        if (with_detail_)
            table_.add(cut(detail_of(record)));
        for (const ResultColumn& monitor : monitors_)
            table_.add_extended(monitor_of(point, monitor.name));
        if (for_people_)
            return;
        table_.add(solution.residual);
        for (const double value : point.stored)
            table_.add(value);
    }
    void add_verdict(const TouchFindings& touch) {
        table_.add(touch.verdict);
        table_.add(touch.next_contact > 0 ? static_cast<double>(touch.next_contact) : not_a_number);
        if (for_people_)
            return;
        table_.add(touch.map);
        table_.add(touch.reason);
        for (const std::optional<double>& number : {touch.projection, touch.growth, touch.jump_growth, touch.reach,
                                                    touch.clearance_rate, touch.speed_factor, touch.fold_distance})
            table_.add(number.value_or(not_a_number));
    }
    std::string cut(std::string text) const {
        constexpr std::size_t longest = 22;
        if (!brief_ || text.size() <= longest)
            return text;
        std::size_t end = longest - 4;
        while (end > 0 && ((static_cast<unsigned char>(text[end]) & 0xc0) == 0x80 || text[end - 1] == ' '))
            --end; // do not end within a character or after a blank
        return text.substr(0, end) + " ...";
    }
    /// The detail of a point; for people followed by the reason if the orbit is unphysical.
    std::string detail_of(const OrbitRecord& record) const {
        const std::string& detail = record.point.detail;
        if (!for_people_ || !is_unphysical(record))
            return detail;
        return detail + (detail.empty() ? "" : "; ") + record.point.solution.certificate.reason;
    }
    /// Adds the largest modulus. CSV and JSON have a number or a missing cell, people also read words.
    void add_multiplier(const OrbitSolution& solution) {
        const double largest = solution.multipliers.empty() ? not_a_number : std::abs(solution.multipliers.front());
        if (std::isinf(largest))
            table_.add(for_people_ ? "infinite" : "inf");
        else if (for_people_ && solution.multipliers.empty())
            table_.add(multipliers_text(solution, digits_));
        else
            table_.add(std::isfinite(largest) ? few_digits(largest) : not_a_number);
    }
    double monitor_of(const ListedPoint& point, const std::string& name) const {
        const std::vector<ResultColumn>& values = list_.run_of(point).record.values;
        const std::vector<double>& monitors = point.record.point.monitors;
        for (std::size_t m = 0; m < std::min(values.size(), monitors.size()); ++m)
            if (values[m].name == name)
                return monitors[m];
        return not_a_number;
    }
    void add_truth(bool holds) {
        if (for_people_)
            table_.add(holds ? "yes" : "no");
        else
            table_.add(holds ? 1.0 : 0.0);
    }
    /// For people six digits, enough to compare a multiplier with 1.
    double few_digits(double value) const { return for_people_ ? rounded(value, 6) : value; }
    static std::string numbers_text(const std::vector<double>& values, int digits) {
        std::string text;
        for (const double value : values)
            text += fmt::format("{}{:.{}g}", text.empty() ? "" : " ", value, digits);
        return text;
    }

    const PointList& list_;
    bool for_people_, brief_, with_run_, with_symmetry_, with_reason_, with_bracket_, with_detail_, with_verdict_,
        with_name_, with_type_, with_parameter_;
    int digits_;
    std::size_t segments_ = 0, multipliers_ = 0; ///< greatest numbers at any point
    std::vector<ResultColumn> monitors_;
    std::vector<Table::Column> columns_;
    Table table_;
};

} // namespace

Table point_table(const PointList& list, const PointTableStyle& style) {
    return PointTable(list, style).make();
}

} // namespace graze
