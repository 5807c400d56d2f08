#include "flow/cyclic.hpp"
#include "graze/base/input_error.hpp"
#include "graze/picture/motion_recorder.hpp"
#include "graze/picture/trajectory_figure.hpp"
#include "graze/results/name_advice.hpp"
#include "graze/results/table_recorder.hpp"
#include "graze/study/plain_states.hpp"
#include "graze/study/run_length.hpp"
#include "graze/trajectory/recorder.hpp"
#include "python/attended.hpp"
#include "python/figures.hpp"
#include "python/tables.hpp"
#include "python/words.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <limits>
#include <mutex>
#include <optional>

namespace graze::python {

namespace {

/// Looks for signals, such as Ctrl-C, while a trajectory is computed by the thread that has called from Python.
class Watch {
public:
    /// @param told called with the completed fraction (negative: unknown) and the time; may be None
    explicit Watch(const py::object& told) : told_(told) {}

    /// Without the interpreter's lock. @return true when the computation has to end
    bool asks_to_stop() {
        constexpr int calls_between_clock_reads = 64;
        if (raised_ || ++calls_ % calls_between_clock_reads != 0 || Clock::now() < next_)
            return raised_ != nullptr;
        if (process_is_ending())
            return true;
        unlocked_->locked([this] {
            try {
                handle_signals();
                if (!told_.is_none())
                    told_(fraction_, time_);
            } catch (...) {
                raised_ = std::current_exception();
            }
        });
        next_ = Clock::now() + between_looks;
        return raised_ != nullptr;
    }
    void note(std::optional<double> fraction, double time) {
        fraction_ = fraction.value_or(-1);
        time_ = time;
    }
    bool has_raised() const { return raised_ != nullptr; }
    void rethrow() const {
        if (raised_)
            std::rethrow_exception(raised_);
    }
    /// What a handler of signals or `told` has raised; None: nothing. With the interpreter's lock.
    py::object raised() const {
        try {
            rethrow();
        } catch (const py::error_already_set& error) {
            if (error.trace())
                PyException_SetTraceback(error.value().ptr(), error.trace().ptr());
            return error.value();
        }
        return py::none();
    }
    /// Does work without the interpreter's lock.
    template <class Doing>
    void during(Doing&& work) {
        Unlocked unlocked;
        unlocked_ = &unlocked;
        const RunningWork running;
        work();
    }

private:
    using Clock = std::chrono::steady_clock;
    // To get the interpreter's lock takes 5 ms where another thread of Python computes.
    static constexpr std::chrono::milliseconds between_looks{40};
    const py::object& told_;
    Unlocked* unlocked_ = nullptr;
    Clock::time_point next_ = Clock::now() + between_looks;
    int calls_ = 0;
    double fraction_ = -1, time_ = 0;
    std::exception_ptr raised_;
};

using NamedNumbers = std::vector<std::pair<std::string, double>>;

/// What is asked of one motion.
struct MotionRequest {
    RunLengthRequest length;
    std::size_t samples = 500;
    std::optional<double> every;
    std::optional<std::vector<double>> at; ///< times, counted from the beginning of what is shown
    std::vector<std::string> derivatives;
    std::optional<std::vector<std::string>> events; ///< whose contacts are shown and counted; none: all
    bool dense = false;
    std::optional<std::vector<double>> state; ///< where it begins; none: the model's, as its mode
    std::optional<std::string> mode;
    NamedNumbers set; ///< other values of parameters
};

bool is_same(const RunLengthRequest& one, const RunLengthRequest& other) {
    return one.time == other.time && one.periods == other.periods && one.contacts == other.contacts &&
           one.after == other.after && one.skip == other.skip && one.phase == other.phase;
}

/// The table of samples at times that the user gives.
class GivenTimes : public TableRecorder {
public:
    /// @param times in rising order, counted from the beginning of what is shown
    GivenTimes(const Simulation& simulation, const std::vector<NamedValue>& quantities, std::vector<double> times)
        : model_(&simulation.model()), columns_(*model_, quantities), times_(std::move(times)),
          state_(model_->states.size()) {
        const auto wrong = [](double time) { return !(time >= 0) || !std::isfinite(time); };
        if (std::ranges::any_of(times_, wrong) || !std::ranges::is_sorted(times_))
            throw InputError(Place{"at", 0, 0}, "the times do not rise from 0 or later",
                             "sort them; they count from the beginning of what is shown");
        table_ = Table(columns_.after({{"time", model_->time_unit}, {"mode", ""}}));
    }
    void begin(const Trajectory& trajectory, std::optional<double> /*duration*/) override {
        begin_ = trajectory.time();
        columns_.set_parameters(trajectory.parameters());
        periods_ = trajectory.simulation().system().periods()(trajectory.parameters());
    }
    void step(const Step& step) override {
        const double start = step.start - begin_;
        for (; taken_ < times_.size() && times_[taken_] <= start + step.length; ++taken_) {
            for (std::size_t i = 0; i < state_.size(); ++i)
                state_[i] = step.state(i, std::max(0.0, times_[taken_] - start));
            add(step.mode);
        }
    }
    /// The end of the motion is known to a round-off error only.
    void finish(const Trajectory& trajectory) override {
        const double end = trajectory.time() - begin_;
        for (; !periods_.empty() && taken_ < times_.size() && times_[taken_] <= end + 1e-14 * trajectory.time();
             ++taken_) {
            std::ranges::copy(trajectory.state(), state_.begin());
            add(trajectory.mode());
        }
    }

private:
    void add(std::size_t mode) {
        for (std::size_t i = 0; i < state_.size(); ++i)
            state_[i] = within_period(state_[i], periods_[i]);
        table_.add(begin_ + times_[taken_], model_->modes[mode].name);
        columns_.add(table_, state_);
    }
    const Model* model_;
    StateColumns columns_;
    std::vector<double> times_, periods_, state_;
    std::size_t taken_ = 0;
    double begin_ = 0;
};

/// Keeps the steps of a motion until they take too much memory.
class KeptSteps : public StepRecorder {
public:
    void step(const Step& step) override {
        StepRecorder::step(step);
        numbers_ += steps().back().coefficients.size();
    }
    bool is_full() const { return numbers_ >= most_numbers; }

private:
    static constexpr std::size_t most_numbers = 250'000'000; ///< 2 GB
    std::size_t numbers_ = 0;
};

/// The steps of a motion, from which its state at any time follows.
class DenseSteps {
public:
    DenseSteps(std::shared_ptr<KeptSteps> steps, std::vector<double> periods)
        : steps_(std::move(steps)), periods_(std::move(periods)) {}

