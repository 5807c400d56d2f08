#include "sweep/transient_search.hpp"

#include "base/special_numbers.hpp"
#include "graze/base/require.hpp"

#include <fmt/format.h>

#include <utility>

namespace graze {

TransientSetting::TransientSetting(const System& system, const TransientOptions& given,
                                   const std::vector<Sampling>& samplings, const std::vector<Expression>& values,
                                   const SimulationOptions& simulation_options)
    : options((given.validate(system.model()), given)), layout(system, samplings, values),
      simulation(system, layout.probes(system.model(), options.section), {}, simulation_options),
      counted(system.model().events.size()) {
    for (const std::size_t event : options.counted)
        counted.at(event) = true;
}

TransientSearch::TransientSearch(std::shared_ptr<const TransientSetting> setting)
    : setting_(std::move(setting)), recorder_(setting_->layout, 0) {}

void TransientSearch::begin(std::span<const double> parameters, std::span<const double> state, std::size_t mode) {
    const TransientOptions& options = setting_->options;
    const System& system = setting_->simulation.system();
    require_size(parameters.size(), system.parameters(), "independent parameters");
    require_size(state.size(), system.states(), "states");
    require_index(mode, system.model().modes.size(), "mode");
    recorder_.begin(parameters);
    trajectory_.emplace(setting_->simulation, parameters, borrowed(static_cast<Observer&>(*this)));
    result_ = {};
    periods_ = contacts_ = all_periods_ = 0;
    waited_ = 0;
    stop_ = escaped_ = reached_ = false;
    shown_ = !(options.skip_time > 0) && options.skip_periods == 0;
    trajectory_->start(state, mode, 0, shown_ ? end_of(0) : options.skip_time > 0 ? options.skip_time : infinity);
}

/// Returns the time at which the sampled part ends if it begins at `time`.
double TransientSearch::end_of(double time) const {
    return setting_->options.time > 0 ? time + setting_->options.time : infinity;
}

void TransientSearch::step(const Step& step) {
    for (const StateBounds& bounds : setting_->options.bounds)
        escaped_ = escaped_ || !bounds.contain(step.state(bounds.state, step.length));
    stop_ = stop_ || escaped_ || has_stalled();
}

/// Counts an occurrence; returns whether a leg that is ended only by a count has had no progress for too long.
bool TransientSearch::has_stalled() {
    // A step covers a part of an oscillation, so these are at least a hundred thousand oscillations of the fastest
    // kind. (A motion at rest makes a single step with endless passages.)
    constexpr std::size_t patience = 1'000'000;
    ++waited_;
    const TransientOptions& options = setting_->options;
    return waited_ >= patience && !((shown_ ? options.time : options.skip_time) > 0);
}

/// Returns the outcome of a motion that was given up.
Outcome TransientSearch::stalled_outcome() const {
    const TransientOptions& options = setting_->options;
    const bool by_contacts = shown_ && (options.contacts > 0 || options.greatest_speed > 0);
    const bool by_periods = (shown_ ? options.periods : options.skip_periods) > 0;
    const std::string missing = !by_periods   ? "contact"
                                : by_contacts ? "contact or passage of the section"
                                              : "passage of the section";
    return {Ending::step_limit, trajectory_->time(),
            fmt::format("no {} that ends the motion in the last {} steps and passages, up to time {:.6g}; {}", missing,
                        waited_, trajectory_->time(),
                        shown_ ? "give a time too, at which it ends in any case" : "skip a time instead of periods")};
}

void TransientSearch::contact(const Contact& contact) {
    if (shown_)
        recorder_.contact(contact);
    stop_ = stop_ || has_stalled();
    if (!shown_ || contact.kind == ContactKind::touch || !setting_->counted[contact.event])
        return;
    ++contacts_;
    if (setting_->options.contacts > 0)
        waited_ = 0;
    const TransientOptions& options = setting_->options;
    reached_ = reached_ || (options.contacts > 0 && contacts_ >= options.contacts) ||
               (options.greatest_speed > 0 && -contact.rate_before > options.greatest_speed);
    stop_ = stop_ || reached_;
}

void TransientSearch::passage(const Passage& passage) {
    if (shown_)
        recorder_.passage(passage);
    stop_ = stop_ || has_stalled();
    if (setting_->options.section.empty() || passage.probe + 1 != setting_->simulation.probes().size())
        return;
    ++periods_;
    ++all_periods_;
    const std::size_t wanted = shown_ ? setting_->options.periods : setting_->options.skip_periods;
    if (wanted > 0)
        waited_ = 0;
    reached_ = reached_ || (wanted > 0 && periods_ >= wanted);
    stop_ = stop_ || reached_;
}

bool TransientSearch::stop() {
    const bool result = stop_;
    stop_ = false;
    return result;
}

bool TransientSearch::proceed() {
    const Ending ending = trajectory_->outcome().ending;
    const bool leg_over = ending == Ending::end_time || (ending == Ending::stopped && reached_ && !escaped_);
    if (!shown_ && leg_over) {
        shown_ = true;
        periods_ = waited_ = 0;
        reached_ = false;
        recorder_.set_origin(trajectory_->time());
        trajectory_->extend(end_of(trajectory_->time()));
        return true;
    }
    const bool in_vain = ending == Ending::stopped && !escaped_ && !leg_over;
    result_.label = escaped_ ? Label::escaped : leg_over ? Label::ended : label_of(ending);
    result_.cycles = result_.periods_run = all_periods_;
    result_.time = trajectory_->time();
    result_.state.assign(trajectory_->state().begin(), trajectory_->state().end());
    result_.mode = trajectory_->mode();
    result_.outcome = in_vain ? stalled_outcome() : trajectory_->outcome();
    result_.samples = std::move(recorder_.samples());
    return false;
}

Label label_of(Ending ending) {
    return ending == Ending::singular   ? Label::singular
           : ending == Ending::chatter  ? Label::chattering
           : ending == Ending::terminal ? Label::ended
                                        : Label::failed;
}

std::unique_ptr<SearchFactory> transient_searches(const System& system, const TransientOptions& options,
                                                  const std::vector<Sampling>& samplings,
                                                  const std::vector<Expression>& values,
                                                  const SimulationOptions& simulation) {
    return std::make_unique<SearchesOf<TransientSetting, TransientSearch>>(system, options, samplings, values,
                                                                           simulation);
}

} // namespace graze
