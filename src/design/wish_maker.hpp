#pragma once

#include "graze/design/wishes.hpp"

#include <functional>
#include <memory>
#include <optional>
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

/// Makes the list of requirements of a design. It must outlive the list's functions.
class WishMaker {
public:
    WishMaker(const Design& design, const TripPoint& trip, const WishesOptions& options);

    /// Returns a device, or null; valid until the next one is requested.
    const TripPoint* device_of(const std::vector<double>& values) { return devices_->at(values); }
    /// Returns the trip value of a device, if it has one.
    std::optional<double> value_of(const std::vector<double>& values) { return devices_->value_at(values).value; }

    /// @param hasty whether to include the trip time, which is discontinuous and unsuitable for the solver
    /// @param score required score of the yield by derivatives
    WishList make(bool hasty, double score);

private:
    using Value = std::function<WantedValue(std::span<const double> values)>;
    const Wanted& wanted() const { return design_.wanted; }
    double importance_of(const std::string& name) const;
    void add(const std::string& name, const std::string& text, double least, double most, Value value,
             double scale = 0);
    void add_of_device(const std::string& name, const std::string& text, double least, double most, double scale,
                       std::function<std::optional<double>(const TripPoint&)> value);
    void add_value();
    void add_class();
    void add_time();
    void add_reset();
    void add_clear();
    void add_sensitivities();
    void add_yield(double score);

    const Design& design_;
    const TripPoint& trip_;
    const WishesOptions& options_;
    std::shared_ptr<ValueOfDevices> devices_;
    WishList list_;
    std::size_t tried_ = 0;
};

} // namespace graze
