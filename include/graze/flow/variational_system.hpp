#pragma once

#include "graze/flow/system.hpp"

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace graze {

/// What second derivatives of a system need: its first variational equations along a vector, and its functions with
/// their second derivatives contracted with that vector. All come from symbolic differentiation, none from differences.
///
/// A vector has one component for each *variable*: the states, then the free parameters. Second derivatives of a
/// function h contracted with it are the derivatives of (h_x v_x + h_p v_p) at fixed v: one number for each variable.
///
/// Compiled once, and shared as a system is: copies are handles of the same, for any number of threads.
class VariationalSystem {
public:
    /// @param free independent parameters with respect to which there are derivatives
    /// @throws InputError for one that is out of range or named twice
    explicit VariationalSystem(const System& system, std::vector<ParameterId> free = {});

    /// The system of which it is.
    const System& system() const { return parts_->system; }
    const std::vector<ParameterId>& free() const { return parts_->free; }
    /// States and free parameters.
    std::size_t variables() const { return system().states() + free().size(); }

    /// x' = f(x, p), w' = f_x w + f_p v_p in each mode, without events. States are x, then as many w; parameters are
    /// the independent ones p, then v_p, as many as are free.
    const System& modes() const { return parts_->modes; }

    // Inputs of all functions: states, independent parameters, vector.
    // Outputs: values; derivatives, row by row: values x variables; second derivatives contracted with the vector,
    // likewise.
    // @throws InputError for an index that is out of range

    /// One value.
    const Function& event(std::size_t index) const;
    /// One value, as of System::section.
    const Function& section(std::size_t index, std::optional<std::size_t> symmetry = std::nullopt) const;
    /// Each state after a jump, and the image of each under a symmetry.
    const Function& jump(std::size_t index) const;
    const Function& symmetry(std::size_t index) const;
    /// Compiles one more. @param expressions in the model's symbols, of any graph
    /// @throws InputError for a symbol that the model does not have
    Function function_of(std::span<const Expression> expressions) const;

    /// Largest workspace of its own functions.
    std::size_t workspace() const { return parts_->workspace; }

private:
    struct Parts {
        System system, modes;
        std::vector<ParameterId> free;
        std::vector<Function> events, jumps, symmetries;
        std::vector<std::vector<Function>> sections; ///< of each: as it is, then under each symmetry
        std::size_t workspace = 0;
    };
    std::shared_ptr<const Parts> parts_;
};

} // namespace graze
