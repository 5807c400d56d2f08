#pragma once

#include "graze/branch/special_point.hpp"
#include "graze/picture/figure.hpp"
#include "graze/results/stored_run.hpp"
#include "graze/study/study.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace graze {

// Branches and curves as lines, symbols and labels of a panel.

/// The property of an orbit that decides how the branch is drawn there.
enum class Look { stable, unstable, unphysical };

struct DrawnPoint {
    std::size_t number; ///< of the stored point
    std::string part, label;
    std::string name; ///< text that is shown for the label
    PointType type;
    Look look;
    std::int64_t step;
    double along; ///< arclength along the branch
    double x;
    std::vector<double> y; ///< of each value that is drawn
    bool left_out = false; ///< it is not marked, whatever its type
};

/// The style of a curve depends on its type: touches are solid, folds dashed, others dotted.
FigureSeries::Style style_of(PointType kept);
FigureSeries::Style style_of(Look look);

/// Reads a branch. @param values monitors, parameters, columns, or expressions in SQL
/// @throws InputError for values that the run does not have, and for directions that it was not followed in
std::vector<DrawnPoint> drawn_points(const StoredRun& run, const StudyPicture& picture, const std::string& x,
                                     const std::vector<std::string>& values);
/// True for points that are marked: all whose type has a symbol, unless the picture chooses types or labels.
bool is_marked(const StudyPicture& picture, const DrawnPoint& point);

/// A branch or curve in a panel.
struct DrawnBranch {
    std::string run;
    std::vector<DrawnPoint> points;
    std::optional<PointType> kept{}; ///< type of the curve; none: a branch, whose line style shows stability
    bool apart = false;              ///< its points are not those of one branch: no line joins them
    std::size_t colour = 0;
    std::string owner{}; ///< name of the branch if there are several; empty: its labels are black
};
/// Adds the lines. @param value index of the value that is drawn
void add_lines(FigurePanel& panel, const DrawnBranch& branch, std::size_t value);
/// Adds the symbols and labels of special points, and the symbols of a branch of one orbit and of points that stand
/// apart.
void add_symbols(FigurePanel& panel, const StudyPicture& picture, const DrawnBranch& branch, std::size_t value,
                 bool labelled = true);

/// Adds an entry to the legend that explains a style or symbol.
void add_to_legend(FigurePanel& panel, const std::string& title, FigureSeries::Style style, std::size_t colour,
                   int symbol = 0);
/// Adds the meanings of the line styles of branches.
/// @param colour of the samples
void add_looks(FigurePanel& panel, const std::vector<DrawnBranch>& branches, std::size_t colour);
/// Adds the meanings of symbols.
void add_point_types(FigurePanel& panel, const StudyPicture& picture, const std::vector<DrawnBranch>& branches,
                     std::size_t colour);

} // namespace graze
