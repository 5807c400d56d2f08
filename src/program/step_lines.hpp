#pragma once

#include "graze/results/orbit_record.hpp"
#include "graze/study/study.hpp"

#include <ostream>
#include <string>

namespace graze {

/// Tells about a branch while it is followed: a line for each orbit.
class StepLines {
public:
    StepLines(const Study& study, std::ostream& out) : study_(&study), out_(&out) {}
    void show(const std::string& run, const OrbitRecord& record);

private:
    void begin(const StudyRun& run, const std::string& part);
    const Study* study_;
    std::ostream* out_;
    std::string run_, part_; ///< of the line before
};

} // namespace graze
