#include "program/result_query.hpp"

#include "graze/model/named_value.hpp"
#include "graze/trajectory/recorder.hpp"
#include "graze/trajectory/trajectory.hpp"
#include "program/values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

namespace graze {

namespace {

constexpr std::size_t dense_samples = 3000;

const ResultColumn* find(const std::vector<ResultColumn>& columns, const std::string& name) {
    const auto found =
        std::find_if(columns.begin(), columns.end(), [&](const ResultColumn& column) { return column.name == name; });
    return found == columns.end() ? nullptr : &*found;
}

/// The quoted column that has the values of something named.
std::string column_of(const std::vector<ResultColumn>& columns, const std::vector<std::string>& in_tables,
                      const std::string& name) {
    const ResultColumn* found = find(columns, name);
    return quoted_column(found ? in_tables[static_cast<std::size_t>(found - columns.data())] : name);
}

} // namespace

std::string quoted_column(const std::string& name) {
    std::string text = "\"";
    for (const char c : name)
        text += c == '"' ? std::string("\"\"") : std::string(1, c);
    return text + '"';
}

std::string in_quotes(const std::string& text) {
    std::string result = "'";
    for (const char c : text)
        result += c == '\'' ? std::string("''") : std::string(1, c);
    return result + "'";
}

std::string result_path(const std::string& file_or_folder) {
    std::error_code error;
    return std::filesystem::is_directory(file_or_folder, error)
               ? (std::filesystem::path(file_or_folder) / "results.sqlite").string()
               : file_or_folder;
}

StoredRun::StoredRun(const ResultFile& file, const std::string& name, const Place& place) {
    const auto found = file.find_run(name);
    if (!found) {
        std::vector<std::string> known;
        for (const RunRecord& run : file.runs())
            known.push_back(run.name);
        throw InputError(place, fmt::format("there are no results of a run '{}'", name),
                         name_advice(name, known, "run the study first"));
    }
    record = *found;
    model = stored_model(record);
    points = quoted_column((record.is_branch() ? "branch_" : "points_") + name);
    samples = quoted_column((record.is_branch() ? "segments_" : "samples_") + name);
    // A name that a table had already was given another one there.
    auto rows = file.query(
        fmt::format("SELECT place, column_name FROM columns WHERE run = {} ORDER BY position", in_quotes(name)));
    while (rows.next()) {
        const std::string what = rows.text(0);
        auto& list = what == "coordinate" ? coordinate_columns : what == "state" ? state_columns : value_columns;
        list.push_back(rows.text(1));
    }
    if (record.is_branch()) {
        joined = fmt::format("{} AS p JOIN {} AS s ON s.point = p.number", points, samples);
        return;
    }
    // Samples lie in the order of their points' numbers, by which they are found without an index.
    joined = fmt::format("{} AS p CROSS JOIN {} AS s ON s.rowid >= p.number * 16777216 AND s.rowid < (p.number + 1) * "
                         "16777216",
                         points, samples);
}

std::string StoredRun::column(const std::string& name) const {
    if (find(record.coordinates, name))
        return "p." + column_of(record.coordinates, coordinate_columns, name);
    if (find(record.values, name))
        return value_column(name);
    if (record.is_branch() && name == "multiplier")
        return fmt::format(
            "(SELECT sqrt(m.real * m.real + m.imaginary * m.imaginary) FROM multipliers AS m WHERE m.run "
            "= {} AND m.point = p.number AND m.position = 0)",
            in_quotes(record.name));
    return name;
}

std::string StoredRun::value_column(const std::string& name) const {
    return (record.is_branch() ? "p." : "s.") + column_of(record.values, value_columns, name);
}

std::string StoredRun::unit(const std::string& name) const {
    for (const auto* columns : {&record.coordinates, &record.values})
        if (const ResultColumn* column = find(*columns, name))
            return column->unit;
    if (name == "time" || name == "ending_time" || name == "duration" || (record.is_branch() && name == "period"))
        return model.time_unit;
    return "";
}

bool StoredRun::has_value(const std::string& name) const {
    return find(record.values, name) != nullptr;
}

PointRecord chosen_point(const ResultFile& file, const StoredRun& run, const StudyPicture& picture) {
    if (run.record.is_branch())
        throw InputError(picture.place,
                         fmt::format("run '{}' has orbits of a branch, without samples", run.record.name),
                         "draw it as branch, portrait or history");
    std::string where, order;
    std::vector<double> values;
    for (const std::string& direction : picture.directions)
        where += fmt::format("{} direction = '{}'", where.empty() ? "WHERE" : " OR",
                             direction == "up" || direction == "down" ? direction : "");
    for (const auto& [name, value] : picture.at) {
        if (!find(run.record.coordinates, name)) {
            std::vector<std::string> known;
            for (const ResultColumn& column : run.record.coordinates)
                known.push_back(column.name);
            throw InputError(picture.place, fmt::format("run '{}' does not vary '{}'", run.record.name, name),
                             name_advice(name, known, "it varies nothing"));
        }
        values.push_back(value);
        order += fmt::format("abs({} - ?{}), ", quoted_column(name), values.size());
    }
    auto rows = file.query(fmt::format("SELECT number FROM {} {} ORDER BY {} number {} LIMIT 1", run.points, where,
                                       order, picture.at.empty() ? "DESC" : "ASC"),
                           values);
    if (!rows.next())
        throw InputError(picture.place, fmt::format("run '{}' has no such point", run.record.name),
                         "run the study first, or choose another direction");
    return *file.point(run.record.name, static_cast<std::size_t>(rows.integer(0)));
}

namespace {

/// States in the order in which they are drawn, the two sides of each jump included.
class DenseRecorder : public Observer {
public:
    DenseRecorder(Function values, std::span<const double> parameters, std::vector<double> periods, double end)
        : values_(std::move(values)),
          sampler_(0, end / static_cast<double>(dense_samples - 1), dense_samples, std::move(periods),
                   [this](double time, std::size_t, std::span<const double> state) { add(time, state); }),
          results_(values_.outputs() + 1), parameters_(parameters.begin(), parameters.end()),
          work_(values_.workspace()), row_(values_.outputs()) {}

