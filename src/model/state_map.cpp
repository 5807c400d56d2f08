#include "graze/model/state_map.hpp"

#include "graze/base/input_error.hpp"
#include "graze/base/require.hpp"

#include <algorithm>
#include <utility>

namespace graze {

StateMap::StateMap(std::vector<Expression> images)
    : shared_(std::make_shared<const std::vector<Expression>>(std::move(images))) {}

StateMap::StateMap(std::initializer_list<Expression> images) : StateMap(std::vector<Expression>(images)) {}

StateMap::operator std::vector<Expression>() const {
    if (!shared_)
        return {};
    std::vector<Expression> images = *shared_;
    for (const Change& change : changes_)
        images[change.state] = change.image;
    return images;
}

const Expression& StateMap::operator[](std::size_t state) const {
    require_index(state, size(), "state");
    const auto change = std::ranges::lower_bound(changes_, state, {}, &Change::state);
    return change != changes_.end() && change->state == state ? change->image : (*shared_)[state];
}

Expression& StateMap::operator[](std::size_t state) {
    require_index(state, size(), "state");
    auto change = std::ranges::lower_bound(changes_, state, {}, &Change::state);
    if (change == changes_.end() || change->state != state)
        change = changes_.insert(change, {state, (*shared_)[state]});
    return change->image;
}

void StateMap::push_back(const Expression& image) {
    std::vector<Expression> images = *this;
    images.push_back(image);
    *this = std::move(images);
}

void StateMap::pop_back() {
    require_index(0, size(), "state");
    std::vector<Expression> images = *this;
    images.pop_back();
    *this = std::move(images);
}

bool operator==(const StateMap& one, const StateMap& other) {
    if (one.size() != other.size())
        return false;
    for (std::size_t state = 0; state < one.size(); ++state)
        if (!(one[state] == other[state]))
            return false;
    return true;
}

void StateMap::replace(std::shared_ptr<const std::vector<Expression>> shared,
                       const std::function<void(Expression&)>& visit_change) {
    if ((shared ? shared->size() : 0) != size())
        throw InputError("a map of states cannot be given another number of them", "");
    shared_ = std::move(shared);
    for (Change& change : changes_)
        visit_change(change.image);
}

} // namespace graze
