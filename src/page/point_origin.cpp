#include "page/point_origin.hpp"

#include "graze/results/orbit_motion.hpp"
#include "graze/study/stored_study.hpp"
#include "page/stored_point.hpp"

#include <fmt/format.h>

namespace graze {

std::string PointOrigin::name() const {
    return orbit && !orbit->label.empty() ? orbit->label : fmt::format("{}", number);
}

PointOrigin point_origin(const StoredRun& stored, const Study& study, std::size_t number) {
    const StudyRun* const known = study.find_run(stored.record.name);
    PointOrigin origin{
        .run = stored.record.name, .asked = known ? *known : stored_run(stored.record), .number = number};
    origin.model = stored.model;
    if (stored.record.is_branch()) {
        origin.orbit = orbit_numbered(stored, number);
        origin.model = model_at(stored.model, origin.orbit->point.solution.orbit);
    } else if (!is_measured_run(stored.record)) {
        origin.point = point_numbered(stored, number);
        origin.model = model_of_point(stored, *origin.point);
    }
    return origin;
}

PointOrigin point_origin(const ResultFile& file, const Study& study, const std::string& run, std::size_t number) {
    return point_origin(StoredRun(file, run, {}), study, number);
}

PointOrigin point_origin(const Model& model) {
    PointOrigin origin;
    origin.model = model;
    return origin;
}

} // namespace graze
