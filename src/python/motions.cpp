#include "graze/base/input_error.hpp"
#include "graze/picture/motion_recorder.hpp"
#include "graze/picture/trajectory_figure.hpp"
#include "graze/results/name_advice.hpp"
#include "graze/results/table_recorder.hpp"
#include "graze/study/plain_states.hpp"
#include "graze/study/run_length.hpp"
#include "graze/trajectory/recorder.hpp"
#include "python/figures.hpp"
#include "python/tables.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>

namespace graze::python {

namespace {

/// Looks for signals, such as Ctrl-C, while a trajectory is computed by the thread that has called from Python.
class SignalWatch {
public:
    /// @param told called with the completed fraction (negative: unknown) and the time; may be None
    explicit SignalWatch(py::object told) : told_(std::move(told)) {}

    /// Without the interpreter's lock. @return true when the computation has to end
    bool asks_to_stop() {
        constexpr int calls_between_clock_reads = 64;
        if (raised_ || ++calls_ % calls_between_clock_reads != 0 || Clock::now() < next_)
            return raised_ != nullptr;
        next_ = Clock::now() + std::chrono::milliseconds(20);
        const py::gil_scoped_acquire locked;
        try {
            if (PyErr_CheckSignals() != 0)
                throw py::error_already_set();
            if (!told_.is_none())
                told_(fraction_, time_);
        } catch (...) {
            raised_ = std::current_exception();
        }
        return raised_ != nullptr;
    }
    void note(std::optional<double> fraction, double time) {
        fraction_ = fraction.value_or(-1);
        time_ = time;
    }
    void rethrow() const {
        if (raised_)
            std::rethrow_exception(raised_);
    }

private:
    using Clock = std::chrono::steady_clock;
    py::object told_;
    Clock::time_point next_ = Clock::now() + std::chrono::milliseconds(20);
    int calls_ = 0;
    double fraction_ = -1, time_ = 0;
    std::exception_ptr raised_;
};

/// Cyclic states within their periods; others as they are.
double reduced(double value, double period) {
    return period > 0 ? value - period * std::floor(value / period) : value;
}

/// Samples at times that the user gives.
class GivenTimes : public Observer {
public:
    /// @param times in rising order, counted from the beginning of what is shown
    GivenTimes(std::vector<double> times, std::vector<double> periods)
        : times_(std::move(times)), periods_(std::move(periods)) {
        const auto wrong = [](double time) { return !(time >= 0) || !std::isfinite(time); };
        if (std::ranges::any_of(times_, wrong) || !std::ranges::is_sorted(times_))
            throw InputError(Place{"at", 0, 0}, "the times do not rise from 0 or later",
                             "sort them; they count from the beginning of what is shown");
    }
    void begin(double time) { begin_ = time; }

    void step(const Step& step) override {
        const double start = step.start - begin_;
        for (; taken_ < times_.size() && times_[taken_] <= start + step.length; ++taken_)
            for (std::size_t i = 0; i < periods_.size(); ++i)
                states_.push_back(reduced(step.state(i, std::max(0.0, times_[taken_] - start)), periods_[i]));
    }
    std::size_t taken() const { return taken_; }
    double last() const { return times_.empty() ? 0 : times_.back(); }
    std::vector<double>& states() { return states_; }

private:
    std::vector<double> times_, periods_, states_;
    std::size_t taken_ = 0;
    double begin_ = 0;
};

/// What is asked of one motion.
struct MotionLength : RunLengthRequest {
    std::size_t samples = 500;
    std::optional<double> every;
    std::optional<std::vector<double>> at; ///< times, counted from the beginning of what is shown
    std::vector<std::string> derivatives;
    bool dense = false;
};

/// A motion while it is computed.
struct Motion {
    std::vector<std::pair<std::string, std::shared_ptr<TableRecorder>>> tables;
    std::shared_ptr<GivenTimes> given;
    std::shared_ptr<StepRecorder> steps;
    std::vector<double> periods, state;
    Outcome outcome;
    std::string mode;
    std::size_t steps_made = 0;

    bool is_full() const {
        return std::ranges::any_of(tables, [](const auto& table) { return table.second->is_full(); });
    }
    void begin_at(const Trajectory& trajectory, std::optional<double> duration) {
        for (const auto& table : tables)
            table.second->begin(trajectory, duration);
        if (given)
            given->begin(trajectory.time());
    }
};

NamedValue asked_value(const Model& model, const std::string& text, const char* argument) {
    return named_value(model, text, {argument, 0, 0});
}

std::vector<NamedValue> asked_values(const Model& model, const std::vector<std::string>& texts, const char* argument) {
    std::vector<NamedValue> values;
    for (const std::string& text : texts)
        values.push_back(asked_value(model, text, argument));
    return values;
}

/// The steps of a motion, from which its state at any time follows.
class DenseSteps {
public:
    DenseSteps(std::shared_ptr<StepRecorder> steps, std::vector<double> periods)
        : steps_(std::move(steps)), periods_(std::move(periods)) {}

