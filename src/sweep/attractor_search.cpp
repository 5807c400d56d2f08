#include "sweep/attractor_search.hpp"

#include "graze/symbolic/input_error.hpp"
#include "sweep/transient_search.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace graze {

namespace {

constexpr double forever = std::numeric_limits<double>::infinity();
constexpr double soonest = 1e-3;  ///< share of the time of a return before which none can come
constexpr double on_orbit = 1e-9; ///< distance from an orbit at which a motion is on it
constexpr double linear = 0.1;    ///< share of its contraction by which the motion may differ from its linear part
constexpr std::size_t most_disturbances = 3;
constexpr double clear_of_zero = 3;     ///< standard errors
constexpr double least_growth = 5;      ///< logarithm, of a small distance over all returns, that shows chaos
constexpr double neutral = 0.02;        ///< growth per return that counts as none
constexpr double very_close = 1e-5;     ///< relative to the extent of the states
constexpr double equal_averages = 1e-6; ///< relative to the extent of a state
constexpr std::size_t least_extension = 400;
constexpr std::size_t returns_between_looks = 25;
constexpr std::size_t extension = 4; ///< of the largest period, in the last part of a search

/// Names of transitions, those that change nothing left out; a name and its repetitions are written once.
std::string signature_of(const Model& model, std::span<const std::uint32_t> contacts) {
    std::vector<std::pair<std::string, std::size_t>> parts;
    for (const std::uint32_t code : contacts) {
        const Transition& transition = model.transitions[code / 2];
        const bool stays = std::all_of(transition.next.begin(), transition.next.end(), [&](const Alternative& next) {
            return next.mode && *next.mode == transition.mode;
        });
        const bool sticking = code % 2 == 1;
        if (transition.jump == 0 && stays && !sticking)
            continue;
        std::string name = transition.label + (sticking ? "(chatter)" : "");
        if (!parts.empty() && parts.back().first == name)
            ++parts.back().second;
        else
            parts.emplace_back(std::move(name), 1);
    }
    std::string text;
    for (const auto& [name, count] : parts)
        text += fmt::format("{}{}{}", text.empty() ? "" : " ", name, count > 1 ? fmt::format("^{}", count) : "");
    return text;
}

/// Averages along a quasi-periodic motion converge faster than any power of their length when its ends have no weight
/// (Das, Sander, Saiki and Yorke 2016); along a chaotic one they differ by the root of it.
double weighted_average(std::span<const double> states, std::size_t stride, std::size_t state, std::size_t first,
                        std::size_t count) {
    double sum = 0, weights = 0;
    for (std::size_t k = 0; k < count; ++k) {
        const double t = (static_cast<double>(k) + 0.5) / static_cast<double>(count);
        const double weight = std::exp(-1 / (t * (1 - t)));
        sum += weight * states[(first + k) * stride + state];
        weights += weight;
    }
    return sum / weights;
}

std::vector<Probe> probes_of(const Model& model, const AttractorOptions& options,
                             const SampleRecorder::Layout& layout) {
    std::vector<Probe> probes = layout.probes();
    // Last, since it ends trajectories: what happens at the same time is to be seen before.
    probes.push_back(section_probe(model, options.section));
    return probes;
}

class AttractorSearches : public SearchFactory {
public:
    AttractorSearches(const Model& model, const AttractorOptions& options, const std::vector<Sampling>& samplings,
                      const std::vector<Expression>& values, const SimulationOptions& simulation_options)
        : setting_(model, options, samplings, values, simulation_options) {}

    const Simulation& simulation() const override { return setting_.simulation; }
    std::unique_ptr<PointSearch> make() const override { return std::make_unique<AttractorSearch>(setting_); }

private:
    AttractorSetting setting_;
};

[[noreturn]] void refuse(const std::string& problem, const std::string& remedy) {
    throw InputError(problem, remedy);
}

} // namespace