    void step(const Step& step) override { sampler_.step(step); }
    void contact(const Contact& contact) override {
        if (contact.kind == ContactKind::touch)
            return;
        add(contact.time, contact.before);
        add(contact.time, contact.after);
    }
    /// Time first, then the values.
    std::vector<std::vector<double>> take() { return std::move(results_); }

private:
    void add(double time, std::span<const double> state) {
        inputs_.assign(state.begin(), state.end());
        inputs_.insert(inputs_.end(), parameters_.begin(), parameters_.end());
        values_.evaluate(inputs_, row_, work_);
        results_[0].push_back(time);
        for (std::size_t i = 0; i < row_.size(); ++i)
            results_[1 + i].push_back(row_[i]);
    }

    Function values_;
    Sampler sampler_;
    std::vector<std::vector<double>> results_;
    std::vector<double> parameters_, inputs_, work_, row_;
};

} // namespace

std::vector<std::vector<double>> dense_motion(const StoredRun& run, const PointRecord& point,
                                              const std::vector<std::string>& names, const Place& place) {
    Model model = run.model;
    std::vector<double> state = point.result.state;
    std::size_t mode = point.result.mode;
    const bool settled = run.record.kind != "simulate";
    for (std::size_t c = 0; c < run.record.coordinates.size(); ++c) {
        const std::string& name = run.record.coordinates[c].name;
        if (model.find_state(name))
            model.set_initial(name, point.coordinates[c]);
        else
            model.set_parameter(name, point.coordinates[c]);
    }
    double duration = settled ? point.result.duration : point.result.time;
    if (!settled) {
        if (run.record.settings.find("\"start\":") != std::string::npos)
            throw InputError(place,
                             fmt::format("run '{}' began where another run ended, which is not kept", run.record.name),
                             "draw a motion of a run that begins at the model's initial state");
        state = model.initial_state();
        mode = model.initial_mode;
    }
    if (state.size() != model.states.size() || mode >= model.modes.size())
        throw InputError(place, fmt::format("run '{}' has no state there to start from", run.record.name),
                         "choose another point");
    if (!(duration > 0)) // of a motion that is not periodic, as much as was sampled
        duration = point.result.samples.times.empty()
                       ? 0
                       : point.result.samples.times.back() - point.result.samples.times.front();
    std::vector<Expression> values;
    const Expression none = Graph::create()->number(0); // stands for time, which is no function of the state
    for (const std::string& name : names)
        values.push_back(name == "t" ? none : named_value(model, name, place).value);
    const Simulation simulation{System(model)};
    const std::vector<double> parameters = model.parameter_values();
    DenseRecorder recorder(simulation.system().function_of(values), parameters, model.periods(), duration);
    Trajectory trajectory(simulation, parameters, recorder);
    trajectory.start(state, mode, 0, duration);
    JetSet jets(simulation, LaneKind::single);
    graze::run(trajectory, jets);
    auto columns = recorder.take();
    std::vector<std::vector<double>> result;
    for (std::size_t i = 0; i < names.size(); ++i)
        result.push_back(names[i] == "t" ? columns[0] : columns[i + 1]);
    return result;
}

} // namespace graze
