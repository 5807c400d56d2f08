#pragma once

#include "branch/orbit_condition.hpp"
#include "graze/branch/monitor.hpp"
#include "graze/flow/roots.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <optional>
#include <vector>

namespace graze {

/// A condition on a quantity of the motion: a monitor, a contact speed, the minimum of an event function, or a
/// duration.
///
/// The gradient of an extremum is that of the function at its time, since the time derivative vanishes there; the
/// gradient of a mean is the mean of the gradients.
class OrbitQuantity final : public OrbitCondition {
public:
    /// A monitor equals a value. @param segment of the monitor; empty: the whole orbit
    /// @throws InputError for multipliers, which have no gradient here
    static OrbitQuantity of_monitor(const OrbitEquations& equations, const Monitor& monitor,
                                    std::optional<std::size_t> segment, double value);
    /// The event that ends a segment is reached at a given approach speed, which may be 0.
    static OrbitQuantity of_speed(const OrbitEquations& equations, std::size_t segment, double speed);
    /// An event is touched within a segment, at about this share of its duration.
    static OrbitQuantity of_touch(const OrbitEquations& equations, std::size_t segment, std::size_t event,
                                  double share);
    /// An event happens at the end of a segment that another event ends.
    static OrbitQuantity of_two_events(const OrbitEquations& equations, std::size_t segment, std::size_t event);
    /// The duration of a segment is zero.
    static OrbitQuantity of_vanishing(const OrbitEquations& equations, std::size_t segment);
    /// The guard after the event of a segment is about to choose another mode: of its conditions, the one nearest to
    /// zero is zero. Empty if the guard has no conditions.
    static std::optional<OrbitQuantity> of_guard(const OrbitEquations& equations, const OrbitEvaluation& at,
                                                 std::size_t segment);

    void set_segment(std::optional<std::size_t> segment) override { segment_ = segment; }
    bool evaluate(const OrbitEquations& equations, const OrbitEvaluation& at) override;
    /// Updates the time near which a touch is searched.
    void renew(const OrbitEquations& equations, const OrbitEvaluation& at) override;

private:
    struct Description {
        Monitor::Kind kind = Monitor::Kind::duration;
        Expression expression{};
        std::optional<std::size_t> segment; ///< empty: the whole orbit
        double target = 0;
        std::optional<double> share;        ///< for a touch: about the share of the segment at which its minimum lies
        std::vector<Expression> in_modes{}; ///< of a conserved quantity: one for each mode, or none
    };
    OrbitQuantity(const OrbitEquations& equations, const Description& description);
    OrbitQuantity(const OrbitEquations& equations, const Description& description,
                  const std::vector<Expression>& expressions);
    static std::vector<Expression> expressions_of(const OrbitEquations& equations, const Description& description);

    /// An expression along the orbit or, for the second half of a symmetric orbit, its image.
    struct Watched {
        Function function; ///< with gradient
        std::size_t series;
    };
    /// The location of an extremum.
    struct Place {
        std::size_t watched = 0, piece = 0;
        double time = 0; ///< since the start of the piece
        bool at_end = false;
        double value = 0, preference = 0;
        double share = 0; ///< time as a share of the duration of all pieces
    };
    std::vector<std::size_t> pieces(const OrbitLayout& layout) const;
    bool at_end(const OrbitEquations& equations, const OrbitEvaluation& at);
    bool at_start(const OrbitEquations& equations, const OrbitEvaluation& at);
    bool duration(const OrbitEquations& equations, const OrbitEvaluation& at);
    bool extremum(const OrbitEquations& equations, const OrbitEvaluation& at);
    std::optional<Place> find_extremum(const OrbitEquations& equations, const OrbitEvaluation& at);
    double distance_from_touch(const OrbitEquations& equations, double share) const;
    bool mean(const OrbitEquations& equations, const OrbitEvaluation& at);
    Eigen::VectorXd gradient_at(const OrbitEquations& equations, const OrbitEvaluation& at, const Watched& watched,
                                const std::vector<double>& state, double& value) const;

    Monitor::Kind kind_;
    std::optional<std::size_t> segment_;
    double target_;
    std::optional<double> share_;
    Simulation simulation_;
    ModeFlow flow_;
    RootFinder roots_;
    std::vector<Watched> watched_;
};

} // namespace graze
