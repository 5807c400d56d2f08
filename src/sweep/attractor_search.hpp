#pragma once

#include "sweep/approach.hpp"
#include "sweep/attractor_setting.hpp"
#include "sweep/equilibrium.hpp"
#include "sweep/exponent.hpp"
#include "sweep/growth_watch.hpp"
#include "sweep/quasi_periodic.hpp"

#include <string_view>

namespace graze {

/// Follows a motion until its long-term behaviour is known. Functions returning bool return false when the search is
/// done.
class AttractorSearch : public PointSearch {
public:
    explicit AttractorSearch(std::shared_ptr<const AttractorSetting> setting);

    void begin(std::span<const double> parameters, std::span<const double> state, std::size_t mode) override;
    Trajectory& trajectory() override;
    bool proceed() override;
    PointResult& result() override { return result_; }

private:
    static constexpr std::size_t most_tries = 50; ///< attempts of Newton's method
    void limit_steps(std::span<const double> state, std::size_t mode);
    bool settle();
    bool examine_without_return();
    bool hardly_moves();
    void keep_signs(std::vector<double>& state);
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
    std::vector<std::size_t> states_of_plane() const;
    double scale_beside_plane(std::size_t state);
    double share_beside(const Eigen::MatrixXd& normals, const std::vector<std::size_t>& states,
                        const Eigen::VectorXd& scale) const;
    bool same_sides(std::span<const double> before, std::span<const double> after, std::size_t mode);
    std::optional<bool> leave_plane();
    std::optional<std::vector<double>> displaced_by(const std::vector<std::size_t>& states,
                                                    const Eigen::VectorXd& change);
    std::optional<bool> consider_growth();
    bool is_behind_event(std::span<const double> state);
    bool has_no_size();
    bool shrinks_to_a_corner();
    bool moves_along_orbit();
    bool vanishes_at_rest();
    bool approaches_rest_slowly();
    void finish_limit(std::string_view detail);
    bool is_neutral() const;
    bool repeats_exactly();
    OrbitStay::Verdict go_on_repeating();
    std::optional<bool> conclude();
    void lengthen();
    std::optional<bool> confirm_chaos();
    void return_to_chaos();
    std::size_t usual_chaos() const;
    std::size_t chaos_needed() const;
    void note_passed_orbit();
    std::optional<bool> conclude_chaos();
    bool begin_stay();
    bool go_on_staying();
    std::size_t exponent_cycles() const;
    void restart(std::span<const double> state, std::size_t mode, double duration);
    std::vector<double> extents_of_visited() const;
    bool finish_periodic();
    bool finish_equilibrium(const Equilibrium& equilibrium);
    bool finish_undisturbed();
    bool finish(Label label);
    void start_exponent();
    void measure_growth(bool sticks);
    void add_to_exponent();
    bool collapses_repeatedly() const { return collapses_ > 1; }
    bool follows_from_rest() const;

    std::shared_ptr<const AttractorSetting> setting_;
    std::optional<StepMaps> maps_; ///< shared by the derivatives below, if the model has few directions
    std::optional<MotionDerivatives> of_orbit_, of_motion_;
    ReturnWatcher watcher_;
    SampleRecorder recorder_;
    OrbitFinder finder_;
    Exponent exponent_;
    EquilibriumFinder equilibria_;
    GrowthWatch growth_;
    UnstableOrbits unstable_;
    std::optional<Trajectory> main_;
    /// The motion when it was first labelled chaotic.
    struct Chaos {
        std::vector<double> state;
        std::size_t mode = 0;
        SampleSet samples;
        double lyapunov = 0, error = 0;
    };
    std::optional<Chaos> chaos_;
    OrbitStay stay_;
    bool repeating_ = false;                   ///< the orbit belongs to a continuous family
    bool plane_left_ = false;                  ///< the motion was displaced from an invariant plane
    bool staying_ = false;                     ///< it is being tested whether the motion stays with the orbit found
    bool lengthened_ = false;                  ///< the search has been extended beyond `cycles`
    bool confirming_ = false;                  ///< it is being tested whether the motion remains chaotic
    std::size_t chaotic_ = 0;                  ///< number of times that the motion was considered chaotic
    std::size_t chaotic_since_ = 0;            ///< return at which this happened last
    std::size_t collapses_ = 0;                ///< number of times that all neighbouring motions have merged into one
    double last_grown_ = 0, grown_before_ = 0; ///< log separation of neighbours before the last two collapses
    bool landing_unseen_ = false;   ///< it is unknown whether neighbours merged at the last accumulation of contacts
    std::size_t passed_period_ = 0; ///< period of a stable orbit that the motion has passed by; 0: none
    bool finding_ = false;          ///< an orbit is being searched: the finder's trajectory is to be run
    bool centre_tried_ = false;     ///< a stable orbit was searched in the centre of a possible torus
    bool limits_tried_ = false;     ///< orbits were searched at the possible limits of a slow motion
    bool guessed_ = false;          ///< the orbit being searched is one of these
    bool near_stable_ = false;      ///< a stable orbit is too close for a torus
    std::vector<Guess> guesses_;
    std::vector<double> parameters_, periods_, thresholds_;
    VisitedStates visited_;           ///< states at returns after `cycles`
    double growth_seen_ = 0;          ///< logarithm of the extent above which growth is examined again
    std::size_t repeating_since_ = 0; ///< return at which the test of exact repetition began
    std::size_t limit_ = 0, disturbances_ = 0, tries_ = 0;
    PointResult result_;
};

} // namespace graze
