#include "graze/design/wishes.hpp"

#include "graze/branch/located_value.hpp"
#include "graze/design/reset.hpp"
#include "graze/design/trip_times.hpp"
#include "graze/symbolic/input_error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <span>

namespace graze {

namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

std::vector<ParameterId> parameters_of(const Design& design) {
    std::vector<ParameterId> result;
    for (const DesignDimension& one : design.dimensions)
        result.push_back(one.parameter);
    return result;
}

/// A point's value of the control parameter as a function of the dimensions, with exact gradients: the last device that
/// was asked for is remembered, since several wants ask for the same.
class ValueOfDevices {
public:
    /// @param approach beyond whose range no device is looked for
    ValueOfDevices(const TripPoint& trip, std::vector<ParameterId> dimensions, const Approach& approach = {})
        : trip_(trip), least_(approach.least), greatest_(approach.greatest), dimensions_(std::move(dimensions)),
          located_(trip_.system, trip_.point, trip_.control, dimensions_) {}

    /// @return none where there is no such device; `problem` says why
    const TripPoint* at(std::span<const double> values) {
        if (std::equal(values.begin(), values.end(), last_.begin(), last_.end()))
            return device_.get();
        last_.assign(values.begin(), values.end());
        device_.reset();
        gradient_.clear();
        const LocatedSolution solution = located_(values);
        problem_ = solution.problem;
        if (!solution.found || !solution.admissible)
            return nullptr;
        // The finished device has to come from rest to its trip point within the approach's range.
        const double value = solution.orbit.parameters[trip_.control.place()];
        if (least_ < greatest_ && !(value >= least_ && value <= greatest_)) {
            problem_ = fmt::format("it trips at {:.6g}, outside of approach.range", value);
            return nullptr;
        }
        device_ = std::make_unique<TripPoint>(moved_to(trip_, solution.orbit));
        return device_.get();
    }
    const std::string& problem() const { return problem_; }
    /// Of the device asked for last.
    const std::vector<double>& gradient() {
        if (gradient_.empty() && device_)
            gradient_ = LocatedValue(device_->system, device_->point, device_->control, dimensions_).derivatives();
        return gradient_;
    }
    WantedValue value_at(std::span<const double> values) {
        WantedValue result;
        if (const TripPoint* device = at(values)) {
            result.value = device->value();
            result.gradient = gradient();
        } else {
            result.problem = problem_;
        }
        return result;
    }

private:
    TripPoint trip_;
    double least_, greatest_; ///< alike: anywhere
    std::vector<ParameterId> dimensions_;
    LocatedValue located_;
    std::vector<double> last_, gradient_;
    std::unique_ptr<TripPoint> device_;
    std::string problem_;
};

/// The least projection of a contact on what comes after it, in units of the largest one. Each is measured by what the
/// leading multiplier leaves of an effect until then: else all late ones would be small, whatever the class.
std::optional<double> least_projection(const CycleMap& map, const Verdict& verdict) {
    constexpr std::size_t looked_at = 100;
    constexpr double faintest = 1e-200; // below which numbers lose their digits
    const double leading = map.multipliers.empty() ? 1 : std::abs(map.multipliers.front());
    double least = infinite, largest = 0, left = 1;
    for (const double one : map.projections(looked_at)) {
        if (!(left > faintest))
            break;
        least = std::min(least, one / left);
        largest = std::max(largest, std::abs(one / left));
        left *= leading;
    }
    if (!(largest > 0) || !std::isfinite(least / largest))
        return std::nullopt;
    // A contact that comes later still is no want that is met.
    return verdict.outcome == GrazingOutcome::persists ? least / largest : std::min(least / largest, 0.0);
}

/// Makes the list.
class WishMaker {
public:
    WishMaker(const Design& design, const TripPoint& trip, const WishesOptions& options)
        : design_(design), trip_(trip), options_(options),
          devices_(std::make_shared<ValueOfDevices>(trip, parameters_of(design), design.approach)) {}

    /// The trip value of a device, if it has one.
    std::optional<double> value_of(const std::vector<double>& values) { return devices_->value_at(values).value; }

