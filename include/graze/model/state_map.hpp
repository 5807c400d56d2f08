#pragma once

#include "graze/symbolic/expression.hpp"

#include <cstddef>
#include <functional>
#include <initializer_list>
#include <memory>
#include <span>
#include <vector>

namespace graze {

/// What each state becomes, in terms of the states before: like a vector of expressions, one for each state. Copies
/// share what they have in common, so that maps that each change one state of thousands take little room if they are
/// made from copies of one that changes none:
///
///     const StateMap stays(model.state_symbols());
///     StateMap impact = stays;
///     impact[i] = -e * v;
class StateMap {
public:
    StateMap() = default;
    StateMap(std::vector<Expression> images);           // NOLINT(google-explicit-constructor): as a vector
    StateMap(std::initializer_list<Expression> images); // NOLINT(google-explicit-constructor)
    operator std::vector<Expression>() const;           // NOLINT(google-explicit-constructor)

    std::size_t size() const { return shared_ ? shared_->size() : 0; }
    bool empty() const { return size() == 0; }
    // @throws InputError, here and below, for a state that there is not
    const Expression& operator[](std::size_t state) const;
    /// To be assigned to; holds until another one is asked for.
    Expression& operator[](std::size_t state);
    Expression& back() { return (*this)[size() - 1]; }
    void push_back(const Expression& image);
    void pop_back();
    void clear() { *this = {}; }
    friend bool operator==(const StateMap& one, const StateMap& other);

    /// What has been assigned to since the map was copied or made, by rising state.
    struct Change {
        std::size_t state = 0;
        Expression image{};
    };
    std::span<const Change> changes() const { return changes_; }
    /// All the rest, in the places of all states: the same for copies of one map. Null for an empty one.
    const std::shared_ptr<const std::vector<Expression>>& shared() const { return shared_; }
    /// Replaces both; the changes are those that there are, in other words.
    /// @throws InputError unless the rest has as many places as before
    void replace(std::shared_ptr<const std::vector<Expression>> shared,
                 const std::function<void(Expression&)>& visit_change);

private:
    std::shared_ptr<const std::vector<Expression>> shared_;
    std::vector<Change> changes_;
};

} // namespace graze
