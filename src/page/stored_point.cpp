#include "page/stored_point.hpp"

#include "graze/results/run_kind.hpp"
#include "graze/results/stored_orbit.hpp"

#include <fmt/format.h>

namespace graze {

OrbitRecord orbit_numbered(const StoredRun& run, std::size_t number) {
    return orbit_of_run(run.file, run.record, fmt::format("{}", number), {});
}

PointRecord point_numbered(const StoredRun& run, std::size_t number) {
    if (auto point = run.file.point(run.record.name, number))
        return std::move(*point);
    throw InputError(fmt::format("run '{}' has no point number {}", run.record.name, number),
                     fmt::format("it has {} points", run.points()));
}

Model model_of_point(const StoredRun& run, const PointRecord& point) {
    Model model = run.model;
    for (std::size_t c = 0; c < run.record.coordinates.size(); ++c)
        if (model.find_independent_parameter(run.record.coordinates[c].name))
            model.set_parameter(run.record.coordinates[c].name, point.coordinates.at(c));
    return model;
}

std::string name_at(const std::vector<std::string>& names, std::size_t index) {
    return index < names.size() ? names[index] : std::string();
}

bool is_measured_run(const RunRecord& run) {
    const auto kind = run_kind(run.kind);
    return kind && is_measured(*kind);
}

} // namespace graze
