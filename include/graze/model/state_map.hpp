#pragma once

#include "graze/symbolic/expression.hpp"

#include <cstddef>
#include <functional>
#include <initializer_list>
#include <memory>
#include <span>
#include <vector>

namespace graze {

/// The image of each state in terms of the states before: a vector of expressions, one for each state. Copies share
/// their common part, so that many maps that each change one of thousands of states need little memory if they are
/// copies of an identity map:
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
    /// @throws InputError, here and below, for an index that is not a state's
    const Expression& operator[](std::size_t state) const;
    /// Returns a reference for assignment; it is valid until the next call.
    Expression& operator[](std::size_t state);
    Expression& back() { return (*this)[size() - 1]; }
    void push_back(const Expression& image);
    void pop_back();
    void clear() { *this = {}; }
    friend bool operator==(const StateMap& one, const StateMap& other);

    /// Images that have been assigned since the map was made or copied, by rising state.
    struct Change {
        std::size_t state = 0;
        Expression image{};
    };
    std::span<const Change> changes() const { return changes_; }
    /// Returns the images of all states that are not among the changes; the same vector for copies of one map. Null if
    /// empty.
    const std::shared_ptr<const std::vector<Expression>>& shared() const { return shared_; }
    /// Replaces the shared images and passes each changed image to `visit_change` for modification.
    /// @throws InputError unless `shared` has as many images as before
    void replace(std::shared_ptr<const std::vector<Expression>> shared,
                 const std::function<void(Expression&)>& visit_change);

private:
    std::shared_ptr<const std::vector<Expression>> shared_;
    std::vector<Change> changes_;
};

} // namespace graze