    /// States at these times, row by row. At the time of a contact: those before it. Not a number outside of the
    /// motion.
    py::array_t<double> at(const std::vector<double>& times) const {
        const std::vector<RecordedStep>& steps = steps_->steps();
        std::vector<double> states;
        states.reserve(times.size() * periods_.size());
        for (const double time : times) {
            const auto after = std::ranges::lower_bound(
                steps, time, {}, [](const RecordedStep& step) { return step.start + step.length; });
            const bool outside = after == steps.end() || !(time >= after->start);
            for (std::size_t i = 0; i < periods_.size(); ++i)
                states.push_back(outside ? std::numeric_limits<double>::quiet_NaN()
                                         : reduced(after->state(i, time - after->start), periods_[i]));
        }
        return array_of(std::move(states),
                        {static_cast<py::ssize_t>(times.size()), static_cast<py::ssize_t>(periods_.size())});
    }

private:
    std::shared_ptr<StepRecorder> steps_;
    std::vector<double> periods_;
};

/// A model ready to be simulated, as often as wanted, with what is looked for on the way.
class HeldSimulation {
public:
    HeldSimulation(HeldModel& of, const std::vector<std::string>& sections, const std::vector<std::string>& extrema,
                   const std::vector<std::string>& quantities, const SimulationOptions& options)
        : model_(of.model), quantities_(asked_values(model_, quantities, "quantities")),
          extrema_(asked_values(model_, extrema, "extrema")), options_(options) {
        options_.validate();
        for (const std::string& name : sections)
            probes_.push_back(section_probe(model_, name));
        first_extremum_ = probes_.size();
        for (const NamedValue& one : extrema_)
            probes_.push_back({one.name, Probe::Kind::extremum, one.value, Direction::both, 0, {}});
        simulation_.emplace(*of.system(), probes_, std::vector<Expression>{}, options_);
    }

    /// @param state, mode where it begins; none: the model's
    /// @param told is called now and then with what is done
    Motion run(const MotionLength& asked, const std::optional<std::vector<double>>& state,
               const std::optional<std::string>& mode, const py::object& told) {
        SignalWatch watch(told);
        const Simulation simulation = simulation_of(asked);
        Motion motion;
        {
            const py::gil_scoped_release unlocked;
            compute(motion, simulation, {asked, state, mode}, watch);
        }
        watch.rethrow();
        return motion;
    }

    py::object figure(const MotionLength& asked, const std::optional<std::vector<double>>& state,
                      const std::optional<std::string>& mode, const std::vector<std::string>& histories,
                      const std::vector<std::pair<std::string, std::string>>& portraits) {
        SignalWatch watch{py::none()};
        const Simulation simulation = simulation_of(asked);
        Figure figure;
        {
            const py::gil_scoped_release unlocked;
            const auto curves = std::make_shared<MotionRecorder>(simulation, panels(histories, portraits));
            curves->finish(moved(simulation, {asked, state, mode}, watch, {curves}, nullptr));
            figure = trajectory_figure(*curves);
        }
        watch.rethrow();
        return object_of(figure);
    }

    const Model& model() const { return model_; }

private:
    struct Asked {
        const MotionLength& length;
        const std::optional<std::vector<double>>& state;
        const std::optional<std::string>& mode;
    };

    /// With the probe that counts periods, if they are counted: another simulation, made when it is needed first. To be
    /// called with the interpreter's lock.
    Simulation simulation_of(const MotionLength& asked) {
        const RunLength length = run_length(model_, asked);
        if (!length.period)
            return *simulation_;
        if (!counting_ || counted_ != asked.phase) {
            std::vector<Probe> probes = probes_;
            probes.push_back(*length.period); // the last: it ends the motion, and what others see then comes before
            counting_.emplace(simulation_->system(), std::move(probes), std::vector<Expression>{}, options_);
            counted_ = asked.phase;
        }
        return *counting_;
    }

