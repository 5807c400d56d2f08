#pragma once

#include "graze/results/stored_orbit.hpp"
#include "graze/results/table.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace graze {

/// Which points of the branches in a result file are listed.
struct PointListRequest {
    std::vector<std::string> runs = {}; ///< only points of these runs; empty: of all branches
    std::vector<PointType> types = {};  ///< only points of these types; empty: of all special types
    bool regular = false;               ///< whether regular points are included
    bool images = true;                 ///< whether images of other points under the model's symmetry are included
    Place place = {};                   ///< where the user named the runs, for messages
};

struct ListedPoint {
    std::size_t run = 0; ///< index in PointList::runs
    OrbitRecord record;
    std::vector<double> parameters; ///< values for the coordinate columns of the run
    std::vector<double> stored;     ///< further numbers of the file, copied as they are
};

/// Listed points, with the names of the parameters in which they differ.
struct PointList {
    std::vector<StoredRun> runs;
    std::vector<ListedPoint> points;
    std::string followed;               ///< the parameter that all runs follow; empty: the runs follow different ones
    std::vector<std::string> differing; ///< the other parameters that do not have the same value at all points
    std::size_t images_left_out = 0;    ///< number of points left out because they are images of other points

    const StoredRun& run_of(const ListedPoint& point) const { return runs[point.run]; }
};

/// Lists points of a file. @throws InputError as branch_runs does
PointList listed_points(const ResultFile& file, const PointListRequest& request);

/// How a list of points is shown as a table.
struct PointTableStyle {
    bool for_people = false; ///< true: the main columns, with words; false: every column, with full numbers
    bool brief = false;      ///< with for_people: long words are shortened so that the table is narrower
    int digits = 17;         ///< with for_people: significant digits of numbers
};
Table point_table(const PointList& list, const PointTableStyle& style = {});

} // namespace graze
