#pragma once

#include "graze/results/stored_orbit.hpp"
#include "graze/results/table.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace graze {

/// Which points of a file's branches are listed.
struct PointListRequest {
    std::vector<std::string> runs = {}; ///< only of these; empty: of all
    std::vector<PointType> types = {};  ///< only these; empty: all special ones
    bool regular = false;               ///< those too that are not special
    bool twins = true;                  ///< those too that are images of others under the model's symmetry
    Place place = {};                   ///< where runs were named, for messages
};

struct ListedPoint {
    std::size_t run = 0; ///< index in PointList::runs
    OrbitRecord record;
    std::vector<double> parameters; ///< of the run's columns
    std::vector<double> stored;     ///< what the file has besides, as it stands there
};

/// Points with the parameters by which they differ.
struct PointList {
    std::vector<StoredRun> runs;
    std::vector<ListedPoint> points;
    std::string followed; ///< the parameter that all follow; empty: each run its own
    std::vector<std::string> others;
    std::size_t twins = 0; ///< points left out, since they are images of others

    const StoredRun& run_of(const ListedPoint& point) const { return runs[point.run]; }
};

/// @throws InputError as branch_runs does
PointList listed_points(const ResultFile& file, const PointListRequest& request);

/// How a list of points is shown.
struct PointTableStyle {
    bool for_people = false; ///< what they look at, in words; otherwise all that is known, in numbers
    bool brief = false;      ///< of people's: long words are cut short, for numbers to have room
    int digits = 17;         ///< of people's numbers
};
Table point_table(const PointList& list, const PointTableStyle& style = {});

} // namespace graze
