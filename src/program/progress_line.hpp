#pragma once

#include "graze/base/time_left.hpp"
#include "graze/results/orbit_record.hpp"
#include "graze/study/runner.hpp"
#include "program/status_line.hpp"

#include <string>

namespace graze {

/// The text of the line: the points done of a run and of the study, and the estimated time left.
/// @param left none: too early for an estimate
std::string progress_text(const StudyProgress& progress, const std::optional<TimeLeft::Estimate>& left);

/// The line of progress of a study on standard error.
class ProgressLine {
public:
    ProgressLine(const Console& console, bool wanted) : line_(console, wanted) {}

    void update(const StudyProgress& progress);
    /// Shows the last orbit of a branch, whose length is not known in advance.
    void update(const std::string& run, const OrbitRecord& orbit);

private:
    StatusLine line_;
    TimeLeft left_;
};

} // namespace graze
