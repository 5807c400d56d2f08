#include "graze/design/design_report.hpp"

#include "design/yield_score.hpp"
#include "graze/base/input_error.hpp"
#include "graze/base/with_place.hpp"
#include "graze/results/orbit_motion.hpp"
#include "graze/study/runner.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace graze {

namespace {

/// Computes the runs that lead to the trip point, or reuses those in the file. @return whether they are complete
bool follow(const Study& study, ResultFile& file, const DesignReportOptions& options) {
    RunnerOptions running;
    running.jobs = options.jobs;
    running.interrupted = options.interrupted;
    if (options.progress)
        running.orbit = [&](const std::string& run, const OrbitRecord& record) {
            options.progress(fmt::format("run '{}': orbit {}", run, record.number));
        };
    const std::vector<RunReport> reports = run_study(study, file, running);
    return std::ranges::none_of(reports,
                                [](const RunReport& report) { return report.outcome == RunOutcome::interrupted; });
}

/// Computes the parts of the report in turn, and reports progress.
class Reporter {
public:
    Reporter(const Design& design, const TripPoint& trip, const DesignReportOptions& options)
        : design_(design), trip_(trip), options_(options), orbit_(trip.point.solution.orbit) {}

    DesignReport make() {
        add_sensitivities();
        report_.found = class_at(trip_);
        part("trip times",
             [&] { report_.times = trip_times(trip_, orbit_, report_.found, design_.trip, options_.interrupted); });
        part("the way back", [&] { add_reset(); });
        part("trial", [&] {
            DeviceTrialOptions trial;
            trial.interrupted = options_.interrupted;
            report_.trial = try_device(trip_, orbit_, report_.found, design_.trip, trial);
        });
        for (std::size_t i = 0; i < design_.dimensions.size(); ++i)
            part("curve of " + design_.dimensions[i].name, [&] {
                report_.curves.push_back(
                    {i, value_curve(trip_, design_.dimensions[i], settings(design_.curve_points))});
            });
        for (const auto& plane : design_.planes) {
            const DesignDimension &x = design_.dimensions[plane.first], &y = design_.dimensions[plane.second];
            part(fmt::format("plane of {} and {}", x.name, y.name), [&] {
                report_.planes.push_back(
                    {plane.first, plane.second, value_plane(trip_, x, y, settings(design_.plane_points))});
            });
        }
        if (design_.adjustable)
            part("tuning", [&] { add_tuning(); });
        part("devices", [&] { add_yield(); });
        return std::move(report_);
    }

private:
    template <class Work>
    void part(const std::string& what, const Work& work) {
        if (options_.interrupted && options_.interrupted())
            report_.interrupted = true;
        if (report_.interrupted)
            return;
        doing_ = what;
        if (options_.progress)
            options_.progress(what);
        work();
        if (options_.interrupted && options_.interrupted())
            report_.interrupted = true;
    }

    MapSettings settings(std::size_t points) const {
        MapSettings result;
        result.points = points;
        result.jobs = options_.jobs;
        result.interrupted = options_.interrupted;
        if (options_.progress)
            result.progress = [this](std::size_t done) {
                options_.progress(fmt::format("{}: point {}", doing_, done));
            };
        return result;
    }

    void add_sensitivities() {
        const Model& model = trip_.system.model();
        const LocatedValue located(trip_.system, trip_.point, trip_.control, parameters_but(model, trip_.control));
        report_.value = located.value();
        const std::vector<std::string> names = model.independent_parameters();
        for (std::size_t i = 0; i < located.others().size(); ++i) {
            Sensitivity one;
            one.parameter = located.others()[i];
            one.name = names[one.parameter.place()];
            one.unit = model.parameter_unit(one.name);
            one.value = located.values()[i];
            one.derivative = located.derivatives()[i];
            if (located.value() != 0)
                one.relative = one.derivative * one.value / located.value();
            report_.sensitivities.push_back(one);
        }
    }

    /// From an overshoot at which the device has surely tripped, back to the beginning of the approach.
    void add_reset() {
        if (report_.found.outcome == GrazingOutcome::persists) {
            report_.reset.reason = "the device does not trip: contacts cease where they have begun";
            return;
        }
        if (trip_.is_touch() && report_.found.outcome == GrazingOutcome::folds) {
            report_.reset.reason = "the orbit goes on beyond the touch: it does not trip there";
            return;
        }
        const std::vector<double> overshoots = overshoots_of(design_.trip, report_.value, report_.found.verdict.side);
        ResetOptions options;
        options.overshoot =
            *std::ranges::max_element(overshoots, [](double a, double b) { return std::abs(a) < std::abs(b); });
        // Down to the start of the approach, or to 0 if that is above the trip value.
        options.least = design_.approach.least < report_.value ? design_.approach.least : 0;
        options.interrupted = options_.interrupted;
        report_.reset = reset_of(trip_, orbit_, options);
    }

    void add_tuning() {
        try {
            report_.tuning =
                tuning_curve(trip_, design_.dimensions[*design_.adjustable], settings(design_.curve_points));
        } catch (const InputError& error) {
            report_.no_tuning = error.problem();
        }
    }

    void add_yield() {
        YieldSettings& settings = report_.yield_settings;
        settings = yield_settings_of(design_, orbit_);
        if (settings.tolerances.empty()) {
            report_.no_yield = "no dimension has a tolerance";
            return;
        }
        settings.jobs = options_.jobs;
        settings.elsewhere = options_.elsewhere;
        settings.interrupted = options_.interrupted;
        if (options_.progress)
            settings.progress = [this](std::size_t devices) {
                options_.progress(fmt::format("device {} of {}", devices, design_.yield.devices));
            };
        report_.yield = yield_of(trip_.system, trip_.point, trip_.control, settings);
        report_.interrupted = report_.yield->interrupted;
    }

    const Design& design_;
    const TripPoint& trip_;
    const DesignReportOptions& options_;
    const Orbit& orbit_;
    DesignReport report_;
    std::string doing_;
};

} // namespace

std::optional<TripPoint> locate_trip(const Design& design, const std::string& path,
                                     const DesignReportOptions& options) {
    const Study study = approach_study(design);
    ResultFile file(path, ResultFile::Access::write);
    if (!follow(study, file, options))
        return std::nullopt;
    return with_place(design.approach.place, [&] { return find_trip_point(design, study, file); });
}

DesignReport report_of(const Design& design, const TripPoint& trip, const DesignReportOptions& options) {
    return Reporter(design, trip, options).make();
}

Model model_of_device(const TripPoint& trip) {
    const Orbit whole = whole_orbit(trip.system, trip.point.solution.orbit);
    Model model = model_at(trip.system.model(), whole);
    for (std::size_t i = 0; i < model.states.size(); ++i)
        model.set_initial(model.states[i].name, whole.starts.front()[i]);
    model.set_initial_mode(model.modes[whole.signature.front().mode].name);
    return model;
}

} // namespace graze
