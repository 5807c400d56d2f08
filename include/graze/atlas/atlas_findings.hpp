#pragma once

#include "graze/branch/special_point.hpp"
#include "graze/results/result_file.hpp"
#include "graze/study/study.hpp"

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace graze {

/// A parameter of an atlas, with its range.
struct AtlasAxis {
    std::string name, unit;
    double least = 0, greatest = 0;
};

/// A located point, once, however many runs have found it.
struct AtlasPoint {
    std::string name; ///< types and number within the atlas, such as "GR1", "SN+GR2"
    /// What it is: of several types where curves meet, each of which tells its own; the one with a name of its own
    /// first.
    std::vector<PointType> types;
    std::vector<double> at; ///< values of the parameters
    double period = 0;
    std::size_t multiple = 1, contacts = 0; ///< period in returns, contacts with barriers in one period
    std::string signature, detail;
    std::vector<std::string> found;  ///< "RUN:LABEL" of each run that has it
    std::vector<std::string> curves; ///< names of the curves that it lies on
    bool on_row = false;             ///< it was found on a branch in the first parameter
};

/// A curve in two parameters.
struct AtlasCurve {
    std::string name;                    ///< type and letter, such as "GR-a"
    PointType type = PointType::regular; ///< of its points
    std::string run;
    std::vector<std::string> same; ///< other runs that have found it
    std::size_t multiple = 1, contacts = 0;
    std::string signature;
    std::vector<std::array<double, 2>> line; ///< values of both parameters, from one end to the other
    std::vector<std::string> ends;
    std::size_t crossings = 0; ///< points of branches in the rows that lie on it
};

/// A piece of a branch on which orbits are stable.
struct AtlasStretch {
    double from = 0, to = 0; ///< values of the first parameter
    std::string confirmed;   ///< the motion that has settled on it: "RUN:NUMBER"; empty: none has
};

/// A branch in the first parameter.
struct AtlasBranch {
    std::string run;
    std::vector<std::string> same; ///< other runs that have found it
    std::size_t row = 0;           ///< number of the value of the second parameter
    std::size_t multiple = 1, contacts = 0;
    std::string signature;
    double least = 0, greatest = 0; ///< of the first parameter
    std::vector<AtlasStretch> stable;
    std::vector<std::string> ends;
};

/// What an atlas knows of a motion that it has simulated.
enum class AtlasClaim {
    explained,   ///< it has settled on a stable orbit of a branch
    unexplained, ///< it has settled on an orbit that lies on none of the branches
    beyond,      ///< it has settled on an orbit beyond the limits of what is followed
    other,       ///< it has not settled on a periodic orbit; the label says what it does
    invalid,     ///< it could not begin
};
std::string_view name_of(AtlasClaim claim);

struct AtlasMotion {
    std::string run;
    std::size_t number = 0, row = 0;
    double value = 0; ///< of the first parameter
    Label label = Label::unsettled;
    std::size_t period = 0, contacts = 0;
    bool accumulates = false; ///< contacts accumulate in each period
    AtlasClaim claim = AtlasClaim::other;
    std::string branch, detail; ///< run of the branch; why none is known
    bool confirms = false;      ///< it began on a stable orbit, to see whether motions settle on it

    /// What it does, in words: "period 1, 2 contacts", "chaotic".
    std::string attractor() const;
};

/// Something that was met and not gone on from.
struct AtlasRemainder {
    std::string what, where, why;
    std::size_t count = 1; ///< how many alike there are; `where` is the first
};

/// What an atlas has found.
struct AtlasFindings {
    std::string run;
    bool finished = false; ///< nothing is left to do within its limits
    bool limited = false;  ///< the number of branches or of curves has reached its limit
    std::vector<AtlasAxis> axes;
    std::vector<double> rows; ///< sampled values of the second parameter; empty: there is one parameter only
    std::vector<AtlasCurve> curves;
    std::vector<AtlasPoint> points;
    std::vector<AtlasBranch> branches;
    std::vector<AtlasMotion> motions;
    std::vector<AtlasRemainder> remainders;
    /// Values at which neighbouring rows differ: one has an attractor that is none of the stable orbits of the other.
    std::size_t changes = 0;
    std::size_t crossed = 0; ///< those between which a curve passes

    /// Whether it has gone on until nothing new was found.
    bool is_whole() const { return finished && !limited; }
    /// Number of motions with this claim, without those that confirm.
    std::size_t count(AtlasClaim claim) const;
    /// Share of motions that are explained, of all that are valid and do not confirm; 0 where there are none.
    double share() const;
};

/// What has been found so far by a run of kind atlas.
/// @param study with all runs, see stored_study
/// @throws InputError when the study has no such run, or results of another kind have its name
AtlasFindings atlas_findings(const Study& study, const std::string& run, const ResultFile& file);

} // namespace graze
