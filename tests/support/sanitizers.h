#pragma once

// g++ has macros of its own for them, clang++ a question.
#if defined(__SANITIZE_ADDRESS__)
#define CAUSTICS_ADDRESS_SANITIZER 1
#elif defined(__has_feature)
#define CAUSTICS_ADDRESS_SANITIZER __has_feature(address_sanitizer)
#else
#define CAUSTICS_ADDRESS_SANITIZER 0
#endif
#if defined(__SANITIZE_THREAD__)
#define CAUSTICS_THREAD_SANITIZER 1
#elif defined(__has_feature)
#define CAUSTICS_THREAD_SANITIZER __has_feature(thread_sanitizer)
#else
#define CAUSTICS_THREAD_SANITIZER 0
#endif

namespace caustics::support {

/// Whether a sanitizer watches: it multiplies time and memory.
#if CAUSTICS_ADDRESS_SANITIZER || CAUSTICS_THREAD_SANITIZER
inline constexpr bool sanitized = true;
#else
inline constexpr bool sanitized = false;
#endif

/// How often a test repeats what needs numbers and not new code: a twentieth under a sanitizer.
inline constexpr int repetitions(int count) { return sanitized ? count / 20 : count; }

}  // namespace caustics::support
