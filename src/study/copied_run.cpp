#include "study/copied_run.hpp"

#include "graze/study/run_times.hpp"

namespace graze {

void copy_rows(const ResultFile& from, const RunRecord& run, ResultFile& to, const std::string& name) {
    if (run.is_branch())
        for (const OrbitRecord& orbit : from.orbits(run.name, false))
            to.add_orbit(name, orbit);
    else
        from.each_point(run.name, [&](const PointRecord& point) { to.add_point(name, point); });
    if (const EstimateRecords found = from.estimates(run.name); !found.numbers.empty())
        to.set_estimates(name, found);
    to.flush();
}

void copy_run(const ResultFile& from, const RunRecord& run, ResultFile& to, const RunRecord& copy) {
    to.begin_run(copy);
    to.name_points(copy.name, run.point_names);
    copy_rows(from, run, to, copy.name);
    if (run.status == RunStatus::complete)
        to.complete_run(copy.name);
    if (run.status == RunStatus::failed)
        to.fail_run(copy.name, run.failure);
    if (const auto times = times_of(from, run.name))
        note_times(to, copy.name, *times);
}

} // namespace graze
