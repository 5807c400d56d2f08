#pragma once

#include "sweep/field_map.hpp"
#include "sweep/return_watcher.hpp"

namespace graze {

/// Finds a periodic orbit near a state by Newton's method on the return map: a state machine that provides a trajectory
/// to be run. After convergence the orbit is run once more to sample it, find its least period, and test whether it is
/// its own image under the symmetry.
class OrbitFinder {
public:
    /// @param field tells which states keep their signs; @param derivatives that follow motions; null: trajectories
    /// propagate their own
    OrbitFinder(const SectionMap& map, const FieldMap& field, const SampleRecorder::Layout& layout,
                const Function& image, const std::vector<std::size_t>& image_modes, MotionDerivatives* derivatives);

    /// @param point the starting point; @param period in returns; @param scale of each state; @param duration estimate
    /// of the period in time; @param sticks whether contacts are likely to accumulate
    void begin(std::span<const double> parameters, std::span<const double> periods, std::span<const double> point,
               std::size_t mode, std::size_t period, std::span<const double> scale, double duration, bool sticks);
    /// Bounds the steps of its trajectories from the next `begin` on; 0: no bound.
    void limit_step(double longest) { longest_step_ = longest; }
    Trajectory& trajectory() { return *trajectory_; }
    /// To be called when the trajectory has finished. @return false when done, successful or not
    bool proceed();

    bool found() const { return stage_ == Stage::found; }
    /// Returns whether the search ended because the orbit, about at `point`, is so unstable that motions soon leave it.
    bool clearly_unstable() const { return stage_ == Stage::failed && clearly_unstable_; }
    std::span<const double> point() const { return point_; }
    std::size_t mode() const { return mode_; }
    std::size_t period() const { return period_; }
    double duration() const { return duration_; }
    double residual() const { return residual_; }
    std::span<const double> extents() const { return extents_; } ///< range of each state along the orbit
    const Eigen::MatrixXd& jacobian() const { return jacobian_.matrix; }
    bool is_active(std::size_t state) const;
    const std::vector<std::complex<double>>& multipliers() const { return spectrum_.multipliers; }
    const Eigen::VectorXd& leading_direction() const { return spectrum_.direction; }
    const Eigen::VectorXcd& leading_functional() const { return spectrum_.functional; }
    const std::vector<std::uint32_t>& contacts() const { return contacts_; }
    std::optional<bool> symmetric() const { return symmetric_; }
    SampleSet& samples() { return recorder_.samples(); }
    /// Returns the states at the returns of the orbit.
    const std::vector<std::vector<double>>& returns() const { return recorded_; }
    std::size_t returns_run() const { return returns_; } ///< since `begin`

private:
    enum class Stage { iterating, recording, comparing, found, failed };
    bool is_on_section();
    void start_run(Stage stage);
    bool find_tangents(Eigen::MatrixXd& tangents);
    bool carries() const { return !derivatives_ || sticks_; }
    bool linearise();
    bool find_spectrum();
    bool iterate();
    bool record();
    bool others_return(std::span<const double> image) const;
    void keep_orbit();
    void start_comparison();
    bool compare();
    bool fail();

    const SectionMap* map_;
    const FieldMap* field_;
    const Function* image_;
    const std::vector<std::size_t>* image_modes_;
    MotionDerivatives* derivatives_;
    ReturnWatcher watcher_;
    SampleRecorder recorder_;
    SectionMap::Workspace workspace_;
    std::optional<Trajectory> trajectory_;
    std::vector<double> parameters_, periods_, point_, seeds_, extents_;
    Eigen::VectorXd scale_;
    ReturnJacobian jacobian_;
    ReturnSpectrum spectrum_;
    std::vector<std::uint32_t> contacts_;
    std::vector<std::vector<double>> recorded_; ///< states at the returns of the orbit
    std::optional<bool> symmetric_;
    std::size_t mode_ = 0, period_ = 0, iterations_ = 0, returns_ = 0;
    double duration_ = 0, residual_ = 0, guard_ = 0, correction_ = 0, longest_step_ = 0;
    Stage stage_ = Stage::failed;
    bool clearly_unstable_ = false, returns_to_section_ = true;
    bool sticks_ = false; ///< contacts accumulate: trajectories have to propagate their derivatives
};

} // namespace graze
