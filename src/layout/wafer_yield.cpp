#include "graze/layout/wafer_yield.hpp"

#include "base/turns.hpp"
#include "branch/examined_yield.hpp"
#include "graze/base/input_error.hpp"
#include "layout/wafer_examination.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

namespace graze {

namespace {

constexpr const char *drive_name = "f", *frequency_name = "f0";

/// Ratio of the drive's frequency to the natural one.
double drive_ratio(const Model& model, const DeviceFile& file) {
    const auto drive = model.find_parameter(drive_name), own = model.find_parameter(frequency_name);
    if (!drive || !own || model.parameters[*drive].expression || model.parameters[*own].expression)
        throw InputError(file.place("spread.drive"), "the model has no frequency 'f' that could be tuned",
                         "give drive = \"fixed\"");
    return *model.parameters[*drive].value / *model.parameters[*own].value;
}

LumpedModel departed(const DeviceFile& file, const DeviceDrawing& drawing, const ProcessDeparture& departure) {
    ProcessData process = file.process;
    ProcessConditions conditions = file.conditions;
    process.wafer_thickness += departure.thickness;
    conditions.bias += departure.bias;
    conditions.taper += departure.taper;
    return lumped_model_of(drawing, process, conditions, departure.stop_gap);
}

/// Simulates the devices of a process.
class WaferSimulation {
public:
    WaferSimulation(const Design& design, const DeviceFile& file, const Layout& wafer, const TripPoint& trip,
                    const WaferYieldSettings& settings)
        : design_(&design), file_(&file), wafer_(&wafer), trip_(&trip), settings_(&settings),
          model_(trip.system.model()) {
        if (file.spread.tuned)
            ratio_ = drive_ratio(design.model, file);
        for (const auto& [name, value] : parameters_of(lumped_model_of(file), model_).set)
            parameters_.push_back(model_.independent_parameter(name));
        if (ratio_)
            parameters_.push_back(model_.independent_parameter(drive_name));
    }

    WaferYield make() {
        place_sites();
        MadeDevices made{parameters_, {}};
        for (std::size_t i = 0; i < settings_->wafers; ++i)
            make_wafer(i, made);
        add_effects();
        choose_overshoot();
        YieldSettings yield;
        yield.least = design_->least_usable();
        yield.greatest = design_->greatest_usable();
        yield.jobs = settings_->jobs;
        yield.interrupted = interrupted_;
        yield.progress = turns_.taking(settings_->progress);
        yield.elsewhere = settings_->elsewhere;
        ExaminedYield solved =
            examined_yield_of(trip_->system, trip_->point, trip_->control, made, yield, examination());
        result_.yield = std::move(solved.yield);
        if (interrupted_ && interrupted_())
            result_.yield.interrupted = true;
        for (std::size_t i = 0; i < result_.devices.size(); ++i)
            tell(result_.devices[i], result_.yield.devices[i], solved.examined[i]);
        count_classes();
        return std::move(result_);
    }

private:
    void place_sites() {
        if (file_->spread.is_empty())
            throw InputError(file_->place("spread"), "nothing of the process is spread: all devices are alike",
                             "give bias, thickness, taper or stop_gap in [spread]");
        for (const double degrees : wafer_->site_degrees) {
            const double angle = degrees * std::numbers::pi / 180;
            sites_.push_back({file_->wafer.radius * std::cos(angle), file_->wafer.radius * std::sin(angle)});
        }
    }

    /// Values of the model's parameters; empty if the etch removes a part.
    std::vector<double> values_of(const LumpedModel& lumped) const {
        std::vector<double> values;
        double frequency = 0;
        for (const auto& [name, value] : parameters_of(lumped, model_).set) {
            values.push_back(value);
            if (name == frequency_name)
                frequency = value;
        }
        if (ratio_)
            values.push_back(*ratio_ * frequency);
        return values;
    }

    void make_wafer(std::size_t number, MadeDevices& made) {
        const std::vector<ProcessDeparture> departures =
            departures_of(file_->spread, sites_, file_->wafer.diameter / 2, settings_->seed, number);
        for (std::size_t site = 0; site < sites_.size(); ++site) {
            WaferDevice device;
            device.wafer = number + 1;
            device.site = site + 1;
            device.place = sites_[site];
            device.departure = departures[site];
            made.values.emplace_back();
            try {
                device.lumped = departed(*file_, drawing_at(site), device.departure);
                made.values.back() = values_of(*device.lumped);
            } catch (const InputError& error) {
                device.problem = error.problem();
            }
            result_.devices.push_back(std::move(device));
        }
    }

