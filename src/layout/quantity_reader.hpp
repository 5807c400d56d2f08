#pragma once

#include "graze/layout/process_conditions.hpp"
#include "study/study_reader.hpp"

#include <string>

namespace graze {

/// The value in a unit of a text: a number or an expression, or either with a unit of the kind behind it.
/// @param name what it is, for messages @param units for the remedy, where more than the unit helps
/// @param inside where the text itself begins @throws InputError with the place
double quantity_of_text(const std::string& text, const std::string& name, const char* unit, const Place& place,
                        const Place& inside, const char* units = nullptr);
/// The same of an entry, which may be a number. @throws InputError with the place
double read_quantity(const StudyReader& reader, const TomlEntry& entry, const char* unit, const char* units = nullptr);

/// @throws InputError (without a place) for a number that is not finite or out of range
void require_within(double value, const std::string& what, const char* unit, double least, double greatest);

/// Sets a section's number from an entry of its name. @return whether it has one
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
