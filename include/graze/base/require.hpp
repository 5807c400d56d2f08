#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string_view>

namespace graze {

/// Checks of what is handed to the library from C++: cheap where all is well, an InputError that names it where not.

namespace require_detail {
[[noreturn]] void refuse_size(std::size_t given, std::size_t needed, std::string_view what);
[[noreturn]] void refuse_index(std::size_t index, std::size_t size, std::string_view what);
[[noreturn]] void refuse_value(double value, std::string_view what);
[[noreturn]] void refuse_nothing(std::string_view what);
} // namespace require_detail

/// @param what in the plural, such as "states". @throws InputError unless exactly as many are given as are needed
inline void require_size(std::size_t given, std::size_t needed, std::string_view what) {
    if (given != needed)
        require_detail::refuse_size(given, needed, what);
}
/// @throws InputError when there is less room than is needed
inline void require_room(std::size_t given, std::size_t needed, std::string_view what) {
    if (given < needed)
        require_detail::refuse_size(given, needed, what);
}
/// @param what in the singular, such as "mode". @throws InputError unless index < size
inline void require_index(std::size_t index, std::size_t size, std::string_view what) {
    if (index >= size)
        require_detail::refuse_index(index, size, what);
}
/// @param what with its article, such as "a source". @throws InputError for a pointer to nothing @return the pointer
template <class T>
std::shared_ptr<T> required(std::shared_ptr<T> pointer, std::string_view what) {
    if (!pointer)
        require_detail::refuse_nothing(what);
    return pointer;
}
/// @throws InputError for NaN and infinities
void require_finite(double value, std::string_view what);
void require_finite(std::span<const double> values, std::string_view what);

} // namespace graze
