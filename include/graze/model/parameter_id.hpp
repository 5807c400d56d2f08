#pragma once

#include <compare>
#include <cstddef>

namespace graze {

/// Which of a model's independent parameters is meant: Model::independent_parameter tells it by the name. No index of
/// anything else becomes one by itself, as that of Model::find_parameter, which counts dependent parameters too.
class ParameterId {
public:
    /// The first.
    constexpr ParameterId() = default;
    /// @param place among the independent parameters, in the model's order
    explicit constexpr ParameterId(std::size_t place) : place_(place) {}

    /// Where its value stands among those of the independent parameters, as in Model::parameter_values and
    /// Orbit::parameters.
    constexpr std::size_t place() const { return place_; }

    constexpr auto operator<=>(const ParameterId&) const = default;

private:
    std::size_t place_ = 0;
};

} // namespace graze