    const DeviceDrawing& drawing_at(std::size_t site) const { return wafer_->devices[wafer_->sites[site]].drawing; }

    /// Adds the linear effects: exact derivatives of the trip value by the model's parameters, times differences of
    /// these by the process.
    void add_effects() {
        const LocatedValue located(trip_->system, trip_->point, trip_->control, parameters_);
        const DeviceDrawing nominal = draw_device(*file_);
        constexpr double step = 1e-3; // um or degrees: numbers of the process are of order one; relative error 1e-6
        for (const DepartureField& field : departure_fields()) {
            const SpreadParts& parts = file_->spread.*field.spread;
            ProcessDeparture less, more;
            less.*field.departure = -step;
            more.*field.departure = step;
            const std::vector<double> below = values_of(departed(*file_, nominal, less)),
                                      above = values_of(departed(*file_, nominal, more));
            SpreadEffect effect{field.name, field.unit, std::hypot(parts.wafer, parts.device), 0, 0};
            for (std::size_t k = 0; k < below.size(); ++k)
                effect.derivative += located.derivatives()[k] * (above[k] - below[k]) / (2 * step);
            effect.effect = effect.derivative * effect.deviation;
            result_.linear_deviation = std::hypot(result_.linear_deviation, effect.effect);
            result_.effects.push_back(std::move(effect));
        }
    }

    /// Chooses the overshoot of the required trip time, or else the largest requested one.
    void choose_overshoot() {
        if (design_->wanted.overshoot)
            result_.overshoot = design_->wanted.overshoot;
        else if (!design_->trip.overshoots.empty())
            result_.overshoot = *std::max_element(design_->trip.overshoots.begin(), design_->trip.overshoots.end());
    }

    /// Each device is classified, and its trip time is computed.
    DeviceExamination examination() const {
        TripRequest request = design_->trip;
        request.overshoots.clear();
        if (result_.overshoot)
            request.overshoots.push_back(*result_.overshoot);
        return wafer_examination_of(trip_->system, trip_->point, trip_->control,
                                    wafer_request(trip_->fold_side, request));
    }

    static void tell(WaferDevice& device, const Device& solved, const std::string& examined) {
        device.outcome = solved.outcome;
        device.value = solved.value;
        if (solved.outcome != DeviceOutcome::found)
            return;
        const ExaminedWaferDevice found = read_examined(examined);
        device.found = found.found;
        device.trip_time = found.trip_time;
    }

    void count_classes() {
        for (const WaferDevice& device : result_.devices) {
            if (device.outcome != DeviceOutcome::found)
                continue;
            auto& classes = result_.classes;
            const auto known = std::find_if(classes.begin(), classes.end(),
                                            [&](const auto& one) { return one.first == device.found; });
            if (known == classes.end())
                classes.emplace_back(device.found, 1);
            else
                ++known->second;
        }
    }

    const Design* design_;
    const DeviceFile* file_;
    const Layout* wafer_;
    const TripPoint* trip_;
    const WaferYieldSettings* settings_;
    Turns turns_;
    std::function<bool()> interrupted_ = turns_.asking(settings_->interrupted);
    Model model_;
    std::optional<double> ratio_;
    std::vector<ParameterId> parameters_;
    std::vector<SitePlace> sites_;
    WaferYield result_;
};

} // namespace

Design design_of_device(const Design& design, const DeviceFile& file) {
    Design result = design;
    result.dimensions.clear(); // this device has no free dimensions
    result.planes.clear();
    result.adjustable.reset();
    const auto set = [&](const std::string& name, double value) {
        result.model.set_parameter(name, value);
        std::erase_if(result.set, [&](const auto& one) { return one.first == name; });
        result.set.emplace_back(name, value);
    };
    const ParameterFile parameters = parameters_of(lumped_model_of(file), design.model);
    for (const auto& [name, value] : parameters.set) {
        if (name == frequency_name && file.spread.tuned)
            set(drive_name, drive_ratio(design.model, file) * value);
        set(name, value);
    }
    return result;
}

WaferYield wafer_yield_of(const Design& design, const DeviceFile& file, const Layout& wafer, const TripPoint& trip,
                          const WaferYieldSettings& settings) {
    constexpr std::size_t most = 100'000;
    if (settings.wafers == 0 || settings.wafers > most)
        throw InputError(fmt::format("{} wafers are out of range", settings.wafers),
                         fmt::format("choose from 1 to {}", most));
    return WaferSimulation(design, file, wafer, trip, settings).make();
}

} // namespace graze
