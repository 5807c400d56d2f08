#pragma once

#include "model/model_file_sliding.hpp"

#include <cstddef>
#include <map>
#include <vector>

namespace graze {

/// Reads the table [contacts] of a model.
class ContactParts : protected SlidingParts {
protected:
    using SlidingParts::SlidingParts;

    /// Reads the table. To be called when modes are known; transitions may then name those that it makes.
    void read_contacts(const TomlEntry& group);
    /// Reads the forces of a mode, of which `set_accelerations` makes rates when masses are known.
    void read_forces(std::size_t mode, const TomlEntry& part);
    /// Returns whether the forces of a mode stand for the rate of this state.
    bool has_force(std::size_t mode, std::size_t state) const;
    void set_accelerations();

private:
    struct ModeForces {
        Place place{};
        std::vector<Expression> of_states{}; ///< empty for states without a force
    };
    void read_settings(const std::vector<TomlEntry>& entries);
    void read_contact(const TomlEntry& entry, UnilateralContact& contact);
    void read_mass(const TomlEntry& entry);

    std::map<std::size_t, ModeForces> forces_; ///< by mode
};

} // namespace graze
