#include "graze/symbolic/require.hpp"
#include "results/point_rows.hpp"
#include "results/result_file_state.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

namespace graze {

namespace {

OrbitOutcome outcome_named(const std::string& name) {
    for (int i = 0; i <= static_cast<int>(OrbitOutcome::undefined); ++i)
        if (name == name_of(static_cast<OrbitOutcome>(i)))
            return static_cast<OrbitOutcome>(i);
    return OrbitOutcome::not_converged;
}

/// Where the parameters of a run's columns are among the model's.
std::vector<std::size_t> parameter_places(const Model& model, const RunRecord& run) {
    std::vector<std::size_t> places;
    for (const ResultColumn& column : run.coordinates)
        places.push_back(model.independent_parameter(column.name));
    return places;
}

constexpr double nothing = std::numeric_limits<double>::quiet_NaN(); ///< what is not finite is NULL in the file

double number_or_nothing(const Statement& row, int column) {
    return row.is_null(column) ? nothing : row.number(column);
}

/// Binds a row's columns one after the other.
class Columns {
public:
    explicit Columns(Statement& row) : row_(&row) {}
    template <class Value>
    Columns& add(Value value) {
        row_->bind(at_++, value);
        return *this;
    }
    Columns& add_extended(double value) {
        row_->bind_extended(at_++, value);
        return *this;
    }
    /// Nothing, if it is empty. The text must live until the row has been written.
    Columns& add_text(const std::string& text) {
        text.empty() ? row_->bind_null(at_) : row_->bind(at_, std::string_view(text));
        ++at_;
        return *this;
    }

private:
    Statement* row_;
    int at_ = 1;
};

/// Of each segment what its start and its duration gain, then what the parameters do.
std::vector<double> numbers_of(const OrbitDirection& direction) {
    std::vector<double> numbers;
    for (std::size_t s = 0; s < direction.starts.size(); ++s) {
        numbers.insert(numbers.end(), direction.starts[s].begin(), direction.starts[s].end());
        numbers.push_back(direction.durations[s]);
    }
    numbers.insert(numbers.end(), direction.parameters.begin(), direction.parameters.end());
    return numbers;
}

/// The same back; nothing, if there are not enough of them.
OrbitDirection direction_of(const std::vector<double>& numbers, std::size_t segments, std::size_t states) {
    OrbitDirection direction;
    if (numbers.size() <= segments * (states + 1))
        return direction;
    auto next = numbers.begin();
    for (std::size_t s = 0; s < segments; ++s) {
        const auto end = next + static_cast<std::ptrdiff_t>(states);
        direction.starts.emplace_back(next, end);
        direction.durations.push_back(*end);
        next = end + 1;
    }
    direction.parameters.assign(next, numbers.end());
    return direction;
}

void write_row(Statement& row, const Model& model, const RunRecord& run, const OrbitRecord& record) {
    const SpecialPoint& point = record.point;
    const OrbitSolution& solution = point.solution;
    const Orbit& orbit = solution.orbit;
    const std::string_view type = short_name(point.type), outcome = name_of(solution.outcome);
    const std::string signature = to_string(model, orbit.signature);
    const std::string symmetry = orbit.symmetry ? model.symmetries[*orbit.symmetry].name : "";
    const std::string tangent = fmt::format("[{}]", fmt::join(numbers_of(point.tangent), ","));
    Columns columns(row);
    columns.add(record.number).add(std::string_view(record.part)).add(point.step).add(type).add_text(record.label);
    for (const std::size_t place : parameter_places(model, run))
        columns.add(orbit.parameters[place]);
    columns.add(orbit.period());
    for (std::size_t m = 0; m < run.values.size(); ++m)
        columns.add_extended(m < point.monitors.size() ? point.monitors[m] : nothing);
    columns.add(std::string_view(signature)).add_text(symmetry);
    columns.add(std::int64_t{record.stable}).add(unstable_directions(solution));
    columns.add(std::int64_t{solution.certificate.admissible}).add_text(solution.certificate.reason).add(outcome);
    columns.add_text(point.detail).add(solution.residual).add(solution.error.value_or(nothing));
    columns.add(solution.iterations).add(point.arclength).add(std::int64_t{point.located});
    columns.add(point.bracket.first).add(point.bracket.second);
    if (kind_of(point.type).limits)
        columns.add(std::string_view(model.events[point.event].name))
            .add(point.segment + 1)
            .add(point.time)
            .add(std::int64_t{point.at_end});
    else
        columns.add(nothing).add(nothing).add(nothing).add(nothing);
    columns.add(std::string_view(tangent));
    row.run();
}

void write_segments(Statement& row, const Model& model, const OrbitRecord& record) {
    const OrbitSolution& solution = record.point.solution;
    const Certificate& certificate = solution.certificate;
    const auto value = [](const std::vector<double>& values, std::size_t s) {
        return s < values.size() ? values[s] : nothing;
    };
    for (std::size_t s = 0; s < solution.orbit.segments(); ++s) {
        const Segment& segment = solution.orbit.signature[s];
        row.bind(1, record.number).bind(2, s + 1).bind(3, std::string_view(model.modes[segment.mode].name));
        row.bind(4, std::string_view(end_name(model, segment))).bind(5, solution.orbit.durations[s]);
        row.bind(6, value(certificate.approach_speeds, s)).bind(7, value(certificate.departures, s));
        row.bind(8, value(certificate.guard_margins, s)); // NULL where there is no other way
        for (std::size_t i = 0; i < solution.orbit.starts[s].size(); ++i)
            row.bind(9 + static_cast<int>(i), solution.orbit.starts[s][i]);
        row.run();
    }
}

/// What the model's motion would meet inside arcs and at their ends.
void write_certificate(Statement& minimum, Statement& end_value, const Model& model, const std::string& run,
                       const OrbitRecord& record) {
    const Certificate& certificate = record.point.solution.certificate;
    std::size_t position = 0;
    for (const OrbitMinimum& one : certificate.minima)
        minimum.bind(1, std::string_view(run))
            .bind(2, record.number)
            .bind(3, position++)
            .bind(4, one.segment + 1)
            .bind(5, std::string_view(model.events[one.event].name))
            .bind(6, one.time)
            .bind_extended(7, one.value)
            .bind(8, one.size)
            .run();
    position = 0;
    for (const EndValue& one : certificate.end_values)
        end_value.bind(1, std::string_view(run))
            .bind(2, record.number)
            .bind(3, position++)
            .bind(4, one.segment + 1)
            .bind(5, std::string_view(model.events[one.event].name))
            .bind_extended(6, one.value)
            .bind_extended(7, one.rate)
            .run();
}

void read_certificate(Statement& minima, Statement& end_values, const Model& model, Certificate& certificate) {
    const auto segment = [](const Statement& row) {
        return static_cast<std::size_t>(std::max<std::int64_t>(row.integer(0), 1) - 1);
    };
    while (minima.step())
        if (const auto event = model.find_event(minima.text(1)))
            certificate.minima.push_back(
                {segment(minima), *event, minima.number(2), minima.number(3), minima.number(4)});
    minima.reset();
    while (end_values.step())
        if (const auto event = model.find_event(end_values.text(1)))
            certificate.end_values.push_back({segment(end_values), *event, end_values.number(2), end_values.number(3)});
    end_values.reset();
}

std::vector<double> listed_numbers(const std::string& json) {
    std::istringstream text(json.substr(std::min<std::size_t>(1, json.size())));
    std::vector<double> values;
    double value = 0;
    for (char separator = ','; separator == ',' && text >> value; text >> separator)
        values.push_back(value);
    return values;
}

/// @throws InputError when the model has no such thing
Segment segment_named(const Model& model, const std::string& mode, const std::string& end, const std::string& path) {
    Segment segment;
    const auto known = model.find_mode(mode);
    if (!known)
        throw_contradiction(path, fmt::format("the model has no mode '{}'", mode));
    segment.mode = *known;
    for (std::size_t t = 0; t < model.transitions.size(); ++t)
        if (model.transitions[t].mode == segment.mode && model.transitions[t].label == end) {
            segment.index = t;
            return segment;
        }
    segment.end = SegmentEnd::section;
    const auto section = model.find_section(end);
    if (!section)
        throw_contradiction(path, fmt::format("nothing called '{}' ends mode '{}'", end, mode));
    segment.index = *section;
    return segment;
}

/// A row without segments and multipliers.
OrbitRecord read_row(const Statement& row, const Model& model, const RunRecord& run) {
    OrbitRecord record;
    SpecialPoint& point = record.point;
    OrbitSolution& solution = point.solution;
    Orbit& orbit = solution.orbit;
    const auto index = [&](int column) { return static_cast<std::size_t>(row.integer(column)); };
    record.number = index(0);
    record.part = row.text(1);
    point.step = index(2);
    point.type = point_type(row.text(3)).value_or(PointType::regular);
    record.label = row.text(4);
    orbit.parameters = model.parameter_values();
    int at = 5;
    for (const std::size_t place : parameter_places(model, run))
        orbit.parameters[place] = row.number(at++);
    point.parameter = run.coordinates.empty() ? 0 : row.number(5);
    ++at; // the period follows from the segments,
    for (std::size_t m = 0; m < run.values.size(); ++m, ++at)
        point.monitors.push_back(number_or_nothing(row, at));
    ++at; // the signature, too
    if (const std::string name = row.text(at++); !name.empty())
        for (std::size_t i = 0; i < model.symmetries.size(); ++i)
            if (model.symmetries[i].name == name)
                orbit.symmetry = i;
    record.stable = row.integer(at++) != 0;
    ++at; // so does the number of unstable directions from the multipliers
    solution.certificate.admissible = row.integer(at++) != 0;
    solution.certificate.reason = row.text(at++);
    solution.outcome = outcome_named(row.text(at++));
    point.detail = row.text(at++);
    solution.residual = number_or_nothing(row, at++);
    if (!row.is_null(at))
        solution.error = row.number(at);
    ++at;
    solution.iterations = index(at++);
    point.arclength = row.number(at++);
    point.located = row.integer(at++) != 0;
    point.bracket = {number_or_nothing(row, at), number_or_nothing(row, at + 1)};
    at += 2;
    if (const auto event = model.find_event(row.text(at)); event && !row.is_null(at)) {
        point.event = *event;
        point.segment = index(at + 1) - 1;
        point.time = row.number(at + 2);
        point.at_end = row.integer(at + 3) != 0;
    }
    return record;
}

} // namespace

void ResultFile::add_orbit(const std::string& name, const OrbitRecord& record) {
    auto& writer = state_->writer_of(*this, name);
    const RunRecord& run = writer.run;
    std::optional<Model>& model = writer.model;
    if (!run.is_branch())
        throw InputError(fmt::format("run '{}' is of kind {}", name, run.kind), "orbits belong to orbit and continue");
    if (!model)
        model = stored_model(run);
    validate_orbit(*model, record.point.solution.orbit);
    require_room(run.values.size(), record.point.monitors.size(), "monitors of a point");
    state_->begin();
    try {
        write_row(writer.point, *model, run, record);
        write_segments(writer.sample, *model, record);
        write_certificate(writer.minimum, writer.end_value, *model, name, record);
        const OrbitSolution& solution = record.point.solution;
        write_multipliers(writer.multiplier, name, record.number, solution.multipliers);
        write_multipliers(writer.half_multiplier, name, record.number, solution.half_multipliers);
        state_->commit_when_due();
    } catch (...) {
        state_->sqlite_rollback();
        state_->writer.reset();
        throw;
    }
}

std::vector<OrbitRecord> ResultFile::read_orbits(const std::string& name, const std::string& where, double number,
                                                 const std::string& label) const {
    std::vector<OrbitRecord> records;
    const auto run = find_run(name);
    if (!run || !run->is_branch())
        return records;
    const RunTables tables(*run);
    const Model model = stored_model(*run);
    Statement row = state_->database.prepare(
        fmt::format("{} WHERE (?1 >= -1 OR ?2 = '') AND {} ORDER BY number", tables.select_point(), where));
    row.bind(1, number).bind(2, std::string_view(label));
    Statement segments =
        state_->database.prepare(fmt::format("SELECT * FROM {} WHERE point = ? ORDER BY segment", tables.samples));
    const auto details = [&](const char* columns, const char* table) {
        Statement rows = state_->database.prepare(
            fmt::format("SELECT {} FROM {} WHERE run = ?1 AND point = ?2 ORDER BY position", columns, table));
        rows.bind(1, std::string_view(name));
        return rows;
    };
    Statement multipliers = details("real, imaginary", "multipliers"),
              half_multipliers = details("real, imaginary", "half_multipliers"),
              minima = details("segment, event, time, value, size", "minima"),
              end_values = details("segment, event, value, rate", "end_values");
    require_columns(row, tables.point_columns(), state_->database.path());
    require_columns(segments, tables.sample_columns(), state_->database.path());
    while (row.step()) {
        OrbitRecord record = read_row(row, model, *run);
        OrbitSolution& solution = record.point.solution;
        Certificate& certificate = solution.certificate;
        segments.bind(1, record.number);
        while (segments.step()) {
            solution.orbit.signature.push_back(
                segment_named(model, segments.text(2), segments.text(3), state_->database.path()));
            solution.orbit.durations.push_back(number_or_nothing(segments, 4));
            certificate.approach_speeds.push_back(number_or_nothing(segments, 5));
            certificate.departures.push_back(number_or_nothing(segments, 6));
            certificate.guard_margins.push_back(segments.is_null(7) ? std::numeric_limits<double>::infinity()
                                                                    : segments.number(7));
            std::vector<double>& start = solution.orbit.starts.emplace_back();
            for (std::size_t i = 0; i < run->states.size(); ++i)
                start.push_back(number_or_nothing(segments, 8 + static_cast<int>(i)));
        }
        segments.reset();
        record.point.tangent = direction_of(listed_numbers(row.text(static_cast<int>(tables.point_columns()) - 1)),
                                            solution.orbit.segments(), run->states.size());
        if (record.point.segment > 0 && record.point.segment >= solution.orbit.segments())
            throw_contradiction(state_->database.path(), fmt::format("orbit {} of run '{}'", record.number, name));
        if (solution.orbit.segments() == 0)
            solution.outcome = OrbitOutcome::not_converged, solution.orbit.symmetry.reset();
        for (Statement* rows : {&multipliers, &half_multipliers, &minima, &end_values})
            rows->bind(2, record.number);
        solution.multipliers = read_multipliers(multipliers);
        solution.half_multipliers = read_multipliers(half_multipliers);
        read_certificate(minima, end_values, model, certificate);
        records.push_back(std::move(record));
    }
    return records;
}

std::vector<OrbitRecord> ResultFile::orbits(const std::string& run, bool special) const {
    return read_orbits(run, special ? "type <> 'RG'" : "1", -1, "");
}

std::optional<OrbitRecord> ResultFile::orbit(const std::string& run, std::size_t number) const {
    auto found = read_orbits(run, "number = ?1", static_cast<double>(number), "");
    return found.empty() ? std::nullopt : std::optional(std::move(found.front()));
}

std::optional<OrbitRecord> ResultFile::orbit(const std::string& run, const std::string& label) const {
    auto found = read_orbits(run, "label = ?2", -1, label);
    return found.empty() ? std::nullopt : std::optional(std::move(found.front()));
}

} // namespace graze
