#pragma once

#include "graze/branch/special_point.hpp"
#include "graze/grazing/cycle_map.hpp"

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace graze {

struct LocatedValueOptions {
    OrbitOptions orbit;       ///< by which it is integrated and corrected; no error is estimated
    std::size_t halvings = 6; ///< of the way from the neighbour, where Newton's method does not reach as far
    bool map = false;         ///< whether solutions come with the map of the cycle
    /// @throws InputError naming the option that is out of range
    void validate() const;
};

/// What has been found at other values of the parameters.
struct LocatedSolution {
    bool found = false;
    double value = 0;           ///< of the control parameter, if found
    Orbit orbit;                ///< if found
    bool admissible = false;    ///< whether the model would follow that orbit: nothing else is touched before
    std::string problem;        ///< why it has not been found, or is not admissible
    std::size_t parts = 0;      ///< into which the way has been divided
    std::size_t iterations = 0; ///< of Newton's method, of all parts
    /// Of a touch, if asked for and found and admissible, with respect to the control parameter and to leading order.
    /// None where something else is touched too, or the contact is not rigid: then `cycle_map` says what it is.
    std::optional<CycleMap> map{};
};

/// The value of one parameter, the control parameter, at which a special point lies, as a function of the others: the
/// voltage at which a switch's orbit touches its stop as a function of its dimensions.
///
/// The orbit's equations, the point's own condition (as BranchSettings::kept holds it) and the values of the other
/// parameters are one system of equations for the orbit and the control parameter. Solved for a unit change of another
/// parameter it gives the derivative, exactly; from that the solution at other values is predicted, and corrected by
/// Newton's method.
///
/// One object belongs to one thread. What it finds depends on where it was made and on what is asked for, not on what
/// it has been asked before.
class LocatedValue {
public:
    /// Solves at the point itself, once more.
    /// @param point whose condition can be held (PointKind::may_be_kept), such as a grazing
    /// @param control the parameter whose value follows; @param others that may be changed
    /// @throws InputError for other points, options out of range, the control parameter among the others, one of them
    ///         twice, and where the value does not follow from the others: as where the control parameter does not move
    ///         the orbit from the point
    LocatedValue(const System& system, const SpecialPoint& point, ParameterId control, std::vector<ParameterId> others,
                 const LocatedValueOptions& options = {});
    ~LocatedValue();
    LocatedValue(LocatedValue&&) noexcept;

    ParameterId control() const;
    const std::vector<ParameterId>& others() const;
    /// Of the control parameter.
    double value() const;
    /// Of the others, there.
    const std::vector<double>& values() const;
    const Orbit& orbit() const;
    /// By each of the others, in units of the control parameter per unit of that one.
    const std::vector<double>& derivatives() const;

    /// At other values of the others, one for each.
    /// @throws InputError for another number of values, or one that is not finite
    LocatedSolution operator()(std::span<const double> values);

private:
    class Solver;
    std::unique_ptr<Solver> solver_;
};

/// All independent parameters of a model but one.
std::vector<ParameterId> parameters_but(const Model& model, ParameterId one);

} // namespace graze
