#pragma once

#include "model/model_file_sliding.hpp"

namespace graze {

/// Reads the table [contacts] of a model.
class ContactParts : protected SlidingParts {
protected:
    using SlidingParts::SlidingParts;

    /// Reads the table. To be called when modes are known; transitions may then name those that it makes.
    void read_contacts(const TomlEntry& group);

private:
    void read_settings(const std::vector<TomlEntry>& entries);
    void read_contact(const TomlEntry& entry, UnilateralContact& contact);
    void read_mass(const TomlEntry& entry);
};

} // namespace graze
