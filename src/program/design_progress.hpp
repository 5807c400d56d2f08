#pragma once

#include "graze/design/design_report.hpp"
#include "program/status_line.hpp"

namespace graze {

/// Options of a design's computations that stop on an interrupt and show progress on `line`, which must outlive them.
DesignReportOptions interactive_options(int jobs, StatusLine& line);

} // namespace graze
