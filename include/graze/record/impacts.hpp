#pragma once

#include "graze/record/samples.hpp"

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace graze {

/// An impact found in a record: a jump of the velocity.
struct RecordedImpact {
    double time = 0, time_error = 0;
    double before = 0, before_error = 0; ///< velocity just before, with its standard error
    double after = 0, after_error = 0;   ///< velocity just after, with its standard error
    double covariance = 0; ///< covariance of both velocities, from the error of the time, which shifts both
};

/// The part of ImpactSettings that does not depend on the channels of a record.
struct ImpactWindow {
    /// Samples before and after an impact to which velocities are fitted, least_window ... most_window; fewer find
    /// impacts that follow one another closely, more reduce noise.
    std::size_t window = 12;
    /// Samples before and after an impact that are ignored, as the impact itself disturbs them.
    std::size_t transition = 0;
    double least_jump = 0; ///< smaller jumps of the velocity are ignored

    static constexpr std::size_t least_window = 5, most_window = 100'000;
};

/// Options of `ImpactFinder`.
struct ImpactSettings : ImpactWindow {
    std::size_t velocity = 0;                  ///< velocity channel
    std::optional<std::size_t> displacement{}; ///< displacement channel; if given, impacts are timed by its corners
    double significance = 6; ///< a jump must exceed its standard error by this factor; raise it against false impacts
};
/// The settings for a record's channels of these names. @param displacement its name; empty: there is none
/// @throws InputError when the record has no channel of that name
ImpactSettings impact_settings(const RecordHeader& header, const std::string& velocity, const std::string& displacement,
                               const ImpactWindow& window);

/// Finds impacts, which are jumps of a noisy velocity. At each place parabolas are fitted by least squares to the
/// samples on both sides. An impact is where their values differ by more than noise and misfit explain, and by more
/// than at neighbouring places. The noise is estimated from the median of third differences, or from the step of
/// numbers with few digits. Then polynomials are fitted to the samples up to the neighbouring impacts (parabolas, or
/// higher degrees if the next terms are significant) and extrapolated to the time of the impact: the middle between two
/// samples, with their distance over the square root of 12 as its error; or, with a displacement channel, the time at
/// which the polynomials through the displacement meet. Impacts closer to one another than the window may be missed.
class ImpactFinder {
public:
    /// @param source is shared
    /// @throws InputError for invalid settings
    ImpactFinder(std::shared_ptr<SampleSource> source, const ImpactSettings& settings);
    ~ImpactFinder();
    ImpactFinder(const ImpactFinder&) = delete;
    ImpactFinder& operator=(const ImpactFinder&) = delete;
    /// Finds the next impacts, in the order of time. @return false at the end of the record; `impacts` may be empty
    /// before
    /// @throws InputError when the samples are not equidistant in time
    bool next(std::vector<RecordedImpact>& impacts);

private:
    struct State;
    std::unique_ptr<State> state_;
};

/// Returns all impacts of a source. @throws InputError when there are more than a million
std::vector<RecordedImpact> find_impacts(SampleSource& source, const ImpactSettings& settings);

} // namespace graze
