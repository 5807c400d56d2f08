#pragma once

#include "graze/layout/process_conditions.hpp"
#include "study/study_reader.hpp"

#include <string>

namespace graze {

/// Parses a number or an expression, optionally followed by a unit of the same dimension, and returns the value in
/// `unit`.
/// @param name for messages @param units description of the units for the remedy
/// @param inside place at which the text itself begins @throws InputError with the place
double quantity_of_text(const std::string& text, const std::string& name, const char* unit, const Place& place,
                        const Place& inside, const char* units = nullptr);
/// Reads such a value from an entry, which may be a number. @throws InputError with the place
double read_quantity(const StudyReader& reader, const TomlEntry& entry, const char* unit, const char* units = nullptr);

/// @throws InputError (without a place) for a number that is not finite or out of range
void require_within(double value, const std::string& what, const char* unit, double least, double greatest);

/// Sets a section's number from the entry of its name. @return whether the section has it
template <class Section>
bool read_quantity_field(const StudyReader& reader, std::span<const QuantityField<Section>> fields,
                         const TomlEntry& entry, Section& section) {
    for (const QuantityField<Section>& field : fields)
        if (entry.name == field.name) {
            const double value = read_quantity(reader, entry, field.unit);
            try {
                require_within(value, entry.path, field.unit, field.least, field.greatest);
            } catch (const InputError& error) {
                reader.fail(entry, error.problem(), error.remedy());
            }
            section.*field.member = value;
            return true;
        }
    return false;
}

} // namespace graze
