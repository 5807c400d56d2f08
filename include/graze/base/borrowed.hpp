#pragma once

#include <memory>

namespace graze {

/// A share of an object that somebody else owns, such as one on the stack, for whoever keeps a share. Every other share
/// keeps its object alive; this one does not: the object must live as long as whatever it is lent to.
template <class T>
std::shared_ptr<T> borrowed(T& object) {
    return {std::shared_ptr<void>(), &object};
}

} // namespace graze
