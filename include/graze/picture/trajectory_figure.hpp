#pragma once

#include "graze/picture/figure.hpp"
#include "graze/picture/motion_recorder.hpp"

namespace graze {

/// The figure of a recorded motion: histories in the left column, portraits beside them, with marks at contacts and
/// passages of sections. Constant histories are left out unless the user chose them. If the motion ends in a
/// singularity, its time is marked, and unbounded values leave the frame.
/// @throws InputError when there is nothing to draw
Figure trajectory_figure(const MotionRecorder& recorder);

} // namespace graze
