#pragma once

#include "graze/base/item_range.hpp"
#include "graze/study/runner.hpp"

#include <chrono>
#include <cstddef>
#include <functional>
#include <memory>
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
    /// @param known what of these chains is there; they are numbered from 0 on there
    /// @param sink receives the points, in order within each chain; called by one thread at a time
    /// @return false if it was stopped
    bool compute(ItemRange chains, const KnownChains& known, const ExecutionOptions& options,
                 const PointSink& sink) const;

private:
    struct State;
    std::unique_ptr<const State> state_;
};

/// What is to be computed by somebody else, in bytes: some chains of a run, and what of them is there.
struct RunPart {
    ItemRange chains;
    KnownChains known{}; ///< the chains are numbered from 0 on there
};
std::string bytes_of(const RunPart& part);
/// @throws InputError when the bytes are none of `bytes_of`
RunPart part_of(std::string_view bytes);

/// Receives what has been computed of a part, since the last piece.
using PieceSink = std::function<void(std::string piece)>;

/// Computes a part with one thread.
/// @param sink receives pieces of the result while it goes on, so that little is lost when it is stopped; without one
/// there is one piece
/// @param between time between pieces at least
/// @return the last piece, for PointsReader; empty: it was interrupted
std::string computed_points(const PartedRun& run, const RunPart& part, const std::function<bool()>& interrupted,
                            const PieceSink& sink = {}, std::chrono::milliseconds between = std::chrono::seconds(1));

/// Reads the points of one part, all bits of them, piece by piece.
class PointsReader {
public:
    /// @throws InputError for a part that the run does not have
    PointsReader(const PartedRun& run, RunPart part);
    /// Gives the points of the next piece to `sink`.
    /// @throws InputError, before any point of the piece is given, when the bytes are not the next piece of the part
    void read(std::string_view piece, bool is_last, const PointSink& sink);

private:
    const PartedRun* run_;
    RunPart part_;
    std::vector<std::size_t> next_; ///< of each chain, the number in it of the point that comes next
};
/// The same where there is one piece.
void read_points(const PartedRun& run, const RunPart& part, std::string_view bytes, const PointSink& sink);

} // namespace graze
