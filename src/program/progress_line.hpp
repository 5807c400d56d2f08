#pragma once

#include "graze/base/time_left.hpp"
#include "graze/results/orbit_record.hpp"
#include "graze/study/runner.hpp"
#include "program/status_line.hpp"

#include <string>

namespace graze {

/// What the line says: which run is at which of its points, how much of the study is done, and how long the rest takes.
/// @param left none: too little has been done to tell
std::string progress_text(const StudyProgress& progress, const std::optional<TimeLeft::Estimate>& left);

/// A line on standard error once a study takes long.
class ProgressLine {
public:
    ProgressLine(const Console& console, bool wanted) : line_(console, wanted) {}

    void update(const StudyProgress& progress);
    /// Of a branch nobody knows how long it will be.
    void update(const std::string& run, const OrbitRecord& orbit);

private:
    StatusLine line_;
    TimeLeft left_;
};

} // namespace graze
