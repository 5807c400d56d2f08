#include "graze/design/finished_design.hpp"

#include "graze/base/with_place.hpp"

#include <fmt/format.h>

#include <cmath>

namespace graze {

namespace {

MetWishes device_for_wishes(const Design& design, const TripPoint& trip, const DesignReportOptions& options) {
    WishesOptions wishes;
    wishes.jobs = options.jobs;
    wishes.elsewhere = options.elsewhere;
    wishes.interrupted = options.interrupted;
    if (options.progress)
        wishes.progress = [&](std::size_t devices) {
            options.progress(fmt::format("{} devices tried for what is wanted", devices));
        };
    return with_place(design.approach.place, [&] { return meet_wishes(design, trip, wishes); });
}

} // namespace

bool FinishedDesign::trips_elsewhere() const {
    constexpr double alike = 1e-6; // far above the difference between two solutions of the same problem
    return trip && report.wishes && report.wishes->trip_value &&
           !(std::abs(*report.wishes->trip_value - trip->value()) <= alike * std::abs(trip->value()));
}

bool FinishedDesign::is_untried() const {
    return report.trial.outcome == TrialOutcome::undecided && report.found.outcome != GrazingOutcome::undecided;
}

std::vector<std::string> FinishedDesign::warnings() const {
    std::vector<std::string> all;
    const auto& wanted = device.wanted.outcome;
    if (wanted && report.found.outcome != *wanted)
        all.push_back(
            fmt::format("the class is {}, and {} is wanted", class_name(report.found.outcome), class_name(*wanted)));
    if (report.trial.outcome == TrialOutcome::contradicted)
        all.push_back(fmt::format("simulation contradicts the class: below {}, above {}", report.trial.seen_below,
                                  report.trial.seen_above));
    if (is_untried())
        all.push_back("the class is not checked by simulation: " + report.trial.reason);
    if (report.yield && report.yield->failed > 0)
        all.push_back(
            fmt::format("{} of {} devices trip at no value that was found", report.yield->failed, report.yield->made));
    if (report.wishes && report.wishes->found.outcome != WishOutcome::met)
        all.push_back(
            fmt::format("what is wanted: {}; {}", name_of(report.wishes->found.outcome), report.wishes->found.reason));
    if (trips_elsewhere())
        all.emplace_back("on its way to the trip point for which it was made, the device comes first to another one: "
                         "change approach.range, approach.from or what is wanted");
    return all;
}

FinishedDesign finish_design(const Design& design, const DesignFiles& files, const DesignReportOptions& options) {
    FinishedDesign finished{design, design, locate_trip(design, files.written, options), {}, false};
    std::optional<MetWishes> wishes;
    if (finished.trip && !design.wanted.is_empty()) {
        wishes = device_for_wishes(design, *finished.trip, options);
        if (wishes->found.outcome == WishOutcome::interrupted) {
            finished.interrupted = true;
            return finished;
        }
        if (wishes->found.outcome != WishOutcome::nowhere) {
            // Follow the finished device from the start too: it may trip earlier, at another point.
            finished.device = with_values(design, wishes->values());
            finished.trip = locate_trip(finished.device, files.device(), options);
        }
    }
    if (finished.trip) {
        finished.report =
            with_place(design.approach.place, [&] { return report_of(finished.device, *finished.trip, options); });
        finished.report.wishes = std::move(wishes);
    }
    finished.interrupted = !finished.trip || finished.report.interrupted;
    return finished;
}

} // namespace graze
