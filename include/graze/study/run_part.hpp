#pragma once

#include "graze/study/item_range.hpp"
#include "graze/study/runner.hpp"

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace graze {

/// Receives a point of a run by its number; may move from the result.
using PointSink = std::function<void(std::size_t point, PointResult& result)>;

/// A run of motions that any process can compute in parts: in any division and order, to the same bits. It knows where
/// its motions begin, and needs no file. Can be used by several threads.
class PartedRun {
public:
    /// @param run of kind simulate, sweep or basin; with the parameters with which it begins
    /// @param start see plan_of
    PartedRun(const StudyRun& run, const PointRecord* start);
    /// The run of a text that `text` wrote, by the same version of graze.
    /// @throws InputError for another version, and when the text cannot be read
    explicit PartedRun(const std::string& text);
    ~PartedRun();
    PartedRun(const PartedRun&) = delete;
    PartedRun& operator=(const PartedRun&) = delete;

    /// All that another process needs in order to compute parts of the run, as JSON.
    std::string text() const;
    const StudyRun& run() const;
    std::size_t chains() const;
    std::size_t chain_length() const;

    /// Computes the points of some chains.
    /// @param known what of each of these chains is there; empty: nothing
    /// @param sink receives the points, in order within each chain; called by one thread at a time
    /// @return false if it was stopped
    bool compute(ItemRange chains, std::span<const ChainProgress> known, const ExecutionOptions& options,
                 const PointSink& sink) const;

private:
    struct State;
    std::unique_ptr<const State> state_;
};

/// What is to be computed by somebody else, in bytes: some chains of a run, and what of each is there.
struct RunPart {
    ItemRange chains;
    std::vector<ChainProgress> known{}; ///< empty: nothing is there
};
std::string bytes_of(const RunPart& part);
/// @throws InputError when the bytes are none of `bytes_of`
RunPart part_of(std::string_view bytes);

/// Computes a part with one thread. @return its points, for read_points; empty: it was interrupted
std::string computed_points(const PartedRun& run, const RunPart& part, const std::function<bool()>& interrupted);
/// Gives the points of a part, all bits of them, to `sink`.
/// @throws InputError, before any point is given, when the bytes are none of `computed_points` of this part
void read_points(const PartedRun& run, const RunPart& part, std::string_view bytes, const PointSink& sink);

/// Computes the points of a run of motions in some other way than by threads of this process.
/// @param known what of each chain is there
/// @param interrupted asked now and then; true: it has to end soon
/// @param sink receives all points that are not there, in order within each chain; called by one thread at a time
/// @return false when it was interrupted
using PointsElsewhere = std::function<bool(const PartedRun& run, std::span<const ChainProgress> known,
                                           const std::function<bool()>& interrupted, const PointSink& sink)>;

/// The same as run_study, but points of runs of motions are computed by `elsewhere`. The file is the same, too.
std::vector<RunReport> run_study(const Study& study, ResultFile& file, const RunnerOptions& options,
                                 const PointsElsewhere& elsewhere);

} // namespace graze
