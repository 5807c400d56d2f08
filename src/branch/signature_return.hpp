#pragma once

#include "orbit/orbit_flow.hpp"
#include "orbit/segment_ends.hpp"

#include <Eigen/Core>

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace graze {

/// The return of a motion that makes the segments of an orbit's signature, one after the other, from any state near the
/// orbit's first start: a smooth map with exact derivatives. No event is searched for: the motion goes on in the mode
/// of each segment until its own event happens, whatever others it passes.
class SignatureReturn {
public:
    /// @param parameter that varies; @param scales of the states, for the planes of cuts
    SignatureReturn(const Simulation& simulation, const Orbit& orbit, ParameterId parameter,
                    const Eigen::VectorXd& scales);

    struct Image {
        /// The motion, which need not close. Cyclic states begin each segment near those of the first orbit.
        Orbit motion;
        std::vector<double> after;   ///< state after the last segment (of a half orbit, its image)
        Eigen::MatrixXd derivatives; ///< of `after` with respect to the state before and the parameter
    };
    /// @param durations of the segments of a motion nearby
    /// @return none where the motion does not come to the end of a segment; `problem` says why
    std::optional<Image> follow(const std::vector<double>& state, double parameter, std::span<const double> durations);
    const std::string& problem() const { return problem_; }
    const Orbit& first() const { return first_; }

private:
    bool pass_segment(std::size_t segment, Image& image, double longest);
    bool find_end(std::size_t segment, const std::vector<double>& start, double& duration, double longest);
    void remove_turns(std::size_t next, Image& image);
    bool fail(std::string why);

    Orbit first_;
    ParameterId parameter_;
    ModeFlow flow_;
    SegmentEnds ends_;
    OrbitEvaluation::Piece piece_;
    std::string problem_;
};

} // namespace graze