    MotionPanelChoice panels(const std::vector<std::string>& histories,
                             const std::vector<std::pair<std::string, std::string>>& portraits) const {
        MotionPanelChoice choice;
        choice.chosen = !histories.empty();
        choice.sections = first_extremum_;
        const auto column = [&](const std::string& text, const char* argument) {
            NamedValue value = asked_value(model_, text, argument);
            const auto known = std::ranges::find(choice.columns, value.name, &NamedValue::name);
            if (known != choice.columns.end())
                return static_cast<std::size_t>(known - choice.columns.begin());
            choice.columns.push_back(std::move(value));
            return choice.columns.size() - 1;
        };
        const std::vector<std::string> plain = plain_states(model_);
        for (const std::string& text : histories.empty() ? plain : histories)
            choice.histories.push_back(column(text, "quantities"));
        auto pairs = portraits;
        if (const std::vector<std::string> usual = default_portrait(model_); pairs.empty() && usual.size() == 2)
            pairs.emplace_back(usual[0], usual[1]);
        for (const auto& [x, y] : pairs) {
            const std::size_t first = column(x, "portraits");
            choice.portraits.emplace_back(first, column(y, "portraits"));
        }
        if (choice.histories.empty() && choice.portraits.empty())
            throw InputError("there is nothing to draw: all states are cyclic or drifting", "name quantities");
        for (const Event& event : model_.events)
            choice.marked.push_back(event.kind == EventKind::barrier && is_met_by_motion(model_, event));
        return choice;
    }

    /// @param motion receives tables; null: nothing but the observers does
    Trajectory moved(const Simulation& simulation, const Asked& asked, SignalWatch& watch,
                     std::vector<std::shared_ptr<Observer>> observers, Motion* motion) const {
        const RunLength length = run_length(model_, asked.length);
        const auto period = length.period ? std::optional(simulation.probes().size() - 1) : std::nullopt;
        const auto control = std::make_shared<RunControl>(std::make_shared<Relay>(std::move(observers)), period,
                                                          std::vector<bool>(model_.events.size(), true));
        control->tell([&watch](std::optional<double> fraction, double time) { watch.note(fraction, time); });
        control->end_when([&watch, motion] { return watch.asks_to_stop() || (motion && motion->is_full()); });
        Trajectory trajectory(simulation, model_.parameter_values(), control);
        const LegEnd& first = length.transient.empty() ? length.shown : length.transient;
        trajectory.start(asked.state ? *asked.state : model_.initial_state(), mode_named(asked.mode), 0,
                         first.duration);
        if (!asked.length.derivatives.empty())
            trajectory.carry_derivatives(asked.length.derivatives);
        JetSet jets(simulation, LaneKind::single);
        if (!length.transient.empty()) {
            control->begin(length.transient, 0, false);
            graze::run(trajectory, jets);
            const Ending ending = trajectory.outcome().ending;
            if (watch.asks_to_stop() || (ending != Ending::end_time && ending != Ending::stopped))
                return trajectory;
            trajectory.extend(trajectory.time() + length.shown.duration);
        }
        control->begin(length.shown, trajectory.time(), true);
        if (motion)
            motion->begin_at(trajectory, length.shown.expected);
        graze::run(trajectory, jets);
        return trajectory;
    }

    std::size_t mode_named(const std::optional<std::string>& name) const {
        if (!name)
            return model_.initial_mode;
        if (const auto mode = model_.find_mode(*name))
            return *mode;
        throw InputError(Place{"mode", 0, 0}, "the model has no mode '" + *name + "'",
                         name_advice(*name, names_of(model_.modes), "it has none"));
    }

    void compute(Motion& motion, const Simulation& simulation, const Asked& asked, SignalWatch& watch) const {
        motion.periods = simulation.system().periods()(model_.parameter_values());
        TableRequest request;
        request.quantities = quantities_;
        request.extrema = extrema_;
        request.first_extremum = first_extremum_;
        request.events.assign(model_.events.size(), true);
        request.samples = std::max<std::size_t>(asked.length.samples, 2);
        request.every = asked.length.every;
        request.directions = asked.length.derivatives;
        const auto add = [&](const char* name, TableKind kind, bool wanted) {
            if (!wanted)
                return;
            request.kind = kind;
            motion.tables.emplace_back(name, make_table_recorder(simulation, request));
        };
        add("samples", TableKind::samples, asked.length.samples > 0 && !asked.length.at);
        add("contacts", TableKind::contacts, true);
        add("sections", TableKind::sections, first_extremum_ > 0);
        add("extrema", TableKind::extrema, !extrema_.empty());
        add("minima", TableKind::minima, options_.minima);
        add("derivatives", TableKind::derivatives, !asked.length.derivatives.empty());
        std::vector<std::shared_ptr<Observer>> observers;
        for (const auto& table : motion.tables)
            observers.push_back(table.second);
        if (asked.length.at)
            observers.push_back(motion.given = std::make_shared<GivenTimes>(*asked.length.at, motion.periods));
        if (asked.length.dense)
            observers.push_back(motion.steps = std::make_shared<StepRecorder>());
        const Trajectory trajectory = moved(simulation, asked, watch, observers, &motion);
        for (const auto& table : motion.tables)
            table.second->finish(trajectory);
        motion.outcome = trajectory.outcome();
        motion.state.assign(trajectory.state().begin(), trajectory.state().end());
        motion.mode = model_.modes[trajectory.mode()].name;
        motion.steps_made = trajectory.steps();
    }

