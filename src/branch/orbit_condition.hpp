#pragma once

#include "graze/branch/monitor.hpp"
#include "graze/branch/special_point.hpp"
#include "graze/flow/roots.hpp"
#include "orbit/orbit_equations.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <optional>
#include <vector>

namespace graze {

/// A number of an orbit as a function of the unknowns of its equations, with its exact gradient, and the value that it
/// is to have. One thing in many roles: a monitor that is held, the speed at which an event is to be met, what vanishes
/// at a special point and can be kept zero while another parameter varies (H. Dankowicz and F. Schilder, "Recipes for
/// Continuation", 2013, where monitor functions have this part).
///
/// An extremum changes as the function's value at its time does, since that is where its time does not matter; a mean
/// as the mean of those changes.
class OrbitCondition {
public:
    /// A monitor has a value. @param segment whose monitor it is; none: of the whole orbit
    /// @throws InputError for multipliers, which have no gradient here
    static OrbitCondition of_monitor(const OrbitEquations& equations, const Monitor& monitor,
                                     std::optional<std::size_t> segment, double value);
    /// The event that ends a segment is met with a speed; 0 where it has lost it.
    static OrbitCondition of_speed(const OrbitEquations& equations, std::size_t segment, double speed);
    /// An event is touched within a segment, at about this share of its duration.
    static OrbitCondition of_touch(const OrbitEquations& equations, std::size_t segment, std::size_t event,
                                   double share);
    /// An event happens at the end of a segment that another one ends.
    static OrbitCondition of_two_events(const OrbitEquations& equations, std::size_t segment, std::size_t event);
    /// A segment takes no time.
    static OrbitCondition of_vanishing(const OrbitEquations& equations, std::size_t segment);
    /// The guard after a segment's event is about to choose another mode: of the conditions that it is made of, the one
    /// that is nearest to zero. None if it has none.
    static std::optional<OrbitCondition> of_guard(const OrbitEquations& equations, const OrbitEvaluation& at,
                                                  std::size_t segment);

    /// Moves it to another segment, as where the signature has changed: the same quantity there.
    void set_segment(std::optional<std::size_t> segment) { segment_ = segment; }
    /// Evaluates value and gradient. @return false where the quantity is not defined
    bool evaluate(const OrbitEquations& equations, const OrbitEvaluation& at);
    /// What the quantity has too much; zero where the condition holds.
    double value() const { return value_ - target_; }
    /// With respect to all unknowns.
    const Eigen::RowVectorXd& gradient() const { return gradient_; }

private:
    enum class Quantity { end, start, duration, maximum, minimum, touch, mean, norm };
    struct Description {
        Quantity quantity = Quantity::duration;
        Expression expression{};
        std::optional<std::size_t> segment; ///< none: the whole orbit
        double target = 0, share = 0;
    };
    OrbitCondition(const OrbitEquations& equations, const Description& description);
    OrbitCondition(const OrbitEquations& equations, const Description& description,
                   const std::vector<Expression>& expressions);
    static std::vector<Expression> expressions_of(const OrbitEquations& equations, const Description& description);

    /// An expression along the orbit: its own or, for the second half of a symmetric orbit, its image.
    struct Watched {
        Function function; ///< with gradient
        std::size_t series;
    };
    /// Where an extremum is.
    struct Place {
        std::size_t watched = 0, piece = 0;
        double time = 0; ///< since the piece's start
        bool at_end = false;
        double value = 0, preference = 0;
    };
    std::vector<std::size_t> pieces(const OrbitLayout& layout) const;
    bool at_end(const OrbitEquations& equations, const OrbitEvaluation& at);
    bool at_start(const OrbitEquations& equations, const OrbitEvaluation& at);
    bool duration(const OrbitEquations& equations, const OrbitEvaluation& at);
    bool extremum(const OrbitEquations& equations, const OrbitEvaluation& at);
    std::optional<Place> find_extremum(const OrbitEquations& equations, const OrbitEvaluation& at);
    bool mean(const OrbitEquations& equations, const OrbitEvaluation& at);
    Eigen::VectorXd gradient_at(const OrbitEquations& equations, const OrbitEvaluation& at, const Watched& watched,
                                std::vector<double> state, double& value) const;

    Quantity quantity_;
    std::optional<std::size_t> segment_;
    double target_, share_;
    Simulation simulation_;
    ModeFlow flow_;
    RootFinder roots_;
    std::vector<Watched> watched_;
    double value_ = 0;
    Eigen::RowVectorXd gradient_;
};

/// Rate of an event's function along the flow of a mode.
Expression rate_of(const System& system, std::size_t mode, std::size_t event);

} // namespace graze
