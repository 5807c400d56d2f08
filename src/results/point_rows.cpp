#include "results/point_columns.hpp"

#include "graze/base/input_error.hpp"
#include "graze/base/require.hpp"
#include "graze/results/name_advice.hpp"
#include "results/detail_rows.hpp"
#include "results/result_file_state.hpp"
#include "results/run_query.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace graze {

namespace {

constexpr std::int64_t samples_of_a_point = RunTables::samples_of_a_point;

/// @throws InputError or InputError if the columns or names of the run do not fit the point
void require_fitting(const RunRecord& run, const PointRecord& point) {
    const PointResult& result = point.result;
    const SampleSet& samples = result.samples;
    if (point.coordinates.size() != run.coordinates.size() || result.state.size() != run.states.size() ||
        (samples.size() > 0 && samples.width != run.values.size()))
        throw InputError(fmt::format("a point does not fit run '{}'", run.name),
                         "give a value for each of its columns");
    if (samples.size() >= static_cast<std::size_t>(samples_of_a_point))
        throw InputError(fmt::format("point {} of run '{}' has {} samples, and a result file takes {} of each",
                                     point.number, run.name, samples.size(), samples_of_a_point - 1),
                         "sample less often, or end the motion sooner");
    require_size(samples.samplings.size(), samples.size(), "samplings of samples");
    require_size(samples.values.size(), samples.size() * samples.width, "values of samples");
    for (const std::size_t sampling : samples.samplings)
        require_index(sampling, run.samplings.size(), "sampling");
    require_index(result.mode, run.modes.size(), "mode");
    require_index(point.direction, run.directions.size(), "direction");
}

void write_samples(Statement& statement, const RunRecord& run, const PointRecord& point) {
    const SampleSet& samples = point.result.samples;
    const auto first = static_cast<std::int64_t>(point.number) * samples_of_a_point;
    SampleRow row;
    row.point = point.number;
    for (std::size_t s = 0; s < samples.size(); ++s) {
        statement.bind(1, first + static_cast<std::int64_t>(s));
        row.sampling = samples.samplings[s];
        row.time = samples.times[s];
        const double* values = samples.values.data() + s * samples.width;
        row.values.assign(values, values + samples.width);
        write_row(statement, sample_columns(), run, row, 2);
    }
}

PointRecord read_point(const Statement& row, const RunRecord& run) {
    PointRecord point;
    read_row(row, point_columns(), run, point, run);
    return point;
}

/// Reads points of a run with their samples, one after the other.
class PointReader {
public:
    /// @param which condition or order of the points, in SQL
    PointReader(const Database& database, const std::string& path, const RunRecord& run, const std::string& which)
        : path_(path), run_(&run), tables_(run), points_(database.prepare(tables_.select_point() + which)),
          samples_(database.prepare(tables_.select_sample() + " WHERE rowid >= ?1 AND rowid < ?2 ORDER BY rowid")),
          multipliers_(database, "multipliers", multiplier_columns(), run),
          eigenvalues_(database, "eigenvalues", multiplier_columns(), run) {
        require_columns(points_, tables_.point_columns.size(), path_);
        require_columns(samples_, tables_.sample_columns.size(), path_);
    }

    /// To bind values that the condition names.
    Statement& points() { return points_; }

    std::optional<PointRecord> next() {
        if (!points_.step())
            return std::nullopt;
        PointRecord point = read_point(points_, *run_);
        read_samples(point.number, point.result.samples);
        point.result.multipliers = multipliers_.of_point(*run_, point.number);
        // Other points have none, and a query for each of millions of points would take time.
        if (point.result.label == Label::equilibrium)
            point.result.eigenvalues = eigenvalues_.of_point(*run_, point.number);
        return point;
    }

private:
    void read_samples(std::size_t number, SampleSet& samples) {
        samples.width = run_->values.size();
        const auto first = static_cast<std::int64_t>(number) * samples_of_a_point;
        samples_.bind(1, first).bind(2, first + samples_of_a_point);
        SampleRow sample;
        while (samples_.step()) {
            read_row(samples_, sample_columns(), *run_, sample, *run_);
            if (sample.sampling >= run_->samplings.size())
                throw_contradiction(path_,
                                    fmt::format("run '{}' has a sample of a sampling it does not know", run_->name));
            samples.samplings.push_back(sample.sampling);
            samples.times.push_back(sample.time);
            samples.values.insert(samples.values.end(), sample.values.begin(), sample.values.end());
        }
        samples_.reset();
    }

    std::string path_;
    const RunRecord* run_;
    RunTables tables_;
    Statement points_, samples_;
    DetailReader<RunRecord, std::complex<double>> multipliers_, eigenvalues_;
};

} // namespace

