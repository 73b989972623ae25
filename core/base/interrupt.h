#pragma once

namespace caustics {

/// Asks all work of this process to end; any thread and any signal handler may.
void request_interrupt();
bool interrupt_requested();
/// Of a process that was forked after somebody asked the one it comes from.
void forget_interrupt();
/// Throws Interrupted when somebody asked. Work that may take long calls it many times a second;
/// parallel_for() does for every index.
void throw_if_interrupted();

}  // namespace caustics
