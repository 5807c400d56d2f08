#pragma once

#include "graze/design/design_report.hpp"
#include "program/status_line.hpp"

namespace graze {

/// Ends when the program is told to, and shows what is done on a line, which must outlive it.
DesignReportOptions interactive_options(int jobs, StatusLine& line);

} // namespace graze
