#pragma once

#include "graze/flow/roots.hpp"
#include "graze/flow/system.hpp"
#include "graze/tape/series.hpp"

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace graze {

/// Ends steps where the argument of a table passes from one piece to the next: series hold within a piece. The motion
/// passes a knot by no more than its round-off, so that the state alone tells the piece. Values are continuous there,
/// so that derivatives pass unchanged (the saltation matrix is the identity).
class TableSteps {
public:
    TableSteps(const System& system, int order);
    /// Returns null where no mode looks up a table.
    static std::unique_ptr<TableSteps> of(const System& system, int order);

    void set_parameters(std::span<const double> parameters);
    /// Returns the length of a step of at most this length, which may be negative.
    /// NaN if the argument leaves the points of a table outside of which nothing is known.
    /// @param series as of Jet::series, at the beginning of the step
    double limit(std::size_t mode, std::span<const Series> series, double length);
    /// Whether the step that was last limited passes a knot at which slopes jump. It is as short as round-off, and
    /// rates of derivatives at its end are not those of its series.
    bool crosses() const { return crosses_; }

private:
    /// Returns the time until a distance that is positive at first has fallen to zero, for the table's piece to end.
    double time_to_end(double margin, double reach, bool smooth);
    double time_to_fall(double below, double reach);
    bool falls_at_once() const;

    System system_;
    RootFinder finder_;
    bool crosses_ = false;
    std::vector<double> inputs_, errors_, bounds_, work_;
    std::vector<double> argument_, distance_; ///< coefficients
};

} // namespace graze
