#pragma once

#include "python/binding.hpp"

#include <functional>
#include <mutex>
#include <utility>

namespace graze::python {

/// A value that several threads change and read, such as how far they are.
template <class Value>
class Noted {
public:
    void note(Value value) {
        const std::lock_guard lock(mutex_);
        value_ = std::move(value);
    }
    template <class Change>
    void change(const Change& change) {
        const std::lock_guard lock(mutex_);
        change(value_);
    }
    Value now() const {
        const std::lock_guard lock(mutex_);
        return value_;
    }

private:
    mutable std::mutex mutex_;
    Value value_{};
};

/// For `attended`: calls a function of Python with what `object` gives at present; empty for None.
template <class Object>
std::function<void()> telling(const py::object& told, Object object) {
    if (told.is_none())
        return {};
    return [told, object = std::move(object)] { told(object()); };
}

} // namespace graze::python
