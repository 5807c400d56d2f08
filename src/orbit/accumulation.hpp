#pragma once

#include "graze/flow/system.hpp"
#include "graze/trajectory/simulation.hpp"
#include "orbit/eigen_index.hpp"

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace graze {

/// The end of a complete chatter sequence: the infinitely many contacts that follow a slow contact, as one map of the
/// state after that contact to the state and time of accumulation (Budd and Dux 1994; Nordmark and Piiroinen 2009),
/// with exact derivatives of that map. With u the rate of the event function after the contact, A its deceleration on
/// the surface, J the rate at which A falls and c the rate at which the deceleration grows with the speed, the contacts
/// accumulate after
///
///     s (1 + (2 J u / A^2 - c u / A) / (3 (1 - r))),   s = 2 u / (A (1 - r)),
///
/// with r the ratio of speeds. The state moves as if it was held on the surface already. Both are known to third order
/// in s.
class Accumulation {
public:
    /// @param transition made at each contact; it declares `chatter`. @param free parameters of the derivatives
    Accumulation(const System& system, std::size_t transition, std::vector<ParameterId> free);

    struct Remainder {
        double time = 0;           ///< from the contact to the accumulation
        Eigen::VectorXd state;     ///< at the accumulation, before the chatter's jump
        Eigen::VectorXd time_by;   ///< derivatives with respect to states, then free parameters
        Eigen::MatrixXd state_by;  ///< the same, states x (states + free)
        double deceleration = 0;   ///< with which the surface is pressed on at the accumulation
        double ratio = 0;          ///< of speeds after and before a contact
        double relative_error = 0; ///< estimate of what the sum neglects, relative to the remaining time
        double round_off = 0;      ///< of the remaining time: that of the contact, divided by its speed
    };
    std::size_t mode() const { return mode_; }
    std::size_t transition() const { return transition_; }
    std::size_t event() const { return event_; }
    /// @param state just after a contact; @return false where contacts do not accumulate
    bool evaluate(std::span<const double> state, std::span<const double> parameters, Remainder& result) const;
    /// Returns the event function and its first two rates at a state.
    std::vector<double> heights(std::span<const double> state, std::span<const double> parameters) const;
    /// Returns the size of the terms of the event function at a state.
    double size(std::span<const double> state, std::span<const double> parameters) const;

private:
    struct Field;
    Field field(const Eigen::VectorXd& state, std::span<const double> parameters) const;
    Eigen::RowVectorXd gradient_of(std::span<const double> values) const;

    std::size_t n_, transition_, event_, mode_;
    std::vector<ParameterId> free_;
    std::vector<Function> heights_; ///< event function and two rates, with gradients
    std::vector<Function> surface_; ///< deceleration, c, J, r, then kicks and field, with gradients
};

/// The contacts of a complete chatter sequence that are resolved one by one.
struct ChatterContacts {
    std::vector<std::vector<double>> starts; ///< of the flights; the last one is the state after the last contact
    std::vector<double> durations;           ///< of the flights that end with a contact: one less
    std::string problem;                     ///< why the contacts do not accumulate; empty if they do
};

/// Follows the motion from the start of a chatter sequence over as many contacts as are needed for the remaining ones
/// to be summed.
/// @param duration approximate time of the accumulation. @param count number of contacts, if it is given
ChatterContacts follow_chatter(const Simulation& simulation, const Accumulation& accumulation,
                               std::span<const double> parameters, std::span<const double> start, double duration,
                               std::optional<std::size_t> count = std::nullopt);

/// Returns the error of the sum of the remaining contacts, relative to the error below which it is as accurate as the
/// contacts are themselves: below 1, enough contacts are resolved.
/// @param duration of the chatter sequence
double excess_error(const Accumulation::Remainder& remainder, double duration);

} // namespace graze
