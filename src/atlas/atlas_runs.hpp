#pragma once

#include "atlas/orbit_mark.hpp"
#include "graze/results/result_file.hpp"
#include "graze/study/study.hpp"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace graze {

/// An orbit of a run that the atlas has made, without its segments.
struct FollowedOrbit {
    std::size_t number = 0; ///< of the point in its run
    std::string part, label;
    PointType type = PointType::regular;
    bool stable = false, located = true, physical = true;
    bool at_end = false; ///< of a touch: the contact with zero speed belongs to the orbit
    OrbitMark mark;
    std::size_t contacts = 0; ///< with barriers, in one period
    std::string signature, detail;

    bool is_special() const { return !label.empty(); }
};

/// A run of kind continue or curve that the atlas has made.
struct FollowedRun {
    const StudyRun* run = nullptr;
    std::size_t multiple = 1;            ///< the period of its orbits, in returns
    std::optional<std::size_t> row;      ///< of a branch: the row of samples that it belongs to
    PointType kept = PointType::regular; ///< of a curve: the type of its points
    std::vector<FollowedOrbit> orbits;   ///< from the end of the first part to the end of the second one
    std::string failure;                 ///< why there is no branch, or only a part of it
    std::vector<std::pair<std::string, std::string>> ends; ///< of each part: its name, and why it ends
    const FollowedRun* same_as = nullptr;                  ///< an earlier run that has found the same

    const std::string& name() const { return run->name; }
    bool is_curve() const { return run->kind == RunKind::curve; }
    /// The orbit at which it begins, between both parts.
    const FollowedOrbit& start() const;
    bool is_found() const { return !orbits.empty() && !same_as; }
    /// Whether it has an orbit that is the same as this one, among special points.
    const FollowedOrbit* special_at(const OrbitMark& mark, const MarkScales& scales, bool multiples = false) const;
};

/// A motion that was simulated: a point of the run itself, or of one that it has made from random states or from a
/// stable orbit.
struct SampledMotion {
    const StudyRun* run = nullptr;
    std::size_t number = 0;
    std::size_t row = 0;
    double value = 0;         ///< of the first parameter
    PointResult result;       ///< without samples
    std::size_t contacts = 0; ///< with barriers, in one period
    bool accumulates = false; ///< contacts accumulate within the period
    bool is_valid() const { return result.label != Label::failed; }
};

/// All that an atlas has computed so far, as it stands in a result file.
struct AtlasRuns {
    const StudyRun* atlas = nullptr;
    MarkScales scales;
    std::vector<double> rows; ///< values of the second parameter; one NaN where there is one parameter only
    std::vector<FollowedRun> branches, curves;
    std::vector<SampledMotion> samples;

    const Variation& axis(std::size_t i) const { return atlas->motion().axes.at(i); }
    bool has_rows() const { return atlas->motion().axes.size() > 1; }
    /// The range of a parameter of the box.
    std::pair<double, double> range(std::size_t i) const;
    const FollowedRun* find(const std::string& run) const;
};

/// Names of runs that an atlas makes: "map.branch3".
bool is_made_by(const std::string& run, const std::string& atlas);

/// Whether an atlas and the runs that it has made are no longer to be computed: samples are complete; branches and
/// curves may have failed.
bool is_computed(const Study& study, const StudyRun& atlas, const ResultFile& file);

/// Reads what is there of an atlas. @param atlas run of the study, valid as long as the study
AtlasRuns read_atlas(const Study& study, const StudyRun& atlas, const ResultFile& file);

} // namespace graze
