#include "graze/grazing/map_motion.hpp"

#include "graze/base/input_error.hpp"
#include "grazing/return_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

namespace graze {

void MapMotionOptions::validate() const {
    if (cycles == 0 || cycles > 10'000'000 || transient > 10'000'000)
        throw InputError(fmt::format("{} cycles after {} are not possible", cycles, transient),
                         "give 1 to 10000000, after at most as many");
    if (!(recurrence > 0 && recurrence < 1))
        throw InputError(fmt::format("the recurrence {} is not between 0 and 1", recurrence), "give 1e-9, say");
}

namespace {

/// Iterates the map in scaled states.
class ScaledMap {
public:
    ScaledMap(const CycleMap& map, double clearance)
        : map_(map), clearance_(clearance), scaled_(map), state_(Eigen::VectorXd::Zero(scaled_.impact.size())) {}

    const Eigen::VectorXd& state() const { return state_; }
    /// Advances by one cycle. @return approach speed or depth of its contact, 0 without one
    double step() {
        const double depth = std::max(0.0, -(clearance_ + scaled_.gradient.dot(state_)));
        state_ += scaled_.impact * map_.contact.by_depth(depth);
        state_ = (scaled_.matrix * state_).eval();
        return map_.contact.order == MapOrder::three_halves ? depth : std::sqrt(2 * map_.contact.acceleration * depth);
    }

private:
    const CycleMap& map_;
    double clearance_;
    ScaledCycleMap scaled_;
    Eigen::VectorXd state_;
};

/// States of the map one after the other, in one piece of memory.
class StateList {
public:
    explicit StateList(const Eigen::VectorXd& first) : size_(first.size()) { add(first); }
    void add(const Eigen::VectorXd& state) { numbers_.insert(numbers_.end(), state.begin(), state.end()); }
    Eigen::Map<const Eigen::VectorXd> operator[](std::size_t index) const {
        return {numbers_.data() + static_cast<Eigen::Index>(index) * size_, size_};
    }
    double largest() const {
        double largest = 0;
        for (const double number : numbers_)
            largest = std::max(largest, std::abs(number));
        return largest;
    }

private:
    Eigen::Index size_;
    std::vector<double> numbers_;
};

/// Asks whether to stop once in many calls, since asking may take longer than a cycle.
class Asking {
public:
    explicit Asking(const std::function<bool()>& interrupted) : interrupted_(interrupted) {}
    bool must_stop() {
        constexpr std::size_t calls = 4096;
        return interrupted_ && ++called_ % calls == 0 && interrupted_();
    }

private:
    const std::function<bool()>& interrupted_;
    std::size_t called_ = 0;
};

MapMotion interrupted_motion() {
    MapMotion motion;
    motion.interrupted = true;
    return motion;
}

} // namespace

MapMotion map_motion(const CycleMap& map, double clearance, const MapMotionOptions& options) {
    options.validate();
    if (!map.exists())
        throw InputError("there is no map to iterate: " + map.reason, "check exists() first");
    if (!std::isfinite(clearance))
        throw InputError("the clearance is not finite", "give a number, negative where contacts happen");
    ScaledMap scaled(map, clearance);
    Asking asking(options.interrupted);
    MapMotion motion;
    for (std::size_t k = 0; k < options.transient; ++k) {
        if (asking.must_stop())
            return interrupted_motion();
        scaled.step();
    }
    StateList states(scaled.state());
    std::vector<double> speeds;
    for (std::size_t k = 0; k < options.cycles; ++k) {
        if (asking.must_stop())
            return interrupted_motion();
        speeds.push_back(scaled.step());
        states.add(scaled.state());
    }
    motion.bounded = scaled.state().allFinite();
    if (!motion.bounded)
        return motion;
    const double size = states.largest();
    for (std::size_t period = 1; motion.period == 0 && 2 * period <= options.cycles; ++period) {
        bool again = true;
        for (std::size_t k = 0; again && k < period; ++k) {
            if (asking.must_stop())
                return interrupted_motion();
            again = (states[k] - states[k + period]).cwiseAbs().maxCoeff() <= options.recurrence * size;
        }
        if (again)
            motion.period = period;
    }
    const std::size_t counted = motion.period > 0 ? motion.period : options.cycles;
    for (std::size_t k = 0; k < counted; ++k) {
        motion.contacts += speeds[k] > 0 ? 1 : 0;
        motion.largest = std::max(motion.largest, speeds[k]);
    }
    return motion;
}

} // namespace graze