void AttractorOptions::validate(const Model& model) const {
    if (section.empty())
        refuse("no section says what a return is", "name one that the model declares under [sections]");
    section_probe(model, section);
    if (cycles < 1 || cycles > 100'000'000)
        refuse(fmt::format("{} cycles are out of range", cycles), "give 1 to 100 million");
    if (keep < 1)
        refuse("no returns are kept", "keep at least one");
    if (largest_period < 1 || largest_period > 1000)
        refuse(fmt::format("a largest period of {} returns is out of range", largest_period), "give 1 to 1000");
    if (!(recurrence > 0 && recurrence <= 0.1))
        refuse(fmt::format("a recurrence of {} is out of range", recurrence), "give more than 0, up to 0.1");
    if (!(disturbance >= 0 && disturbance <= 0.1))
        refuse(fmt::format("a disturbance of {} is out of range", disturbance), "give 0 to 0.1");
    if (!(longest_return >= 0))
        refuse("the longest time of a return is negative", "give a positive time, or 0 for no bound");
    for (const auto& [state, range] : bounds)
        if (state >= model.states.size() || !(range.first < range.second))
            refuse("bounds of a state are not in order", "give the least value, then the greatest");
}

AttractorSetting::AttractorSetting(const Model& model, const AttractorOptions& given,
                                   const std::vector<Sampling>& samplings, const std::vector<Expression>& values,
                                   const SimulationOptions& simulation_options)
    : options((given.validate(model), given)), layout(model, samplings, values),
      simulation(model, probes_of(model, options, layout), {}, simulation_options),
      map(simulation, simulation.probes().size() - 1) {
    if (model.symmetries.empty())
        return;
    std::vector<Expression> inputs = model.state_symbols();
    for (const Expression& symbol : model.parameter_symbols())
        inputs.push_back(symbol);
    image = Function(inputs, model.expand(model.symmetries.front().map));
    image_modes = model.symmetries.front().modes;
}

AttractorSearch::AttractorSearch(const AttractorSetting& setting)
    : setting_(&setting),
      watcher_(setting.map, 2 * extension * setting.options.largest_period + 1, setting.options.bounds),
      recorder_(setting.layout, 0), finder_(setting.map, setting.layout, setting.image, setting.image_modes),
      exponent_(setting.map) {}

void AttractorSearch::begin(std::span<const double> parameters, std::span<const double> state, std::size_t mode) {
    const CompiledModel& compiled = setting_->simulation.compiled();
    parameters_.assign(parameters.begin(), parameters.end());
    periods_.resize(compiled.states());
    std::vector<double> work(compiled.workspace());
    main_.emplace(setting_->simulation, parameters, watcher_);
    compiled.periods().evaluate(parameters_, periods_, work);
    recorder_.begin(parameters);
    recorder_.set_origin(0);
    watcher_.begin(parameters, periods_, &recorder_);
    thresholds_.assign(extension * setting_->options.largest_period + 1, setting_->options.recurrence);
    watcher_.watch_recurrence(&thresholds_, setting_->options.largest_period);
    watcher_.allow_any_steps(setting_->options.longest_return > 0);
    watcher_.start_leg(0, 0);
    exponent_.clear();
    visited_.clear();
    limit_ = setting_->options.cycles;
    disturbances_ = 0;
    finding_ = confirming_ = false;
    result_ = {};
    main_->start(state, mode, 0, setting_->options.longest_return > 0 ? setting_->options.longest_return : forever);
    const std::size_t before = std::min(limit_, setting_->options.lyapunov_cycles);
    watcher_.stop_after(limit_ > before ? limit_ - before : 1);
}

Trajectory& AttractorSearch::trajectory() {
    return finding_ ? finder_.trajectory() : *main_;
}

bool AttractorSearch::proceed() {
    if (!finding_)
        return settle();
    if (finder_.proceed())
        return true;
    finding_ = false;
    result_.periods_run += finder_.returns();
    return consider_orbit();
}

