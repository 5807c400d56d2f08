#pragma once

#include "graze/model/model.hpp"
#include "graze/picture/motion_recorder.hpp"
#include "graze/study/figure_style.hpp"
#include "program/arguments.hpp"

#include <string>
#include <vector>

namespace graze {

/// A picture that has been asked for.
struct PlotRequest {
    std::string path, data_path;
    MotionPanelChoice contents;
    FigureStyle style;
};

/// Decides what is drawn and makes sure that it can be. @throws InputError
/// @param marked events chosen by the user; empty: all that are not mere clocks
PlotRequest plot_request(const Model& model, const SimulateArguments& arguments, const std::vector<bool>& marked);

/// Draws the picture. @throws InputError when gnuplot fails or the file cannot be written
void draw_plot(const PlotRequest& request, const MotionRecorder& recorder);

} // namespace graze
