#include "design/wish_maker.hpp"

#include "base/special_numbers.hpp"
#include "design/yield_score.hpp"
#include "graze/base/input_error.hpp"
#include "graze/design/reset.hpp"
#include "graze/design/trip_times.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace graze {

namespace {

std::vector<ParameterId> parameters_of(const Design& design) {
    std::vector<ParameterId> result;
    for (const DesignDimension& one : design.dimensions)
        result.push_back(one.parameter);
    return result;
}

/// Least projection of a contact on later ones, relative to the largest one. Each is normalised by the decay of the
/// leading multiplier until then: otherwise all late ones would be small for any class.
std::optional<double> least_projection(const CycleMap& map, const Verdict& verdict) {
    constexpr std::size_t looked_at = 100;
    constexpr double faintest = 1e-200; // below this, numbers lose their digits
    const double leading = map.multipliers.empty() ? 1 : std::abs(map.multipliers.front());
    double least = infinity, largest = 0, left = 1;
    for (const double one : map.projections(looked_at)) {
        if (!(left > faintest))
            break;
        least = std::min(least, one / left);
        largest = std::max(largest, std::abs(one / left));
        left *= leading;
    }
    if (!(largest > 0) || !std::isfinite(least / largest))
        return std::nullopt;
    // A contact beyond the examined cycles must not count as meeting the requirement.
    return verdict.outcome == GrazingOutcome::persists ? least / largest : std::min(least / largest, 0.0);
}

} // namespace

ValueOfDevices::ValueOfDevices(const TripPoint& trip, std::vector<ParameterId> dimensions, const Approach& approach)
    : trip_(trip), least_(approach.least), greatest_(approach.greatest), dimensions_(std::move(dimensions)),
      located_(trip_.system, trip_.point, trip_.control, dimensions_) {}

