#pragma once

#include "branch/orbit_condition.hpp"
#include "graze/branch/monitor.hpp"
#include "graze/flow/roots.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <optional>
#include <vector>

namespace graze {

/// Conditions on numbers of an orbit that are those of its motion: a monitor's, a speed, the least value of an event's
/// function, a duration.
///
/// An extremum changes as the function's value at its time does, since that is where its time does not matter; a mean
/// as the mean of those changes.
class OrbitQuantity final : public OrbitCondition {
public:
    /// A monitor has a value. @param segment whose monitor it is; none: of the whole orbit
    /// @throws InputError for multipliers, which have no gradient here
    static OrbitQuantity of_monitor(const OrbitEquations& equations, const Monitor& monitor,
                                    std::optional<std::size_t> segment, double value);
    /// The event that ends a segment is met with a speed; 0 where it has lost it.
    static OrbitQuantity of_speed(const OrbitEquations& equations, std::size_t segment, double speed);
    /// An event is touched within a segment, at about this share of its duration.
    static OrbitQuantity of_touch(const OrbitEquations& equations, std::size_t segment, std::size_t event,
                                  double share);
    /// An event happens at the end of a segment that another one ends.
    static OrbitQuantity of_two_events(const OrbitEquations& equations, std::size_t segment, std::size_t event);
    /// A segment takes no time.
    static OrbitQuantity of_vanishing(const OrbitEquations& equations, std::size_t segment);
    /// The guard after a segment's event is about to choose another mode: of the conditions that it is made of, the one
    /// that is nearest to zero. None if it has none.
    static std::optional<OrbitQuantity> of_guard(const OrbitEquations& equations, const OrbitEvaluation& at,
                                                 std::size_t segment);

    void set_segment(std::optional<std::size_t> segment) override { segment_ = segment; }
    bool evaluate(const OrbitEquations& equations, const OrbitEvaluation& at) override;
    /// A touch is looked for where it has been last.
    void renew(const OrbitEquations& equations, const OrbitEvaluation& at) override;

private:
    enum class Quantity { end, start, duration, maximum, minimum, touch, mean, norm };
    struct Description {
        Quantity quantity = Quantity::duration;
        Expression expression{};
        std::optional<std::size_t> segment; ///< none: the whole orbit
        double target = 0, share = 0;
    };
    OrbitQuantity(const OrbitEquations& equations, const Description& description);
    OrbitQuantity(const OrbitEquations& equations, const Description& description,
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
        double share = 0; ///< of the duration of all pieces, at which it is
    };
    std::vector<std::size_t> pieces(const OrbitLayout& layout) const;
    bool at_end(const OrbitEquations& equations, const OrbitEvaluation& at);
    bool at_start(const OrbitEquations& equations, const OrbitEvaluation& at);
    bool duration(const OrbitEquations& equations, const OrbitEvaluation& at);
    bool extremum(const OrbitEquations& equations, const OrbitEvaluation& at);
    std::optional<Place> find_extremum(const OrbitEquations& equations, const OrbitEvaluation& at);
    double off_touch(const OrbitEquations& equations, double share) const;
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
};

} // namespace graze
