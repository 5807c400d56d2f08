#pragma once

#include "graze/flow/system.hpp"
#include "graze/flow/tangent_steps.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace graze {

/// Derivatives along a mode of many states of which each acts on few others. Within a step a disturbance reaches only
/// the states that are at most as many couplings away as the order of the series. States whose reaches do not overlap
/// are therefore disturbed together: the place of a derivative tells which of them it belongs to (A. R. Curtis, M. J.
/// D. Powell and J. K. Reid, "On the estimation of sparse Jacobian matrices", J. Inst. Maths Applics 13, 1974). The
/// derivatives along an arc are the product of those of its steps.
class GroupedDirections {
public:
    /// Finds groups of states. @return null where they would save little
    /// @param order of the series; @param starts states at the beginning, @param free parameters, by which the
    /// derivatives are taken
    static std::unique_ptr<GroupedDirections> of(const System& system, std::size_t mode, double tolerance, int order,
                                                 std::span<const std::size_t> starts,
                                                 std::span<const ParameterId> free);

    void set_parameters(std::span<const double> parameters) { steps_.set_parameters(parameters, parameter_seeds_); }
    /// Number of groups, without parameters.
    std::size_t groups() const { return groups_; }

    /// The derivatives of one step, in groups: `begin` them with the seeds, `carry` or `cross` to the space for the
    /// end.
    TangentSteps& steps() { return steps_; }
    std::span<const double> seeds() const { return seeds_; }
    std::span<double> at_end() { return at_end_; }

    /// To be called at the beginning of an arc.
    void begin();
    /// Multiplies the derivatives at the beginning of a step with those of the step. @param before, after states x
    /// (starts + free), row by row
    void multiply(std::span<const double> before, std::span<double> after);

private:
    using Reaches = std::vector<std::vector<std::size_t>>;
    GroupedDirections(const System& system, double tolerance, const Reaches& reaches,
                      const std::vector<std::size_t>& group_of, std::size_t groups, std::span<const std::size_t> starts,
                      std::span<const ParameterId> free);

    /// A derivative of a state at the end of a step by one at its beginning.
    struct Place {
        std::size_t state, group;
    };
    std::size_t states_, groups_, free_, columns_, words_;
    TangentSteps steps_;
    std::vector<double> parameter_seeds_, seeds_, at_end_;
    std::vector<std::size_t> row_starts_, starts_;
    std::vector<Place> places_; ///< row by row
    /// Blocks of columns that are not zero, one bit for each, row by row.
    std::vector<std::uint64_t> filled_, filled_after_;
};

} // namespace graze