/// The motion has stopped.
bool AttractorSearch::settle() {
    const Ending ending = main_->outcome().ending;
    if (ending == Ending::end_time)
        return finish(Label::unsettled);
    if (ending != Ending::stopped)
        return finish(label_of(ending));
    if (watcher_.escaped())
        return finish(Label::escaped);
    if (watcher_.stuck())
        return finish(Label::unsettled);
    return examine_return();
}

bool AttractorSearch::examine_return() {
    if (exponent_.begun() && !confirming_)
        exponent_.add_return(*main_);
    if (watcher_.returns() > setting_->options.cycles)
        visited_.insert(visited_.end(), watcher_.recent(0).state.begin(), watcher_.recent(0).state.end());
    const std::size_t n = watcher_.recurrent();
    if (n == 0)
        return go_on();
    finding_ = true;
    finder_.begin(parameters_, periods_, watcher_.recent(0).state, watcher_.recent(0).mode, n, watcher_.scale(),
                  watcher_.recent(0).time - watcher_.recent(n).time);
    return true;
}

void AttractorSearch::start_exponent() {
    exponent_.begin(parameters_, watcher_.scale(), main_->time());
    exponent_.seed(*main_);
    std::fill(thresholds_.begin(), thresholds_.end(), setting_->options.recurrence);
}

bool AttractorSearch::go_on() {
    const std::size_t returns = watcher_.returns();
    const bool look_again = limit_ > setting_->options.cycles && returns % returns_between_looks == 0 && !confirming_;
    if ((returns >= limit_ || look_again) && conclude())
        return false;
    const std::size_t before = std::min(setting_->options.cycles, setting_->options.lyapunov_cycles);
    if (confirming_) {
        watcher_.stop_after(limit_);
        const double longest_confirmed = setting_->options.longest_return;
        main_->extend(longest_confirmed > 0 ? main_->time() + longest_confirmed : forever);
        return true;
    }
    if (before > 0 && !exponent_.begun() && returns + before >= setting_->options.cycles)
        start_exponent();
    watcher_.stop_after(exponent_.begun() ? returns + 1 : setting_->options.cycles - before);
    const double longest = setting_->options.longest_return;
    main_->extend(longest > 0 ? main_->time() + longest : forever);
    return true;
}

/// An orbit may have been found near the last return.
bool AttractorSearch::consider_orbit() {
    const std::size_t n = watcher_.recurrent();
    if (finder_.found() && is_attracting())
        return finish_periodic();
    if (finder_.found() && leave_unstable_orbit())
        return true;
    // Worth another try when the motion has come clearly closer.
    thresholds_[n] = watcher_.distance(watcher_.recent(0).state, watcher_.recent(n).state) / 3;
    return go_on();
}

/// Whether the motion is seen to approach the orbit that was found: it is stable, and from one period to the next the
/// distance has become what the multipliers say. That excludes orbits which Newton's method found further away.
bool AttractorSearch::is_attracting() const {
    double radius = 0;
    for (const auto& multiplier : finder_.multipliers())
        radius = std::max(radius, std::abs(multiplier));
    const std::size_t n = finder_.period();
    if (!(radius < 1) || watcher_.remembered() <= n)
        return false;
    const std::span<const double> scale = watcher_.scale();
    const auto size = static_cast<Eigen::Index>(scale.size());
    std::vector<double> now(scale.size()), before(scale.size());
    subtract_states(watcher_.recent(0).state, finder_.point(), periods_, now);
    subtract_states(watcher_.recent(n).state, finder_.point(), periods_, before);
    double distance = 0, distance_before = 0, difference = 0;
    for (Eigen::Index i = 0; i < size; ++i) {
        const auto state = static_cast<std::size_t>(i);
        if (!finder_.is_active(state))
            continue;
        double foreseen = 0;
        for (Eigen::Index j = 0; j < size; ++j)
            if (finder_.is_active(static_cast<std::size_t>(j)))
                foreseen += finder_.jacobian()(i, j) * before[static_cast<std::size_t>(j)];
        distance = std::max(distance, std::abs(now[state]) / scale[state]);
        distance_before = std::max(distance_before, std::abs(before[state]) / scale[state]);
        difference = std::max(difference, std::abs(now[state] - foreseen) / scale[state]);
    }
    if (distance < on_orbit)
        return true;
    return difference <= linear * (1 - radius) * distance_before && watcher_.contacts(n) == finder_.contacts();
}

