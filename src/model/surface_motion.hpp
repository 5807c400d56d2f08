#pragma once

#include "graze/model/model.hpp"
#include "graze/symbolic/transform.hpp"

#include <optional>
#include <span>
#include <vector>

namespace graze {

class Expander;

/// Derives motions along surfaces: zeros of functions of the states. All expressions are expanded (Model::expand).
class SurfaceMotion {
public:
    /// @param model its graph grows
    SurfaceMotion(Model& model, Expander& expander);

    Expression expanded(const Expression& expression);
    std::vector<Expression> expanded(std::span<const Expression> expressions);
    /// Returns the rate of a function along a field, one component for each state.
    Expression rate_along(const Expression& function, std::span<const Expression> field) const;
    /// Returns whether a function depends on any state.
    bool depends_on_states(const Expression& function) const;
    /// Returns the map that puts a state close to the zero of a function onto it. It changes one state if the function
    /// is linear in it with a number as coefficient (exact up to one rounding), otherwise it is a step of Newton's
    /// method along the gradient.
    StateMap projection(const Expression& function) const;

    /// A surface on which one state follows from the others.
    struct Solved {
        std::size_t state = 0;
        Expression image{};
    };
    /// Returns the state in which a function is linear with a number as coefficient, and its value on the surface.
    /// @param preferred if possible one of the states for which this is true
    std::optional<Solved> solved(const Expression& function, const std::vector<bool>& preferred) const;
    /// Adds a surface to those by which states have been replaced; nothing if no state follows from the others.
    void add_surface(const Expression& function, const std::vector<bool>& preferred);
    /// Also solves for states whose coefficients are expressions in parameters, which must not become zero.
    void allow_parameters() { by_parameters_ = true; }
    /// Forgets all surfaces.
    void leave_surfaces() { replaced_.clear(); }
    /// Replaces states by their values on the surfaces.
    Expression on_surface(const Expression& expression) const;
    std::vector<Expression> on_surface(std::span<const Expression> expressions) const;
    /// Returns a field that is tangent to the surfaces, with the rates of replaced states made of those of the others.
    std::vector<Expression> tangent(std::vector<Expression> field) const;
    /// Returns whether a motion along `field` stays on the zero of a function to the last digit.
    bool stays(const Expression& function, std::span<const Expression> field) const;

private:
    std::vector<Replacement> replacements() const;

    Model& model_;
    Expander& expander_;
    std::vector<Expression> states_;
    std::vector<Solved> replaced_;
    bool by_parameters_ = false; ///< see allow_parameters
};

/// Returns for each component whether two fields differ in it.
std::vector<bool> differing(std::span<const Expression> one, std::span<const Expression> other);
/// Returns the combination one + share (other - one) of two fields.
std::vector<Expression> combined(std::span<const Expression> one, std::span<const Expression> other,
                                 const Expression& share);

} // namespace graze
