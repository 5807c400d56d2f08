#include "graze/design/trip_location.hpp"

#include "graze/base/with_place.hpp"
#include "graze/study/runner.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

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
    return std::none_of(reports.begin(), reports.end(),
                        [](const RunReport& report) { return report.outcome == RunOutcome::interrupted; });
}

} // namespace

std::optional<TripPoint> locate_trip(const Design& design, const std::string& path,
                                     const DesignReportOptions& options) {
    const Study study = approach_study(design);
    ResultFile file(path, ResultFile::Access::write);
    if (!follow(study, file, options))
        return std::nullopt;
    return with_place(design.approach.place, [&] { return find_trip_point(design, study, file); });
}

} // namespace graze