/// A motion on an unstable orbit would stay there until round-off has grown: it is displaced.
bool AttractorSearch::leave_unstable_orbit() {
    const double size = setting_->options.disturbance;
    if (finder_.multipliers().empty() || std::abs(finder_.multipliers().front()) < 1 || size == 0 ||
        disturbances_ >= most_disturbances || watcher_.distance(watcher_.recent(0).state, finder_.point()) > size)
        return false;
    ++disturbances_;
    const std::span<const double> scale = watcher_.scale();
    std::vector<double> state(finder_.point().begin(), finder_.point().end()), deviation(state.size());
    subtract_states(watcher_.recent(0).state, state, periods_, deviation);
    const Eigen::VectorXd& direction = finder_.leading_direction();
    double length = 0, along = 0;
    for (std::size_t i = 0; i < state.size(); ++i) {
        const double component = direction[static_cast<Eigen::Index>(i)] / scale[i];
        length = std::max(length, std::abs(component));
        along += component * deviation[i] / scale[i];
    }
    if (!(length > 0))
        return false;
    for (std::size_t i = 0; i < state.size(); ++i)
        state[i] += (along < 0 ? -size : size) * direction[static_cast<Eigen::Index>(i)] / length;
    std::fill(thresholds_.begin(), thresholds_.end(), setting_->options.recurrence);
    restart(state, finder_.mode(), finder_.duration() / static_cast<double>(finder_.period()));
    if (exponent_.begun() && !confirming_)
        exponent_.seed(*main_);
    return true;
}

/// Many transients look chaotic until they suddenly settle: what does is followed as long again.
void AttractorSearch::confirm_chaos() {
    confirming_ = true;
    limit_ = watcher_.returns() + setting_->options.cycles;
    std::fill(thresholds_.begin(), thresholds_.end(), setting_->options.recurrence);
    restart(watcher_.recent(0).state, watcher_.recent(0).mode, watcher_.recent(0).time - watcher_.recent(1).time);
}

/// Starts the motion anew where it is, or close to that, without derivatives.
void AttractorSearch::restart(std::span<const double> state, std::size_t mode, double duration) {
    const double time = main_->time(), longest = setting_->options.longest_return;
    watcher_.start_leg(time, soonest * duration);
    main_->start(state, mode, time, longest > 0 ? time + longest : forever);
}

/// After all cycles. @return whether the point is done
bool AttractorSearch::conclude() {
    if (confirming_)
        return !finish(Label::chaotic);
    if (!exponent_.begun())
        return !finish(Label::unsettled);
    if (exponent_.known()) {
        const double growth = exponent_.value() * exponent_.time_per_return();
        if (exponent_.value() > clear_of_zero * exponent_.error() &&
            growth * static_cast<double>(exponent_.returns()) > least_growth) {
            confirm_chaos();
            return false;
        }
        if (watcher_.returns() >= limit_ && limit_ > setting_->options.cycles &&
            std::abs(growth) * static_cast<double>(exponent_.returns()) < neutral && is_quasi_periodic())
            return !finish(Label::quasi_periodic);
    }
    if (watcher_.returns() < limit_)
        return false;
    if (limit_ > setting_->options.cycles)
        return !finish(Label::unsettled);
    // Slow transients and quasi-periodic motions are worth a longer look.
    limit_ += std::max(least_extension, 2 * setting_->options.cycles);
    std::fill(thresholds_.begin(), thresholds_.end(), setting_->options.recurrence);
    const std::size_t largest = setting_->options.largest_period;
    std::fill(thresholds_.begin() + static_cast<std::ptrdiff_t>(largest) + 1, thresholds_.end(),
              setting_->options.recurrence / 100);
    watcher_.watch_recurrence(&thresholds_, extension * largest);
    return false;
}

