#include "graze/results/located_point.hpp"

#include "graze/base/input_error.hpp"
#include "graze/branch/curve_start.hpp"
#include "graze/branch/yield.hpp"
#include "graze/results/orbit_motion.hpp"
#include "graze/results/touching_orbit.hpp"

#include <fmt/format.h>

#include <utility>
#include <vector>

namespace graze {

namespace {

/// The point as one whose condition can be held: of several, what it is first.
SpecialPoint with_condition(const SpecialPoint& point, const Place& place) {
    if (kind_of(point.type).may_be_kept)
        return point;
    const std::vector<PointType> known = curves_at(point);
    if (known.empty())
        throw InputError(place,
                         fmt::format("nothing that could be held happens at a point of type {} ({})",
                                     short_name(point.type), name_of(point.type)),
                         "choose a grazing (GR), fold (SN) or flip (PD), or a point of a curve of such");
    return as_type(point, known.front());
}

/// By the first of the parameters on which the point depends.
LocatedValue located(const System& system, const SpecialPoint& point, const Model& model,
                     const std::vector<ParameterId>& candidates, const Place& place) {
    for (const ParameterId one : candidates) {
        try {
            return LocatedValue(system, point, one, parameters_but(model, one));
        } catch (const InputError& error) {
            if (one == candidates.back())
                throw InputError(place, error.problem(), error.remedy());
        }
    }
    throw InputError(place, "no parameter is followed", "name a parameter");
}

} // namespace

LocatedPoint located_point(const ResultFile& file, const std::string& point, const std::string& parameter,
                           const Place& point_place, const Place& parameter_place) {
    StoredOrbit stored = find_closed_orbit(file, point, point_place);
    const SpecialPoint held = with_condition(stored.record.point, point_place);
    Model model = model_at(stored.run.model, held.solution.orbit);
    const std::vector<ParameterId> candidates = moving_parameters(stored.run, parameter, parameter_place);
    if (candidates.empty())
        throw InputError(point_place, fmt::format("run '{}' follows no parameter", stored.run.record.name),
                         fmt::format("say whose value follows from the others: {} NAME", parameter_place.file));
    LocatedValue value = located(System(stored.run.model), held, model, candidates, point_place);
    const std::string name = model.independent_parameters()[value.control().place()];
    const std::string unit = model.parameter_unit(name);
    return {std::move(stored), std::move(model), held, std::move(value), name, unit};
}

} // namespace graze
