#pragma once

#include <compare>
#include <cstddef>

namespace graze {

/// Identifies an independent parameter of a model; Model::independent_parameter finds it by name. Other indices do not
/// convert to it implicitly, for example that of Model::find_parameter, which counts dependent parameters too.
class ParameterId {
public:
    /// The first independent parameter.
    constexpr ParameterId() = default;
    /// @param place index among the independent parameters, in the model's order
    explicit constexpr ParameterId(std::size_t place) : place_(place) {}

    /// Returns the index of its value among those of the independent parameters, as in Model::parameter_values and
    /// Orbit::parameters.
    constexpr std::size_t place() const { return place_; }

    constexpr auto operator<=>(const ParameterId&) const = default;

private:
    std::size_t place_ = 0;
};

} // namespace graze
