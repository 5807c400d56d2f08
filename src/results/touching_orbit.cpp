#include "graze/results/touching_orbit.hpp"

#include "graze/base/input_error.hpp"

#include <utility>

namespace graze {

namespace {

/// Does something; what is wrong, and has no place of its own, is said of the place.
template <class Work>
auto said_at(const Place& place, const Work& work) {
    try {
        return work();
    } catch (const InputError& error) {
        if (!error.place().file.empty())
            throw;
        throw InputError(place, error.problem(), error.remedy());
    }
}

} // namespace

std::vector<ParameterId> moving_parameters(const StoredRun& run, const std::string& asked, const Place& place) {
    if (!asked.empty())
        return {said_at(place, [&] { return run.model.independent_parameter(asked); })};
    std::vector<ParameterId> result;
    if (run.record.kind == "curve" && run.record.coordinates.size() > 1)
        result.push_back(run.model.independent_parameter(run.record.coordinates[1].name));
    if (const std::string followed = followed_parameter(run.record); !followed.empty())
        result.push_back(run.model.independent_parameter(followed));
    return result;
}

TouchingOrbit find_touching_orbit(const ResultFile& file, const std::string& point, const std::string& parameter,
                                  const Place& point_place, const Place& parameter_place) {
    StoredOrbit stored = find_stored_orbit(file, point, point_place);
    const std::vector<ParameterId> candidates = moving_parameters(stored.run, parameter, parameter_place);
    return said_at(point_place, [&] {
        return TouchingOrbit{touching_map(System(stored.run.model), stored.record.point, candidates,
                                          "the orbit at " + title_of(stored.record)),
                             std::move(stored)};
    });
}

LossPoint loss_point(const StoredOrbit& stored, const std::string& parameter, const Place& point_place,
                     const Place& parameter_place) {
    const std::vector<ParameterId> candidates = moving_parameters(stored.run, parameter, parameter_place);
    return said_at(point_place, [&] {
        return loss_point(System(stored.run.model), stored.record.point, candidates,
                          "the orbit at " + title_of(stored.record));
    });
}

} // namespace graze