    /// States at these times, row by row. At the time of a contact: those before it. Not a number outside of the
    /// motion.
    py::array_t<double> at(const py::array_t<double, py::array::c_style | py::array::forcecast>& times) const {
        const std::vector<RecordedStep>& steps = steps_->steps();
        std::vector<double> states;
        states.reserve(static_cast<std::size_t>(times.size()) * periods_.size());
        for (const double time : std::span(times.data(), static_cast<std::size_t>(times.size()))) {
            const auto after = std::ranges::lower_bound(
                steps, time, {}, [](const RecordedStep& step) { return step.start + step.length; });
            const bool outside = after == steps.end() || !(time >= after->start);
            for (std::size_t i = 0; i < periods_.size(); ++i)
                states.push_back(outside ? std::numeric_limits<double>::quiet_NaN()
                                         : within_period(after->state(i, time - after->start), periods_[i]));
        }
        return array_of(std::move(states),
                        {static_cast<py::ssize_t>(times.size()), static_cast<py::ssize_t>(periods_.size())});
    }

private:
    std::shared_ptr<KeptSteps> steps_;
    std::vector<double> periods_;
};

/// A computed motion, with its tables. They become arrays when they are asked for.
class Motion {
public:
    bool is_full() const {
        return std::ranges::any_of(tables,
                                   [](const auto& table) { return table->is_full() || !table->is_complete(); }) ||
               (steps && steps->is_full());
    }
    /// None if it was not asked for.
    py::object table(const std::string& name) const {
        const auto kind = table_kind(name);
        for (std::size_t i = 0; i < tables.size(); ++i)
            if (kinds[i] == kind)
                return columns_of(tables[i]->table());
        return py::none();
    }
    std::string ending() const {
        return is_interrupted                                   ? "interrupted"
               : is_full() && outcome.ending == Ending::stopped ? "table-full"
                                                                : std::string(name_of(outcome.ending));
    }
    bool is_regular() const {
        return !is_interrupted && graze::is_regular(outcome.ending) &&
               !(is_full() && outcome.ending == Ending::stopped);
    }
    py::object dense() const { return steps ? py::cast(DenseSteps(steps, periods)) : py::none(); }

