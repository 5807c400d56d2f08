#include "model/contact_forces.hpp"

#include "graze/base/input_error.hpp"
#include "graze/symbolic/transform.hpp"
#include "model/model_completion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace graze {

namespace {

using ExpressionMatrix = std::vector<std::vector<Expression>>;

/// Eliminates the columns of a matrix with further columns of right-hand sides. Matrices of inertia need no exchange of
/// rows for stability; a pivot that is identically zero is exchanged. @return the determinant
Expression eliminate(ExpressionMatrix& rows, const Expression& one) {
    Expression determinant = one;
    for (std::size_t k = 0; k < rows.size(); ++k) {
        const auto found = std::find_if(rows.begin() + static_cast<std::ptrdiff_t>(k), rows.end(),
                                        [&](const auto& row) { return !row[k].is_number(0); });
        if (found == rows.end())
            return one.graph()->number(0);
        if (found != rows.begin() + static_cast<std::ptrdiff_t>(k)) {
            std::swap(*found, rows[k]);
            determinant = -determinant;
        }
        determinant = determinant * rows[k][k];
        for (std::size_t j = k + 1; j < rows[k].size(); ++j)
            rows[k][j] = rows[k][j] / rows[k][k];
        for (std::size_t i = 0; i < rows.size(); ++i)
            if (i != k && !rows[i][k].is_number(0))
                for (std::size_t j = k + 1; j < rows[k].size(); ++j)
                    if (!rows[k][j].is_number(0))
                        rows[i][j] = rows[i][j] - rows[i][k] * rows[k][j];
    }
    return determinant;
}

/// Tries Cholesky's method, which needs pivots above this share of the diagonal. @param matrix symmetric, n x n
bool has_positive_pivots(std::vector<double> matrix, std::size_t n, double share) {
    const std::vector<double> given = matrix;
    for (std::size_t k = 0; k < n; ++k) {
        const double pivot = matrix[k * n + k];
        if (!(pivot > share * given[k * n + k]))
            return false;
        for (std::size_t i = k + 1; i < n; ++i)
            for (std::size_t j = k + 1; j < n; ++j)
                matrix[i * n + j] -= matrix[i * n + k] * matrix[k * n + j] / pivot;
    }
    return true;
}

} // namespace

std::vector<Expression> accelerations_by(const std::vector<Expression>& mass, const std::vector<Expression>& forces) {
    const std::size_t n = forces.size();
    std::vector<Expression> result;
    if (mass.size() == n) {
        for (std::size_t i = 0; i < n; ++i)
            result.push_back(forces[i] / mass[i]);
        return result;
    }
    ExpressionMatrix rows(n);
    for (std::size_t i = 0; i < n; ++i) {
        rows[i].assign(mass.begin() + static_cast<std::ptrdiff_t>(i * n),
                       mass.begin() + static_cast<std::ptrdiff_t>((i + 1) * n));
        rows[i].push_back(forces[i]);
    }
    eliminate(rows, forces.front().graph()->number(1));
    for (const auto& row : rows)
        result.push_back(row.back());
    return result;
}

std::vector<ContactStates> combinations(const std::vector<std::vector<ContactState>>& options) {
    std::vector<ContactStates> result{{}};
    for (const std::vector<ContactState>& states : options) {
        std::vector<ContactStates> longer;
        for (const ContactStates& one : result)
            for (const ContactState state : states) {
                longer.push_back(one);
                longer.back().push_back(state);
            }
        result = std::move(longer);
    }
    return result;
}

std::string contact_words(const std::string& contact, ContactState state) {
    constexpr std::string_view words[] = {"", "", "-stick", "-forward", "-backward"};
    return state == ContactState::open ? "" : fmt::format("-{}{}", contact, words[static_cast<std::size_t>(state)]);
}

ContactMechanics::ContactMechanics(Model& model, const Places& places, SurfaceMotion& motion, std::size_t mode)
    : model_(model), places_(places), motion_(motion), velocities_(model.contact_settings.velocities),
      mass_(motion.expanded(model.contact_settings.mass)), field_(motion.expanded(model.modes[mode].rates)) {
    for (const std::size_t state : velocities_)
        symbols_.push_back(model.symbol(model.states[state].name));
    require_positive_masses();
    for (const UnilateralContact& contact : model.contacts) {
        const std::string path = "contacts." + contact.name;
        gaps_.push_back(motion.expanded(contact.gap));
        for (std::size_t i = 0; i < symbols_.size(); ++i)
            if (!differentiate(gaps_.back(), symbols_[i]).is_number(0))
                throw InputError(places.of(path + ".gap"),
                                 fmt::format("the gap of '{}' depends on the velocity '{}', which impulses change",
                                             contact.name, model.states[velocities_[i]].name),
                                 "give it in terms of positions");
        normal_.push_back(direction_of(motion.rate_along(gaps_.back(), field_), path + ".gap",
                                       fmt::format("the rate of the gap of '{}'", contact.name)));
        friction_.push_back(contact.friction ? motion.expanded(*contact.friction) : model.number(0));
        slip_.emplace_back();
        if (contact.slip)
            slip_.back() = direction_of(motion.expanded(*contact.slip), path + ".slip",
                                        fmt::format("the slip of '{}'", contact.name));
    }
    note_products();
}

