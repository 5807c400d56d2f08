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

/// An orbit whose contacts at one event accumulate where the event's function and its first two rates are zero. It
/// begins there and is followed, as the model does, over some contacts; for the rest it is taken to be self-similar.
/// Unknowns are the state in which contacts accumulate and a parameter.
class AccumulatingOrbit {
public:
    /// @param like an orbit that is near, of the same period, symmetry and other parameters
    /// @param mode in which the event is met; @param along the parameter
    AccumulatingOrbit(const System& system, const Orbit& like, std::size_t mode, std::size_t event, ParameterId along,
                      double tolerance);

    /// Takes the parameter's value, a number of contacts, and a state near that in which they accumulate.
    /// @return false, with the problem, where nothing can accumulate
    bool begin(double parameter, std::size_t count, const std::vector<double>& state, std::string& problem);
    /// Newton's method. @return false where it does not converge
    bool solve();
    bool has_solution() const { return solved_; }
    std::size_t contacts_of_solution() const { return solution_count_; }
    /// From now on, with more contacts.
    void add_contacts(std::size_t more);

    ParameterId along() const { return along_; }
    double parameter() const { return unknowns_[parameter_place()]; }
    /// Of the parameter, by round-off of heights.
    double uncertainty() const { return uncertainty_; }
    const SelfSimilarContacts& contacts() const { return contacts_; }
    /// The last solution's motion over contacts until little is left, for which a last segment stands. @param gap
    /// between its ends, relative to the sizes of the states. @return none where it cannot be followed
    std::optional<Orbit> shown(double& gap);

private:
    /// The motion after a number of contacts.
    struct Rest {
        Eigen::VectorXd start;  ///< in which they have accumulated before
        Eigen::VectorXd state;  ///< in which contacts will accumulate
        double left = 0;        ///< time until then
        double excess = 0;      ///< of the speed over that of the self-similar sequence
        double uncertainty = 0; ///< of the excess, by round-off of heights
        SelfSimilarContacts contacts;
        FollowedMotion motion;
        std::size_t contact = 0, segments = 0; ///< the last one that counts; until there
    };
    Eigen::Index parameter_place() const { return scales_.size() - 1; }
    std::vector<double> inputs(const Eigen::VectorXd& state) const;
    bool set(const Eigen::VectorXd& unknowns);
    /// h, h', h'', h''' and their gradients.
    Eigen::VectorXd heights(const Eigen::VectorXd& state) const;
    Eigen::MatrixXd slopes(const Eigen::VectorXd& state) const;
    Eigen::VectorXd field(const Eigen::VectorXd& state) const;
    bool project(Eigen::VectorXd& state) const;
    bool follow(std::size_t count, Rest& rest);
    bool judge(const Eigen::VectorXd& before, const Eigen::VectorXd& after, Rest& rest) const;
    bool accumulate(const Eigen::VectorXd& before, const Eigen::VectorXd& after, Rest& rest) const;
    bool residuals(const Eigen::VectorXd& unknowns, Eigen::VectorXd& values, Rest& rest);
    bool differentiate(const Eigen::VectorXd& values);
    bool renew_excess(const Eigen::VectorXd& values);
    double size_of_step(const Eigen::VectorXd& step) const { return step.cwiseQuotient(scales_).cwiseAbs().maxCoeff(); }

    Simulation simulation_;
    ModeFlow flow_;
    Orbit like_;
    ParameterId along_;
    std::size_t mode_, event_, first_mode_;
    std::vector<Function> heights_; ///< each with its gradient
    std::vector<double> periods_, parameters_;
    Eigen::VectorXd solution_; ///< the last one, with the number of its contacts
    std::size_t solution_count_ = 0;
    Eigen::VectorXd scales_, unknowns_, rows_; ///< of states, then the parameter; of the equations
    Eigen::MatrixXd jacobian_;                 ///< in units of the scales
    std::vector<bool> closes_;                 ///< states that come back
    std::size_t count_ = 2, added_ = 1;
    bool solved_ = false;
    double uncertainty_ = 0;
    SelfSimilarContacts contacts_;
};

} // namespace graze
