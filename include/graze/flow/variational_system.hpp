#pragma once

#include "graze/flow/system.hpp"

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace graze {

/// The functions needed for second derivatives of a system: its first variational equations along a vector, and its
/// functions with second derivatives contracted with that vector. All derivatives are symbolic, none are differences.
///
/// A vector has one component for each *variable*: the states, then the free parameters. Second derivatives of a
/// function h contracted with it are the derivatives of (h_x v_x + h_p v_p) at fixed v: one number for each variable.
///
/// Compiled once for a model and its free parameters, and kept with the System: all that are made from copies of it are
/// handles to the same object, for any number of threads.
class VariationalSystem {
public:
    /// @param free independent parameters with respect to which derivatives are computed
    /// @throws InputError for a parameter out of range or given twice
    explicit VariationalSystem(const System& system, std::vector<ParameterId> free = {});

    /// Returns the system from which this one was made.
    const System& system() const { return system_; }
    const std::vector<ParameterId>& free() const { return parts_->free; }
    /// Returns the number of variables: states and free parameters.
    std::size_t variables() const { return system().states() + free().size(); }

    /// Returns the system x' = f(x, p), w' = f_x w + f_p v_p in each mode, without events. Its states are x, then w;
    /// its parameters are the independent ones p, then v_p, one for each free parameter.
    const System& modes() const { return parts_->modes; }

    // Inputs of all functions: states, independent parameters, vector.
    // Outputs: values; derivatives, row by row: values x variables; second derivatives contracted with the vector, in
    // the same layout.
    // @throws InputError for an index that is out of range

    /// Function of an event: one value.
    const Function& event(std::size_t index) const { return item_at(parts_->events, index, "event"); }
    /// Function of a section, as System::section: one value.
    const Function& section(std::size_t index, std::optional<std::size_t> symmetry = std::nullopt) const {
        if (symmetry)
            require_index(*symmetry, parts_->symmetries.size(), "symmetry");
        return item_at(parts_->sections, index, "section")[symmetry ? 1 + *symmetry : 0];
    }
    /// Image of each state under a jump, and under a symmetry.
    const Function& jump(std::size_t index) const { return item_at(parts_->jumps, index, "jump"); }
    const Function& symmetry(std::size_t index) const { return item_at(parts_->symmetries, index, "symmetry"); }
    /// Compiles another function. @param expressions in the model's symbols, of any graph
    /// @throws InputError for a symbol that the model does not have
    Function function_of(std::span<const Expression> expressions) const;

    /// Returns the largest workspace of these functions.
    std::size_t workspace() const { return parts_->workspace; }

private:
    friend class System;
    /// Without the system itself, which keeps them.
    struct Parts {
        System modes;
        std::vector<ParameterId> free;
        std::vector<Function> events, jumps, symmetries;
        std::vector<std::vector<Function>> sections; ///< for each section: its function, then that under each symmetry
        std::size_t workspace = 0;
    };
    static Parts compiled(const System& system, const std::vector<ParameterId>& free);

    System system_;
    std::shared_ptr<const Parts> parts_;
};

} // namespace graze
