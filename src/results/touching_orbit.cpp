#include "graze/results/touching_orbit.hpp"

#include "graze/base/input_error.hpp"
#include "graze/base/with_place.hpp"

#include <utility>

namespace graze {

std::vector<ParameterId> moving_parameters(const StoredRun& run, const std::string& asked, const Place& place) {
    if (!asked.empty())
        return {with_place(place, [&] { return run.model.independent_parameter(asked); })};
    std::vector<ParameterId> result;
    if (run.record.kind == "curve" && run.record.coordinates.size() > 1)
        result.push_back(run.model.independent_parameter(run.record.coordinates[1].name));
    if (const std::string followed = followed_parameter(run.record); !followed.empty())
        result.push_back(run.model.independent_parameter(followed));
    return result;
}

TouchingOrbit find_touching_orbit(const ResultFile& file, const std::string& point, const std::string& parameter,
                                  const Place& point_place, const Place& parameter_place) {
    StoredOrbit stored = find_closed_orbit(file, point, point_place);
    const std::vector<ParameterId> candidates = moving_parameters(stored.run, parameter, parameter_place);
    return with_place(point_place, [&] {
        return TouchingOrbit{touching_map(System(stored.run.model), stored.record.point, candidates,
                                          "the orbit at " + title_of(stored.record)),
                             std::move(stored)};
    });
}

LossPoint loss_point(const StoredOrbit& stored, const std::string& parameter, const Place& point_place,
                     const Place& parameter_place) {
    const std::vector<ParameterId> candidates = moving_parameters(stored.run, parameter, parameter_place);
    return with_place(point_place, [&] {
        return loss_point(System(stored.run.model), stored.record.point, candidates,
                          "the orbit at " + title_of(stored.record));
    });
}

} // namespace graze
