#pragma once

#include "graze/model/model.hpp"
#include "model/model_places.hpp"

#include <string>
#include <vector>

namespace graze {

/// A coefficient in a declaration of contacts or frictions, and the values that its law is for.
struct Coefficient {
    enum class Range {
        finite, ///< of masses; whether their matrix is positive definite is told where contacts are completed
        not_negative,
        share, ///< from 0 to 1
    };

    std::string path; ///< in the model file
    std::string what; ///< "the restitution of the contact 'wall'"
    Expression value;
    Range range = Range::not_negative;

    /// Its table in the model file: "contacts.wall".
    std::string part() const;
    bool allows(double number) const;
    /// What would be allowed: "a number from 0 to 1".
    const char* allowed() const;
};

/// Returns all coefficients of the declared contacts and frictions.
std::vector<Coefficient> coefficients_of(const Model& model);
/// Refuses coefficients that are the same whatever states and parameters are, and with which their laws mean nothing.
/// @throws InputError
void check_coefficients(const Model& model, const Places& places);

} // namespace graze