    /// @param hasty with the trip time, which jumps from cycle to cycle: nothing that a solver likes
    WishList make(bool hasty) {
        list_ = {};
        const Orbit& orbit = trip_.point.solution.orbit;
        for (const DesignDimension& one : design_.dimensions)
            list_.dimensions.push_back({one.name, orbit.parameters[one.parameter.place()], one.least, one.greatest, 0});
        add_value();
        add_class();
        add_reset();
        add_clear();
        add_sensitivities();
        if (hasty)
            add_time();
        return std::move(list_);
    }

private:
    const Wanted& wanted() const { return design_.wanted; }

    void add(const std::string& name, double least, double most,
             std::function<WantedValue(std::span<const double>)> value, double scale = 0) {
        list_.wants.push_back(
            {name, least, most, scale, [this, value = std::move(value)](std::span<const double> values) {
                 if (options_.progress)
                     options_.progress(++tried_);
                 return value(values);
             }});
    }

    /// A value of a device that has one, without a gradient.
    void add_of_device(const std::string& name, double least, double most, double scale,
                       std::function<std::optional<double>(const TripPoint&)> value) {
        add(
            name, least, most,
            [devices = devices_, value = std::move(value)](std::span<const double> values) {
                WantedValue result;
                if (const TripPoint* device = devices->at(values))
                    result.value = value(*device);
                else
                    result.problem = devices->problem();
                if (!result.value && result.problem.empty())
                    result.problem = "the device has no such value";
                return result;
            },
            scale);
    }

    void add_value() {
        if (!wanted().value && !wanted().least)
            return;
        add("value", wanted().value ? *wanted().value : *wanted().least,
            wanted().value ? *wanted().value : *wanted().greatest,
            [devices = devices_](std::span<const double> values) { return devices->value_at(values); });
    }

    /// Which contacts lead to others: the least projection decides.
    void add_class() {
        if (!wanted().outcome)
            return;
        const GrazingOutcome outcome = *wanted().outcome;
        if (outcome == GrazingOutcome::folds || !trip_.is_touch()) {
            if (class_at(trip_).outcome != outcome)
                throw InputError(design_.approach.place,
                                 fmt::format("the device {} at its trip point, and no dimension changes that into '{}'",
                                             class_name(class_at(trip_).outcome), class_name(outcome)),
                                 "want another class, or another trip point");
            return;
        }
        constexpr double margin = 1e-3; // of the largest projection, so that the boundary itself is not met
        const bool trips = outcome == GrazingOutcome::lost;
        add_of_device("class", trips ? -infinite : margin, trips ? -margin : infinite, 1,
                      [](const TripPoint& device) -> std::optional<double> {
                          const TripClass found = class_at(device);
                          if (!found.map || !found.map->exists())
                              return std::nullopt;
                          return least_projection(*found.map, found.verdict);
                      });
    }

    void add_time() {
        if (!wanted().longest_time)
            return;
        TripRequest request = design_.trip;
        request.overshoots = {*wanted().overshoot};
        add_of_device("trip_time", -infinite, *wanted().longest_time, 0,
                      [request, interrupted = options_.interrupted](const TripPoint& device) -> std::optional<double> {
                          const TripTimes times =
                              trip_times(device, device.point.solution.orbit, class_at(device), request, interrupted);
                          const TripTime* best = times.rows.empty() ? nullptr : times.rows.front().best();
                          return best ? std::optional(best->time) : std::nullopt;
                      });
    }

    void add_reset() {
        if (!wanted().least_reset)
            return;
        const std::vector<double> overshoots = overshoots_of(design_.trip, trip_.value(), class_at(trip_).verdict.side);
        ResetOptions way;
        way.overshoot = overshoots.front();
        way.least = design_.approach.least < trip_.value() ? design_.approach.least : 0;
        way.interrupted = options_.interrupted;
        const Reset reset = reset_of(trip_, trip_.point.solution.orbit, way);
        if (!reset.point)
            throw InputError(wanted().reset_place,
                             fmt::format("a reset value is wanted, and there is none to follow: {}",
                                         !reset.reason.empty() ? reset.reason
                                         : reset.lost_at ? "it is known by simulation alone, and cannot be designed for"
                                                         : "the tripped motion is lost by a " + reset.how),
                             "leave `reset` out of what is wanted");
        TripPoint back = trip_;
        back.point = *reset.point;
        auto resets = std::make_shared<ValueOfDevices>(back, parameters_of(design_));
        add("reset", *wanted().least_reset, *wanted().greatest_reset,
            [resets](std::span<const double> values) { return resets->value_at(values); });
    }

