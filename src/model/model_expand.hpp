#pragma once

#include "graze/model/model.hpp"

#include <span>
#include <string>
#include <vector>

namespace graze {

/// Names of definitions or dependent parameters that refer to one another in a circle, the first repeated at the
/// end; empty when there is no circle.
std::vector<std::string> find_circle(const Model& model);

/// "a -> b -> a"
std::string circle_text(const std::vector<std::string>& names);

/// Values of expressions in terms of parameters at the present parameters; not finite where an operation is
/// outside its domain.
std::vector<double> evaluate_in_parameters(const Model& model, std::span<const Expression> expressions);

} // namespace graze
