#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace peers {

/// A line of AUTO's fort.7: type, label and columns.
struct AutoPoint {
    int type = 0;  ///< 5: fold, 6: branch point, 7: flip, -4: a requested value, 9: an end, -9: no convergence
    int label = 0; ///< label of its stored solution, from which AUTO can restart; 0: none
    std::vector<double> columns; ///< the branch's parameter, the norm, maxima of the first states, other parameters
};

struct AutoRun {
    std::vector<AutoPoint> points;
    double seconds = 0; ///< CPU time

    /// Parameters at all points of a type.
    std::vector<double> located(int type) const;
    double milliseconds_per_point() const { return 1e3 * seconds / static_cast<double>(points.size()); }
};

/// Settings of an AUTO run.
struct AutoSettings {
    std::string problem;   ///< the program's name
    std::string constants; ///< besides those below
    int states = 0, intervals = 20, points = 40;
    double accuracy = 1e-7, first_step = 0.01, largest_step = 0.05;
};

/// Runs an AUTO program, in one thread, in the present folder. @throws std::runtime_error when it fails
AutoRun run_auto(const AutoSettings& settings);
/// Lets the next run begin from solutions of the last one: IRS is their label.
void keep_solutions();

} // namespace peers