    /// The distance from each earlier point that changes the motion and whose value can be followed.
    void add_clear() {
        if (!wanted().clear)
            return;
        for (const EarlierPoint& earlier : trip_.earlier) {
            if (!earlier.changes || !kind_of(earlier.type).may_be_kept)
                continue;
            TripPoint other = trip_;
            other.point = earlier.point;
            auto others = std::make_shared<ValueOfDevices>(other, parameters_of(design_));
            const double sign = earlier.value > trip_.value() ? -1 : 1;
            add(fmt::format("clear_{}", earlier.label), *wanted().clear, infinite,
                [devices = devices_, others, sign](std::span<const double> values) {
                    WantedValue here = devices->value_at(values);
                    const WantedValue there = others->value_at(values);
                    if (!here.value || !there.value)
                        return here.value ? there : here;
                    *here.value = sign * (*here.value - *there.value);
                    for (std::size_t i = 0; i < here.gradient.size(); ++i)
                        here.gradient[i] = sign * (here.gradient[i] - there.gradient[i]);
                    return here;
                });
        }
    }

    void add_sensitivities() {
        const std::vector<std::string> names = trip_.system.model().independent_parameters();
        for (const auto& one : wanted().sensitivities) {
            const ParameterId parameter = one.first;
            add_of_device("sensitivity_" + names[parameter.place()], -one.second, one.second, 0,
                          [parameter](const TripPoint& device) -> std::optional<double> {
                              const LocatedValue located(device.system, device.point, device.control, {parameter});
                              return located.value() != 0 ? std::optional(located.derivatives()[0] *
                                                                          located.values()[0] / located.value())
                                                          : std::nullopt;
                          });
        }
    }

    const Design& design_;
    const TripPoint& trip_;
    const WishesOptions& options_;
    std::shared_ptr<ValueOfDevices> devices_;
    WishList list_;
    std::size_t tried_ = 0;
};

} // namespace

std::vector<double> MetWishes::values() const {
    std::vector<double> result;
    for (const FoundDimension& one : found.dimensions)
        result.push_back(one.value);
    return result;
}

MetWishes meet_wishes(const Design& design, const TripPoint& trip, const WishesOptions& options) {
    WishMaker maker(design, trip, options);
    WishOptions solver;
    solver.evaluations = options.evaluations;
    solver.interrupted = options.interrupted;
    MetWishes result;
    result.list = maker.make(false);
    result.found = design_for(result.list, solver);
    if (design.wanted.longest_time && result.found.outcome != WishOutcome::interrupted &&
        result.found.outcome != WishOutcome::nowhere) {
        WishList whole = maker.make(true);
        FoundWant time;
        const std::vector<double> found = result.values();
        time.value = whole.wants.back().value(found).value;
        time.met = time.value && *time.value <= *design.wanted.longest_time;
        if (time.value && !time.met)
            time.violation = *time.value / *design.wanted.longest_time - 1;
        // The time is looked for only where it is what is missing.
        if (!time.met && result.found.outcome == WishOutcome::met)
            result.found = design_for(whole, solver);
        else
            result.found.wants.push_back(time);
        result.list = std::move(whole);
    }
    if (result.found.outcome != WishOutcome::nowhere)
        result.trip_value = maker.value_of(result.values());
    for (Want& one : result.list.wants)
        one.value = nullptr; // they refer to what ends here
    return result;
}

Design with_values(const Design& design, const std::vector<double>& values) {
    Design result = design;
    for (std::size_t i = 0; i < values.size(); ++i) {
        const std::string& name = result.dimensions[i].name;
        result.model.set_parameter(name, values[i]);
        std::erase_if(result.set, [&](const auto& one) { return one.first == name; });
        result.set.emplace_back(name, values[i]);
    }
    return result;
}

} // namespace graze
