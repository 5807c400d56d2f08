#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

namespace graze {

/// Checks of arguments handed to the library from C++: cheap when they pass, an InputError naming the argument if not.

namespace require_detail {
[[noreturn]] void refuse_size(std::size_t given, std::size_t needed, std::string_view what);
[[noreturn]] void refuse_index(std::size_t index, std::size_t size, std::string_view what);
[[noreturn]] void refuse_value(double value, std::string_view what);
[[noreturn]] void refuse_nothing(std::string_view what);
} // namespace require_detail

/// @param what names the items in the plural, such as "states". @throws InputError unless given == needed
inline void require_size(std::size_t given, std::size_t needed, std::string_view what) {
    if (given != needed)
        require_detail::refuse_size(given, needed, what);
}
/// @throws InputError if a buffer of `given` items is smaller than `needed`
inline void require_room(std::size_t given, std::size_t needed, std::string_view what) {
    if (given < needed)
        require_detail::refuse_size(given, needed, what);
}
/// @param what names the item in the singular, such as "mode". @throws InputError unless index < size
inline void require_index(std::size_t index, std::size_t size, std::string_view what) {
    if (index >= size)
        require_detail::refuse_index(index, size, what);
}
/// Returns an item of a list. @throws InputError as require_index
template <class Item>
const Item& item_at(const std::vector<Item>& items, std::size_t index, std::string_view what) {
    require_index(index, items.size(), what);
    return items[index];
}
/// @param what names the object in the message with its article, such as "a source". @throws InputError for a null
/// pointer. @return the pointer
template <class T>
std::shared_ptr<T> required(std::shared_ptr<T> pointer, std::string_view what) {
    if (!pointer)
        require_detail::refuse_nothing(what);
    return pointer;
}
/// @throws InputError for NaN and infinities. @param what names the value in the message
void require_finite(double value, std::string_view what);
void require_finite(std::span<const double> values, std::string_view what);

} // namespace graze
