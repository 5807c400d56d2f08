#pragma once

#include "graze/record/samples.hpp"

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace graze {

/// A jump of the velocity in a record.
struct RecordedImpact {
    double time = 0, time_error = 0;
    double before = 0, before_error = 0; ///< velocity just before, with its standard error
    double after = 0, after_error = 0;   ///< and just after
    double covariance = 0;               ///< of both velocities: an error of the time moves both
};

/// Which samples beside an impact tell the velocities before and after it.
struct ImpactWindow {
    std::size_t window = 12;    ///< samples on each side that parabolas are fitted to: least_window ... most_window
    std::size_t transition = 0; ///< samples on each side that the impact itself disturbs, and that are left out
    double least_jump = 0;      ///< changes of the velocity below this are no impacts; 0: only noise is excluded

    static constexpr std::size_t least_window = 5, most_window = 100'000;
};

struct ImpactSettings : ImpactWindow {
    std::size_t velocity = 0;                  ///< channel
    std::optional<std::size_t> displacement{}; ///< channel whose corners tell the times of impacts; none: see below
    double significance = 6;                   ///< how many standard errors of its noise a jump exceeds
};
/// The settings for a record's channels of these names. @param displacement its name; empty: there is none
/// @param asked_as what stands before names of settings in messages, such as "--"
/// @throws InputError when the record has no channel of that name
ImpactSettings impact_settings(const RecordHeader& header, const std::string& velocity, const std::string& displacement,
                               const ImpactWindow& window, const std::string& asked_as = "");

/// Finds jumps of a noisy velocity. To the samples on both sides of each place parabolas are fitted by least squares; a
/// jump is where their values differ by more than noise and their own misfit explain, and more than beside it. The
/// noise is what third differences of the velocity have in the median, or the step in which numbers of few digits go.
/// Then parabolas, or polynomials of higher degree where the next terms stand out of the noise, are fitted to samples
/// that have no other impact between them and this one, and continued to the time of the impact: the middle between two
/// samples, with their distance over the square root of 12 as its error, or where such polynomials through the
/// displacement meet. Impacts that follow one another by fewer samples than the window may be missed.
class ImpactFinder {
public:
    /// @param source must outlive this
    /// @throws InputError for settings without meaning
    ImpactFinder(SampleSource& source, const ImpactSettings& settings);
    ~ImpactFinder();
    ImpactFinder(const ImpactFinder&) = delete;
    ImpactFinder& operator=(const ImpactFinder&) = delete;
    /// The next ones, in the order of time. @return false when there are no more; `impacts` may be empty before
    /// @throws InputError when the samples are not at equal distances of time
    bool next(std::vector<RecordedImpact>& impacts);

private:
    struct State;
    std::unique_ptr<State> state_;
};

/// All of them. @throws InputError when there are more than a million
std::vector<RecordedImpact> find_impacts(SampleSource& source, const ImpactSettings& settings);

} // namespace graze
