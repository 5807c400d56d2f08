#include "graze/results/point_list.hpp"

#include "base/special_numbers.hpp"
#include "graze/base/rounded.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <limits>
#include <map>
#include <utility>
#include <variant>

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

/// The table of points: for people with the main columns, for CSV and JSON with every column.
class PointTable {
public:
    PointTable(const PointList& list, const PointTableStyle& style)
        : list_(list), for_people_(style.for_people), brief_(style.brief && for_people_), digits_(style.digits) {
        show_names();
        show_orbits();
        show_evidence();
        show_touches();
        show_tori();
        show(!for_people_ ||
                 any([](const auto& p) { return !p.record.point.detail.empty() || is_unphysical(p.record); }),
             "detail", "", [this](const auto& p) { return cut(detail_of(p.record)); });
        show_monitors();
        show(!for_people_, "residual", "", [](const auto& p) { return p.record.point.solution.residual; });
        for (std::size_t c = 0; c < stored_columns().size(); ++c)
            show(!for_people_, stored_columns()[c], "", [c](const auto& p) { return p.stored[c]; });
    }

    Table make() const {
        Table table(columns_);
        for (const ListedPoint& point : list_.points)
            for (const auto& value : values_)
                std::visit([&](const auto& cell) { table.add(cell); }, value(point));
        return table;
    }

private:
    using Cell = std::variant<double, std::string>;

    template <class Value>
    void show(bool wanted, const std::string& name, const std::string& unit, const Value& value) {
        if (wanted) {
            columns_.push_back({name, unit});
            values_.push_back(value);
        }
    }
    template <class Holds>
    bool any(const Holds& holds) const {
        return std::any_of(list_.points.begin(), list_.points.end(), holds);
    }
    const RunRecord& run_of(const ListedPoint& point) const { return list_.run_of(point).record; }
    const Model& model_of(const ListedPoint& point) const { return list_.run_of(point).model; }

