#pragma once

#include "graze/results/result_file.hpp"
#include "graze/study/study.hpp"
#include "study/bench_records.hpp"

#include <cstddef>
#include <functional>
#include <optional>

namespace graze {

/// Makes the points of a run of kind record, one for each record, in their order.
class RecordRun {
public:
    /// @param run must outlive this
    explicit RecordRun(const StudyRun& run) : run_(&run) {
        if (run.record().bench)
            bench_.emplace(*run.record().bench);
    }

    /// @param interrupted asked again and again; may be null
    /// @return nothing when it was interrupted
    /// @throws InputError naming the record, for what is none or has no such channels, and for a record that is not
    ///         the one that the study was read with
    std::optional<PointRecord> point(std::size_t number, const std::function<bool()>& interrupted);

private:
    const StudyRun* run_;
    std::optional<BenchRecords> bench_;
};

} // namespace graze
