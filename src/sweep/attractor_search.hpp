#pragma once

#include "graze/sweep/point_search.hpp"
#include "sweep/exponent.hpp"
#include "sweep/orbit_finder.hpp"
#include "sweep/return_watcher.hpp"
#include "sweep/sample_recorder.hpp"
#include "sweep/section_map.hpp"

#include <optional>
#include <span>
#include <vector>

namespace graze {

/// What all searches of a run share.
struct AttractorSetting {
    AttractorSetting(const Model& model, const AttractorOptions& given, const std::vector<Sampling>& samplings,
                     const std::vector<Expression>& values, const SimulationOptions& simulation_options);

    AttractorOptions options;
    SampleRecorder::Layout layout;
    Simulation simulation;
    SectionMap map;
    Function image; ///< of the first symmetry, in states and parameters
    std::vector<std::size_t> image_modes;
};

/// Follows a motion until it is known what it settles on.
class AttractorSearch : public PointSearch {
public:
    explicit AttractorSearch(const AttractorSetting& setting);

    void begin(std::span<const double> parameters, std::span<const double> state, std::size_t mode) override;
    Trajectory& trajectory() override;
    bool proceed() override;
    PointResult& result() override { return result_; }

private:
    bool settle();
    bool examine_return();
    bool go_on();
    bool consider_orbit();
    bool is_attracting() const;
    bool leave_unstable_orbit();
    bool conclude();
    void confirm_chaos();
    void restart(std::span<const double> state, std::size_t mode, double duration);
    bool comes_back();
    bool is_quasi_periodic();
    bool finish_periodic();
    bool finish(Label label);
    void start_exponent();

    const AttractorSetting* setting_;
    ReturnWatcher watcher_;
    SampleRecorder recorder_;
    OrbitFinder finder_;
    Exponent exponent_;
    std::optional<Trajectory> main_;
    bool confirming_ = false; ///< that the motion remains chaotic
    bool finding_ = false;    ///< an orbit: the finder's trajectory is to be run
    std::vector<double> parameters_, periods_, thresholds_;
    std::vector<double> visited_; ///< states at returns of the time after `cycles`
    std::size_t limit_ = 0, disturbances_ = 0;
    PointResult result_;
};

} // namespace graze
