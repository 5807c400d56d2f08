#include "base/special_numbers.hpp"
#include "graze/base/require.hpp"
#include "results/detail_rows.hpp"
#include "results/orbit_columns.hpp"
#include "results/point_columns.hpp"
#include "results/result_file_state.hpp"

#include <fmt/format.h>

namespace graze {

namespace {

void write_segments(Statement& statement, const OrbitContext& context, const OrbitRecord& record) {
    const Orbit& orbit = record.point.solution.orbit;
    const Certificate& certificate = record.point.solution.certificate;
    const auto value = [](const std::vector<double>& values, std::size_t s) {
        return s < values.size() ? values[s] : not_a_number;
    };
    for (std::size_t s = 0; s < orbit.segments(); ++s) {
        const Segment& segment = orbit.signature[s];
        const SegmentRow row{record.number,
                             s + 1,
                             context.model->modes[segment.mode].name,
                             end_name(*context.model, segment),
                             orbit.durations[s],
                             value(certificate.approach_speeds, s),
                             value(certificate.departures, s),
                             value(certificate.guard_margins, s),
                             orbit.starts[s]};
        write_row(statement, segment_columns(), context, row);
    }
}

/// The segment with this mode and end. @throws InputError if the model has no such mode or end
Segment segment_named(const Model& model, const std::string& mode, const std::string& end, const std::string& path) {
    Segment segment;
    const auto known = model.find_mode(mode);
    if (!known)
        throw_contradiction(path, fmt::format("the model has no mode '{}'", mode));
    segment.mode = *known;
    for (std::size_t t = 0; t < model.transitions.size(); ++t)
        for (const SegmentEnd kind : {SegmentEnd::event, SegmentEnd::chatter}) {
            const Segment one{segment.mode, kind, t};
            if (model.transitions[t].mode == one.mode && end_name(model, one) == end)
                return one;
        }
    if (end == cut_name()) {
        segment.end = SegmentEnd::cut;
        return segment;
    }
    if (end == rest_name()) {
        segment.end = SegmentEnd::rest;
        return segment;
    }
    if (end == saddle_name()) {
        segment.end = SegmentEnd::saddle;
        return segment;
    }
    segment.end = SegmentEnd::section;
    const auto section = model.find_section(end);
    if (!section)
        throw_contradiction(path, fmt::format("nothing called '{}' ends mode '{}'", end, mode));
    segment.index = *section;
    return segment;
}

/// Removes details of events that the model does not have, and of segments that the orbit does not have.
template <class Detail>
std::vector<Detail> of_known_events(std::vector<Detail> details, const Model& model, const Orbit& orbit) {
    std::erase_if(details, [&](const Detail& one) {
        return one.event >= model.events.size() || one.segment >= orbit.segments();
    });
    return details;
}

/// Reads orbits from the tables of orbits, segments and details.
class OrbitReader {
public:
    OrbitReader(const Database& database, const RunRecord& run, const Model& model)
        : path_(database.path()), run_(&run), context_(run, model), tables_(run),
          segments_(database.prepare(tables_.select_sample() + " WHERE point = ? ORDER BY segment")),
          multipliers_(database, "multipliers", multiplier_columns(), run),
          half_multipliers_(database, "half_multipliers", multiplier_columns(), run),
          eigenvalues_(database, "eigenvalues", multiplier_columns(), run),
          minima_(database, "minima", minimum_columns(), run),
          end_values_(database, "end_values", end_value_columns(), run),
          circles_(database, "circles", circle_columns(), run) {
        require_columns(segments_, tables_.sample_columns.size(), path_);
    }

