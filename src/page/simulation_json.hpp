#pragma once

#include "graze/model/model.hpp"

#include <nlohmann/json.hpp>

#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace graze {

/// A motion that somebody wants to see while a slider moves.
struct SimulationWish {
    std::map<std::string, double> parameters{}, initial{}; ///< values that replace those of the model
    std::optional<double> duration{};                      ///< none: usual_duration
    std::string mode{};                                    ///< in which it begins; empty: that of the model
    std::vector<std::string> names{};                      ///< what is shown; none: the states that pictures show
    std::size_t most_rows = 5'000;                         ///< that are given, evenly thinned; fewer of many columns
    std::size_t most_steps = 20'000;                       ///< after which the motion ends, whatever its duration
    double most_seconds = 0.25;                            ///< of computing, after which it ends
    std::function<bool()> interrupted{};                   ///< asked after each step; true ends it
};

/// The duration for which a model is shown if nothing is said: 20 periods of its phase, as `graze simulate` has them;
/// without a phase that of 300 steps, to two digits.
double usual_duration(const Model& model);

/// The motion of a model, as motion_rows_json gives it. Where it was ended before its duration, `complete` is false and
/// `limit` says by what: "steps", "seconds" or "interrupted".
/// @throws InputError for unknown names, values that are not finite, and a duration that is not positive
nlohmann::json simulation_json(const Model& model, const SimulationWish& wish);

} // namespace graze
