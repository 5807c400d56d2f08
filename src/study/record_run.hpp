#pragma once

#include "graze/results/result_file.hpp"
#include "graze/study/study.hpp"

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>

namespace graze {

/// Makes the points of a run of kind record, one for each record, in their order.
class RecordRun {
public:
    /// @param run must outlive this
    explicit RecordRun(const StudyRun& run);
    ~RecordRun();
    RecordRun(const RecordRun&) = delete;
    RecordRun& operator=(const RecordRun&) = delete;

    /// @param interrupted asked again and again; may be null
    /// @return nothing when it was interrupted
    /// @throws InputError naming the record, for what is none or has no such channels, and for a record that is not
    ///         the one that the study was read with
    std::optional<PointRecord> point(std::size_t number, const std::function<bool()>& interrupted);

private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace graze
