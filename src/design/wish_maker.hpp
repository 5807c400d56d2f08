#pragma once

#include "design/value_of_devices.hpp"
#include "graze/design/wishes.hpp"

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace graze {

/// Makes the list of what a design wants, whose functions it must outlive.
class WishMaker {
public:
    WishMaker(const Design& design, const TripPoint& trip, const WishesOptions& options);

    /// A device, if there is such a one; until another is asked for.
    const TripPoint* device_of(const std::vector<double>& values) { return devices_->at(values); }
    /// The trip value of a device, if it has one.
    std::optional<double> value_of(const std::vector<double>& values) { return devices_->value_at(values).value; }

    /// @param hasty with the trip time, which jumps from cycle to cycle: nothing that a solver likes
    /// @param score of the yield by derivatives that is asked for
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
