#include "design/value_of_devices.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace graze {

ValueOfDevices::ValueOfDevices(const TripPoint& trip, std::vector<ParameterId> dimensions, const Approach& approach)
    : trip_(trip), least_(approach.least), greatest_(approach.greatest), dimensions_(std::move(dimensions)),
      located_(trip_.system, trip_.point, trip_.control, dimensions_) {}

const TripPoint* ValueOfDevices::at(std::span<const double> values) {
    if (std::equal(values.begin(), values.end(), last_.begin(), last_.end()))
        return device_.get();
    last_.assign(values.begin(), values.end());
    device_.reset();
    gradient_.clear();
    const LocatedSolution solution = located_(values);
    problem_ = solution.problem;
    if (!solution.found || !solution.admissible)
        return nullptr;
    // The finished device must reach its trip point within the approach's range.
    const double value = solution.orbit.parameters[trip_.control.place()];
    if (least_ < greatest_ && !(value >= least_ && value <= greatest_)) {
        problem_ = fmt::format("it trips at {:.6g}, outside of approach.range, {:.6g} to {:.6g}: widen it", value,
                               least_, greatest_);
        return nullptr;
    }
    device_ = std::make_unique<TripPoint>(moved_to(trip_, solution.orbit));
    return device_.get();
}

const std::vector<double>& ValueOfDevices::gradient() {
    if (gradient_.empty() && device_)
        gradient_ = LocatedValue(device_->system, device_->point, device_->control, dimensions_).derivatives();
    return gradient_;
}

WantedValue ValueOfDevices::value_at(std::span<const double> values) {
    WantedValue result;
    if (const TripPoint* device = at(values)) {
        result.value = device->value();
        result.gradient = gradient();
    } else {
        result.problem = problem_;
    }
    return result;
}

} // namespace graze
