#pragma once

namespace graze {

/// True when the code is built with a sanitizer. Sanitizers reserve the whole address space, so that it cannot be
/// limited, and their allocators may hold locks of other threads after a fork. (clang 14 offers __has_feature, g++ 12
/// macros.)
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool sanitized = true;
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer) || __has_feature(memory_sanitizer)
inline constexpr bool sanitized = true;
#else
inline constexpr bool sanitized = false;
#endif
#else
inline constexpr bool sanitized = false;
#endif

} // namespace graze