    Model model_;
    std::vector<NamedValue> quantities_, extrema_;
    SimulationOptions options_;
    std::vector<Probe> probes_;
    std::size_t first_extremum_ = 0;
    std::optional<Simulation> simulation_, counting_;
    std::string counted_;
};

py::dict object_of(Motion motion) {
    py::dict tables, result;
    for (const auto& [name, table] : motion.tables)
        tables[name.c_str()] = columns_of(table->table());
    result["tables"] = tables;
    result["at"] = py::none();
    if (motion.given)
        result["at"] = array_of(std::move(motion.given->states()), {static_cast<py::ssize_t>(motion.given->taken()),
                                                                    static_cast<py::ssize_t>(motion.periods.size())});
    result["dense"] = py::none();
    if (motion.steps)
        result["dense"] = py::cast(DenseSteps(motion.steps, motion.periods));
    result["ending"] = motion.is_full() && motion.outcome.ending == Ending::stopped
                           ? std::string("table-full")
                           : std::string(name_of(motion.outcome.ending));
    result["regular"] = is_regular(motion.outcome.ending);
    result["detail"] = motion.outcome.detail;
    result["time"] = motion.outcome.time;
    result["state"] = array_of(std::move(motion.state));
    result["mode"] = motion.mode;
    result["steps"] = motion.steps_made;
    return result;
}

/// Keyword arguments by which a motion's length is given, the same for several functions.
MotionLength length_from(const py::dict& words) {
    MotionLength length;
    const auto read = [&](const char* name, auto& value) {
        if (words.contains(name))
            value = words[name].cast<std::remove_reference_t<decltype(value)>>();
    };
    read("time", length.time);
    read("after", length.after);
    read("periods", length.periods);
    read("skip", length.skip);
    read("contacts", length.contacts);
    read("phase", length.phase);
    read("samples", length.samples);
    read("every", length.every);
    read("at", length.at);
    read("derivatives", length.derivatives);
    read("dense", length.dense);
    if (length.at && !length.at->empty() && !length.time && !length.periods && !length.contacts)
        length.time = length.at->back();
    return length;
}

} // namespace

void bind_motions(py::module_& module) {
    py::class_<DenseSteps>(module, "DenseSteps").def("at", &DenseSteps::at);
    py::class_<HeldSimulation>(module, "Simulation")
        .def(py::init([](HeldModel& model, const std::vector<std::string>& sections,
                         const std::vector<std::string>& extrema, const std::vector<std::string>& quantities,
                         double tolerance, int order, double largest_step, std::size_t step_limit, int contacts_at_once,
                         double touch, bool minima) {
                 return std::make_unique<HeldSimulation>(
                     model, sections, extrema, quantities,
                     SimulationOptions{tolerance, order, largest_step, step_limit, contacts_at_once, touch, minima});
             }),
             py::arg("model"), py::kw_only(), py::arg("sections"), py::arg("extrema"), py::arg("quantities"),
             py::arg("tolerance"), py::arg("order"), py::arg("largest_step"), py::arg("step_limit"),
             py::arg("contacts_at_once"), py::arg("touch"), py::arg("minima"))
        .def(
            "run",
            [](HeldSimulation& self, const py::dict& words, const std::optional<std::vector<double>>& state,
               const std::optional<std::string>& mode,
               const py::object& told) { return object_of(self.run(length_from(words), state, mode, told)); },
            py::arg("length"), py::arg("state"), py::arg("mode"), py::arg("told"))
        .def(
            "figure",
            [](HeldSimulation& self, const py::dict& words, const std::optional<std::vector<double>>& state,
               const std::optional<std::string>& mode, const std::vector<std::string>& histories,
               const std::vector<std::pair<std::string, std::string>>& portraits) {
                return self.figure(length_from(words), state, mode, histories, portraits);
            },
            py::arg("length"), py::arg("state"), py::arg("mode"), py::arg("histories"), py::arg("portraits"));
}

} // namespace graze::python