    std::vector<TableKind> kinds;
    std::vector<std::shared_ptr<TableRecorder>> tables;
    std::shared_ptr<KeptSteps> steps;
    std::vector<double> periods, state;
    Outcome outcome;
    std::string mode;
    std::size_t steps_made = 0;
    bool is_interrupted = false;
    py::object raised = py::none(); ///< by a handler of signals, or a function of progress
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

/// A simulation with the jets that its motions have used, for the next ones.
class JetPool {
public:
    explicit JetPool(Simulation of) : simulation(std::move(of)) {}
    std::unique_ptr<JetSet> take(bool with_derivatives) {
        if (const std::lock_guard lock(mutex_); !with_derivatives && !jets_.empty()) {
            auto last = std::move(jets_.back());
            jets_.pop_back();
            return last;
        }
        return std::make_unique<JetSet>(simulation, LaneKind::single);
    }
    void give_back(std::unique_ptr<JetSet> jets) {
        if (const std::lock_guard lock(mutex_); !jets->has_tangents())
            jets_.push_back(std::move(jets));
    }
    const Simulation simulation; // NOLINT(cppcoreguidelines-avoid-const-or-ref-data-members)

private:
    std::mutex mutex_;
    std::vector<std::unique_ptr<JetSet>> jets_;
};

/// A model ready to be simulated, as often as wanted, with what is looked for on the way.
class HeldSimulation {
public:
    HeldSimulation(HeldModel& of, const std::vector<std::string>& sections, const std::vector<std::string>& extrema,
                   const std::vector<std::string>& quantities, const SimulationOptions& options)
        : model_(of.model), parameters_(model_.parameter_values()),
          quantities_(asked_values(model_, quantities, "quantities")),
          extrema_(asked_values(model_, extrema, "extrema")), options_(options) {
        options_.validate();
        for (const std::string& name : sections)
            probes_.push_back(section_probe(model_, name));
        first_extremum_ = probes_.size();
        for (const NamedValue& one : extrema_)
            probes_.push_back({one.name, Probe::Kind::extremum, one.value, Direction::both, 0, {}});
        pool_ = std::make_shared<JetPool>(Simulation(*of.system(), probes_, std::vector<Expression>{}, options_));
    }

    /// @param told is called now and then with what is done
    Motion run(const MotionRequest& asked, const py::object& told) {
        Watch watch(told);
        Plan plan = plan_of(asked);
        Motion motion;
        watch.during([&] { compute(motion, asked, plan, watch); });
        motion.raised = watch.raised();
        return motion;
    }

    py::object figure(const MotionRequest& asked, const std::vector<std::string>& histories,
                      const std::vector<std::pair<std::string, std::string>>& portraits) {
        const py::none nothing;
        Watch watch(nothing);
        const Plan plan = plan_of(asked);
        Figure figure;
        watch.during([&] {
            const auto curves =
                std::make_shared<MotionRecorder>(plan.pool->simulation, panels(asked, plan, histories, portraits));
            curves->set_parameters(plan.parameters);
            curves->finish(moved(asked, plan, watch, {curves}, nullptr));
            figure = trajectory_figure(*curves);
        });
        watch.rethrow();
        return object_of(std::move(figure));
    }

    /// The value of an expression in parameters, given some others.
    double value_of(const std::string& text, const NamedNumbers& set, const char* argument) const {
        Model model = model_;
        for (const auto& [name, value] : set)
            model.set_parameter(name, value);
        return model.values_of(std::vector{asked_value(model, text, argument).value}).front();
    }

private:
    /// How a motion is to be computed.
    struct Plan {
        std::shared_ptr<JetPool> pool;
        RunLength length;
        std::vector<double> parameters, state;
        std::size_t mode = 0;
        std::vector<bool> events;
    };

    /// With the interpreter's lock.
    Plan plan_of(const MotionRequest& asked) {
        Plan plan{pool_, {}, parameters_, {}, mode_named(asked.mode), chosen_events(asked.events)};
        std::optional<Model> other; // than the model as it was given
        if (!asked.set.empty()) {
            other = model_;
            for (const auto& [name, value] : asked.set)
                other->set_parameter(name, value);
            plan.parameters = other->parameter_values();
        } else if (!asked.state && initial_.empty()) {
            initial_ = model_.initial_state();
        }
        plan.state = asked.state ? *asked.state : other ? other->initial_state() : initial_;
        if (!other && !asked.state && length_ && is_same(asked.length, length_->first)) {
            plan.length = length_->second;
        } else {
            if (asked.state && (!asked.length.time || asked.length.skip)) { // periods of the phase with which it begins
                if (!other)
                    other = model_;
                if (plan.state.size() == other->states.size())
                    for (std::size_t i = 0; i < plan.state.size(); ++i)
                        other->set_initial(other->states[i].name, plan.state[i]);
            }
            plan.length = run_length(other ? *other : model_, asked.length);
            if (!other && !asked.state)
                length_ = {asked.length, plan.length};
        }
        if (plan.length.period)
            plan.pool = counting_pool(*plan.length.period);
        return plan;
    }

