#include "model/surface_motion.hpp"

#include "graze/symbolic/symbol_index.hpp"
#include "model/model_expand.hpp"

namespace graze {

SurfaceMotion::SurfaceMotion(Model& model, Expander& expander)
    : model_(model), expander_(expander), states_(model.state_symbols()) {}

Expression SurfaceMotion::expanded(const Expression& expression) {
    return expander_.expand(expression);
}

std::vector<Expression> SurfaceMotion::expanded(std::span<const Expression> expressions) {
    return expander_.expand(expressions);
}

Expression SurfaceMotion::rate_along(const Expression& function, std::span<const Expression> field) const {
    std::vector<Component> components;
    for (std::size_t i = 0; i < states_.size(); ++i)
        components.emplace_back(states_[i], field[i]);
    return differentiate_along({&function, 1}, components).front();
}

bool SurfaceMotion::depends_on_states(const Expression& function) const {
    return !sparse_jacobian({&function, 1}, SymbolIndex(states_)).empty();
}

namespace {

/// Returns the zero of rest + slope x.
Expression zero_of(const Expression& rest, const Expression& slope) {
    if (!slope.is_number())
        return -rest / slope;
    const double number = slope.node().value;
    return number == 1 ? -rest : number == -1 ? rest : rest / slope.graph()->number(-number);
}

} // namespace

std::optional<SurfaceMotion::Solved> SurfaceMotion::solved(const Expression& function,
                                                           const std::vector<bool>& preferred) const {
    std::optional<Solved> found;
    for (const JacobianEntry& slope : sparse_jacobian({&function, 1}, SymbolIndex(states_))) {
        const std::size_t i = slope.column;
        // A cyclic state has many values on a surface.
        const bool is_constant = slope.value.is_number() || (by_parameters_ && !depends_on_states(slope.value));
        if (!is_constant || model_.states[i].period || (found && !preferred[i]))
            continue;
        const Expression rest = substitute(function, std::vector<Replacement>{{states_[i], model_.number(0)}});
        found = Solved{i, zero_of(rest, slope.value)};
        if (preferred[i])
            break;
    }
    return found;
}

StateMap SurfaceMotion::projection(const Expression& function) const {
    StateMap map(states_);
    if (const auto one = solved(function, std::vector<bool>(states_.size(), false))) {
        map[one->state] = one->image;
        return map;
    }
    const std::vector<JacobianEntry> gradient = sparse_jacobian({&function, 1}, SymbolIndex(states_));
    Expression square = model_.number(0);
    for (const JacobianEntry& slope : gradient)
        square = square + pow(slope.value, 2);
    for (const JacobianEntry& slope : gradient)
        map[slope.column] = states_[slope.column] - function * slope.value / square;
    return map;
}

void SurfaceMotion::add_surface(const Expression& function, const std::vector<bool>& preferred) {
    const auto one = solved(on_surface(function), preferred);
    if (!one)
        return;
    const std::vector<Replacement> replacement{{states_[one->state], one->image}};
    for (Solved& other : replaced_)
        other.image = substitute(other.image, replacement);
    replaced_.push_back(*one);
}

std::vector<Replacement> SurfaceMotion::replacements() const {
    std::vector<Replacement> result;
    for (const Solved& one : replaced_)
        result.emplace_back(states_[one.state], one.image);
    return result;
}

Expression SurfaceMotion::on_surface(const Expression& expression) const {
    return substitute(expression, replacements());
}

std::vector<Expression> SurfaceMotion::on_surface(std::span<const Expression> expressions) const {
    return substitute(expressions, replacements());
}

std::vector<Expression> SurfaceMotion::tangent(std::vector<Expression> field) const {
    field = on_surface(field);
    for (const Solved& one : replaced_)
        field[one.state] = rate_along(one.image, field);
    return field;
}

bool SurfaceMotion::stays(const Expression& function, std::span<const Expression> field) const {
    const auto one = solved(function, std::vector<bool>(states_.size(), false));
    return one && field[one->state].is_number(0) && !depends_on_states(one->image);
}

std::vector<bool> differing(std::span<const Expression> one, std::span<const Expression> other) {
    std::vector<bool> result;
    for (std::size_t i = 0; i < one.size(); ++i)
        result.push_back(!(one[i] == other[i]));
    return result;
}

std::vector<Expression> combined(std::span<const Expression> one, std::span<const Expression> other,
                                 const Expression& share) {
    std::vector<Expression> field;
    for (std::size_t i = 0; i < one.size(); ++i)
        field.push_back(one[i] == other[i] ? one[i] : one[i] + share * (other[i] - one[i]));
    return field;
}

} // namespace graze
