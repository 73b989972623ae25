#pragma once

namespace caustics::support {

/// Whether a sanitizer watches: it multiplies time and memory.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool sanitized = true;
#else
inline constexpr bool sanitized = false;
#endif

/// How often a test repeats what needs numbers and not new code: a twentieth under a sanitizer.
inline constexpr int repetitions(int count) { return sanitized ? count / 20 : count; }

}  // namespace caustics::support
