#pragma once

#include "graze/branch/located_value.hpp"
#include "graze/design/trip_point.hpp"
#include "graze/design/wish_list.hpp"

#include <memory>
#include <span>
#include <string>
#include <vector>

namespace graze {

/// Value of the control parameter at a point, as a function of the dimensions, with exact gradients. The last device is
/// cached, since several requirements use it.
class ValueOfDevices {
public:
    /// @param approach its range limits the devices
    ValueOfDevices(const TripPoint& trip, std::vector<ParameterId> dimensions, const Approach& approach = {});

    /// @return null if there is no such device; `problem` says why
    const TripPoint* at(std::span<const double> values);
    const std::string& problem() const { return problem_; }
    /// Gradient at the last device.
    const std::vector<double>& gradient();
    WantedValue value_at(std::span<const double> values);

private:
    TripPoint trip_;
    double least_, greatest_; ///< equal: no limits
    std::vector<ParameterId> dimensions_;
    LocatedValue located_;
    std::vector<double> last_, gradient_;
    std::unique_ptr<TripPoint> device_;
    std::string problem_;
};

} // namespace graze
