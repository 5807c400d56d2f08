#pragma once

#include "graze/model/model.hpp"
#include "graze/results/stored_run.hpp"
#include "graze/study/picture.hpp"

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
std::vector<std::string> shown_samplings(const StudyPicture& picture, const StoredRun& run);
/// A number of a title.
std::string title_number(double value);
FigurePanel panel_of(const StudyPicture& picture, const std::string& x, const std::string& x_unit, const std::string& y,
                     const std::string& y_unit);
/// A value at the samples of one point. @param times where to add their times; may be null
std::vector<double> samples_of(const PointRecord& point, const StoredRun& run, const std::string& value,
                               const std::string& sampling, std::vector<double>* times);

Figure bifurcation_picture(const StudyPicture& picture, const ResultFile& file);
ResultPicture basin_picture(const StudyPicture& picture, const ResultFile& file);
ResultPicture spectrum_picture(const StudyPicture& picture, const ResultFile& file);
/// Histories and portraits: one panel for each point (portrait) or value (history).
Figure motion_picture(const StudyPicture& picture, const ResultFile& file, bool portrait);
/// The same of orbits of branches, along the segments that were computed.
Figure orbit_picture(const StudyPicture& picture, const ResultFile& file, bool portrait);
/// Branches of orbits: one panel for each monitor.
Figure branch_picture(const StudyPicture& picture, const ResultFile& file);
ResultPicture regression_picture(const StudyPicture& picture, const ResultFile& file);
Figure scatter_picture(const StudyPicture& picture, const ResultFile& file);

} // namespace graze
