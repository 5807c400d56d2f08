#include "page/simulation_json.hpp"

#include "graze/base/rounded.hpp"
#include "graze/picture/motion_recorder.hpp"
#include "graze/study/run_length.hpp"
#include "graze/trajectory/recorder.hpp"
#include "page/motion_rows.hpp"
#include "page/time_limit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

namespace graze {

namespace {

/// Ends a motion that takes too many steps, or too long.
class WorkLimit : public Observer {
public:
    WorkLimit(std::size_t most_steps, double most_seconds, std::function<bool()> interrupted)
        : steps_(most_steps), late_(time_limit(most_seconds)), interrupted_(std::move(interrupted)) {}

    void step(const Step&) override { steps_ -= steps_ > 0 ? 1 : 0; }
    bool stop() override {
        limit_ = steps_ == 0 ? "steps" : late_() ? "seconds" : interrupted_ && interrupted_() ? "interrupted" : "";
        return !limit_.empty();
    }
    /// What has ended the motion; empty: nothing.
    const std::string& limit() const { return limit_; }

private:
    std::size_t steps_;
    std::function<bool()> late_, interrupted_;
    std::string limit_;
};

Model wished_model(const Model& model, const SimulationWish& wish) {
    Model wished = model;
    for (const auto& [name, value] : wish.parameters)
        wished.set_parameter(name, value);
    for (const auto& [name, value] : wish.initial)
        wished.set_initial(name, value);
    if (!wish.mode.empty())
        wished.set_initial_mode(wish.mode);
    return wished;
}

/// The time that some steps of a model take.
double time_of_steps(const Model& model, std::size_t steps) {
    const Simulation simulation{System(model)};
    const auto limit = std::make_shared<WorkLimit>(steps, 1, std::function<bool()>());
    Trajectory trajectory(simulation, model.parameter_values(), limit);
    trajectory.start(model.initial_state(), model.initial_mode, 0, std::numeric_limits<double>::infinity());
    JetSet jets(simulation, LaneKind::single);
    run(trajectory, jets);
    return trajectory.time();
}

} // namespace

double usual_duration(const Model& model) {
    constexpr std::size_t steps_without_phase = 300;
    const auto phase = std::ranges::find_if(model.states, [](const State& state) { return state.period.has_value(); });
    if (phase != model.states.end()) {
        RunLengthRequest request;
        request.phase = phase->name;
        const RunLength length = run_length(model, request);
        if (length.shown.expected)
            return *length.shown.expected;
    }
    return rounded(time_of_steps(model, steps_without_phase), 2);
}

nlohmann::json simulation_json(const Model& given, const SimulationWish& wish) {
    const Model model = wished_model(given, wish);
    const double duration = wish.duration ? *wish.duration : usual_duration(model);
    if (!(duration > 0) || !std::isfinite(duration))
        throw InputError({"duration", 0, 0}, fmt::format("{} is no duration", duration), "give a positive number");
    const std::vector<NamedValue> columns = motion_columns(model, wish.names);
    MotionPanelChoice contents;
    contents.marked = usual_marks(model);
    std::vector<std::size_t> places{0};
    for (auto column = columns.begin() + 1; column != columns.end(); ++column)
        places.push_back(1 + contents.column(*column));
    // So that neither the recorded numbers nor the steps grow without bound.
    constexpr std::size_t most_numbers = 10'000'000, most_numbers_given = 100'000;
    constexpr int points_of_step = 16;
    const std::size_t steps = std::min(wish.most_steps, most_numbers / (points_of_step * (columns.size() + 1)));
    const std::size_t rows = std::min(wish.most_rows, most_numbers_given / columns.size());
    const Simulation simulation{System(model)};
    const auto curves = std::make_shared<MotionRecorder>(simulation, std::move(contents), points_of_step);
    const auto limit = std::make_shared<WorkLimit>(steps, wish.most_seconds, wish.interrupted);
    Trajectory trajectory(simulation, model.parameter_values(),
                          std::make_shared<Relay>(std::vector<std::shared_ptr<Observer>>{curves, limit}));
    trajectory.start(model.initial_state(), model.initial_mode, 0, duration);
    JetSet jets(simulation, LaneKind::single);
    run(trajectory, jets);
    curves->finish(trajectory);
    DenseMotion motion = curves->motion();
    const std::vector<std::vector<double>> recorded = std::move(motion.values);
    const std::vector<double> periods = std::move(motion.periods);
    motion.values.clear();
    motion.periods.clear();
    for (const std::size_t place : places) {
        motion.values.push_back(recorded[place]);
        motion.periods.push_back(periods[place]);
    }
    const bool whole = trajectory.outcome().ending != Ending::stopped;
    nlohmann::json one = motion_rows_json(model, columns, std::move(motion), {.complete = whole, .most_rows = rows});
    one["limit"] = whole ? std::string() : limit->limit();
    one["duration"] = duration;
    one["steps"] = trajectory.steps();
    return one;
}

} // namespace graze
