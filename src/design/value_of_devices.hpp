#pragma once

#include "graze/branch/located_value.hpp"
#include "graze/design/trip_point.hpp"
#include "graze/design/wish_list.hpp"

#include <memory>
#include <span>
#include <string>
#include <vector>

namespace graze {

/// A point's value of the control parameter as a function of the dimensions, with exact gradients: the last device that
/// was asked for is remembered, since several wants ask for the same.
class ValueOfDevices {
public:
    /// @param approach beyond whose range no device is looked for
    ValueOfDevices(const TripPoint& trip, std::vector<ParameterId> dimensions, const Approach& approach = {});

    /// @return none where there is no such device; `problem` says why
    const TripPoint* at(std::span<const double> values);
    const std::string& problem() const { return problem_; }
    /// Of the device asked for last.
    const std::vector<double>& gradient();
    WantedValue value_at(std::span<const double> values);

private:
    TripPoint trip_;
    double least_, greatest_; ///< alike: anywhere
    std::vector<ParameterId> dimensions_;
    LocatedValue located_;
    std::vector<double> last_, gradient_;
    std::unique_ptr<TripPoint> device_;
    std::string problem_;
};

} // namespace graze