const TripPoint* ValueOfDevices::at(std::span<const double> values) {
    if (std::ranges::equal(values, last_))
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

WishMaker::WishMaker(const Design& design, const TripPoint& trip, const WishesOptions& options)
    : design_(design), trip_(trip), options_(options),
      devices_(std::make_shared<ValueOfDevices>(trip, parameters_of(design), design.approach)) {}

WishList WishMaker::make(bool hasty, double score) {
    list_ = {};
    const Orbit& orbit = trip_.point.solution.orbit;
    for (const DesignDimension& one : design_.dimensions)
        list_.dimensions.push_back({one.name, orbit.parameters[one.parameter.place()], one.least, one.greatest, 0});
    add_value();
    add_class();
    add_reset();
    add_clear();
    add_sensitivities();
    add_yield(score);
    if (hasty)
        add_time();
    return std::move(list_);
}

/// Weight of a requirement, or of one of several with the same key.
double WishMaker::importance_of(const std::string& name) const {
    for (const auto& [key, times] : wanted().importance)
        if (name == key || name.starts_with(key + "_"))
            return times;
    return 1;
}

void WishMaker::add(const std::string& name, const std::string& text, double least, double most, Value value,
                    double scale) {
    Want want{name,
              least,
              most,
              scale,
              [this, first = list_.wants.empty(), value = std::move(value)](std::span<const double> values) {
                  if (first && options_.progress) // counted once for each device
                      options_.progress(++tried_);
                  return value(values);
              },
              importance_of(name),
              text,
              ""};
    // A limit of zero gives no scale: use the trip value's.
    if (scale == 0 &&
        std::max(std::isfinite(least) ? std::abs(least) : 0, std::isfinite(most) ? std::abs(most) : 0) == 0)
        want.scale = trip_.value() != 0 ? std::abs(trip_.value()) : 1;
    list_.wants.push_back(std::move(want));
}

/// Adds a requirement on a value without a gradient.
void WishMaker::add_of_device(const std::string& name, const std::string& text, double least, double most, double scale,
                              std::function<std::optional<double>(const TripPoint&)> value) {
    add(
        name, text, least, most,
        [devices = devices_, text, value = std::move(value)](std::span<const double> values) {
            WantedValue result;
            if (const TripPoint* device = devices->at(values))
                result.value = value(*device);
            else
                result.problem = devices->problem();
            if (!result.value && result.problem.empty())
                result.problem = text + " of the device is not known";
            return result;
        },
        scale);
}

void WishMaker::add_value() {
    if (!wanted().value && !wanted().least)
        return;
    add("value", "the trip value", wanted().value ? *wanted().value : *wanted().least,
        wanted().value ? *wanted().value : *wanted().greatest,
        [devices = devices_](std::span<const double> values) { return devices->value_at(values); });
}

/// Adds the class: whether contacts lead to others, by the least projection.
void WishMaker::add_class() {
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
    constexpr double margin = 1e-3; // relative to the largest projection: keeps off the boundary itself
    const bool trips = outcome == GrazingOutcome::lost;
    add_of_device("class", "the class", trips ? -infinity : margin, trips ? -margin : infinity, 1,
                  [](const TripPoint& device) -> std::optional<double> {
                      const TripClass found = class_at(device);
                      if (!found.map || !found.map->exists())
                          return std::nullopt;
                      return least_projection(*found.map, found.verdict);
                  });
    list_.wants.back().limits =
        fmt::format("'{}', which is {} here,", class_name(outcome), trips ? "below 0" : "above 0");
}

void WishMaker::add_time() {
    if (!wanted().longest_time)
        return;
    TripRequest request = design_.trip;
    request.overshoots = {*wanted().overshoot};
    add_of_device("trip_time", "the trip time", -infinity, *wanted().longest_time, 0,
                  [request, interrupted = options_.interrupted](const TripPoint& device) -> std::optional<double> {
                      const TripTimes times =
                          trip_times(device, device.point.solution.orbit, class_at(device), request, interrupted);
                      const TripTime* best = times.rows.empty() ? nullptr : times.rows.front().best();
                      return best ? std::optional(best->time) : std::nullopt;
                  });
}

void WishMaker::add_reset() {
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
    add("reset", "the reset value", *wanted().least_reset, *wanted().greatest_reset,
        [resets](std::span<const double> values) { return resets->value_at(values); });
}

/// Adds the distance from each earlier point that changes the motion and can be continued.
void WishMaker::add_clear() {
    if (!wanted().clear)
        return;
    for (const EarlierPoint& earlier : trip_.earlier) {
        if (!earlier.changes || !kind_of(earlier.type).may_be_kept)
            continue;
        TripPoint other = trip_;
        other.point = earlier.point;
        auto others = std::make_shared<ValueOfDevices>(other, parameters_of(design_));
        const double sign = earlier.value > trip_.value() ? -1 : 1;
        add(fmt::format("clear_{}", earlier.label), "the distance from " + earlier.label, *wanted().clear, infinity,
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

void WishMaker::add_sensitivities() {
    const std::vector<std::string> names = trip_.system.model().independent_parameters();
    for (const auto& one : wanted().sensitivities) {
        const ParameterId parameter = one.first;
        add_of_device("sensitivity_" + names[parameter.place()],
                      fmt::format("the sensitivity to '{}'", names[parameter.place()]), -one.second, one.second, 0,
                      [parameter](const TripPoint& device) -> std::optional<double> {
                          const LocatedValue located(device.system, device.point, device.control, {parameter});
                          return located.value() != 0
                                     ? std::optional(located.derivatives()[0] * located.values()[0] / located.value())
                                     : std::nullopt;
                      });
        list_.wants.back().limits = fmt::format("at most {:.6g} percent for one", one.second);
    }
}

/// Adds the yield by derivatives: a score of the trip value within its limits, for devices made with the tolerances.
void WishMaker::add_yield(double score) {
    if (!wanted().least_yield)
        return;
    const auto scored = [this](std::span<const double> values) {
        WantedValue result;
        const TripPoint* device = devices_->at(values);
        if (!device) {
            result.problem = devices_->problem();
            return result;
        }
        constexpr double faintest = 1e-12; // relative to the trip value: smallest deviation
        double deviation = faintest * std::abs(device->value());
        for (std::size_t i = 0; i < design_.dimensions.size(); ++i)
            if (const DesignDimension& one = design_.dimensions[i]; one.tolerance)
                deviation = std::hypot(deviation, devices_->gradient()[i] *
                                                      one.tolerance->at(one.parameter, values[i]).deviation());
        result.value = yield_score(*design_.least_usable(), *design_.greatest_usable(), device->value(), deviation);
        return result;
    };
    add("yield", "the yield", score, infinity, scored, 1);
    list_.wants.back().limits = fmt::format("at least {:.6g}", *wanted().least_yield);
}

} // namespace graze
