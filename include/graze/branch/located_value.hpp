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
    OrbitOptions orbit;       ///< tolerances of integration and Newton's method; the error is not estimated
    std::size_t halvings = 6; ///< how often the path from the known point may be halved where Newton's method does not
                              ///< converge at once, up to 30
    bool map = false;         ///< compute LocatedSolution::map too
    /// @throws InputError naming the option that is out of range
    void validate() const;
};

/// The special point at other values of the parameters, or why it was not found.
struct LocatedSolution {
    bool found = false;
    double value = 0;           ///< value of the control parameter, if found
    Orbit orbit;                ///< the orbit, if found
    bool admissible = false;    ///< whether the model would follow the orbit
    std::string problem;        ///< why the point was not found, or why the orbit is not admissible
    std::size_t parts = 0;      ///< number of parts into which the path was divided
    std::size_t iterations = 0; ///< iterations of Newton's method in all parts
    /// For an admissible touch, if requested: the leading-order map of the cycle with respect to the control parameter.
    /// Empty where the orbit touches more than once or the contact is not rigid; then use `cycle_map`.
    std::optional<CycleMap> map{};
};

/// The value of one parameter, the control parameter, at which a special point lies, as a function of the other
/// parameters: for example the voltage at which the orbit of a switch touches its stop as a function of its dimensions.
///
/// The orbit's equations, the point's own condition (as BranchSettings::kept holds it) and the values of the other
/// parameters are one system of equations for the orbit and the control parameter. Its solution for a unit change of
/// another parameter is the exact derivative, from which the solution at other values is predicted; Newton's method
/// corrects it.
///
/// An object must be used by one thread. Its results do not depend on earlier calls.
class LocatedValue {
public:
    /// Solves for the point itself again. @param point a point whose condition can be held (PointKind::may_be_kept),
    /// such as a grazing @param control the parameter that is solved for; @param others the parameters that may be
    /// changed @throws InputError for other points, options out of range, the control parameter among the others or one
    /// of them given twice, and if the others do not determine the value, as when the control parameter does not move
    /// the orbit from the point
    LocatedValue(const System& system, const SpecialPoint& point, ParameterId control, std::vector<ParameterId> others,
                 const LocatedValueOptions& options = {});
    ~LocatedValue();
    LocatedValue(LocatedValue&&) noexcept;

    ParameterId control() const;
    const std::vector<ParameterId>& others() const;
    /// Value of the control parameter at the point.
    double value() const;
    /// Values of the other parameters at the point.
    const std::vector<double>& values() const;
    const Orbit& orbit() const;
    /// Derivatives of the control parameter with respect to each other parameter, in their units.
    const std::vector<double>& derivatives() const;

    /// Solves at given values of the other parameters, one for each.
    /// @throws InputError for a wrong number of values, or one that is not finite
    LocatedSolution operator()(std::span<const double> values);

private:
    class Solver;
    std::unique_ptr<Solver> solver_;
};

/// Returns all independent parameters of a model except one.
std::vector<ParameterId> parameters_but(const Model& model, ParameterId one);

} // namespace graze
