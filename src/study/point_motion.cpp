#include "graze/study/point_motion.hpp"

#include "graze/model/named_value.hpp"
#include "graze/results/name_advice.hpp"
#include "graze/study/stored_study.hpp"
#include "graze/symbolic/transform.hpp"
#include "graze/trajectory/recorder.hpp"
#include "graze/trajectory/trajectory.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace graze {

PointRecord chosen_point(const StoredRun& run, const std::vector<std::pair<std::string, double>>& at,
                         const std::vector<std::string>& directions, const Place& place) {
    const std::string& name = run.record.name;
    if (run.record.is_branch())
        throw InputError(place, fmt::format("run '{}' has orbits of a branch, without samples", name),
                         "draw it as branch, portrait or history");
    const std::vector<std::string> known = run.coordinate_names();
    for (const auto& [coordinate, value] : at)
        if (std::find(known.begin(), known.end(), coordinate) == known.end())
            throw InputError(place, fmt::format("run '{}' does not vary '{}'", name, coordinate),
                             name_advice(coordinate, known, "it varies nothing"));
    const auto number = run.nearest(at, directions);
    if (!number)
        throw InputError(place, fmt::format("run '{}' has no such point", name),
                         "run the study first, or choose another direction");
    return *run.file->point(name, *number);
}

namespace {

constexpr std::size_t dense_samples = 3000;

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

/// What a study called a value of its own is found among those, all else in the model.
Expression value_of(const StoredRun& run, const Model& model, const std::string& name, const Place& place) {
    const bool of_model = model.find_state(name) || model.find_parameter(name) || model.find_quantity(name);
    if (run.has_value(name) && !of_model) {
        const StudyRun asked = stored_run(run.record);
        for (std::size_t i = 0; i < asked.value_names.size(); ++i)
            if (asked.value_names[i] == name)
                return named_value(model, to_string(asked.values[i]), place).value;
    }
    return named_value(model, name, place).value;
}

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
        if (stored_run(run.record).start)
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
        values.push_back(name == "t" ? none : value_of(run, model, name, place));
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
