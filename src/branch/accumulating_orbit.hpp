#pragma once

#include "graze/branch/chatter_limit.hpp"
#include "graze/flow/mode_flow.hpp"
#include "graze/orbit/solve.hpp"
#include "graze/trajectory/simulation.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace graze {

/// An orbit whose contacts at one event accumulate where the event function and its first two derivatives are zero. It
/// starts there and is simulated over some contacts; the remaining contacts are approximated by the self-similar
/// sequence. Unknowns are the state of accumulation and a parameter.
class AccumulatingOrbit {
public:
    /// @param like a nearby orbit with the same period, symmetry and other parameters
    /// @param mode mode of the contacts; @param along the unknown parameter
    AccumulatingOrbit(const System& system, const Orbit& like, std::size_t mode, std::size_t event, ParameterId along,
                      double tolerance);

    /// Sets a first guess of the parameter, the number of simulated contacts, and a state near that of accumulation.
    /// @return false, with the problem set, where contacts cannot accumulate
    bool begin(double parameter, std::size_t count, const std::vector<double>& state, std::string& problem);
    /// Solves by a quasi-Newton method. @return false where it does not converge
    bool solve();
    bool has_solution() const { return solved_; }
    std::size_t contacts_of_solution() const { return solution_count_; }
    /// Increases the number of simulated contacts.
    void add_contacts(std::size_t more);

    ParameterId along() const { return along_; }
    double parameter() const { return unknowns_[parameter_place()]; }
    /// Uncertainty of the parameter due to round-off of heights.
    double uncertainty() const { return uncertainty_; }
    const SelfSimilarContacts& contacts() const { return contacts_; }
    /// Returns the orbit of the last solution, with one last segment for all contacts that are too small to plot.
    /// @param gap distance between its ends, relative to the scales of the states. @return empty where it cannot be
    /// followed
    std::optional<Orbit> orbit_for_output(double& gap);

private:
    /// The motion over a number of contacts, with an estimate of the remainder.
    struct Remainder {
        Eigen::VectorXd start;  ///< state of accumulation at the start
        Eigen::VectorXd state;  ///< state of accumulation at the end
        double left = 0;        ///< time from the last simulated contact to the accumulation
        double excess = 0;      ///< relative excess of the last speed over that of the self-similar sequence
        double uncertainty = 0; ///< uncertainty of the excess due to round-off of heights
        SelfSimilarContacts contacts;
        FollowedMotion motion;
        std::size_t contact = 0, segments = 0; ///< index of the last contact; number up to the return to the mode
    };
    Eigen::Index parameter_place() const { return scales_.size() - 1; }
    std::vector<double> inputs(const Eigen::VectorXd& state) const;
    bool set(const Eigen::VectorXd& unknowns);
    /// Values of h, h', h'', h'''; slopes: their gradients.
    Eigen::VectorXd heights(const Eigen::VectorXd& state) const;
    Eigen::MatrixXd slopes(const Eigen::VectorXd& state) const;
    Eigen::VectorXd field(const Eigen::VectorXd& state) const;
    bool project(Eigen::VectorXd& state) const;
    bool follow(std::size_t count, Remainder& remainder);
    bool compare_with_self_similar(const Eigen::VectorXd& before, const Eigen::VectorXd& after,
                                   Remainder& remainder) const;
    bool find_accumulation(const Eigen::VectorXd& before, const Eigen::VectorXd& after, Remainder& remainder) const;
    Eigen::VectorXd gaps(const Remainder& remainder) const;
    bool residuals(const Eigen::VectorXd& unknowns, Eigen::VectorXd& values, Remainder& remainder);
    bool differentiate(const Eigen::VectorXd& values);
    bool renew_excess(const Eigen::VectorXd& values);
    double size_of_step(const Eigen::VectorXd& step) const { return step.cwiseQuotient(scales_).cwiseAbs().maxCoeff(); }

    Simulation simulation_;
    ModeFlow flow_;
    Orbit like_;
    ParameterId along_;
    std::size_t mode_, event_, first_mode_;
    std::vector<Function> heights_; ///< h and its derivatives, each with its gradient
    std::vector<double> periods_, parameters_;
    Eigen::VectorXd solution_; ///< unknowns of the last solution
    std::size_t solution_count_ = 0;
    Eigen::VectorXd scales_, unknowns_,
        rows_;                    ///< scales of the states, then of the parameter; unknowns; scales of the equations
    Eigen::MatrixXd jacobian_;    ///< in scaled unknowns
    std::vector<bool> is_closed_; ///< true for states that are not drifting
    std::size_t count_ = 2, added_ = 1;
    bool solved_ = false;
    double uncertainty_ = 0;
    SelfSimilarContacts contacts_;
};

} // namespace graze
