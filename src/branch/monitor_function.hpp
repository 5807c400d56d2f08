#pragma once

#include "graze/branch/monitor.hpp"
#include "graze/flow/roots.hpp"
#include "orbit/orbit_equations.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <optional>
#include <vector>

namespace graze {

/// A monitor as a function of the unknowns of a shooting problem, with its exact gradient: what it takes to hold it.
/// An extremum changes as the function's value at its time does, since that is where its time does not matter; a mean
/// as the mean of those changes.
class MonitorFunction {
public:
    /// @param segment whose monitor it is; none: of the whole orbit
    MonitorFunction(const OrbitEquations& equations, const Monitor& monitor, std::optional<std::size_t> segment);

    /// Value and gradient. @return false where not defined
    bool evaluate(const OrbitEquations& equations, const OrbitEvaluation& at);
    double value() const { return value_; }
    const Eigen::RowVectorXd& gradient() const { return gradient_; }

private:
    /// An expression along the orbit: the monitor's own or, for the second half of a symmetric orbit, its image.
    struct Watched {
        Function function; ///< with gradient
        std::size_t series;
    };
    /// Where an extremum is.
    struct Place {
        std::size_t watched = 0, piece = 0;
        double time = 0; ///< since the piece's start
        bool at_end = false;
        double value = 0;
    };
    bool is_whole() const { return !segment_; }
    std::vector<std::size_t> pieces(const OrbitLayout& layout) const;
    bool at_end(const OrbitEquations& equations, const OrbitEvaluation& at);
    bool at_start(const OrbitEquations& equations, const OrbitEvaluation& at);
    bool duration(const OrbitEquations& equations, const OrbitEvaluation& at);
    bool extremum(const OrbitEquations& equations, const OrbitEvaluation& at);
    std::optional<Place> find_extremum(const OrbitEquations& equations, const OrbitEvaluation& at);
    bool mean(const OrbitEquations& equations, const OrbitEvaluation& at);
    Eigen::VectorXd gradient_at(const OrbitEquations& equations, const OrbitEvaluation& at, const Watched& watched,
                                std::vector<double> state, double& value) const;

    Monitor::Kind kind_;
    std::optional<std::size_t> segment_;
    Simulation simulation_;
    ModeFlow flow_;
    RootFinder roots_;
    std::vector<Watched> watched_;
    double value_ = 0;
    Eigen::RowVectorXd gradient_;
};

} // namespace graze