    void show_names() {
        show(!brief_ || list_.runs.size() != 1, "run", "", [this](const auto& p) { return run_of(p).name; });
        show(true, "label", "", [](const auto& p) { return p.record.label; });
        const auto name = [this](const auto& p) { return run_of(p).point_name(p.record.label); };
        show(any([&](const auto& p) { return name(p) != p.record.label; }), "name", "", name);
        show(!for_people_ || any([](const auto& p) { return p.record.label.empty(); }), "type", "",
             [](const auto& p) { return std::string(short_name(p.record.point.type)); });
        const auto followed = [this](const auto& p) { return followed_parameter(run_of(p)); };
        const bool several = list_.followed.empty() && any([&](const auto& p) { return !followed(p).empty(); });
        show(several, "parameter", "", followed);
        show(several, "value", "", [this, followed](const auto& p) {
            return followed(p).empty() ? not_a_number : value_of_parameter(list_, p, followed(p));
        });
        std::vector<std::string> parameters = list_.differing;
        if (!list_.followed.empty())
            parameters.insert(parameters.begin(), list_.followed);
        for (const std::string& one : parameters)
            show(true, one, list_.runs.empty() ? "" : list_.runs.front().unit(one),
                 [this, one](const auto& p) { return value_of_parameter(list_, p, one); });
    }
    void show_orbits() {
        std::size_t segments = 0, multipliers = 0, eigenvalues = 0; // greatest numbers at any point
        for (const ListedPoint& p : list_.points) {
            segments = std::max(segments, p.record.point.solution.orbit.segments());
            multipliers = std::max(multipliers, p.record.point.solution.multipliers.size());
            eigenvalues = std::max(eigenvalues, p.record.point.solution.eigenvalues.size());
        }
        const std::string time = list_.runs.empty() ? "" : list_.runs.front().model.time_unit;
        const auto orbit = [](const auto& p) -> const Orbit& { return p.record.point.solution.orbit; };
        const auto rests = [orbit](const auto& p) { return is_rest(orbit(p).signature); };
        const bool moves = !for_people_ || list_.points.empty() || any([rests](const auto& p) { return !rests(p); });
        show(moves, "period", time, [orbit](const auto& p) { return orbit(p).period(); });
        show(for_people_ && moves, "durations", time,
             [orbit](const auto& p) { return numbers_text(orbit(p).durations, 6); });
        for (std::size_t s = 0; s < segments; ++s)
            show(!for_people_, fmt::format("duration_{}", s + 1), time,
                 [orbit, s](const auto& p) { return s < orbit(p).segments() ? orbit(p).durations[s] : not_a_number; });
        show(true, "signature", "",
             [this, orbit](const auto& p) { return to_string(model_of(p), orbit(p).signature); });
        show(!for_people_ || any([orbit](const auto& p) { return orbit(p).symmetry.has_value(); }), "symmetry", "",
             [this, orbit](const auto& p) {
                 return orbit(p).symmetry ? model_of(p).symmetries[*orbit(p).symmetry].name : "";
             });
        show(true, "stable", "", [this](const auto& p) { return truth(p.record.stable); });
        show(moves, "multiplier", "", [this](const auto& p) { return multiplier_of(p.record); });
        show_complex(!for_people_, "multiplier", multipliers, &OrbitSolution::multipliers);
        show(for_people_ && eigenvalues > 0, "eigenvalues", "", [this](const auto& p) {
            return multipliers_text(p.record.point.solution.eigenvalues, brief_ ? 4 : digits_);
        });
        show_complex(!for_people_, "eigenvalue", eigenvalues, &OrbitSolution::eigenvalues);
    }
    /// Columns of real and imaginary parts. @param count of numbers
    void show_complex(bool wanted, const char* name, std::size_t count,
                      std::vector<std::complex<double>> OrbitSolution::*numbers) {
        for (std::size_t m = 0; m < count; ++m)
            for (const bool real : {true, false})
                show(wanted, fmt::format("{}_{}_{}", name, m + 1, real ? "real" : "imaginary"), "",
                     [m, real, numbers](const auto& p) {
                         const auto& all = p.record.point.solution.*numbers;
                         return extended(m >= all.size() ? not_a_number : real ? all[m].real() : all[m].imag());
                     });
    }
    void show_evidence() {
        const auto certificate = [](const auto& p) -> const Certificate& {
            return p.record.point.solution.certificate;
        };
        if (for_people_)
            show(any([](const auto& p) { return is_unphysical(p.record); }), "physical", "",
                 [certificate](const auto& p) {
                     return certificate(p).admissible ? "yes" : is_unphysical(p.record) ? "no" : "limit";
                 });
        else
            show(true, "admissible", "",
                 [this, certificate](const auto& p) { return truth(certificate(p).admissible); });
        show(!for_people_, "reason", "", [certificate](const auto& p) { return certificate(p).reason; });
        const bool bracket = !for_people_ || any([](const auto& p) { return !p.record.point.located; });
        show(bracket, "located", "", [this](const auto& p) { return truth(p.record.point.located); });
        show(bracket, "low", "", [](const auto& p) { return p.record.point.bracket.first; });
        show(bracket, "high", "", [](const auto& p) { return p.record.point.bracket.second; });
    }
    void show_touches() {
        const bool verdicts = any([](const auto& p) { return p.record.touch.has_value(); });
        const auto show_text = [&](bool wanted, const char* name, std::string TouchFindings::*text) {
            show(wanted, name, "", [text](const auto& p) { return p.record.touch ? (*p.record.touch).*text : ""; });
        };
        show_text(verdicts, "touch_verdict", &TouchFindings::verdict);
        show(verdicts, "touch_next_contact", "", [](const auto& p) {
            const std::size_t next = p.record.touch ? p.record.touch->next_contact : 0;
            return next > 0 ? static_cast<double>(next) : not_a_number;
        });
        show_text(verdicts && !for_people_, "touch_map", &TouchFindings::map);
        show_text(verdicts && !for_people_, "touch_verdict_reason", &TouchFindings::reason);
        for (const auto& [name, number] : {std::pair("touch_projection_1", &TouchFindings::projection),
                                           {"touch_growth", &TouchFindings::growth},
                                           {"touch_jump_growth", &TouchFindings::jump_growth},
                                           {"touch_reach", &TouchFindings::reach},
                                           {"touch_clearance_rate", &TouchFindings::clearance_rate},
                                           {"touch_speed_factor", &TouchFindings::speed_factor},
                                           {"touch_fold_distance", &TouchFindings::fold_distance}})
            show(verdicts && !for_people_, name, "", [number = number](const auto& p) {
                return p.record.touch ? ((*p.record.touch).*number).value_or(not_a_number) : not_a_number;
            });
    }
    void show_tori() {
        const bool tori = any([](const auto& p) { return p.record.torus.has_value(); });
        for (const auto& [name, number] : {std::pair("rotation_number", &TorusRecord::rotation),
                                           {"torus_growth", &TorusRecord::growth},
                                           {"torus_tail", &TorusRecord::tail}})
            show(tori && (!for_people_ || number != &TorusRecord::tail), name, "", [number = number](const auto& p) {
                return p.record.torus ? (*p.record.torus).*number : not_a_number;
            });
        show(tori, "torus_harmonics", "", [](const auto& p) {
            return p.record.torus ? static_cast<double>(p.record.torus->harmonics) : not_a_number;
        });
    }
    /// The monitors of all runs by name; for people without the period, which has its own column. A monitor with the
    /// name of another column gets a number appended to its name, as in the result file.
    void show_monitors() {
        std::vector<ResultColumn> monitors;
        for (const StoredRun& run : list_.runs)
            for (const ResultColumn& value : run.record.values)
                if (std::ranges::find(monitors, value.name, &ResultColumn::name) == monitors.end() &&
                    !(for_people_ && value.name == "period"))
                    monitors.push_back(value);
        for (const ResultColumn& monitor : monitors) {
            std::string name = monitor.name;
            for (int i = 2; std::ranges::find(columns_, name, &Table::Column::name) != columns_.end(); ++i)
                name = fmt::format("{}_{}", monitor.name, i);
            show(true, name, monitor.unit,
                 [this, of = monitor.name](const auto& p) { return extended(monitor_of(p, of)); });
        }
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
    /// The largest modulus. CSV and JSON have a number or a missing cell, people also read words, and six digits,
    /// enough to compare a multiplier with 1.
    Cell multiplier_of(const OrbitRecord& record) const {
        const OrbitSolution& solution = record.point.solution;
        const double largest = solution.multipliers.empty() ? not_a_number : std::abs(solution.multipliers.front());
        if (std::isinf(largest))
            return for_people_ ? "infinite" : "inf";
        if (for_people_ && record.torus) // which has none
            return "";
        if (for_people_ && solution.multipliers.empty())
            return multipliers_text(solution, digits_);
        return for_people_ && std::isfinite(largest) ? rounded(largest, 6) : largest;
    }
    double monitor_of(const ListedPoint& point, const std::string& name) const {
        const std::vector<ResultColumn>& values = run_of(point).values;
        const std::vector<double>& monitors = point.record.point.monitors;
        for (std::size_t m = 0; m < std::min(values.size(), monitors.size()); ++m)
            if (values[m].name == name)
                return monitors[m];
        return not_a_number;
    }
    Cell truth(bool holds) const { return for_people_ ? Cell(holds ? "yes" : "no") : Cell(holds ? 1.0 : 0.0); }
    /// As Table::add_extended has it.
    static Cell extended(double value) { return std::isinf(value) ? Cell(value > 0 ? "inf" : "-inf") : Cell(value); }
    static std::string numbers_text(const std::vector<double>& values, int digits) {
        std::string text;
        for (const double value : values)
            text += fmt::format("{}{:.{}g}", text.empty() ? "" : " ", value, digits);
        return text;
    }

    const PointList& list_;
    bool for_people_, brief_;
    int digits_;
    std::vector<Table::Column> columns_;
    std::vector<std::function<Cell(const ListedPoint&)>> values_;
};

} // namespace

Table point_table(const PointList& list, const PointTableStyle& style) {
    return PointTable(list, style).make();
}

} // namespace graze
