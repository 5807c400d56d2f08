#pragma once

#include "graze/picture/figure.hpp"
#include "graze/picture/motion_recorder.hpp"

namespace graze {

/// A motion that has been recorded: histories in the left column, portraits beside them, with contacts and passages of
/// sections marked. Of histories that nobody asked for only those in which something changes are shown. Where the
/// motion ends in a singularity, that time is marked, and what grows without bounds runs out of the picture.
/// @throws InputError when there is nothing to draw
Figure trajectory_figure(const MotionRecorder& recorder);

} // namespace graze
