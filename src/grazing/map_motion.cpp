#include "graze/grazing/map_motion.hpp"

#include "graze/base/input_error.hpp"
#include "grazing/return_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
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

} // namespace

MapMotion map_motion(const CycleMap& map, double clearance, const MapMotionOptions& options) {
    options.validate();
    if (!map.exists())
        throw InputError("there is no map to iterate: " + map.reason, "check exists() first");
    if (!std::isfinite(clearance))
        throw InputError("the clearance is not finite", "give a number, negative where contacts happen");
    ScaledMap scaled(map, clearance);
    MapMotion motion;
    for (std::size_t k = 0; k < options.transient; ++k)
        scaled.step();
    std::vector<Eigen::VectorXd> states{scaled.state()};
    std::vector<double> speeds;
    for (std::size_t k = 0; k < options.cycles; ++k) {
        speeds.push_back(scaled.step());
        states.push_back(scaled.state());
    }
    motion.bounded = states.back().allFinite();
    if (!motion.bounded)
        return motion;
    double size = 0;
    for (const Eigen::VectorXd& state : states)
        size = std::max(size, state.cwiseAbs().maxCoeff());
    for (std::size_t period = 1; motion.period == 0 && 2 * period <= options.cycles; ++period) {
        bool again = true;
        for (std::size_t k = 0; again && k < period; ++k)
            again = (states[k] - states[k + period]).cwiseAbs().maxCoeff() <= options.recurrence * size;
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
