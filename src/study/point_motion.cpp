#include "graze/study/point_motion.hpp"

#include "graze/model/named_value.hpp"
#include "graze/results/name_advice.hpp"
#include "graze/results/query_interruption.hpp"
#include "graze/study/stored_study.hpp"
#include "graze/symbolic/transform.hpp"
#include "graze/trajectory/observer.hpp"
#include "graze/trajectory/trajectory.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

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
    return *run.file.point(name, *number);
}

namespace {

constexpr std::size_t most_rows = 1'000'000, most_values = 16'000'000;
/// A step of high order covers a good part of an oscillation; the curve is thinned out again before it is drawn.
constexpr int points_of_step = 32, fewest_points = 2;

/// Values in the order in which they are drawn, the two sides of each jump included.
class DenseRecorder : public Observer {
public:
    DenseRecorder(Function values, std::span<const double> parameters, std::vector<double> periods,
                  std::vector<bool> marked, WhenLong when_long, std::size_t mode, std::function<bool()> interrupted)
        : values_(std::move(values)), periods_(std::move(periods)), marked_(std::move(marked)), when_long_(when_long),
          interrupted_(std::move(interrupted)), columns_(values_.outputs() + 1),
          parameters_(parameters.begin(), parameters.end()), work_(values_.workspace()), row_(values_.outputs()) {
        motion_.modes.push_back(mode);
    }

    void step(const Step& step) override {
        state_.resize(periods_.size());
        for (int k = new_arc_ ? 0 : 1; k <= points_; ++k) {
            const double s = k == points_ ? step.length : step.length * k / points_;
            for (std::size_t i = 0; i < state_.size(); ++i)
                state_[i] = step.state(i, s);
            add(step.start + s);
        }
        new_arc_ = false;
        if (rows() > std::min(most_rows, most_values / columns_.size()))
            make_room();
    }
    void contact(const Contact& contact) override {
        if (contact.kind == ContactKind::touch)
            return;
        for (const bool after : {false, true}) {
            const std::span<const double> side = after ? contact.after : contact.before;
            if (after) {
                motion_.begins.push_back(rows());
                motion_.modes.push_back(contact.mode_after);
            }
            if (marked_[contact.event]) {
                motion_.impacts.push_back(rows());
                motion_.met.push_back(contact.event);
            }
            state_.assign(side.begin(), side.end());
            add(contact.time);
        }
        new_arc_ = false;
    }
    bool stop() override { return QueryInterruption::requested() || (interrupted_ && interrupted_()); }
    /// Time first, then the values.
    DenseMotion take() {
        motion_.start = columns_[0].empty() ? 0 : columns_[0].front();
        motion_.values = std::move(columns_);
        return std::move(motion_);
    }

private:
    std::size_t rows() const { return columns_[0].size(); }

    void add(double time) {
        for (std::size_t i = 0; i < state_.size(); ++i)
            if (periods_[i] > 0)
                state_[i] -= std::floor(state_[i] / periods_[i]) * periods_[i];
        inputs_.assign(state_.begin(), state_.end());
        inputs_.insert(inputs_.end(), parameters_.begin(), parameters_.end());
        values_.evaluate(inputs_, row_, work_);
        columns_[0].push_back(time);
        for (std::size_t i = 0; i < row_.size(); ++i)
            columns_[1 + i].push_back(row_[i]);
    }

    /// Fewer rows of all, or only the later half. Beginnings of arcs and impacts stay what they are.
    void make_room() {
        std::vector<bool> needed(rows(), false);
        const bool thin = when_long_ == WhenLong::coarser && points_ > fewest_points;
        if (thin)
            points_ /= 2;
        for (std::size_t i = 0; i < rows(); ++i)
            needed[i] = thin ? i % 2 == 0 || i + 1 == rows() : 2 * i >= rows();
        // What is beside the places that are gone goes with them: they are the first ones.
        const auto keep = [&](std::vector<std::size_t>& places, std::vector<std::size_t>& beside) {
            for (const std::size_t place : places)
                needed[place] = needed[place] || thin;
            const std::size_t gone = std::erase_if(places, [&](std::size_t place) { return !needed[place]; });
            beside.erase(beside.begin(), beside.begin() + static_cast<std::ptrdiff_t>(gone));
        };
        keep(motion_.begins, motion_.modes);
        keep(motion_.impacts, motion_.met);
        std::vector<std::size_t> places(rows() + 1, 0);
        for (std::size_t i = 0; i < rows(); ++i)
            places[i + 1] = places[i] + (needed[i] ? 1 : 0);
        for (auto* list : {&motion_.begins, &motion_.impacts})
            for (std::size_t& place : *list)
                place = places[place];
        for (std::vector<double>& column : columns_) {
            std::size_t next = 0;
            for (std::size_t i = 0; i < column.size(); ++i)
                if (needed[i])
                    column[next++] = column[i];
            column.resize(next);
        }
    }

    Function values_;
    std::vector<double> periods_, state_;
    std::vector<bool> marked_;
    WhenLong when_long_;
    std::function<bool()> interrupted_;
    std::vector<std::vector<double>> columns_;
    std::vector<double> parameters_, inputs_, work_, row_;
    DenseMotion motion_;
    int points_ = points_of_step;
    bool new_arc_ = true;
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

/// True when an event depends on states other than phases: the motion meets it, rather than the clock.
bool is_met_by_motion(const Model& model, const Event& event) {
    const std::vector<Expression> symbols = symbols_of({{Model(model).expand(event.function)}});
    return std::any_of(symbols.begin(), symbols.end(), [&](const Expression& symbol) {
        const auto state = model.find_state(symbol.name());
        return state && !model.states[*state].period;
    });
}

} // namespace

std::vector<bool> usual_marks(const Model& model) {
    std::vector<bool> marked;
    for (const Event& event : model.events)
        marked.push_back(event.kind == EventKind::barrier && is_met_by_motion(model, event));
    return marked;
}

DenseMotion dense_motion(const StoredRun& run, const PointRecord& point, const std::vector<std::string>& names,
                         const Place& place, WhenLong when_long, const std::function<bool()>& interrupted) {
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
    DenseRecorder recorder(simulation.system().function_of(values), parameters, model.periods(), usual_marks(model),
                           when_long, mode, interrupted);
    Trajectory trajectory(simulation, parameters, borrowed(recorder));
    trajectory.start(state, mode, 0, duration);
    JetSet jets(simulation, LaneKind::single);
    graze::run(trajectory, jets);
    DenseMotion motion = recorder.take();
    motion.outcome = trajectory.outcome();
    // It is computed up to the time at which the stored one ended, of its own or after what it had to count.
    const Outcome& stored = point.result.outcome;
    if (!settled && motion.outcome.ending == Ending::end_time && stored.ending != Ending::stopped) {
        motion.outcome.ending = stored.ending;
        motion.outcome.detail = stored.detail;
    }
    std::vector<std::vector<double>> columns;
    for (std::size_t i = 0; i < names.size(); ++i) {
        columns.push_back(motion.values[names[i] == "t" ? 0 : i + 1]);
        const auto state_of_name = model.find_state(names[i]);
        motion.periods.push_back(state_of_name ? model.periods()[*state_of_name] : 0);
    }
    motion.values = std::move(columns);
    return motion;
}

} // namespace graze
