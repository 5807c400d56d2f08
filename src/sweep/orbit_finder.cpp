#include "sweep/orbit_finder.hpp"

#include "base/concatenated.hpp"
#include "base/many_states.hpp"
#include "base/neutral_multipliers.hpp"
#include "flow/cyclic.hpp"

#include <algorithm>
#include <cmath>

namespace graze {

namespace {

constexpr std::size_t most_iterations = 10;
/// Close to a bifurcation corrections shrink only by a third or a half at first.
constexpr std::size_t most_shrinking = 40;
constexpr double newton_contraction = 0.8;
/// Relative to the extent of the states. Newton's method doubles the number of correct digits.
constexpr double small_correction = 1e-9;
constexpr double large_correction = 0.5;
/// Multiplier above which motions leave an orbit before it matters whether they are on it, unless they are within
/// `sits`.
constexpr double most_unstable = 2;
constexpr double sits = 1e-6;
/// How well a recorded orbit must close, and how much its returns must differ to count as different.
constexpr double closed = 1e-8;
constexpr double same_orbit = 1e-7;
constexpr double resolution = 1e-7; ///< resolution of states, relative to their size
/// How well states must close that Newton's method does not change, such as a second clock: the period must be one of
/// all of them. Larger than the rounding within a return.
constexpr double closed_exactly = 1e-10;
/// Earliest next return, as a share of the time of a return.
constexpr double earliest_return = 1e-3;

} // namespace

OrbitFinder::OrbitFinder(const SectionMap& map, const FieldMap& field, const SampleRecorder::Layout& layout,
                         const Function& image, const std::vector<std::size_t>& image_modes,
                         MotionDerivatives* derivatives)
    : map_(&map), field_(&field), image_(&image), image_modes_(&image_modes), derivatives_(derivatives),
      watcher_(map, 2, {}), recorder_(layout, 0) {}

void OrbitFinder::begin(std::span<const double> parameters, std::span<const double> periods,
                        std::span<const double> point, std::size_t mode, std::size_t period,
                        std::span<const double> scale, double duration, bool sticks) {
    parameters_.assign(parameters.begin(), parameters.end());
    periods_.assign(periods.begin(), periods.end());
    point_.assign(point.begin(), point.end());
    scale_ = Eigen::Map<const Eigen::VectorXd>(scale.data(), static_cast<Eigen::Index>(scale.size()));
    mode_ = mode;
    period_ = period;
    duration_ = duration;
    sticks_ = sticks;
    clearly_unstable_ = false;
    iterations_ = 0;
    returns_ = 0;
    symmetric_.reset();
    workspace_ = map_->workspace(parameters);
    trajectory_.emplace(map_->simulation(), parameters, borrowed(watcher_));
    trajectory_->limit_step(longest_step_);
    const std::size_t states = map_->states(), stride = states + parameters.size();
    seeds_.assign(states * stride, 0);
    for (std::size_t i = 0; i < states; ++i)
        seeds_[i * stride + i] = 1;
    // The watcher stores as many returns as the orbit has.
    watcher_ = ReturnWatcher(*map_, std::max<std::size_t>(period, 2), {});
    watcher_.allow_any_steps(true);
    guard_ = 3 * duration;
    returns_to_section_ = is_on_section();
    start_run(Stage::iterating);
}

/// Returns whether returns end on the section. If the section is the surface of an event whose jump leads off it, such
/// as the reset of a voltage, they end there.
bool OrbitFinder::is_on_section() {
    constexpr double next_to = 1e-6; // distance relative to the extent of the states
    std::vector<double> settled = point_;
    map_->settle_on_section(workspace_, settled);
    for (std::size_t i = 0; i < settled.size(); ++i)
        if (!(std::abs(settled[i] - point_[i]) <= next_to * scale_[static_cast<Eigen::Index>(i)]))
            return false;
    return true;
}

/// Runs the orbit from the point, with derivatives. The orbit's derivatives are those of the recorded run: at the point
/// before Newton's last step, products of many factors would differ in many digits.
void OrbitFinder::start_run(Stage stage) {
    stage_ = stage;
    SampleRecorder* const recorder = stage == Stage::recording ? &recorder_ : nullptr;
    if (returns_to_section_)
        map_->settle_on_section(workspace_, point_);
    if (recorder) {
        recorder->begin(parameters_);
        recorder->set_origin(0);
    }
    watcher_.begin(parameters_, periods_, recorder);
    watcher_.stop_after(period_);
    watcher_.start_leg(0, earliest_return * duration_ / static_cast<double>(period_));
    trajectory_->start(point_, mode_, 0, guard_);
    if (carries())
        return trajectory_->carry_tangents(seeds_, map_->states());
    const auto states = static_cast<Eigen::Index>(map_->states());
    derivatives_->begin(parameters_, {scale_.data(), map_->states()}, Eigen::MatrixXd::Identity(states, states));
    watcher_.follow(derivatives_);
}

/// Computes the derivatives of the completed run. @return false if there are none
bool OrbitFinder::find_tangents(Eigen::MatrixXd& tangents) {
    if (!carries()) {
        derivatives_->carry();
        tangents = derivatives_->derivatives();
        return derivatives_->valid();
    }
    const auto states = static_cast<Eigen::Index>(map_->states());
    tangents = Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(
        trajectory_->tangents().data(), states, states);
    return trajectory_->tangents_valid();
}

bool OrbitFinder::fail() {
    stage_ = Stage::failed;
    return false;
}

bool OrbitFinder::is_active(std::size_t state) const {
    return std::ranges::binary_search(jacobian_.active, state); // they are in rising order
}

bool OrbitFinder::proceed() {
    if (stage_ == Stage::comparing)
        return compare();
    returns_ += watcher_.returns();
    if (!carries() && derivatives_->broken()) {
        sticks_ = true;
        start_run(stage_);
        return true;
    }
    const bool arrived = trajectory_->outcome().ending == Ending::stopped && watcher_.returns() >= period_ &&
                         trajectory_->mode() == mode_;
    if (!arrived || !linearise())
        return fail();
    if (stage_ == Stage::iterating)
        return iterate();
    return find_spectrum() ? record() : fail();
}

/// Computes the derivative of the return map at the start of the completed run.
bool OrbitFinder::linearise() {
    Eigen::MatrixXd tangents;
    if (!find_tangents(tangents) || !map_->project(workspace_, mode_, watcher_.recent(0).state, tangents))
        return false;
    jacobian_ = return_jacobian(*map_, tangents);
    return true;
}

bool OrbitFinder::find_spectrum() {
    auto spectrum = return_spectrum(*map_, jacobian_, scale_);
    if (!spectrum)
        return false;
    spectrum_ = std::move(*spectrum);
    return true;
}

bool OrbitFinder::iterate() {
    const auto states = static_cast<Eigen::Index>(map_->states());
    const std::span<const double> image = watcher_.recent(0).state;
    if (states <= many_states && !find_spectrum())
        return fail();
    Eigen::VectorXd defect(states);
    subtract_states(image, point_, periods_, {defect.data(), map_->states()});
    const Eigen::VectorXd correction = newton_correction(jacobian_, defect, scale_);
    const double size = correction.cwiseQuotient(scale_).cwiseAbs().maxCoeff();
    if (!std::isfinite(size) || size > large_correction || ++iterations_ > most_shrinking)
        return fail();
    // Next to a bifurcation an orbit is known no better than this, but its existence is.
    const bool closes = defect.cwiseQuotient(scale_).cwiseAbs().maxCoeff() < map_->simulation().options().tolerance;
    const bool stalls = iterations_ > most_iterations && size > newton_contraction * correction_;
    if (stalls && !closes)
        return fail();
    correction_ = size;
    for (std::size_t i = 0; i < point_.size(); ++i) {
        const double before = point_[i], change = correction[static_cast<Eigen::Index>(i)];
        if (change != 0)
            point_[i] = within_period(point_[i] + change, periods_[i]);
        // No motion leads to the other side of zero.
        if (field_->keeps_sign(i) && !(point_[i] * before > 0))
            point_[i] = 0;
    }
    // The eigenvalues of a large matrix take longer than anything else.
    if (states > many_states)
        clearly_unstable_ = size > sits && has_multiplier_beyond(jacobian_, scale_, most_unstable);
    else
        clearly_unstable_ = !multipliers().empty() && std::abs(multipliers().front()) > most_unstable && size > sits;
    if (clearly_unstable_)
        return fail();
    start_run(size > small_correction && !stalls ? Stage::iterating : Stage::recording);
    return true;
}

bool OrbitFinder::record() {
    const auto distance = [&](std::span<const double> a, std::span<const double> b) {
        Eigen::VectorXd difference(scale_.size());
        subtract_states(a, b, periods_, {difference.data(), map_->states()});
        double largest = 0;
        for (const std::size_t i : jacobian_.active) {
            const auto state = static_cast<Eigen::Index>(i);
            largest = std::max(largest, std::abs(difference[state]) / scale_[state]);
        }
        return largest;
    };
    residual_ = distance(watcher_.recent(0).state, point_);
    if (!(residual_ < closed) || !others_return(watcher_.recent(0).state))
        return fail();
    keep_orbit();
    // Returns whether two states are equal to within their errors.
    const auto indistinct = [&](std::span<const double> a, std::span<const double> b) {
        Eigen::VectorXd difference(scale_.size());
        subtract_states(a, b, periods_, {difference.data(), map_->states()});
        return std::ranges::all_of(jacobian_.active, [&](std::size_t i) {
            return std::abs(difference[static_cast<Eigen::Index>(i)]) <= resolution * std::abs(b[i]);
        });
    };
    // The orbit may close after fewer returns.
    for (std::size_t d = 1; d < period_; ++d)
        if (period_ % d == 0 && watcher_.recent(period_ - d).mode == mode_ && others_return(recorded_[d - 1]) &&
            (distance(recorded_[d - 1], point_) < same_orbit || indistinct(recorded_[d - 1], point_))) {
            duration_ *= static_cast<double>(d) / static_cast<double>(period_);
            period_ = d;
            iterations_ = 0;
            start_run(Stage::iterating);
            return true;
        }
    if (image_->outputs() == 0) {
        stage_ = Stage::found;
        return false;
    }
    start_comparison();
    return true;
}

/// Returns whether the states that take part, but that Newton's method does not change, return to their values. A phase
/// that does not return has another period: the motion is not periodic, even if the other states show little of it.
bool OrbitFinder::others_return(std::span<const double> image) const {
    std::vector<double> difference(map_->states());
    subtract_states(image, point_, periods_, difference);
    for (std::size_t i = 0; i < difference.size(); ++i)
        if (map_->takes_part(i) && !is_active(i) &&
            !(std::abs(difference[i]) <= closed_exactly * scale_[static_cast<Eigen::Index>(i)]))
            return false;
    return true;
}

/// Stores the properties of the orbit that has just been run: duration, contacts, returns and extents.
void OrbitFinder::keep_orbit() {
    duration_ = watcher_.recent(0).time;
    contacts_ = watcher_.contacts(period_);
    recorded_.clear();
    extents_.assign(map_->states(), 0);
    std::size_t neutral = 0;
    for (std::size_t i = 0; i < extents_.size(); ++i) {
        double least = point_[i], greatest = point_[i];
        for (std::size_t k = 0; k < period_; ++k) {
            least = std::min(least, watcher_.recent(k).least[i]);
            greatest = std::max(greatest, watcher_.recent(k).greatest[i]);
        }
        extents_[i] = greatest - least;
        // A state that returns exactly, from any initial value, is constant; or, if it moves, the orbit belongs to a
        // continuous family, such as that of a ball that loses no energy.
        if (map_->takes_part(i) && !(periods_[i] > 0) && !is_active(i) &&
            extents_[i] > same_orbit * std::abs(point_[i]))
            ++neutral;
    }
    // For a single active state the multiplier 0 means a superstable map; this map is not one.
    if (neutral > 0 && !map_->is_phase() && jacobian_.active.size() == 1)
        spectrum_.multipliers.clear();
    add_neutral_multipliers(spectrum_.multipliers, neutral);
    for (std::size_t k = period_; k-- > 0;)
        recorded_.push_back(watcher_.recent(k).state);
}

/// Runs the image under the symmetry to its first return, which is a return of the orbit if the orbit is symmetric.
void OrbitFinder::start_comparison() {
    const std::vector<double> image = (*image_)(concatenated(point_, parameters_));
    stage_ = Stage::comparing;
    watcher_.begin(parameters_, periods_, nullptr);
    watcher_.stop_after(1);
    watcher_.start_leg(0, earliest_return * duration_ / static_cast<double>(period_));
    trajectory_->start(image, (*image_modes_)[mode_], 0, guard_);
}

bool OrbitFinder::compare() {
    stage_ = Stage::found;
    symmetric_ = false;
    if (trajectory_->outcome().ending != Ending::stopped || watcher_.returns() < 1)
        return false;
    ++returns_;
    std::vector<double> difference(map_->states());
    for (const std::vector<double>& state : recorded_) {
        subtract_states(watcher_.recent(0).state, state, periods_, difference);
        bool equal = true;
        for (const std::size_t i : jacobian_.active)
            equal = equal && std::abs(difference[i]) < 10 * same_orbit * scale_[static_cast<Eigen::Index>(i)];
        if (equal)
            symmetric_ = true;
    }
    return false;
}

} // namespace graze