void ContactMechanics::require_positive_masses() const {
    const std::size_t n = velocities_.size();
    const std::vector<double> mass = values_at_start(model_, mass_);
    if (std::ranges::any_of(mass, [](double value) { return !std::isfinite(value); }))
        return; // `validate` tells what is wrong with the initial state
    std::vector<double> matrix(n * n, 0.0);
    for (std::size_t i = 0; i < mass.size(); ++i)
        matrix[mass.size() == n ? i * (n + 1) : i] = mass[i];
    if (!has_positive_pivots(std::move(matrix), n, 0))
        throw InputError(places_.of("contacts.mass"), "the mass matrix is not positive definite at the initial state",
                         "give masses and moments of inertia, which are positive");
}

ContactDirection ContactMechanics::direction_of(const Expression& velocity, const std::string& path,
                                                const std::string& what) const {
    ContactDirection direction{.velocity = velocity};
    for (const Expression& symbol : symbols_)
        direction.slopes.push_back(differentiate(velocity, symbol));
    require_linear(direction, path, what);
    direction.response = accelerations_by(mass_, direction.slopes);
    direction.acceleration = motion_.rate_along(velocity, field_);
    return direction;
}

/// Impulses are proportional to changes of velocities only if these enter linearly.
void ContactMechanics::require_linear(const ContactDirection& direction, const std::string& path,
                                      const std::string& what) const {
    if (std::ranges::all_of(direction.slopes, [](const Expression& slope) { return slope.is_number(0); }))
        throw InputError(places_.of(path), what + " does not depend on a velocity",
                         "name in `velocities` the states that impulses change, and give the gap in terms of positions "
                         "whose rates contain them");
    for (const Expression& slope : direction.slopes)
        for (const Expression& symbol : symbols_)
            if (contains_symbol(slope, symbol))
                throw InputError(places_.of(path), fmt::format("{} is not linear in '{}'", what, symbol.name()),
                                 "give the gap in terms of positions, and velocities in which their rates are linear");
}

Expression ContactMechanics::along(const ContactDirection& direction, const std::vector<Expression>& changes) const {
    Expression sum = model_.number(0);
    for (std::size_t i = 0; i < changes.size(); ++i)
        sum = sum + direction.slopes[i] * changes[i];
    return sum;
}

ContactForces ContactMechanics::solve(const ContactStates& states, const std::vector<Expression>& normal_changes,
                                      const std::vector<Expression>& tangential_changes) const {
    const Expression zero = model_.number(0), one = model_.number(1);
    const std::vector<std::size_t> carried_by = carriers(states).value();
    std::vector<const ContactDirection*> equations;
    std::vector<std::vector<Expression>> columns;
    std::vector<Expression> wanted;
    ContactForces result;
    for (std::size_t i = 0; i < states.size(); ++i) {
        if (states[i] == ContactState::open)
            continue;
        equations.push_back(&normal_[i]);
        wanted.push_back(normal_changes[i]);
        columns.push_back(normal_[i].response);
        if (is_slip(states[i])) {
            const Expression share = states[i] == ContactState::forward ? -friction_[i] : friction_[i];
            for (std::size_t k = 0; k < symbols_.size(); ++k)
                columns.back()[k] = columns.back()[k] + share * slip_[i]->response[k];
            result.regular.push_back(along(normal_[i], columns.back()));
        }
        if (states[i] == ContactState::stick && carried_by[i] == i) {
            equations.push_back(&*slip_[i]);
            wanted.push_back(tangential_changes[i]);
            columns.push_back(slip_[i]->response);
        }
    }
    ExpressionMatrix rows(equations.size());
    for (std::size_t i = 0; i < rows.size(); ++i) {
        for (const auto& column : columns)
            rows[i].push_back(along(*equations[i], column));
        rows[i].push_back(wanted[i]);
    }
    const Expression determinant = eliminate(rows, one);
    if (!result.regular.empty() && rows.size() > 1)
        result.regular.push_back(determinant);
    result.changes.assign(symbols_.size(), zero);
    result.normal.assign(states.size(), zero);
    result.tangential.assign(states.size(), zero);
    for (std::size_t i = 0, row = 0; i < states.size(); ++i) {
        if (states[i] == ContactState::open)
            continue;
        const auto add = [&](const Expression& force) {
            for (std::size_t k = 0; k < symbols_.size(); ++k)
                result.changes[k] = result.changes[k] + columns[row][k] * force;
            ++row;
            return force;
        };
        result.normal[i] = add(rows[row].back());
        if (states[i] == ContactState::stick && carried_by[i] == i)
            result.tangential[i] = add(rows[row].back());
        else if (is_slip(states[i]))
            result.tangential[i] =
                (states[i] == ContactState::forward ? -friction_[i] : friction_[i]) * result.normal[i];
    }
    result.limit.assign(states.size(), zero);
    for (std::size_t i = 0; i < states.size(); ++i)
        if (states[i] == ContactState::stick)
            result.limit[carried_by[i]] = result.limit[carried_by[i]] + friction_[i] * result.normal[i];
    for (std::size_t i = 0; i < states.size(); ++i)
        if (carried_by[i] != i) {
            result.parallel.push_back(same_direction(*slip_[i], *slip_[carried_by[i]]));
            if (const Expression apart = this->apart(i, carried_by[i]); !apart.is_number(0))
                result.apart.push_back(apart);
        }
    return result;
}

