#pragma once

namespace caustics {

/// From now on SIGINT or SIGTERM only asks the program to stop; another, a second later, ends it.
void catch_interrupts();
/// Whether somebody asked.
bool interrupt_requested();
/// Throws Interrupted when somebody did. For RunOptions::progress.
void throw_if_interrupted();

}  // namespace caustics
