#pragma once

#include "graze/results/result_file.hpp"

#include <nlohmann/json.hpp>

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace graze {

/// How the trips from a point are asked for.
struct TripWish {
    std::string parameter{};               ///< that moves the orbit from the point; empty: the one that the run follows
    std::vector<std::string> overshoots{}; ///< numbers or FIRST:LAST; none: the usual ones
    std::string until{};                   ///< EXPR=LEVEL that ends trips; empty: the usual end
    std::optional<double> cycles{};        ///< that are simulated at most; none: 2000
    double most_seconds = 20;              ///< of computing, after which further overshoots are left out
    std::function<bool()> interrupted{};   ///< asked now and then; true leaves out further overshoots
};

/// How long a motion takes to trip beyond a point of a branch at which it is lost: a figure and a table of times over
/// overshoots, and sentences. @throws InputError for an unknown run or point, and where the motion is not lost
nlohmann::json trip_json(const ResultFile& file, const std::string& run, std::size_t number, const TripWish& wish);

} // namespace graze
