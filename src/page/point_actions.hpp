#pragma once

#include "page/point_origin.hpp"

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace graze {

/// A parameter along which something is followed, with its bounds.
struct AlongParameter {
    std::string name;
    double least = 0, greatest = 0;
};

/// What can be done from a point: a run that begins there.
struct PointAction {
    std::string name, title, words;
    std::vector<AlongParameter> along{}; ///< what it takes, as it is proposed
    std::string onto{};                  ///< which branch, or curve of which points; empty: the study need not say it
};

/// All independent parameters of the model, first those that the run follows or varies, then the frequencies of cyclic
/// states, with their bounds there or bounds around their values at the point.
std::vector<AlongParameter> proposed_parameters(const PointOrigin& origin);

/// What can be done from a point, the most likely first.
std::vector<PointAction> actions_at(const PointOrigin& origin);

/// The same for the page: name, title, words, `along` (the number of parameters), and these with proposed bounds.
nlohmann::json actions_json(const std::vector<PointAction>& actions);

} // namespace graze
