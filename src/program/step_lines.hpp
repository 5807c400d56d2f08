#pragma once

#include "graze/results/orbit_record.hpp"
#include "graze/study/study.hpp"

#include <ostream>
#include <string>

namespace graze {

/// Prints one line for each orbit of a branch while the branch is followed (`graze run --steps`).
class StepLines {
public:
    StepLines(const Study& study, std::ostream& out) : study_(&study), out_(&out) {}
    void show(const std::string& run, const OrbitRecord& record);

private:
    void begin(const StudyRun& run, const std::string& part);
    const Study* study_;
    std::ostream* out_;
    std::string run_, part_; ///< run and part of the last line
};

} // namespace graze
