#include "sweep/step_maps.hpp"

#include "graze/flow/step_check.hpp"
#include "graze/flow/variational_system.hpp"
#include "graze/symbolic/transform.hpp"

#include <algorithm>
#include <cmath>

namespace graze {

namespace {

/// Directions up to which a lane for each is cheaper than one trajectory that carries them.
constexpr std::size_t most_directions = 8;
/// What derivatives are allowed of the tolerance of the states, as in TangentSteps.
constexpr double allowance = 50;
/// Round-off of rates that is allowed in any case.
constexpr double roundoff = 1e4 * std::numeric_limits<double>::epsilon() / 2;
constexpr int most_halvings = 8;
constexpr double least_gain = 0.1; ///< of all halvings, below which what differs is round-off

/// Whether the rate of a state is the same whatever the states and the mode, and no jump changes it.
bool is_clock(const System& system, Model& model, std::size_t state) {
    Expression rate;
    for (const Mode& mode : model.modes) {
        const Expression here = model.expand(mode.rates)[state];
        if (!rate.empty() && !(here == rate))
            return false;
        rate = here;
    }
    for (const Expression& symbol : model.state_symbols())
        if (!(differentiate(rate, symbol) == model.number(0)))
            return false;
    for (std::size_t j = 0; j < model.jumps.size(); ++j) {
        const std::vector<std::size_t>& changed = system.jump(j).changed;
        if (std::find(changed.begin(), changed.end(), state) != changed.end())
            return false;
    }
    return true;
}

std::vector<std::size_t> directions_of(const SectionMap& map) {
    const System& system = map.simulation().system();
    Model model = system.model();
    std::vector<std::size_t> directions;
    for (std::size_t i = 0; i < system.states(); ++i)
        if (map.takes_part(i) || !is_clock(system, model, i))
            directions.push_back(i);
    return directions;
}

} // namespace

VariationalModes::VariationalModes(const SectionMap& map)
    : simulation_(map.simulation()), system_(simulation_.system()) {
    // Models with many states are not to be differentiated for nothing.
    if (system_.states() > 2 * most_directions)
        return;
    directions_ = directions_of(map);
    const auto lanes = static_cast<std::size_t>(lanes_of(LaneKind::ensemble, best_instruction_set()));
    suit_ = !directions_.empty() && directions_.size() <= std::min(lanes, most_directions);
    if (suit_)
        system_ = VariationalSystem(simulation_.system()).modes();
}

StepMaps::StepMaps(const VariationalModes& modes)
    : modes_(&modes), states_(modes.simulation().system().states()), directions_(modes.directions().size()),
      map_size_(std::max<std::size_t>(states_ * directions_, 1)),
      tolerance_(allowance * modes.simulation().options().tolerance),
      jets_(modes.system(), modes.simulation().order(), LaneKind::ensemble),
      lanes_(static_cast<std::size_t>(jets_.width())), product_(map_size_),
      queues_(modes.system().model().modes.size()), seeds_(2 * states_ * lanes_), sums_(seeds_.size()),
      slopes_(seeds_.size()), times_(lanes_) {}

void StepMaps::begin(std::span<const double> parameters, std::span<const double> scale) {
    parameters_.resize(parameters.size() * lanes_);
    for (std::size_t j = 0; j < parameters.size(); ++j)
        std::fill_n(&parameters_[j * lanes_], lanes_, parameters[j]);
    jets_.set_parameters(parameters_);
    scale_.assign(scale.begin(), scale.end());
    clear();
}

void StepMaps::clear() {
    numbers_.clear();
    maps_.clear();
}

std::size_t StepMaps::add(std::size_t mode, std::span<const double> state, double length) {
    const std::size_t step = steps();
    queues_[mode].push_back({step, numbers_.size(), length, length});
    numbers_.insert(numbers_.end(), state.begin(), state.end());
    maps_.resize(maps_.size() + map_size_, 0.0);
    for (std::size_t d = 0; d < directions_; ++d)
        maps_[step * map_size_ + modes_->directions()[d] * directions_ + d] = 1;
    return step;
}

void StepMaps::compute() {
    const std::size_t together = lanes_ / directions_;
    for (std::size_t mode = 0; mode < queues_.size(); ++mode) {
        std::vector<Part>& queue = queues_[mode];
        // What is left of a step after a part of it comes last.
        for (std::size_t done = 0; done < queue.size();) {
            const std::size_t count = std::min(together, queue.size() - done);
            const std::vector<Part> batch(queue.begin() + static_cast<std::ptrdiff_t>(done),
                                          queue.begin() + static_cast<std::ptrdiff_t>(done + count));
            compute(mode, batch);
            done += count;
        }
        queue.clear();
    }
}

/// States and unit vectors into lanes; those that are empty repeat the first.
void StepMaps::load(std::span<const Part> parts) {
    std::fill(seeds_.begin(), seeds_.end(), 0.0);
    for (std::size_t lane = 0; lane < lanes_; ++lane) {
        const std::size_t place = lane / directions_, d = lane % directions_;
        const Part& part = parts[place < parts.size() ? place : 0];
        for (std::size_t i = 0; i < states_; ++i)
            seeds_[i * lanes_ + lane] = numbers_[part.state + i];
        seeds_[(states_ + modes_->directions()[d]) * lanes_ + lane] = 1;
    }
}

void StepMaps::compute(std::size_t mode, std::span<const Part> given) {
    std::vector<Part> parts(given.begin(), given.end());
    load(parts);
    const Jet& jet = jets_.computed(mode, seeds_);
    find_reaches(jet, parts);
    for (std::size_t lane = 0; lane < lanes_; ++lane) {
        const std::size_t place = lane / directions_;
        times_[lane] = parts[place < parts.size() ? place : 0].attempt;
    }
    jet.evaluate_states(times_, sums_, slopes_);
    Jet& next = jets_.next(mode);
    next.begin(sums_);
    for (std::size_t p = 0; p < parts.size(); ++p) {
        Part part = parts[p];
        if (!believe(part, misfit(jet, next, p * directions_, part.attempt))) {
            queues_[mode].push_back(part);
            continue;
        }
        apply(part, p * directions_);
        const double left = part.length - part.attempt;
        if (!(left > 0))
            continue;
        const std::size_t state = numbers_.size();
        for (std::size_t i = 0; i < states_; ++i)
            numbers_.push_back(sums_[i * lanes_ + p * directions_]);
        queues_[mode].push_back({part.step, state, left, left});
    }
}

/// The larger of a direction's last two terms, relative to its size.
double StepMaps::last_terms(const Jet& jet, std::size_t lane, double length) const {
    const auto order = static_cast<std::size_t>(jet.order());
    double power = 1, size = 0, last = 0;
    for (std::size_t k = 1; k < order; ++k)
        power *= length;
    const std::span<const Series> series = jet.series().subspan(states_, states_);
    for (std::size_t i = 0; i < states_; ++i) {
        const double *c = series[i].first + lane, scale = scale_[i];
        size = std::max(size,
                        (std::abs(c[0]) + length * (std::abs(c[lanes_]) + length * std::abs(c[2 * lanes_]))) / scale);
        last = std::max(
            last, power * std::max(std::abs(c[(order - 1) * lanes_]), length * std::abs(c[order * lanes_])) / scale);
    }
    return last / size;
}

/// How far each part can be followed at once.
void StepMaps::find_reaches(const Jet& jet, std::span<Part> parts) {
    if (jet.order() < 3)
        return;
    const double root = 1.0 / (jet.order() - 1);
    for (std::size_t p = 0; p < parts.size(); ++p) {
        double reach = parts[p].attempt;
        for (std::size_t d = 0; d < directions_ && !parts[p].accepted; ++d) {
            double worst = last_terms(jet, p * directions_ + d, reach);
            // Sizes shrink with the step: a few rounds.
            for (int round = 0; round < 6 && worst > tolerance_; ++round) {
                reach *= std::pow(tolerance_ / worst, root);
                worst = last_terms(jet, p * directions_ + d, reach);
            }
        }
        if (std::isfinite(reach) && reach > 0)
            parts[p].attempt = reach;
    }
}

/// By how much slopes of the directions' polynomials differ from what the variational equations say, in units of what
/// is allowed.
double StepMaps::misfit(const Jet& jet, const Jet& next, std::size_t first_lane, double length) const {
    double most = 0;
    const std::span<const Series> series = jet.series().subspan(states_, states_),
                                  there = next.series().subspan(states_, states_);
    for (std::size_t lane = first_lane; lane < first_lane + directions_; ++lane) {
        double apart = 0, size = 0;
        for (std::size_t i = 0; i < states_; ++i) {
            const double* c = series[i].first + lane;
            const std::size_t at = (states_ + i) * lanes_ + lane;
            const double rate = there[i].first[lanes_ + lane];
            const double difference = length * std::abs(slopes_[at] - rate) / scale_[i];
            apart = std::isnan(difference) ? difference : std::max(apart, difference);
            if (std::isnan(apart))
                break;
            size = std::max(size, StepCheck::size_over(c[0], c[lanes_], sums_[at], rate, length) / scale_[i]);
        }
        const double ratio = apart / ((StepCheck::allowance * tolerance_ + roundoff) * size);
        most = std::isnan(ratio) ? std::numeric_limits<double>::infinity() : std::max(most, ratio);
    }
    return most;
}

/// Whether a part is good enough; one that is not is to be halved.
bool StepMaps::believe(Part& part, double misfit) const {
    if (misfit <= 1 || part.accepted)
        return true;
    if (part.halvings == 0)
        part.first_misfit = misfit;
    if (part.halvings < most_halvings) {
        ++part.halvings;
        part.attempt *= 0.5;
        return false;
    }
    if (std::isfinite(misfit) && misfit <= least_gain * part.first_misfit)
        return true;
    part.accepted = true;
    part.attempt = part.length;
    return false;
}

/// What the step has been followed for so far, and this part of it behind.
void StepMaps::apply(const Part& part, std::size_t first_lane) {
    double* map = &maps_[part.step * map_size_];
    const std::vector<std::size_t>& rows = modes_->directions();
    std::fill(product_.begin(), product_.end(), 0.0);
    for (std::size_t i = 0; i < states_; ++i)
        for (std::size_t j = 0; j < directions_; ++j) {
            const double entry = sums_[(states_ + i) * lanes_ + first_lane + j];
            for (std::size_t d = 0; d < directions_; ++d)
                product_[i * directions_ + d] += entry * map[rows[j] * directions_ + d];
        }
    std::copy(product_.begin(), product_.end(), map);
}

} // namespace graze
