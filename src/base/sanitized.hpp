#pragma once

namespace graze {

/// Whether a sanitizer watches this code. Sanitizers reserve the whole address space, so that no limit can be set to
/// it, and their allocators keep locks of other threads in a process that is forked. (clang 14 has a question for that,
/// g++ 12 has macros.)
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