/// Whether the motion has been very close to where it is now: then its period is only too long to be tried.
bool AttractorSearch::comes_back() {
    const std::size_t stride = periods_.size(), count = visited_.size() / stride;
    const std::span<const double> states(visited_);
    for (std::size_t k = 0; k + 1 < count; ++k)
        if (watcher_.distance(states.subspan(k * stride, stride), states.last(stride)) < very_close)
            return true;
    return false;
}

bool AttractorSearch::is_quasi_periodic() {
    const std::size_t stride = periods_.size(), count = visited_.size() / stride / 2;
    if (count < least_extension / 4)
        return false;
    if (comes_back())
        return false;
    bool moves = false;
    for (std::size_t i = 0; i < stride; ++i) {
        if (!setting_->map.takes_part(i) || periods_[i] > 0)
            continue;
        double extent[2];
        for (std::size_t half = 0; half < 2; ++half) {
            double least = forever, greatest = -forever;
            for (std::size_t k = half * count; k < (half + 1) * count; ++k) {
                least = std::min(least, visited_[k * stride + i]);
                greatest = std::max(greatest, visited_[k * stride + i]);
            }
            extent[half] = greatest - least;
        }
        const double difference =
            weighted_average(visited_, stride, i, count, count) - weighted_average(visited_, stride, i, 0, count);
        if (std::abs(difference) > equal_averages * watcher_.scale()[i] || extent[1] < 0.95 * extent[0])
            return false;
        moves = moves || extent[1] > setting_->options.recurrence * watcher_.scale()[i];
    }
    return moves;
}

bool AttractorSearch::finish_periodic() {
    finish(Label::periodic);
    result_.period = finder_.period();
    result_.duration = finder_.duration();
    result_.signature = signature_of(setting_->simulation.model(), finder_.contacts());
    result_.symmetric = finder_.symmetric();
    result_.multipliers = finder_.multipliers();
    result_.residual = finder_.residual();
    result_.state.assign(finder_.point().begin(), finder_.point().end());
    result_.mode = finder_.mode();
    result_.samples = std::move(finder_.samples());
    result_.lyapunov.reset();
    result_.lyapunov_error.reset();
    if (!result_.multipliers.empty() && std::abs(result_.multipliers.front()) > 0)
        result_.lyapunov = std::log(std::abs(result_.multipliers.front())) / result_.duration;
    return false;
}

bool AttractorSearch::finish(Label label) {
    result_.label = label;
    result_.cycles = watcher_.returns();
    result_.periods_run += watcher_.returns();
    result_.time = main_->time();
    result_.state.assign(main_->state().begin(), main_->state().end());
    result_.mode = main_->mode();
    result_.outcome = main_->outcome();
    if (watcher_.stuck())
        result_.outcome.detail = "no return to the section came; choose another section";
    if (exponent_.known()) {
        result_.lyapunov = exponent_.value();
        result_.lyapunov_error = exponent_.error();
    }
    recorder_.keep_last(setting_->options.keep);
    result_.samples = std::move(recorder_.samples());
    return false;
}

std::unique_ptr<SearchFactory> attractor_searches(const Model& model, const AttractorOptions& options,
                                                  const std::vector<Sampling>& samplings,
                                                  const std::vector<Expression>& values,
                                                  const SimulationOptions& simulation) {
    return std::make_unique<AttractorSearches>(model, options, samplings, values, simulation);
}

} // namespace graze