void ResultFile::add_point(const std::string& name, const PointRecord& point) {
    auto& writer = state_->writer_of(*this, name);
    const RunRecord& run = writer.run;
    require_fitting(run, point);
    state_->begin();
    try {
        write_row(writer.point, point_columns(), run, point);
        write_samples(writer.sample, run, point);
        write_details(writer.multiplier, multiplier_columns(), run, run, point.number, point.result.multipliers);
        write_details(writer.eigenvalue, multiplier_columns(), run, run, point.number, point.result.eigenvalues);
        state_->commit_when_due();
    } catch (...) {
        state_->sqlite_rollback();
        state_->writers.erase(name);
        throw;
    }
}

void ResultFile::set_label(const std::string& name, const std::vector<std::size_t>& points, Label label,
                           const std::string& detail) {
    const auto run = find_run(name);
    if (!run || run->is_branch())
        throw InputError(fmt::format("there is no run '{}' whose points have labels", name), "name a sweep or a basin");
    flush();
    state_->at_once([&] {
        Statement update = state_->database.prepare(
            fmt::format("UPDATE {} SET label = ?, detail = ? WHERE number = ?", RunTables(*run).points));
        for (const std::size_t point : points)
            update.run(name_of(label), detail, point);
    });
}

std::size_t ResultFile::point_count(const std::string& name) const {
    const auto run = find_run(name);
    if (!run)
        return 0;
    Statement rows = state_->database.prepare("SELECT count(*) FROM " + RunTables(*run).points);
    rows.step();
    return static_cast<std::size_t>(rows.integer(0));
}

std::function<std::optional<PointRecord>()> ResultFile::last_points(const std::string& name,
                                                                    std::size_t chain_length) const {
    auto run = find_run(name);
    if (!run || run->is_branch() || chain_length == 0)
        return [] { return std::optional<PointRecord>(); };
    const RunTables tables(*run);
    Statement rows = state_->database.prepare(
        fmt::format("{0} WHERE number IN (SELECT max(number) FROM {1} GROUP BY number / {2}) ORDER BY number",
                    tables.select_point(), tables.points, chain_length));
    require_columns(rows, tables.point_columns.size(), path());
    struct Reading {
        std::shared_ptr<State> state; // outlives the statement
        RunRecord run;
        Statement rows;
    };
    return [reading = std::make_shared<Reading>(Reading{state_, std::move(*run), std::move(rows)})] {
        return reading->rows.step() ? std::optional(read_point(reading->rows, reading->run)) : std::nullopt;
    };
}

std::function<std::optional<std::size_t>()> ResultFile::point_numbers(const std::string& name) const {
    const auto run = find_run(name);
    if (!run || run->is_branch())
        return [] { return std::optional<std::size_t>(); };
    struct Reading {
        std::shared_ptr<State> state; // outlives the statement
        Statement rows;
    };
    const auto reading = std::make_shared<Reading>(
        Reading{state_, state_->database.prepare(fmt::format("SELECT number FROM {} WHERE mode IN ({}) ORDER BY number",
                                                             RunTables(*run).points, text_literals(run->modes)))});
    return [reading] {
        return reading->rows.step() ? std::optional(static_cast<std::size_t>(reading->rows.integer(0))) : std::nullopt;
    };
}

std::optional<PointRecord> ResultFile::point(const std::string& name, std::size_t number) const {
    const auto run = find_run(name);
    if (!run || run->is_branch())
        return std::nullopt;
    PointReader reader(state_->database, path(), *run, " WHERE number = ?1");
    reader.points().bind(1, number);
    return reader.next();
}

std::function<std::optional<PointRecord>()> ResultFile::points(const std::string& name) const {
    const auto run = find_run(name);
    if (!run || run->is_branch())
        return [] { return std::optional<PointRecord>(); };
    struct Reading {
        Reading(std::shared_ptr<State> of_file, RunRecord of_run, const std::string& path)
            : state(std::move(of_file)), run(std::move(of_run)),
              reader(state->database, path, run, " ORDER BY number") {}
        std::shared_ptr<State> state; // outlives the statements
        RunRecord run;
        PointReader reader;
    };
    const auto reading = std::make_shared<Reading>(state_, *run, path());
    return [reading] { return reading->reader.next(); };
}

void ResultFile::each_point(const std::string& name, const std::function<void(const PointRecord& point)>& use) const {
    const auto next = points(name);
    while (const auto point = next())
        use(*point);
}

std::optional<PointRecord> ResultFile::nearest_point(const std::string& name, const std::string& coordinate,
                                                     double value, std::optional<std::size_t> direction) const {
    const auto run = find_run(name);
    if (!run || run->is_branch())
        return std::nullopt;
    const std::vector<std::string> known = names_of(run->coordinates);
    if (std::find(known.begin(), known.end(), coordinate) == known.end())
        return std::nullopt;
    std::vector<std::string> directions;
    if (direction && *direction < run->directions.size())
        directions.push_back(run->directions[*direction]);
    const auto number = nearest_number(*this, *run, {{coordinate, value}}, directions);
    return number ? point(name, *number) : std::nullopt;
}

} // namespace graze