    OrbitRecord read(const Statement& row) {
        OrbitRecord record;
        read_row(row, orbit_columns(), context_, record, *run_);
        read_segments(record);
        OrbitSolution& solution = record.point.solution;
        if (record.point.segment > 0 && record.point.segment >= solution.orbit.segments())
            throw_contradiction(path_, fmt::format("orbit {} of run '{}'", static_cast<std::int64_t>(record.number),
                                                   run_->name)); // a changed file may have negative numbers
        if (solution.orbit.segments() == 0)
            solution.outcome = OrbitOutcome::not_converged, solution.orbit.symmetry.reset(),
            solution.orbit.cycle.reset();
        const Model& model = *context_.model;
        solution.multipliers = multipliers_.of_point(*run_, record.number);
        solution.half_multipliers = half_multipliers_.of_point(*run_, record.number);
        solution.eigenvalues = eigenvalues_.of_point(*run_, record.number);
        solution.certificate.minima = of_known_events(minima_.of_point(context_, record.number), model, solution.orbit);
        solution.certificate.end_values =
            of_known_events(end_values_.of_point(context_, record.number), model, solution.orbit);
        if (record.torus) {
            record.torus->circle = circles_.of_point(context_, record.number);
            std::erase_if(record.torus->circle,
                          [&](const CircleTerm& term) { return term.state >= model.states.size(); });
        }
        return record;
    }

private:
    void read_segments(OrbitRecord& record) {
        Orbit& orbit = record.point.solution.orbit;
        Certificate& certificate = record.point.solution.certificate;
        segments_.bind(1, record.number);
        SegmentRow row;
        while (segments_.step()) {
            read_row(segments_, segment_columns(), context_, row, *run_);
            orbit.signature.push_back(segment_named(*context_.model, row.mode, row.ending, path_));
            orbit.durations.push_back(row.duration);
            orbit.starts.push_back(row.start);
            certificate.approach_speeds.push_back(row.approach_speed);
            certificate.departures.push_back(row.departure);
            certificate.guard_margins.push_back(row.guard_margin);
        }
        segments_.reset();
    }

    std::string path_;
    const RunRecord* run_;
    OrbitContext context_;
    RunTables tables_;
    Statement segments_;
    DetailReader<RunRecord, std::complex<double>> multipliers_, half_multipliers_, eigenvalues_;
    DetailReader<OrbitContext, OrbitMinimum> minima_;
    DetailReader<OrbitContext, EndValue> end_values_;
    DetailReader<OrbitContext, CircleTerm> circles_;
};

} // namespace

void ResultFile::add_orbit(const std::string& name, const OrbitRecord& record) {
    auto& writer = state_->writer_of(*this, name);
    const RunRecord& run = writer.run;
    std::optional<Model>& model = writer.model;
    if (!run.is_branch())
        throw InputError(fmt::format("run '{}' is of kind {}", name, run.kind), "orbits belong to orbit and continue");
    if (!model)
        model = stored_model(run);
    const OrbitSolution& solution = record.point.solution;
    validate_orbit(*model, solution.orbit);
    require_room(run.values.size(), record.point.monitors.size(), "monitors of a point");
    const OrbitContext context(run, *model);
    state_->begin();
    try {
        write_row(writer.point, orbit_columns(), context, record);
        write_segments(writer.sample, context, record);
        const auto write = [&, number = record.number](Statement& statement, const auto& columns, const auto& in,
                                                       const auto& details) {
            write_details(statement, columns, in, run, number, details);
        };
        write(writer.minimum, minimum_columns(), context, solution.certificate.minima);
        write(writer.end_value, end_value_columns(), context, solution.certificate.end_values);
        if (record.torus)
            write(writer.circle, circle_columns(), context, record.torus->circle);
        write(writer.multiplier, multiplier_columns(), run, solution.multipliers);
        write(writer.half_multiplier, multiplier_columns(), run, solution.half_multipliers);
        write(writer.eigenvalue, multiplier_columns(), run, solution.eigenvalues);
        state_->commit_when_due();
    } catch (...) {
        state_->sqlite_rollback();
        state_->writers.erase(name);
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
    require_columns(row, tables.point_columns.size(), state_->database.path());
    OrbitReader reader(state_->database, *run, model);
    while (row.step())
        records.push_back(reader.read(row));
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
