#pragma once

#include "graze/model/model.hpp"
#include "graze/picture/result_picture.hpp"
#include "graze/results/stored_run.hpp"
#include "picture/shown_names.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace graze {

// What the kinds of pictures have in common: which values, samplings and axes of a run are shown.

/// The values asked for, or all of the run.
std::vector<std::string> chosen_values(const StudyPicture& picture, const StoredRun& run);
/// @throws InputError naming the first that the run does not have
void require_values(const StudyPicture& picture, const StoredRun& run, const std::vector<std::string>& names);
/// What is drawn along x: as asked for, or what the run varies first.
std::string first_coordinate(const StudyPicture& picture, const StoredRun& run);
/// Of runs of kind record, samplings that are all rows of a record rather than points of it.
std::vector<std::string> row_samplings(const StoredRun& run);
/// Those asked for, or all but these.
std::vector<std::string> shown_points(const StudyPicture& picture, const StoredRun& run);
std::vector<std::string> shown_samplings(const StudyPicture& picture, const StoredRun& run);
/// Whether values within these limits differ by no more than rounding does.
bool is_constant(double least, double greatest);
/// By which a panel is known where there are several: (a) to (z), then (aa) and so on.
std::string panel_letter(std::size_t index);
/// A panel without anything in it, and with axes as far as the picture itself says.
FigurePanel empty_panel(const StudyPicture& picture);
/// The same with what is beside its axes. @param index of the value that is its y
FigurePanel panel_of(const StudyPicture& picture, const StoredRun& run, const std::string& x, const std::string& y,
                     std::size_t index);
/// A value at the samples of one point. @param times where to add their times; may be null
std::vector<double> samples_of(const PointRecord& point, const StoredRun& run, const std::string& value,
                               const std::string& sampling, std::vector<double>* times);

/// Leaves out values that are the same in all their panels, where others change; the letters of those that stay go on.
void drop_constant_panels(Figure& figure);

Figure bifurcation_picture(const StudyPicture& picture, const ResultFile& file);
/// Two of the things that vary, and which attractor (or, of maps, which kind of one) is reached.
ResultPicture basin_picture(const StudyPicture& picture, const ResultFile& file, bool map);
ResultPicture spectrum_picture(const StudyPicture& picture, const ResultFile& file);
/// How a motion is looked at: values over time, values over another, or only its samples over one another.
enum class MotionView { history, portrait, section };
/// One panel for each value (histories), or for each point and value.
Figure motion_picture(const StudyPicture& picture, const ResultFile& file, MotionView view);
/// The same of orbits of branches, along the segments that were computed.
Figure orbit_picture(const StudyPicture& picture, const ResultFile& file, bool portrait);
/// Branches of orbits: one panel for each monitor.
Figure branch_picture(const StudyPicture& picture, const ResultFile& file);
ResultPicture regression_picture(const StudyPicture& picture, const ResultFile& file);
Figure scatter_picture(const StudyPicture& picture, const ResultFile& file);
/// What runs of kind identify have measured and fitted, and what is left.
Figure residual_picture(const StudyPicture& picture, const ResultFile& file);

} // namespace graze
