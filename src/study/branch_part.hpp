#pragma once

#include "graze/base/input_error.hpp"
#include "graze/base/with_place.hpp"
#include "graze/branch/switching.hpp"
#include "graze/study/runner.hpp"
#include "study/shared_file.hpp"

#include <fmt/format.h>

#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace graze {

/// Of a point: NULL in the file.
inline constexpr double unknown_value = std::numeric_limits<double>::quiet_NaN();

/// A branch, or half of one, that a run follows.
struct BranchPart {
    std::string name;
    Orbit orbit;
    std::optional<BranchStart> onto; ///< along this rather than along the branch through the orbit
    int direction = 1;
    bool again = false; ///< another part has begun at the same orbit
    std::string twin;   ///< of which part its orbits are images under the symmetry; empty: of none
    std::optional<SpecialPoint> kept = std::nullopt;  ///< of curves
    std::optional<PointType> kept_too = std::nullopt; ///< of curves of codimension two
};

/// Messages of numerical functions, with the place of the run.
template <class Work>
auto at_place(const Place& place, const StudyRun& run, const Work& work) {
    return with_place(place, work, "run '" + run.name + "': ");
}

/// Writes points one by one, the last of a part only when it is known to be the last.
class PointWriter {
public:
    PointWriter(const StudyRun& run, SharedFile& file, const RunnerOptions& options, RunReport& report)
        : run_(&run), file_(&file), options_(&options), report_(&report) {}

    void add(const std::string& part, const SpecialPoint& point, bool stable);
    /// Points to come are images of those of an earlier part, if they are like them.
    void set_twin(const std::string& part) { twin_ = part; }
    /// What is said of the last point, which becomes an end unless it is special already.
    void end(const std::string& why);
    /// The last point has been none.
    void drop() { waiting_.reset(); }
    void flush();

private:
    void note_twin(OrbitRecord& record);

    const StudyRun* run_;
    SharedFile* file_;
    const RunnerOptions* options_;
    RunReport* report_;
    std::string twin_;
    std::vector<OrbitRecord> special_; ///< written so far
    std::map<PointType, std::size_t> counts_;
    std::optional<OrbitRecord> waiting_;
};

/// How a part has ended.
struct PartEnd {
    bool interrupted = false;
    BranchOutcome outcome = BranchOutcome::no_start;
    bool begun = true;
    bool left = true; ///< its first point
    std::string why;
    std::optional<SpecialPoint> last; ///< if it has ended at a special point
};

/// Follows a part and writes its points. @param settings of the run, or more special ones
PartEnd follow_part(const StudyRun& run, const BranchSettings& settings, const System& system, const BranchPart& part,
                    PointWriter& writer, const RunnerOptions& options);

} // namespace graze