/// Returns an expression that is positive where two directions differ by round-off.
Expression ContactMechanics::same_direction(const ContactDirection& one, const ContactDirection& other) const {
    constexpr double same = 1e-12; // of the square of the difference
    Expression difference = model_.number(0);
    for (std::size_t k = 0; k < symbols_.size(); ++k)
        difference = difference + (one.slopes[k] - other.slopes[k]) * (one.response[k] - other.response[k]);
    return along(one, one.response) * same - difference;
}

/// Returns the part of a slip that no velocity of the model makes, such as the speed of a belt.
Expression ContactMechanics::without_velocities(const Expression& slip) const {
    std::vector<Replacement> replacements;
    for (const Expression& symbol : symbols_)
        replacements.emplace_back(symbol, model_.number(0));
    return substitute(slip, replacements);
}

Expression ContactMechanics::apart(std::size_t one, std::size_t other) const {
    constexpr double same = 1e-24; // of the square of the difference
    const Expression first = without_velocities(slip_[one]->velocity),
                     second = without_velocities(slip_[other]->velocity), difference = first - second;
    if (first == second || difference.is_number(0))
        return model_.number(0);
    return difference * difference - same * (first * first + second * second);
}

ContactForces ContactMechanics::forces(const ContactStates& states) const {
    std::vector<Expression> normal, tangential;
    for (std::size_t i = 0; i < states.size(); ++i) {
        normal.push_back(-normal_[i].acceleration);
        tangential.push_back(slip_[i] ? -slip_[i]->acceleration : model_.number(0));
    }
    return solve(states, normal, tangential);
}

std::optional<std::vector<std::size_t>> ContactMechanics::carriers(const ContactStates& states) const {
    std::vector<std::size_t> held, result, sticking;
    for (std::size_t i = 0; i < states.size(); ++i) {
        result.push_back(i);
        if (states[i] != ContactState::open)
            held.push_back(2 * i);
    }
    if (!independent(held))
        return std::nullopt;
    for (std::size_t i = 0; i < states.size(); ++i) {
        if (states[i] != ContactState::stick)
            continue;
        held.push_back(2 * i + 1);
        if (!independent(held)) {
            if (sticking.empty())
                return std::nullopt;
            held.pop_back();
            result[i] = sticking.front();
            const Expression apart = this->apart(i, result[i]);
            for (const Expression& state : model_.state_symbols())
                if (contains_symbol(apart, state))
                    return std::nullopt;
        } else {
            sticking.push_back(i);
        }
    }
    return result;
}

/// Evaluates the products of all directions at the initial state: normals at even, slips at odd indices.
void ContactMechanics::note_products() {
    std::vector<Expression> entries;
    for (std::size_t i = 0; i < 2 * size(); ++i)
        for (std::size_t j = 0; j < 2 * size(); ++j) {
            const bool both = (i % 2 == 0 || rubs(i / 2)) && (j % 2 == 0 || rubs(j / 2));
            const auto direction = [&](std::size_t k) -> const ContactDirection& {
                return k % 2 == 0 ? normal_[k / 2] : *slip_[k / 2];
            };
            entries.push_back(both ? along(direction(i), direction(j).response) : model_.number(0));
        }
    products_ = values_at_start(model_, entries);
    if (std::ranges::any_of(products_, [](double value) { return !std::isfinite(value); }))
        products_.clear(); // `validate` tells what is wrong with the initial state
}

/// A small pivot of the matrix of products means that one direction follows from others.
bool ContactMechanics::independent(const std::vector<std::size_t>& directions) const {
    constexpr double dependent = 1e-9;
    if (products_.empty())
        return true;
    const std::size_t n = directions.size();
    std::vector<double> matrix;
    for (const std::size_t i : directions)
        for (const std::size_t j : directions)
            matrix.push_back(products_[i * 2 * normal_.size() + j]);
    return has_positive_pivots(std::move(matrix), n, dependent);
}

} // namespace graze
