#include "model/contact_directions.hpp"

#include "graze/symbolic/transform.hpp"
#include "model/expression_matrix.hpp"
#include "model/vanishing.hpp"

#include <algorithm>
#include <cmath>

namespace graze {

Expression ContactDirection::along(const std::vector<Expression>& changes) const {
    Expression sum = velocity.graph()->number(0);
    for (std::size_t i = 0; i < changes.size(); ++i)
        sum = sum + slopes[i] * changes[i];
    return sum;
}

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

void ContactDirections::add_contact(ContactDirection normal, std::optional<ContactDirection> slip) {
    directions_.emplace_back(std::move(normal));
    directions_.push_back(std::move(slip));
}

void ContactDirections::note(std::vector<Expression> velocities, std::vector<Expression> gaps) {
    velocities_ = std::move(velocities);
    gaps_ = std::move(gaps);
    start_ = StartValues(model_);
    std::vector<Expression> entries;
    for (std::size_t i = 0; i < directions_.size(); ++i)
        for (std::size_t j = 0; j < directions_.size(); ++j)
            entries.push_back(has(i) && has(j) ? (*this)[i].along((*this)[j].response) : model_.number(0));
    products_ = start_.of(entries);
    if (std::ranges::any_of(products_, [](double value) { return !std::isfinite(value); }))
        products_.clear(); // `validate` tells what is wrong with the initial state
}

/// A small pivot of the matrix of products means that one direction follows from others.
bool ContactDirections::independent(const std::vector<std::size_t>& directions) const {
    constexpr double dependent = 1e-9;
    if (products_.empty())
        return true;
    std::vector<double> matrix;
    for (const std::size_t i : directions)
        for (const std::size_t j : directions)
            matrix.push_back(products_[i * directions_.size() + j]);
    return has_positive_pivots(std::move(matrix), directions.size(), dependent);
}

std::optional<DirectionDependence> ContactDirections::dependence(std::size_t direction,
                                                                 const std::vector<std::size_t>& others) const {
    std::vector<std::size_t> all = others;
    all.push_back(direction);
    if (independent(all))
        return std::nullopt;
    const auto found = known_.find({direction, others});
    if (found != known_.end())
        return found->second;
    return known_.emplace(std::pair(direction, others), dependence_of(direction, others)).first->second;
}

/// Returns the part of a velocity that no velocity of the model makes, such as the speed of a belt.
Expression ContactDirections::without_velocities(std::size_t direction) const {
    std::vector<Replacement> replacements;
    for (const Expression& symbol : velocities_)
        replacements.emplace_back(symbol, model_.number(0));
    return substitute((*this)[direction].velocity, replacements);
}

/// Returns the shares of others in a direction, by the products of directions: the combination that is nearest.
std::vector<Expression> ContactDirections::shares(std::size_t direction, const std::vector<std::size_t>& others) const {
    const std::vector<Expression>& slopes = (*this)[direction].slopes;
    std::vector<Expression> result(others.size(), model_.number(0));
    for (std::size_t k = 0; k < others.size(); ++k) {
        const std::vector<Expression>& same = (*this)[others[k]].slopes;
        bool equal = true, opposite = true;
        for (std::size_t i = 0; i < slopes.size(); ++i) {
            equal = equal && slopes[i] == same[i];
            opposite = opposite && slopes[i] == -same[i];
        }
        if (equal || opposite) {
            result[k] = model_.number(equal ? 1 : -1);
            return result;
        }
    }
    ExpressionMatrix rows;
    for (const std::size_t i : others) {
        rows.emplace_back();
        for (const std::size_t j : others)
            rows.back().push_back((*this)[i].along((*this)[j].response));
        rows.back().push_back((*this)[i].along((*this)[direction].response));
    }
    eliminate(rows, model_.number(1));
    for (std::size_t k = 0; k < others.size(); ++k)
        result[k] = rows[k].back();
    return result;
}

DirectionDependence ContactDirections::dependence_of(std::size_t direction,
                                                     const std::vector<std::size_t>& others) const {
    constexpr double same = 1e-12, roundoff = 1e-13; // of the squares of directions; of directions
    const auto size = [&](std::size_t i) { return std::sqrt(products_[i * (directions_.size() + 1)]); };
    std::vector<Expression> closed;
    for (const std::size_t other : others)
        if (other % 2 == 0)
            closed.push_back(gaps_[other / 2]);
    const Vanishing vanishing(model_, RandomInputs(model_), closed);
    DirectionDependence result{.shares = shares(direction, others)};
    const std::vector<bool> none = vanishing.of(result.shares);
    const ContactDirection& one = (*this)[direction];
    std::vector<Expression> slopes = one.slopes, response = one.response;
    const Expression first = without_velocities(direction);
    Expression difference = first, squares = first * first;
    for (std::size_t k = 0; k < others.size(); ++k) {
        Expression& share = result.shares[k];
        if (none[k] ||
            (share.is_number() && std::abs(share.node().value) * size(others[k]) <= roundoff * size(direction)))
            share = model_.number(0);
        if (share.is_number(0))
            continue;
        for (std::size_t i = 0; i < slopes.size(); ++i) {
            slopes[i] = slopes[i] - share * (*this)[others[k]].slopes[i];
            response[i] = response[i] - share * (*this)[others[k]].response[i];
        }
        const Expression second = share * without_velocities(others[k]);
        difference = difference == second ? model_.number(0) : difference - second;
        squares = squares + second * second;
    }
    result.at_start = start_.of(result.shares);
    const std::vector<bool> follows = vanishing.of(slopes);
    Expression square = model_.number(0);
    for (std::size_t i = 0; i < slopes.size(); ++i)
        square = square + slopes[i] * response[i];
    result.same = one.along(one.response) * same - square;
    result.everywhere = std::ranges::find(follows, false) == follows.end() ||
                        (result.same.is_number() && result.same.node().value > 0); // numbers have round-off, too
    if (result.everywhere)
        result.same = model_.number(1);
    result.apart = apart(difference, squares);
    const bool agree = difference.is_number(0) || vanishing.of({&difference, 1}).front();
    if (agree || (result.apart.is_number() && result.apart.node().value <= 0))
        result.apart = model_.number(0);
    return result;
}

} // namespace graze
