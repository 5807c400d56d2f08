#pragma once

#include "graze/sweep/point_search.hpp"
#include "sweep/approach.hpp"
#include "sweep/attractor_setting.hpp"
#include "sweep/equilibrium.hpp"
#include "sweep/exponent.hpp"
#include "sweep/growth_watch.hpp"
#include "sweep/orbit_finder.hpp"
#include "sweep/quasi_periodic.hpp"
#include "sweep/return_watcher.hpp"
#include "sweep/sample_recorder.hpp"
#include "sweep/section_map.hpp"
#include "sweep/unstable_orbits.hpp"

#include <optional>
#include <span>
#include <vector>

namespace graze {

/// Follows a motion until it is known what it settles on.
class AttractorSearch : public PointSearch {
public:
    explicit AttractorSearch(std::shared_ptr<const AttractorSetting> setting);

    void begin(std::span<const double> parameters, std::span<const double> state, std::size_t mode) override;
    Trajectory& trajectory() override;
    bool proceed() override;
    PointResult& result() override { return result_; }

private:
    void limit_steps(std::span<const double> state, std::size_t mode);
    bool settle();
    bool look();
    bool hardly_moves();
    bool does_not_move() const;
    bool examine_return();
    bool go_on();
    void extend();
    void ask_for_closer(std::size_t period);
    bool find_orbit(std::span<const double> point, std::size_t period, std::span<const double> scale);
    std::optional<bool> try_next_guess();
    bool fills_a_torus();
    bool may_fill_a_torus();
    bool consider_orbit();
    std::optional<Equilibrium> equilibrium_of_orbit();
    std::optional<bool> consider_rest(std::span<const double> state, std::size_t mode);
    bool comes_closer(const Equilibrium& equilibrium);
    std::optional<bool> leave_equilibrium(const Equilibrium& equilibrium, double distance);
    std::optional<bool> leave_unstable_orbit(const Equilibrium* equilibrium);
    void displace(std::span<const double> state, std::size_t mode, double duration);
    std::optional<bool> conclude();
    void lengthen();
    void confirm_chaos();
    void restart(std::span<const double> state, std::size_t mode, double duration);
    std::vector<double> extents_of_visited() const;
    bool finish_periodic();
    bool finish_equilibrium(const Equilibrium& equilibrium);
    bool finish_still();
    bool finish(Label label);
    void start_exponent(bool sticks);

    std::shared_ptr<const AttractorSetting> setting_;
    std::optional<StepMaps> maps_; ///< for those that follow, where the model suits
    std::optional<MotionDerivatives> of_orbit_, of_motion_;
    ReturnWatcher watcher_;
    SampleRecorder recorder_;
    OrbitFinder finder_;
    Exponent exponent_;
    EquilibriumFinder equilibria_;
    GrowthWatch growth_;
    UnstableOrbits unstable_;
    std::optional<Trajectory> main_;
    bool confirming_ = false;   ///< that the motion remains chaotic
    bool finding_ = false;      ///< an orbit: the finder's trajectory is to be run
    bool centre_tried_ = false; ///< a stable orbit was looked for in the middle of what may be a torus
    bool limits_tried_ = false; ///< orbits were looked for where a slow motion may lead
    bool guessed_ = false;      ///< the orbit that is looked for is one of those
    bool near_stable_ = false;  ///< a stable orbit is too near for a torus
    std::vector<Guess> guesses_;
    std::vector<double> parameters_, periods_, thresholds_;
    VisitedStates visited_;  ///< in the time after `cycles`
    double growth_seen_ = 0; ///< logarithm of the extent, above which growth is looked at again
    std::size_t limit_ = 0, disturbances_ = 0, tries_ = 0;
    PointResult result_;
};

} // namespace graze
