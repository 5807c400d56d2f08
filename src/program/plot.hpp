#pragma once

#include "graze/model/model.hpp"
#include "graze/picture/motion_recorder.hpp"
#include "graze/study/figure_style.hpp"
#include "program/arguments.hpp"

#include <string>
#include <vector>

namespace graze {

/// A picture of a trajectory that the command line asks for.
struct PlotRequest {
    std::string path, data_path;
    MotionPanelChoice contents;
    FigureStyle style;
};

/// Chooses the contents of the picture, and checks that its files can be written and that gnuplot is there.
/// @param marked for each event, whether its contacts are marked; used only if --event was given, otherwise contacts of
/// all barriers that depend on the motion are marked
/// @throws InputError
PlotRequest plot_request(const Model& model, const SimulateArguments& arguments, const std::vector<bool>& marked);

/// Draws the picture. @throws InputError when gnuplot fails or the file cannot be written
void draw_plot(const PlotRequest& request, const MotionRecorder& recorder);

} // namespace graze