    /// With the probe that counts periods, which is the last: it ends the motion, and what others see then comes
    /// before.
    std::shared_ptr<JetPool> counting_pool(const Probe& period) {
        const double value = period.value.node().value; // run_length has made it a number
        if (!counting_ || counted_state_ != period.state || counted_value_ != value) {
            std::vector<Probe> probes = probes_;
            probes.push_back(period);
            counting_ = std::make_shared<JetPool>(
                Simulation(pool_->simulation.system(), std::move(probes), std::vector<Expression>{}, options_));
            counted_state_ = period.state;
            counted_value_ = value;
        }
        return counting_;
    }

    std::vector<bool> chosen_events(const std::optional<std::vector<std::string>>& names) const {
        std::vector<bool> chosen(model_.events.size(), !names);
        for (const std::string& name : names ? *names : std::vector<std::string>{}) {
            const auto event = model_.find_event(name);
            if (!event)
                throw InputError(Place{"events", 0, 0}, "the model has no event '" + name + "'",
                                 name_advice(name, names_of(model_.events), "it has none"));
            chosen[*event] = true;
        }
        return chosen;
    }

    std::size_t mode_named(const std::optional<std::string>& name) const {
        if (!name)
            return model_.initial_mode;
        if (const auto mode = model_.find_mode(*name))
            return *mode;
        throw InputError(Place{"mode", 0, 0}, "the model has no mode '" + *name + "'",
                         name_advice(*name, names_of(model_.modes), "it has none"));
    }

