#pragma once

#include "base/special_numbers.hpp"
#include "graze/base/input_error.hpp"
#include "graze/base/with_place.hpp"
#include "graze/branch/switching.hpp"
#include "graze/study/runner.hpp"
#include "study/shared_file.hpp"

#include <fmt/format.h>

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace graze {

/// A value of a point that is not known, which is NULL in the file.

/// A branch that a run follows from an orbit in one direction.
struct BranchPart {
    std::string name;
    Orbit orbit;
    std::optional<BranchStart> onto; ///< the branch that begins so is followed, rather than that through the orbit
    int direction = 1;
    bool again = false;   ///< another part of the run begins at the same orbit
    std::string image_of; ///< the part whose orbits have those of this part as symmetric images; empty: none
    std::optional<SpecialPoint> kept = std::nullopt;  ///< of curves
    std::optional<PointType> kept_too = std::nullopt; ///< of curves of codimension two
};

/// Gives errors of numerical functions the place and the name of the run.
template <class Work>
auto at_place(const Place& place, const StudyRun& run, const Work& work) {
    return with_place(place, work, "run '" + run.name + "': ");
}

/// What becomes of an orbit beyond its touch, by the map of its cycle and the first of the run's parameters that moves
/// the orbit from the touch. It is told of grazings, and of all points of curves of touches. @return none otherwise
std::optional<TouchFindings> findings_at(const StudyRun& run, const SpecialPoint& point);

/// The point that is stored of an orbit that has been solved for by itself.
SpecialPoint point_of_solution(const StudyRun& run, const System& system, OrbitSolution solution);

/// Writes points to the result file one by one. It holds the last point back until it is known whether the part ends
/// there.
class PointWriter {
public:
    PointWriter(const StudyRun& run, SharedFile& file, const RunnerOptions& options, RunReport& report)
        : run_(&run), file_(&file), options_(&options), report_(&report) {}

    void add(const std::string& part, const SpecialPoint& point, bool stable,
             std::optional<TorusRecord> torus = std::nullopt);
    /// Points to come are compared with those of this earlier part, of which they may be symmetric images.
    void set_image_of(const std::string& part) { image_of_ = part; }
    /// Ends a part: its last point becomes an end point unless it is special already. @param why is added to its detail
    void end(const std::string& why);
    /// Forgets the last point, which does not belong to the branch.
    void drop() { waiting_.reset(); }
    void flush();

private:
    void note_image(OrbitRecord& record);

    const StudyRun* run_;
    SharedFile* file_;
    const RunnerOptions* options_;
    RunReport* report_;
    std::string image_of_;
    std::vector<OrbitRecord> special_; ///< special points that have been written
    std::map<PointType, std::size_t> counts_;
    std::optional<OrbitRecord> waiting_;
};

/// Tells how a part has ended.
struct PartEnd {
    bool interrupted = false;
    BranchOutcome outcome = BranchOutcome::no_start;
    bool begun = true; ///< its first orbit was found
    bool left = true;  ///< it has a second point
    std::string why;
    std::optional<SpecialPoint> last; ///< if it has ended at a special point
};

/// Follows a part and writes its points. @param settings of the run, or of a rung of a ladder
PartEnd follow_part(const StudyRun& run, const BranchSettings& settings, const System& system, const BranchPart& part,
                    PointWriter& writer, const RunnerOptions& options);

} // namespace graze
