#pragma once

#include "graze/model/model.hpp"
#include "graze/picture/result_picture.hpp"
#include "graze/results/stored_run.hpp"
#include "picture/shown_names.hpp"

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace graze {

// Functions common to all kinds of pictures: the values, samplings and axes of a run that are shown.

/// The values that the picture chooses, or all values of the run.
std::vector<std::string> chosen_values(const StudyPicture& picture, const StoredRun& run);
/// @throws InputError for the first name that is no value of the run
void require_values(const StudyPicture& picture, const StoredRun& run, const std::vector<std::string>& names);
/// The horizontal axis: as the picture chooses, or the first coordinate that the run varies.
std::string first_coordinate(const StudyPicture& picture, const StoredRun& run);
/// For runs of kind record: the samplings that hold all rows of a record.
std::vector<std::string> row_samplings(const StoredRun& run);
/// The samplings that the picture chooses, or all except row_samplings.
std::vector<std::string> shown_points(const StudyPicture& picture, const StoredRun& run);
/// The samplings that the picture chooses, or all.
std::vector<std::string> shown_samplings(const StudyPicture& picture, const StoredRun& run);
/// The letter of a panel: (a) to (z), then (aa) and so on.
std::string panel_letter(std::size_t index);
/// A panel without series, with the ranges and scales of the picture.
FigurePanel empty_panel(const StudyPicture& picture);
/// The same with axis labels. @param index index of y among the picture's values
FigurePanel panel_of(const StudyPicture& picture, const StoredRun& run, const std::string& x, const std::string& y,
                     std::size_t index);
/// A value at the samples of one point. @param times receives their times; may be null
std::vector<double> samples_of(const PointRecord& point, const StoredRun& run, const std::string& value,
                               const std::string& sampling, std::vector<double>* times);

/// Removes panels of values that are constant in all their panels, unless all values are. Letters of the remaining
/// panels are consecutive.
void drop_constant_panels(Figure& figure);

/// How a picture draws a motion with a label (of the enumeration Label).
enum class DrawnAs {
    attractor, ///< the motion has settled
    uncertain, ///< the motion has not settled: drawn as crosses, which the legend explains
    nothing    ///< the motion ended, is unbounded or failed: not drawn, but counted under the picture
};

/// @param label name of a Label, as in result files
DrawnAs drawn_as(std::string_view label);
/// True for runs whose points should be attractors: sweeps and basins.
bool seeks_attractors(const RunRecord& run);

/// A sentence with the numbers of points that are not drawn, by label; empty if all are drawn.
/// @param directions only points of these; empty: all
std::string note_of_left_out(const StoredRun& run, const std::vector<std::string>& directions);

/// A series of points without an attractor, whose colour, symbol and, for cells, hatch show their label.
/// @param label name of a Label
FigureSeries series_of_label(std::string_view label);
/// Adds a series unless it is empty, so that legends name only what is drawn.
void add_if_drawn(FigurePanel& panel, FigureSeries series);
/// Says of the series of a panel, from `first` on, that they show one stored point of a run, as its motion does.
void show_point(FigurePanel& panel, std::size_t first, const std::string& run, std::size_t number);

// Pictures of each kind.
ResultPicture bifurcation_picture(const StudyPicture& picture, const ResultFile& file);
/// The attractor that is reached over two varied coordinates; a map shows only the kind of attractor.
ResultPicture basin_picture(const StudyPicture& picture, const ResultFile& file);
ResultPicture spectrum_picture(const StudyPicture& picture, const ResultFile& file);
/// Motions of points: values over time in one panel for each value (history), or in a panel for each point and value
/// over another value (portrait), or only samples over another value (poincare).
ResultPicture motion_picture(const StudyPicture& picture, const ResultFile& file);
/// Histories and portraits of orbits of branches, along their computed segments.
ResultPicture orbit_picture(const StudyPicture& picture, const ResultFile& file);
/// Branches of orbits: one panel for each monitor.
ResultPicture branch_picture(const StudyPicture& picture, const ResultFile& file);
/// What an atlas has found, in one parameter or in the plane of both.
ResultPicture atlas_picture(const StudyPicture& picture, const ResultFile& file);
ResultPicture regression_picture(const StudyPicture& picture, const ResultFile& file);
ResultPicture scatter_picture(const StudyPicture& picture, const ResultFile& file);
/// Measured and fitted values and residuals of runs of kind identify.
ResultPicture residual_picture(const StudyPicture& picture, const ResultFile& file);

} // namespace graze