    MotionPanelChoice panels(const MotionRequest& asked, const Plan& plan, const std::vector<std::string>& histories,
                             const std::vector<std::pair<std::string, std::string>>& portraits) const {
        MotionPanelChoice choice;
        choice.chosen = !histories.empty();
        choice.sections = first_extremum_;
        const auto column = [&](const std::string& text, const char* argument) {
            return choice.column(asked_value(model_, text, argument));
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
        choice.marked = asked.events ? plan.events : usual_marks(model_);
        return choice;
    }

    /// @param motion receives tables; null: nothing but the observers does
    static Trajectory moved(const MotionRequest& asked, const Plan& plan, Watch& watch,
                            std::vector<std::shared_ptr<Observer>> observers, Motion* motion) {
        const Simulation& simulation = plan.pool->simulation;
        const RunLength& length = plan.length;
        const auto period = length.period ? std::optional(simulation.probes().size() - 1) : std::nullopt;
        const auto control =
            std::make_shared<RunControl>(std::make_shared<Relay>(std::move(observers)), period, plan.events);
        control->tell([&watch](std::optional<double> fraction, double time) { watch.note(fraction, time); });
        control->end_when([&watch, motion] { return watch.asks_to_stop() || (motion && motion->is_full()); });
        Trajectory trajectory(simulation, plan.parameters, control);
        trajectory.start(plan.state, plan.mode, 0, length.first().duration);
        if (!asked.derivatives.empty())
            trajectory.carry_derivatives(asked.derivatives);
        auto jets = plan.pool->take(!asked.derivatives.empty());
        const auto begin = [&] {
            if (motion)
                for (const auto& table : motion->tables)
                    table->begin(trajectory, length.shown.expected);
        };
        run_legs(
            trajectory, *jets, *control, length, [&watch] { return watch.has_raised(); }, begin);
        plan.pool->give_back(std::move(jets));
        return trajectory;
    }

    void compute(Motion& motion, const MotionRequest& asked, const Plan& plan, Watch& watch) const {
        const Simulation& simulation = plan.pool->simulation;
        TableRequest request;
        request.quantities = quantities_;
        request.extrema = extrema_;
        request.first_extremum = first_extremum_;
        request.events = plan.events;
        request.samples = asked.samples;
        request.every = asked.every;
        request.directions = asked.derivatives;
        std::vector<std::shared_ptr<Observer>> observers;
        const auto keep = [&](TableKind kind, std::shared_ptr<TableRecorder> table) {
            motion.kinds.push_back(kind);
            observers.push_back(table);
            motion.tables.push_back(std::move(table));
        };
        if (asked.samples > 0 && !asked.at)
            require_room_for_samples(request, plan.length.shown.expected, "every");
        const auto add = [&](TableKind kind, bool wanted) {
            if (!wanted)
                return;
            request.kind = kind;
            keep(kind, make_table_recorder(simulation, request));
        };
        if (asked.at)
            keep(TableKind::samples, std::make_shared<GivenTimes>(simulation, quantities_, *asked.at));
        add(TableKind::samples, asked.samples > 0 && !asked.at);
        add(TableKind::contacts, true);
        add(TableKind::sections, first_extremum_ > 0);
        add(TableKind::extrema, !extrema_.empty());
        add(TableKind::minima, options_.minima);
        add(TableKind::derivatives, !asked.derivatives.empty());
        add(TableKind::summary, true);
        if (asked.dense) {
            motion.periods = simulation.system().periods()(plan.parameters);
            observers.push_back(motion.steps = std::make_shared<KeptSteps>());
        }
        const Trajectory trajectory = moved(asked, plan, watch, std::move(observers), &motion);
        for (const auto& table : motion.tables)
            table->finish(trajectory);
        motion.is_interrupted = watch.has_raised();
        motion.outcome = trajectory.outcome();
        motion.state.assign(trajectory.state().begin(), trajectory.state().end());
        motion.mode = model_.modes[trajectory.mode()].name;
        motion.steps_made = trajectory.steps();
    }

    Model model_;
    std::vector<double> parameters_, initial_; ///< initial_ is found when it is needed first
    std::vector<NamedValue> quantities_, extrema_;
    SimulationOptions options_;
    std::vector<Probe> probes_;
    std::size_t first_extremum_ = 0;
    std::optional<std::pair<RunLengthRequest, RunLength>> length_; ///< the last one, from the initial state
    std::shared_ptr<JetPool> pool_, counting_;
    std::size_t counted_state_ = 0;
    double counted_value_ = 0;
};

/// Keyword arguments by which a motion is asked for, the same for several functions.
MotionRequest request_from(const py::dict& words) {
    MotionRequest asked;
    std::size_t known = 0;
    const auto read = [&](const char* name, auto& value) { known += read_word(words, name, value) ? 1 : 0; };
    read("time", asked.length.time);
    read("after", asked.length.after);
    read("periods", asked.length.periods);
    read("skip", asked.length.skip);
    read("contacts", asked.length.contacts);
    read("phase", asked.length.phase);
    read("samples", asked.samples);
    read("every", asked.every);
    read("at", asked.at);
    read("derivatives", asked.derivatives);
    read("events", asked.events);
    read("dense", asked.dense);
    read("state", asked.state);
    read("mode", asked.mode);
    read("set", asked.set);
    if (known != words.size())
        throw py::type_error("a motion has no such argument");
    if (asked.at && !asked.at->empty() && !asked.length.time && !asked.length.periods && !asked.length.contacts)
        asked.length.time = asked.at->back();
    return asked;
}

} // namespace

void bind_motions(py::module_& module) {
    stop_work_at_exit();
    py::class_<DenseSteps>(module, "DenseSteps").def("at", &DenseSteps::at, py::arg("times"));
    py::class_<Motion>(module, "Motion")
        .def("table", &Motion::table, py::arg("name"))
        .def("dense", &Motion::dense)
        .def_property_readonly("ending", &Motion::ending)
        .def_property_readonly("regular", &Motion::is_regular)
        .def_property_readonly("detail", [](const Motion& self) { return self.outcome.detail; })
        .def_property_readonly("time", [](const Motion& self) { return self.outcome.time; })
        .def_property_readonly("state", [](const Motion& self) { return self.state; })
        .def_readonly("mode", &Motion::mode)
        .def_readonly("steps", &Motion::steps_made)
        .def_readonly("raised", &Motion::raised);
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
            [](HeldSimulation& self, const py::dict& words, const py::object& told) {
                return self.run(request_from(words), told);
            },
            py::arg("words"), py::arg("told"))
        .def(
            "figure",
            [](HeldSimulation& self, const py::dict& words, const std::vector<std::string>& histories,
               const std::vector<std::pair<std::string, std::string>>& portraits) {
                return self.figure(request_from(words), histories, portraits);
            },
            py::arg("words"), py::arg("histories"), py::arg("portraits"))
        .def(
            "value_of",
            [](const HeldSimulation& self, const std::string& text, const NamedNumbers& set,
               const std::string& argument) { return self.value_of(text, set, argument.c_str()); },
            py::arg("text"), py::arg("set"), py::arg("argument"));
}

} // namespace graze::python
